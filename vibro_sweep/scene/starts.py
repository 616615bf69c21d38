"""Where the orbits of a scene begin."""

from dataclasses import dataclass, field

import numpy as np

from vibro_sweep.oscillator.function_model import FunctionModel
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.tables.coordinates import START, state

from .fields import Form
from .form import FollowStart, RandomStart
from .problems import problem


@dataclass(frozen=True)
class Start:
    """The states of orbits at t = 0.

    kind : "state", "random" or "follow"
    state : (2N,), x1 v1 .. xN vN; of a `follow` that of its first point
    count, seed : of random starts, how many at each point, and the seed
    box : of random starts, (coordinate, low, high) of those whose range is given
    direction : of a `follow`, "up", "down" or "both"
    rest : nothing is said of the state: at rest, and where zero is behind a stop held by that. A state of zeros that is
        said is never behind one

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> from vibro_sweep.types import Start
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> data = vs.sweep(system, {"b": [3.5, 3.8]}, start=Start("random", count=3), transient=300, record=20)
    >>> dict(data.period.sizes)
    {'b': 2, 'start': 3}
    """

    kind: str = "state"
    state: tuple[float, ...] = ()
    count: int = 1
    seed: int = 0
    box: tuple[tuple[str, float, float], ...] = ()
    direction: str | None = None
    rest: bool = field(default=False, compare=False)


def start_of(form: Form, masses: int) -> Start:
    """The Start that a form describes."""
    if isinstance(form, RandomStart):
        return Start("random", count=form.random, seed=form.seed, box=tuple((k, *v) for k, v in form.box.items()))
    values, names = tuple(getattr(form, name) for name in state(masses)), state(masses)
    rest = not form.model_fields_set.intersection(names)
    if isinstance(form, FollowStart):
        return Start("follow", state=values, direction=form.follow, rest=rest)
    return Start("state", state=values, rest=rest)


def start_problems(form: Form, sweep, system: Oscillator | None, masses: int) -> list[str]:
    """The problems of the start, given or swept, in this system (None: it is wrong itself)."""
    if isinstance(form.start, FollowStart) and form.sweep is None:
        return [problem("start.follow", form.start.follow, "there is no sweep to follow")]
    names = state(masses)
    swept = [name for name in names if form.sweep and name in form.sweep.model_fields_set]
    for word in ("random", "follow"):
        if swept and hasattr(form.start, word):
            text = f"the sweep over {', '.join(swept)} says where orbits start; give one state or leave it out"
            return [problem(f"start.{word}", getattr(form.start, word), text)]
    for name in swept:
        if name in form.start.model_fields_set:
            text = "is swept, and would have no effect here; leave it out"
            return [problem(f"start.{name}", getattr(form.start, name), text)]
    if isinstance(form.start, RandomStart):
        for key, ends in form.start.box.items():
            if key not in names:
                return [problem("start.box", key, f"must be a coordinate: {', '.join(names)}")]
            if not (len(ends) == 2 and ends[0] < ends[1]):
                return [problem(f"start.box.{key}", ends, "must be two numbers, the lower end and a greater one")]
    if system is None or form.dynamics == "map":  # points of the map may lie beyond the stops
        return []
    if isinstance(form.start, RandomStart):
        nowhere = system.numbers.get("b", 1.0) == 0 or 0 in sweep.get("b", [])
        text = "random states lie within the clearance b, which is 0 here; give a state"
        said = {*names[::2]} <= {*form.start.box}
        return [problem("start.random", form.start.random, text)] if nowhere and not said else []
    if isinstance(system, FunctionModel):
        return []  # where its stops are is known point by point; states behind one begin at it
    named = [name for name in names if name in swept or name in form.start.model_fields_set]
    return _behind(form, sweep, system, names, swept) if named else []


def _behind(form: Form, sweep, system: Oscillator, names, swept) -> list[str]:
    """States with the gap behind a stop, at the corners of the sweep: both are linear in what is swept."""
    along = system.linear.contact.normal
    used = [name for i, name in enumerate(names[::2]) if along[i]]
    path = next((f"sweep.{name}" for name in used if name in swept), f"start.{used[0]}")
    gaps = np.zeros(1)
    for i, name in enumerate(names[::2]):
        values = sweep.get(START[name], [getattr(form.start, name)])
        gaps = np.add.outer(gaps, along[i] * np.array([min(values), max(values)])).ravel()
    low, high = stops_of(system, sweep)
    left, right = system.linear.contact.is_compliant((-1, 1))
    low, high = -np.inf if left else low, np.inf if right else high
    if low <= gaps.min() and gaps.max() <= high:
        return []
    worst = float(gaps.max() if gaps.max() > high else gaps.min())
    what = (
        f"|x1| must be <= {high!r}"
        if low == -high and system.gap_is_x1
        else f"the gap must be from {low!r} to {high!r}"
    )
    origin = ", the smallest b of the sweep" if "b" in sweep else ""
    return [problem(path, worst, f"is behind a stop; {what}{origin}")]


def stops_of(system: Oscillator, sweep) -> tuple[float, float]:
    """The narrowest positions of the stops in a sweep, infinite where there is none."""
    if isinstance(system, FunctionModel):
        return system.linear.contact.low, system.linear.contact.high
    b, offset = (sweep.get(name, [system.numbers.get(name, 0.0)]) for name in ("b", "offset"))
    stops = system.options.get("stops", "both")
    low = float(max(offset) - min(b)) if stops != "right" else -np.inf
    high = float(min(offset) + min(b)) if stops != "left" else np.inf
    return low, high
