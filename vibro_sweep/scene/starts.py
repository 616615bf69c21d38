"""Where the orbits of a scene begin."""

from dataclasses import dataclass

from vibro_sweep.model.oscillator import System
from vibro_sweep.model.state import START, STATE

from .form import FollowStart, RandomStart, SceneForm
from .problems import problem


@dataclass(frozen=True)
class Start:
    """Where orbits begin at t = 0. `kind`: "state" | "random" | "follow"."""

    kind: str = "state"
    state: tuple[float, ...] = (0.0,) * len(STATE)  # (x1, v1, x2, v2); of a `follow`: of its first point
    count: int = 1  # random starts at each point
    seed: int = 0
    direction: str | None = None  # of a `follow`: "up" | "down" | "both"


def start_of(form) -> Start:
    """The Start that a form describes."""
    if isinstance(form, RandomStart):
        return Start("random", count=form.random, seed=form.seed)
    if isinstance(form, FollowStart):
        return Start("follow", state=_state(form), direction=form.follow)
    return Start("state", state=_state(form))


def _state(form) -> tuple[float, ...]:
    return tuple(getattr(form, name) for name in STATE)


def start_problems(form: SceneForm, sweep, system: System | None) -> list[str]:
    """What is wrong with the start, given or swept, in this system (None: it is wrong itself)."""
    if isinstance(form.start, FollowStart) and form.sweep is None:
        return [problem("start.follow", form.start.follow, "there is no sweep to follow")]
    swept = [name for name in STATE if form.sweep and name in form.sweep.model_fields_set]
    for word in ("random", "follow"):
        if swept and hasattr(form.start, word):
            text = f"the sweep over {', '.join(swept)} says where orbits start; give one state or leave it out"
            return [problem(f"start.{word}", getattr(form.start, word), text)]
    for name in swept:
        if name in form.start.model_fields_set:
            text = "is swept, and would have no effect here; leave it out"
            return [problem(f"start.{name}", getattr(form.start, name), text)]
    if system is None or form.model == "map":  # points of the map may lie beyond the stops
        return []
    path, values = "start.x1", [getattr(form.start, "x1", 0.0)]
    if "x1" in swept:
        path, values = "sweep.x1", sweep.get(START["x1"], [0.0])
    b, origin = system.b, ""
    if "b" in sweep:
        b, origin = float(sweep["b"].min()), ", the smallest b of the sweep"
    left, right = form.system.stops != "right", form.system.stops != "left"
    for x1 in (float(max(values)), float(min(values))):
        if (right and x1 > b) or (left and x1 < -b):
            return [problem(path, x1, f"is behind a stop; |x1| must be <= {b!r}{origin}")]
    return []
