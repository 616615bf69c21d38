"""The orbit at a value of the swept number: what a click shows of it."""

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from vibro_sweep.analysis.periodic.itinerary import canonical_start, word
from vibro_sweep.analysis.single.orbit import simulate
from vibro_sweep.driver.block_columns import columns_of, whole_block
from vibro_sweep.driver.compute import compute
from vibro_sweep.live.requests import View
from vibro_sweep.live.views import scene_of_view
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.scene import Scene, Section
from vibro_sweep.tables.coordinates import state
from vibro_sweep.tables.outcomes import is_valid, status_of

SAMPLES = 200  # in a forcing period
MOST_SHOWN, UNSETTLED = 60, 8  # forcing periods: of a periodic orbit, of another one
LONGEST = 500  # forcing periods of which impacts are counted
RELAXING = 300  # forcing periods passed first where stops relax: where these are is not part of a state


class Settled(NamedTuple):
    """An orbit after its transient: its oscillator, where it ends, its section points (record, 2 N), what is known."""

    system: Oscillator
    end: np.ndarray
    section: np.ndarray
    period: int
    status: int
    exponents: np.ndarray
    errors: np.ndarray
    alone: bool  # whether it was computed by itself, and not from where the points before it lead
    mapping: bool  # whether it is one of the discontinuity mapping, which has no motion between its points


def settled(view: View, value: float, start: int, end: np.ndarray | None) -> Settled:
    """The orbit at a value of the swept number; end: where its orbit in the diagram has ended, to go on from there.

    Random starts are those that the diagram has at this value.
    """
    scene = replace(scene_of_view(view), section=Section())
    system = scene.system.replace(**{view.axis: value})
    places = np.flatnonzero(scene.sweep[view.axis] == value)
    if end is None and scene.start.kind == "random" and len(places):
        return _drawn(scene, system, int(places[0]), start)
    if end is not None:
        of_one_orbit = scene.replace(system=system, sweep=None, start=end, transient=_lead(system))
    else:
        alone = None if scene.start.kind != "follow" else scene.start.state
        of_one_orbit = scene.replace(system=system, sweep=None, **({} if alone is None else {"start": alone}))
    return _computed(of_one_orbit, system, start, scene.start.kind == "follow" and end is None)


def _lead(system: Oscillator) -> int:
    return RELAXING if system.linear.contact.by_force else 0


def _drawn(scene: Scene, system: Oscillator, column: int, start: int) -> Settled:
    """The orbit of a random start of a column."""
    block = columns_of(whole_block(scene, _wanted(system)), slice(column, column + 1))
    arrays = {name: values[0] for name, values in compute(block)[1].items()}
    return _settled(scene, system, arrays, start, False)


def _computed(scene: Scene, system: Oscillator, start: int, alone: bool) -> Settled:
    return _settled(scene, system, compute(whole_block(scene, _wanted(system)))[1], start, alone)


def _wanted(system: Oscillator) -> list[str]:
    return [*state(system.masses), "period", "lyapunov", "lyapunov_error", "status", "end"]


def _settled(scene: Scene, system: Oscillator, arrays: dict[str, np.ndarray], start: int, alone: bool) -> Settled:
    if scene.n_starts > 1:
        arrays = {name: values[min(start, scene.n_starts - 1)] for name, values in arrays.items()}
    section = np.stack([arrays[name] for name in state(system.masses)], axis=-1)
    numbers = (int(arrays["period"]), int(arrays["status"]), arrays["lyapunov"], arrays["lyapunov_error"])
    return Settled(system, arrays["end"], section, *numbers, alone, scene.dynamics == "map")


def orbit_message(found: Settled) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Arrays and words on an orbit: samples of its motion, impacts, section points, exponents."""
    system, q = found.system, found.system.linear
    words: dict[str, Any] = {"status": status_of(found.status).text, "period": found.period, "alone": found.alone}
    one = q.contact
    words |= {"T": _finite(system.period), "low": _finite(one.low), "high": _finite(one.high), "masses": system.masses}
    words |= {"normal": one.normal.tolist(), "mapping": found.mapping}
    words["pressed"] = [bool(soft) for soft in one.is_compliant((-1, 1))]
    arrays = {"exponents": found.exponents, "errors": found.errors, "section": found.section.astype("f4").ravel()}
    if found.mapping or not is_valid(found.status):
        return arrays, words | {"periods": 0}
    T, periods = system.period, min(found.period, MOST_SHOWN) if found.period else UNSETTLED
    begin = _lead(system) * T
    orbit = simulate(system, found.end, _lead(system) + max(periods, min(found.period, LONGEST)))
    impacts = orbit.impacts[orbit.impacts["t"] >= begin]
    impacts["t"] -= begin
    if found.period:  # an impact at t = 0 comes again at the end
        impacts = impacts[impacts["t"] < found.period * T * (1 - 1e-9)]
    shown = impacts[impacts["t"] <= periods * T]
    touch, release = (np.nan_to_num(orbit.contacts[name], nan=np.inf) - begin for name in ("t_touch", "t_release"))
    drawn = (touch <= periods * T) & (release > 0)
    pressed = np.maximum(touch[drawn], 0.0), np.minimum(release[drawn], periods * T)
    times = np.unique(np.concatenate([np.linspace(0, periods * T, periods * SAMPLES + 1), shown["t"], *pressed]))
    states = orbit.sample(np.minimum(begin + times, orbit.section_times[-1]))
    rests = int(np.count_nonzero(orbit.sticking["t_off"] >= begin))
    words |= {"periods": periods, "impacts": len(impacts), "rests": rests}
    words |= {"itinerary": _itinerary(impacts, T, found.period), "orbit_status": str(orbit.status)}
    arrays |= {"t": times.astype("f4"), "states": states.astype("f4").ravel()}
    arrays |= {"impact_t": shown["t"].astype("f4"), "impact_side": shown["side"].astype("i1")}
    arrays |= {"contact_touch": pressed[0].astype("f4"), "contact_release": pressed[1].astype("f4")}
    return arrays, words | {"contacts": _contacts(touch, release, found.period * T * (1 - 1e-9))}


def _contacts(touch: np.ndarray, release: np.ndarray, end: float) -> int:
    """Contacts of an orbit that repeats itself after the time `end`, where one at t = 0 goes on; 0: it does not."""
    there = (touch >= 0) & (touch < (end or np.inf))
    count = int(np.count_nonzero(there))
    return count - int(end > 0 and count > 1 and touch[there][0] == 0 and release[there][-1] > end)


def _itinerary(impacts: np.ndarray, T: float, period: int) -> str:
    """Of a periodic orbit, from its impacts."""
    sides = impacts["side"]
    return word(np.roll(sides, -canonical_start(sides, impacts["t"], T, period * T))) if 0 < period <= LONGEST else ""


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
