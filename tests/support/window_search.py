"""A search for windows that are wrong: random sweeps with half and twice the values, and with other starts."""

import itertools
import tempfile
from functools import partial
from pathlib import Path

import numpy as np

import vibro_sweep as vs
from support import conditions
from support.compliant_branches import BY_FORCE, drawn_stops
from support.compliant_branches import MODELS as COMPLIANT
from support.drawn_branches import MODELS, drawn_number, drawn_oscillator
from support.searching import Report, new_report
from support.windows import check_end
from vibro_sweep.analysis.periodic.periodic_orbit import orbit_of
from vibro_sweep.analysis.windows.job import Job, lies_on, window_of
from vibro_sweep.analysis.windows.members import solution_in
from vibro_sweep.driver.windows import rows_in
from vibro_sweep.files.reading import sweep_in
from vibro_sweep.tables.outcomes import REASONS

NEAR_ENDS = (1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12)  # shares of a window from its ends
CLOSE = 1e-9  # of the range: ends of one window differ by less
NARROW = 1e-11  # of the range: a window found from a value of a sweep is wider
RESOLVED = 1e-7  # of the range: in a narrower window simulations do not tell orbits inside from those outside
EXPLAINED = ("in_a_window", "sticking", "not_isolated", "permanent_contact", "unrelaxed")  # reasons that hold
BESIDE = 1e-8  # of a state: the step of differences


def swept(system, name, values, seed, folder):
    """(Dataset, windows, the bounds within which they are followed) of a sweep with two random starts."""
    path = Path(folder) / f"{len(values)}-{seed}.h5"
    start = {"random": 2, "seed": seed}
    data = vs.sweep(system, {name: values}, start=start, transient=600, record=100, output=path, workers=1)
    with sweep_in(path, computes=True) as contents:
        (row,) = rows_in(contents, name)
    return data, vs.windows(path), row.bounds


def at(window, value):
    """The orbit of a window at a value within it."""
    system = window._system.replace(**{window.parameter: float(value)})
    return orbit_of(system, solution_in(window._arrays, float(value), system))


def drawn(seed: int, compliant: bool, rng):
    """(model, oscillator) of a search."""
    if not compliant:
        model = MODELS[seed % len(MODELS)]
        return model, drawn_oscillator(model, rng)
    model = COMPLIANT[seed % len(COMPLIANT)]
    return model, drawn_stops(model, rng, "displacement" if seed < BY_FORCE else "force")


def off_and_largest(orbit) -> tuple[float, float]:
    """By how much an orbit misses itself after its period, and its largest multiplier in size, not as the core says:
    of rigid stops by saltation matrices, of compliant ones by differences of simulations."""
    if not orbit.system.linear.compliant:
        found, *_ = conditions.at_point(orbit)
        return float(found.off[0]), float(np.abs(np.linalg.eigvals(found.matrix[0])).max())

    def flown(state):
        return vs.simulate(orbit.system, state, orbit.period).section[-1]

    step = min(BESIDE, max(orbit.stop_distance / 10, 1e-12))  # that touches the stop at no other place
    ends = [[flown(orbit.state + sign * step * one) for sign in (1, -1)] for one in np.eye(len(orbit.state))]
    columns = [(there - back) / (2 * step) for there, back in ends]
    size = np.abs(orbit.state).max()
    return float(np.abs(flown(orbit.state) - orbit.state).max() / size), float(
        np.abs(np.linalg.eigvals(np.array(columns).T)).max()
    )


def study(seed: int, compliant: bool = False) -> Report:
    rng, report = np.random.default_rng([seed, 1]), new_report()
    model, system = drawn(seed, compliant, rng)
    name, (lo, hi) = drawn_number(system, rng)
    lo = max(lo, 0.0) if name in ("c_stop", "preload") else lo
    count = 2 * int(rng.integers(6, 11)) + 1
    values = np.linspace(lo, hi, count) if hi > lo else None
    where = f"sweep {seed}, {model}, {name} {lo:.9g} .. {hi:.9g}, {count} values"

    def wrong(kind, words):
        report.wrong.append(f"{where}: {kind}: {words}")

    found = []
    with tempfile.TemporaryDirectory() as folder:
        runs = [(values, 0), (values[::2], 0), (np.linspace(lo, hi, 2 * count - 1), 0), (values, 1)]
        for chosen, start in runs:
            try:
                found.append(swept(system, name, chosen, start, folder))
            except Exception as error:
                wrong(f"raises {type(error).__name__}", f"{len(chosen)} values, starts {start}: {error!r:.200}")
        for data, windows, bounds in found:
            size = hi - lo
            report.counted["sweeps"] += 1
            report.counted["windows"] += len(windows)
            for window in windows:
                one_window(report, wrong, window, size)
                if data is found[0][0] and not window.orbit.sticking.size:
                    other_starts(report, wrong, window, bounds)
            covered(report, wrong, data, windows, name)
            data.close()
        for (_, one, _), (_, other, _) in itertools.combinations(found, 2):
            for a in one:
                for b in other:
                    same_window(report, wrong, a, b, hi - lo)
    return report


study_of_compliant = partial(study, compliant=True)


def one_window(report, wrong, window, size) -> None:
    words = f"{window.itinerary or 'free'} of period {window.period}, {window.lo!r} .. {window.hi!r}"
    if not window.hi - window.lo > NARROW * size:
        wrong("no width", words)
        return
    orbit = window.orbit
    value = getattr(orbit.system, window.parameter)
    if not window.lo <= value <= window.hi:
        wrong("orbit outside", f"{words}: {value!r}")
    compliant = orbit.system.linear.compliant
    for kind, more in [] if compliant else conditions.not_reduced(orbit, window.parameter):
        wrong(kind, f"{words}: {more}")
    for special in (window.lower, window.upper):
        report.counted[special.type] += 1
        far, more = (np.nan, "") if compliant else conditions.distance(special)
        if not np.isnan(far) and not far < conditions.MEETS:
            wrong(f"condition of {special.type}", f"{words}: {far:.1e}, {more}")
    if orbit.sticking.size:
        report.counted["rests"] += 1
        return
    if compliant and window.hi - window.lo < RESOLVED * size:
        report.counted["too narrow"] += 1
        return
    for special, outwards in ((window.lower, -1), (window.upper, 1)):
        try:
            told = check_end(window, special, outwards)
        except Exception as error:
            told = f"{error!r:.100}"
        if told is not None:
            wrong(f"end {special.type}", f"{words}: at {special.parameters[window.parameter]!r} {told}")
    for share in (1e-4, 0.3, 0.7, 1 - 1e-4):
        value = window.lo + share * (window.hi - window.lo)
        inner = at(window, value)
        if inner._solution is None:
            report.counted["not found inside"] += 1
            continue
        report.counted["inside"] += 1
        off, largest = off_and_largest(inner)
        if not off < 1e-7 or not inner.ok:
            wrong("not an orbit inside", f"{words}: at {value!r} off {off:.1e}, {inner.status}")
        elif not largest < 1 + (1e-4 if compliant else 1e-9):
            wrong("not stable inside", f"{words}: at {value!r} {largest!r}")


def other_starts(report, wrong, window, bounds) -> None:
    """The window again, from its orbits near both ends and in the middle."""
    size = bounds[1] - bounds[0]
    for share in (0.5, *NEAR_ENDS, *(1 - share for share in NEAR_ENDS)):
        value = window.lo + share * (window.hi - window.lo)
        if not window.lo < value < window.hi:
            continue
        inner = at(window, value)
        if not (inner.ok and inner.stable) or (inner.itinerary, inner.period) != (
            window.orbit.itinerary,
            window.period,
        ):
            report.counted["starts not found"] += 1
            continue
        result = window_of(Job(inner.system, inner.state, inner.period, window.parameter, bounds))
        words = (
            f"{window.itinerary or 'free'} of period {window.period}, {window.lo!r} .. {window.hi!r}, from {value!r}"
        )
        report.counted["starts"] += 1
        beside = (
            min(share, 1 - share) <= 1e-6
        )  # there Newton's method may find no orbit, and WindowSearch takes it back
        if "reason" in result:
            reason = REASONS[int(result["reason"])].name
            report.counted[f"starts {reason}"] += 1
            if not beside:
                wrong(f"start in the window: {reason}", words)
            continue
        lo, hi = result["special_value"][[0, -1]].tolist()
        if max(abs(lo - window.lo), abs(hi - window.hi)) <= CLOSE * size:
            continue
        there = inner.system.replace(**{window.parameter: (lo + hi) / 2})
        stable = off_and_largest(orbit_of(there, solution_in(result, (lo + hi) / 2, there)))[1] < 1
        if beside and stable and min(abs(lo - value), abs(hi - value)) <= CLOSE * size:
            report.counted["neighbours"] += 1  # the window that begins where this one ends
        else:
            wrong("start: ends differ", f"{words}: {lo!r} .. {hi!r}, stable {stable}")


def covered(report, wrong, data, windows, name) -> None:
    """Each periodic orbit of the sweep is in a window, or has a reason that holds."""
    period = data["period"].transpose(name, ...).values
    last = [
        data[key].isel({d: -1 for d in data[key].dims if d not in (name, "start")}).transpose(name, ...).values
        for key in [
            f"{kind}{i + 1}" for i in range(windows[0]._system.linear.masses if len(windows) else 0) for kind in "xv"
        ]
    ]
    values = data[name].values
    for place in np.argwhere(period > 0).tolist():
        reason = REASONS[int(windows.reason[tuple(place)])].name
        report.counted[f"periodic: {reason}"] += 1
        if reason in EXPLAINED:
            continue
        value = float(values[place[0]])
        state = np.array([one[tuple(place)] for one in last])
        words = f"at {value!r}, period {period[tuple(place)]}, start {place[1:]}"
        for window in windows:
            if window.lo < value < window.hi and period[tuple(place)] % window.period == 0:
                orbit = at(window, value)
                if orbit.ok and lies_on(orbit, state):
                    wrong(f"covered, but {reason}", f"{words}: {window.itinerary} {window.lo!r} .. {window.hi!r}")
                    break
        else:
            wrong(f"periodic, but {reason}", words)


def same_window(report, wrong, a, b, size) -> None:
    """Windows of two sweeps that are of the same orbit have the same ends."""
    if (a.itinerary, a.period, a.symmetric) != (b.itinerary, b.period, b.symmetric):
        return
    lo, hi = max(a.lo, b.lo), min(a.hi, b.hi)
    if not hi - lo > NARROW * size:
        return
    orbits = [at(one, (lo + hi) / 2) for one in (a, b)]
    speeds = [
        np.sort([*one.impacts["v1"], *(one.contacts["side"] * one.contacts["v_touch"])]) for one in orbits
    ]  # with their sides, which tell an orbit from its mirror image
    if not all(orbit.ok for orbit in orbits) or np.ptp(speeds, axis=0).max(initial=0.0) > 1e-7 * np.abs(speeds).max(
        initial=0.0
    ):
        return
    report.counted["pairs"] += 1
    for end in ("lower", "upper"):
        x, y = getattr(a, end), getattr(b, end)
        p, q = x.parameters[a.parameter], y.parameters[a.parameter]
        if x.type != y.type or not abs(p - q) <= CLOSE * size:
            wrong("ends differ", f"{a.itinerary or 'free'} of period {a.period}: {x.type} {p!r} and {y.type} {q!r}")
        elif not abs(p - q) <= 10 * (x.error + y.error) and x.type != "boundary":
            wrong("errors of ends", f"{x.type} {p!r} and {q!r}: {x.error:.1e}, {y.error:.1e}")
