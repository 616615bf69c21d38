"""Why a window ends: the periodic orbit of a column is followed along the swept number to where it is not stable."""

from collections.abc import Callable
from typing import Any

import numpy as np

from vibro_sweep.analysis.branches.branch import Branch, continue_orbit
from vibro_sweep.analysis.branches.branch_arrays import Arrays, arrays_of, branch_of, sections_of
from vibro_sweep.analysis.branches.branch_switching import switch
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit
from vibro_sweep.analysis.windows.job import Job, window_of
from vibro_sweep.live.clicked_orbit import Settled
from vibro_sweep.live.requests import View
from vibro_sweep.live.views import PEAKS, SPEEDS, height_of
from vibro_sweep.oscillator.checked_numbers import range_of
from vibro_sweep.tables.bifurcations import BY_NAME, GRAZES
from vibro_sweep.tables.coordinates import state
from vibro_sweep.tables.exponents import CERTAIN
from vibro_sweep.tables.outcomes import REASONS, is_valid, named, status_of

MOST_POINTS = 300  # of a branch that is drawn
NEAR = 1e-9  # relative: grazes nearer than this are the same


def window_message(
    view: View, value: float, settled_orbit: Settled, progress: Callable[[int, float], None]
) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Arrays and words on the window around a value: its ends, and the branches that meet there; or `reason`.

    The first branch is that of which the window is a part. progress : as of `continue_orbit`
    """
    if settled_orbit.mapping:
        return {}, {"reason": "windows are those of the oscillator itself, and this is its mapping"}
    if settled_orbit.period == 0:
        return {}, {"reason": _not_periodic(settled_orbit)}
    bounds = _bounds(view, settled_orbit)
    job = Job(settled_orbit.system, settled_orbit.end, settled_orbit.period, view.axis, bounds)
    arrays = window_of(job)
    if "reason" in arrays:
        found_out = REASONS[int(arrays["reason"])]
        return {}, {"reason": f"no window here: {found_out.text}. {found_out.advice}".strip()}
    window = branch_of(arrays, view.axis, settled_orbit.system)
    orbit = window._start
    event = "contact" if settled_orbit.system.linear.compliant else "impact"
    words: dict[str, Any] = {"low": _end(window.begins, -1, event), "high": _end(window.ends, 1, event), "event": event}
    words |= {"period": int(arrays["branch_period"]), "symmetric": bool(arrays["branch_symmetric"])}
    origin = settled_orbit.system.replace(**{view.axis: float(arrays["value"][int(arrays["branch_origin"])])})
    orbit = PeriodicOrbit(origin, "ok", orbit)
    words["itinerary"] = orbit.itinerary
    words["mirrored"] = settled_orbit.system.linear.symmetric and not orbit.symmetric
    branches = [continue_orbit(orbit, view.axis, bounds, progress)]
    branches += _met((window.begins, window.ends), view.axis, bounds, progress)
    drawn = [_drawn(view, settled_orbit, _thinned(arrays_of(branch, value))) for branch in branches]
    words["specials"] = [_end(special, 0, event) for special in branches[0].special]
    words["branches"] = [[len(lines["value"]), len(lines["y"]) // len(lines["value"])] for lines in drawn]
    return {name: np.concatenate([lines[name] for lines in drawn]) for name in drawn[0]}, words


def _met(ends: tuple[SpecialPoint, ...], axis: str, bounds: tuple[float, float], progress) -> list[Branch]:
    """The branches that a motion meets at grazes, where an impact appears or vanishes; one that leads from graze to
    graze once."""
    beyond: list[Branch] = []
    for end in ends:
        if end.type == "graze" and not any(_ends_at(branch, end, axis) for branch in beyond):
            beyond += [continue_orbit(start, axis, bounds, progress) for start in switch(end)]
    return beyond


def _ends_at(branch: Branch, end: SpecialPoint, axis: str) -> bool:
    value = end.parameters[axis]
    near = NEAR * max(abs(value), 1.0)
    return any(special.type == "graze" and abs(special.parameters[axis] - value) <= near for special in branch.special)


def _not_periodic(settled_orbit: Settled) -> str:
    if not is_valid(settled_orbit.status):
        return status_of(settled_orbit.status).text
    if settled_orbit.exponents[0] > CERTAIN * settled_orbit.errors[0]:
        return "no window here: " + named(REASONS, "chaos").text
    return "no window here: no period was found within the record; a longer transient or record may find one"


def _bounds(view: View, settled_orbit: Settled) -> tuple[float, float]:
    """What is looked at: the view, and as much again on both sides where the number may be there."""
    (begin, end), width = view.ends, view.ends[1] - view.ends[0]
    allowed = range_of(settled_orbit.system.described[view.axis], settled_orbit.system.options.get("stops", "both"))
    low, high = (
        wide if allowed.holds(np.array(wide)) else near for wide, near in ((begin - width, begin), (end + width, end))
    )
    return float(low), float(high)


def _end(point: SpecialPoint, side: int, event: str) -> dict[str, Any]:
    """What a special point is. side: -1, 1 of the lower and the upper end of a window; 0 of another point. event: what
    happens at a stop, an impact or a contact."""
    (value,) = point.parameters.values()
    beyond = point.type == "boundary"
    text = "it is stable beyond what was looked at" if side and beyond else BY_NAME[point.type].text
    if point.type == "graze":
        stop = "right" if (point.stop or 1) > 0 else "left"
        change = "an impact loses its speed" if point.impact is not None else "a flight touches a stop"
        text = f"{stop} stop, {change}: {point.kind}; {GRAZES[point.kind.replace(' ', '_')]}"
    elif point.criticality:
        text += f" ({point.criticality}critical)"
    if event == "contact":
        text = text.replace("an impact", "a contact").replace("impact", "contact")
    error = float(point.error) if np.isfinite(point.error) else None
    return {"value": value, "error": error, "type": point.type, "text": text}


def _thinned(arrays: Arrays) -> Arrays:
    """A branch with no more points than are drawn: those where its stability changes, and others evenly."""
    n = len(arrays["value"])
    changes = np.flatnonzero(np.diff(np.minimum(arrays["unstable"], 1)))
    keep = np.unique(np.r_[np.linspace(0, n - 1, min(n, MOST_POINTS)).astype(int), changes, changes + 1])
    of_points = ("value", "unstable", "impact_t", "impact_v", "impact_t_off")
    return arrays | {name: arrays[name][keep] for name in of_points}


def _drawn(view: View, settled_orbit: Settled, arrays: Arrays) -> dict[str, np.ndarray]:
    """Values (n,), whether unstable (n,), and what stands on the vertical axis (n, m) of the section points."""
    if view.y in PEAKS:  # which branches do not have
        points = np.empty((len(arrays["value"]), 0))
    elif view.y in SPEEDS:
        side = 1 if SPEEDS[view.y] == "right" else -1
        points = np.abs(arrays["impact_v"][:, arrays["impact_side"] == side])
    else:
        states = sections_of(arrays, view.axis, settled_orbit.system)
        named = {name: states[..., i] for i, name in enumerate(state(settled_orbit.system.masses))}
        named["gap"] = states[..., 0::2] @ settled_orbit.system.linear.contact.normal
        points = height_of(settled_orbit.system, view.y, named)
    return {"value": arrays["value"], "unstable": np.minimum(arrays["unstable"], 1).astype("i1"), "y": points.ravel()}
