"""Problems from published material (tests/cases/published.yaml): what the public functions of Python answer."""

import math

import numpy as np
import pytest
from support import cases

import vibro_sweep as vs

WITHIN = 1e-13
TABLE = cases.rows("published")
ROWS = [row for param in TABLE for row in param.values]
RIGHT = [
    pytest.param(row, name, id=f"{row['id']}, {name}", marks=param.marks)
    for param in TABLE
    for row in param.values
    for name in row["right"]
    if name not in row.get("left_out", {})
]
UNFORCED = [row for row in ROWS if not np.any(row["system"].get("F", row["system"].get("force", 1)))]
EVENTS = [("impacts", "t"), ("sticking", "t_on"), ("contacts", "t_touch"), ("contacts", "t_release")]
FIELDS = {"id", "name", "source", "system", "start", "compute", "right", "check", "digits", "how", "left_out", "slow"}


def oscillator(row, **numbers):
    given = row["system"] | numbers
    return vs.Oscillator.named(given["type"], **{name: value for name, value in given.items() if name != "type"})


def state_of(row):
    state = [value for name, value in row.get("start", {}).items() if name != "start_time"]
    return state or None


def motion(row):
    return vs.simulate(
        oscillator(row), state_of(row), row["check"]["periods"], row.get("start", {}).get("start_time", 0.0)
    )


def listed(row, name, values):
    """The values of so many events as are right; all of them, if all are known."""
    return values if row["check"].get("all") else values[: len(row["right"][name])]


def impact_times(row):
    return listed(row, "impact_t", motion(row).impacts["t"])


def touches(row, name, field):
    """Of contacts that begin after the start; of a periodic orbit where nothing is simulated."""
    contacts = (motion(row) if "periods" in row["check"] else periodic(row)).contacts
    return listed(row, name, contacts[field][contacts["t_touch"] > 0])


def releases(row, name, field):
    values = (motion(row) if "periods" in row["check"] else periodic(row)).contacts[field]
    return listed(row, name, values[~np.isnan(values)])


def heights(row):
    """Of the flights after contacts, half of a parabola later."""
    orbit, ((g, *_),) = motion(row), [np.divide(row["system"]["constant"], np.diag(row["system"]["M"]))]
    contacts = orbit.contacts[: len(row["right"]["height"])]
    return orbit.sample(contacts["t_release"] + contacts["v_release"] / g)[:, 0]


def recorded(row, name):
    """A number of a sweep with one point."""
    check, system = row["check"], oscillator(row)
    events = "contacts" if "k_stop" in row["system"] else "impacts"
    data = vs.sweep(
        system, {"omega": [system.omega]}, start=state_of(row), transient=check.get("transient", 0),
        record=check["record"], observe=["section", "energy", events],
    )  # fmt: skip
    assert (data.status == 0).all()
    return data[name].values[0]


def energy_lost(row):
    return recorded(row, "impact_power") * row["check"]["record"] * 2 * math.pi / row["system"]["omega"]


def periodic(row):
    how = dict(row["check"]["orbit"])
    if "start" in row:
        how["state"] = motion(row).section[-1]
    orbit = vs.periodic_orbit(oscillator(row, **row["check"].get("at", {})), **how)
    assert orbit.ok
    return orbit


def specials(row, kind, orbit=None):
    """Values of the number along a branch at special points of a type, in order."""
    ((name, bounds),) = row["check"]["along"].items()
    branch = vs.continue_orbit(orbit or periodic(row), name, tuple(bounds))
    assert branch.ok
    return sorted(one.parameters[name] for one in branch.special if one.type == kind)


def only(values):
    (value,) = values
    return value


def flip_of_two(row):
    """Of the orbit that the first flip bears; where it is born is that flip again."""
    ((name, bounds),) = row["check"]["along"].items()
    first = next(one for one in vs.continue_orbit(periodic(row), name, tuple(bounds)).special if one.type == "flip")
    born, second = specials(row, "flip", vs.switch(first)[0])
    assert born == pytest.approx(first.parameters[name], rel=1e-13)
    return second


def exponents(row):
    """Of the stable orbit; of a motion that repeats itself from its start on."""
    if "orbit" in row["check"]:
        orbit = periodic(row)
        return vs.lyapunov(orbit.system, orbit.state, 0, 100)
    return vs.lyapunov(oscillator(row), state_of(row), 0, row["check"]["record"])


def taps(row):
    """A sweep over the clearance."""
    return vs.sweep(
        oscillator(row), {"b": np.linspace(0.15, 0.95, 41)}, transient=row["check"]["transient"],
        record=row["check"]["record"], observe=["section", "lyapunov", "multipliers"],
    )  # fmt: skip


def exponents_at_each_b(row):
    """Those that are farthest from what is right, where multipliers are a pair."""
    data = taps(row)
    found = data.lyapunov.values[data.multiplier_im.values[:, 0] > 0]
    assert len(found) == 41
    return found[np.abs(found - row["right"]["exponents_at_each_b"]).max(axis=1).argmax()]


def quiet_up_to_eps(row):
    """By bisection: the force is that of eps = 0.5; whether a pair that is at rest in contact stays so."""
    low, high = 0.1, 0.3
    while high - low > 1e-14:
        eps = (low + high) / 2
        forces = {name: [2 * eps * row["system"][name][0]] for name in ("force", "force_cos")}
        orbit = vs.simulate(oscillator(row, **forces), (row["system"]["b"], 0.0), 2)
        stays = len(orbit.impacts) == 0 and len(orbit.sticking) == 1
        low, high = (eps, high) if stays else (low, eps)
    return low


def quiet_ends(row):
    (_, first), (last, _) = vs.quiet(oscillator(row), "omega", (2, 200)).ranges
    return first, last


def resonant_grazes(row):
    orbit = periodic(row)
    (graze,) = [one for one in vs.continue_orbit(orbit, "b", (2, 4)).special if one.type == "graze"]
    curve = vs.bifurcation_curve(graze, ("omega", "b"), ((0.3, 2.6), (0.05, 60)))
    return sorted(one.parameters["omega"] for one in curve.special if one.type == "resonant_graze")


def far_away(row, name):
    """Of the sample 22 nm away, after 9000 periods."""
    data = vs.sweep(oscillator(row), {"b": [2.2e-8]}, transient=9000, record=60)
    if name == "status":
        return data.status.attrs["flag_meanings"].split()[list(data.status.attrs["flag_values"]).index(data.status[0])]
    return data[name].item()


def number_of_windows(row):
    axis = {"b": np.linspace(0.3, 2.9, 53)}
    return len(vs.windows(vs.sweep(oscillator(row), axis, start={"follow": "both"}, transient=600, record=60)))


def period_of_the_gap(row):
    """After how many periods the gap comes back, of a motion whose displacements grow."""
    system = oscillator(row)
    data = vs.sweep(system, {"b": [system.b]}, start=state_of(row), transient=800, record=60, observe=["section"])
    assert data.status.item() == 0
    gap = data.gap.values[0]
    return next(n for n in range(1, 30) if np.abs(gap[n:] - gap[:-n]).max() < 1e-9)


ANSWERS = {
    "impact_t": impact_times,
    "touch_t": lambda row: touches(row, "touch_t", "t_touch"),
    "touch_v": lambda row: touches(row, "touch_v", "v_touch"),
    "release_t": lambda row: releases(row, "release_t", "t_release"),
    "release_v": lambda row: releases(row, "release_v", "v_release"),
    "impact_speed_9": lambda row: -motion(row).impacts["v1"][8],
    "rest_begins": lambda row: motion(row).sticking["t_on"][0],
    "rest_ends": lambda row: motion(row).sticking["t_off"][0],
    "rests": lambda row: listed(row, "rests", [[one["t_on"], one["t_off"]] for one in motion(row).sticking]),
    "state_at_t_top": lambda row: motion(row).sample([row["check"]["t_top"]])[0],
    "state": lambda row: motion(row).section[-1],
    "v2": lambda row: motion(row).section[-1][3],
    "height": heights,
    "energy_lost": energy_lost,
    "rest_in_a_period": lambda row: recorded(row, "sticking_time") / row["check"]["record"],
    "fold": lambda row: only(specials(row, "fold")),
    "flip": lambda row: only(specials(row, "flip")),
    "flips": lambda row: specials(row, "flip"),
    "flip_of_two": flip_of_two,
    "F_displacement": lambda row: only(specials(row, "permanent_contact")),
    "graze": lambda row: vs.grazing(oscillator(row)).b_right,
    "grazes": quiet_ends,
    "quiet_up_to_eps": quiet_up_to_eps,
    "resonant_grazes": resonant_grazes,
    "multipliers": lambda row: periodic(row).multipliers,
    "trace": lambda row: sum(periodic(row).multipliers).real,
    "determinant": lambda row: np.prod(periodic(row).multipliers).real,
    "exponents": exponents,
    "exponents_at_each_b": exponents_at_each_b,
    "t_left": lambda row: periodic(row).impacts["t"][0],
    "t_right": lambda row: periodic(row).impacts["t"][1],
    "v_after_left": lambda row: -row["system"]["R"] * periodic(row).impacts["v1"][0],
    "x1": lambda row: periodic(row).state[0],
    "v1": lambda row: periodic(row).state[1] * 1e-9,
    "ok_without_period": lambda row: int(((taps(row).status == 0) & (taps(row).period == 0)).sum()),
    "status_at_22nm": lambda row: far_away(row, "status"),
    "period_at_22nm": lambda row: far_away(row, "period"),
    "number_of_windows": number_of_windows,
    "period_of_the_gap": period_of_the_gap,
}


def answer(row, name):
    """What the program answers; names with a number in them are of one state, those of files are of a sweep."""
    if name in ANSWERS:
        return ANSWERS[name](row)
    return ANSWERS["state"](row) if name.startswith("state_") else recorded(row, name)


def number(value):
    """A complex one is written with i."""
    return complex(value.replace("i", "j")) if isinstance(value, str) else value


def faults(row, name) -> list[str]:
    found, right = answer(row, name), row["right"][name]
    if isinstance(found, str):
        return [] if found == right else [f"{found}, not {right}"]
    right = np.array([number(value) for value in right] if isinstance(right, list) else number(right))
    if np.shape(found) != right.shape:
        return [f"{np.shape(found)} numbers, not {right.shape}: {found}"]
    size = np.abs(right).max() or 1.0
    off = np.abs(np.asarray(found) - right).max() / size
    return [] if off <= row["check"].get("within", WITHIN) else [f"{off:.2g} from what is right: {found}"]


@pytest.mark.parametrize("row, name", RIGHT)
def test_an_answer(row, name):
    assert faults(row, name) == []


@pytest.mark.parametrize("row", [pytest.param(row, id=row["id"]) for row in UNFORCED if "start" in row])
def test_without_a_force_omega_plays_no_part(row):
    """Events, and states at the same times."""
    system, periods = oscillator(row), row["check"]["periods"]
    one = motion(row)
    end = 0.99 * periods * 2 * math.pi / system.omega
    times = np.linspace(0, end, 30)
    for factor in (0.37, 2.9):
        other = vs.simulate(system.replace(omega=factor * system.omega), state_of(row), math.ceil(factor * periods))
        for kind, name in EVENTS:
            found, again = (getattr(orbit, kind)[name] for orbit in (one, other))
            found, again = found[found < end], again[again < end]
            size = min(len(found), len(again))  # how many impacts of chatter are computed one by one differs
            assert size >= len(row["right"].get({"impacts": "impact_t", "contacts": "touch_t"}.get(kind), []))
            assert np.abs(found[:size] - again[:size]).max(initial=0) < 1e-12 * end
        states = one.sample(times)
        assert np.abs(states - other.sample(times)).max() < 1e-11 * np.abs(states).max()


def test_each_answer_is_compared_or_left_out_for_a_reason():
    left_out = {name for row in ROWS for name in row.get("left_out", {})}
    assert len(ROWS) == 28 and len(RIGHT) == 92 and left_out == {"F_force"} and len(UNFORCED) == 11
    for row in ROWS:
        assert row.keys() <= FIELDS and row.get("left_out", {}).keys() < row["right"].keys()


def test_a_wrong_answer_is_seen():
    row = next(row for row in ROWS if "nine bounces" in row["name"])
    times = row["right"]["impact_t"]
    for wrong in ([*times[:-1], times[-1] * (1 + 1e-12)], [*times, 26.0], times[::-1]):
        assert faults(row | {"right": {"impact_t": wrong}}, "impact_t") != []
    assert faults(row, "impact_t") == []
