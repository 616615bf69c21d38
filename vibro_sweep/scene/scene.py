"""From a YAML text to a Scene: everything that a computation needs to know, checked as a whole."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from vibro_sweep.checks.real import array_of
from vibro_sweep.oscillator.function_model import FunctionModel
from vibro_sweep.oscillator.grid import digest, grid
from vibro_sweep.oscillator.models import MODELS
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.tables.coordinates import START, start
from vibro_sweep.tables.parameters import CYCLES, FREQUENCY
from vibro_sweep.tables.units import shown_unit, unit_in

from .any_scene import AnyScene, parsed
from .combinations import combination_problems, stop_problems
from .form import form_of_function, scene_form
from .problems import SceneError, form_problems, problem
from .size import size_problems
from .starts import Start, start_of, start_problems, stops_of
from .system import in_own_words, kind_of, sweep_of, system_of
from .written import KEYS, ORBIT, changed, progression, start_data, system_data, yaml_of


@dataclass(frozen=True)
class Section:
    """Where an orbit becomes points.

    kind : "phase", at t = 0 mod T; or "impact", just before each impact on one stop
    stop : of "impact", "right" or "left"

    Examples
    --------
    >>> from vibro_sweep.types import Section
    >>> Section("impact", "left")
    Section(kind='impact', stop='left')
    """

    kind: str = "phase"
    stop: str = "right"


@dataclass(frozen=True)
class Trajectory:
    """The continuous orbit: `samples` times over `periods` forcing periods.

    begin : "end", after the last section point; or "start", at t = 0 (in YAML `from`)

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> from vibro_sweep.types import Trajectory
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> data = vs.sweep(system, {"b": [4.0]}, trajectory=Trajectory(2, 201), transient=300, record=10)
    >>> data.trajectory_x1.shape
    (1, 201)
    """

    periods: int
    samples: int
    begin: str = "end"


@dataclass(frozen=True, eq=False, repr=False)
class Scene(AnyScene):
    """A scene: what to compute. `system` is the base; at each point of the sweep the swept numbers replace its own.

    dynamics : "flow", or "map" with its `order` and the clearance `expand_at` at which it is expanded; None: b*
    sweep : name -> (n,) values, of none, one or two numbers in the order of the file's dimensions
    start, section, trajectory : as `Start`, `Section` and `Trajectory` say
    transient, settle, record : forcing periods; settle: None where no orbit goes on after its transient
    observe : words of what is computed
    picture : kind that is drawn by default
    picture_units : names of units in which numbers are shown, whatever the system's are
    source : the file that it was read from

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> text = "{system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8}, "
    >>> text += "sweep: {b: {values: [3, 4]}}, orbit: {transient: 300, record: 50}}"
    >>> with open("scene.yaml", "w") as file:
    ...     _ = file.write(text)
    >>> scene = vs.load_scene("scene.yaml")
    >>> scene.record, scene.shape, scene.replace(record=100).record
    (50, (2,), 100)
    """

    dynamics: str
    order: int
    expand_at: float | None
    sweep: dict[str, np.ndarray]  # of the start: start_x1, ...
    start: Start
    transient: int
    settle: int | None
    record: int
    section: Section
    observe: frozenset[str]
    trajectory: Trajectory | None
    picture: str | None = None
    picture_units: tuple[str, ...] = ()

    @cached_property
    def text(self) -> str:
        """The YAML text that it was read from; of another scene `to_yaml`. Raises SceneError for no scene."""
        if self.as_written is not None:
            return self.as_written
        data = self.data()
        if isinstance(self.system, FunctionModel):  # no text says what the function does: its matrices stand for it
            return yaml_of(data | {"system": data["system"] | {"matrices": digest(self.system, self.sweep)}})
        return yaml_of(data) if self.checked else parse_scene(yaml_of(data), self.name).text

    def data(self) -> dict[str, Any]:
        """The data that its YAML holds; numbers that are the default are left out."""
        data = {
            "system": system_data(self.system, self.sweep),
            "sweep": {KEYS.get(key, key): progression(values) for key, values in self.sweep.items()},
            "start": start_data(self.start, self.sweep, self.system.masses),
            "orbit": {name: getattr(self, name) for name in ORBIT if getattr(self, name) is not None},
            "section": {"kind": self.section.kind},
            "observe": sorted(self.observe),
        }
        if self.dynamics == "map":
            data |= {"dynamics": "map", "order": self.order}
            data |= {} if self.expand_at is None else {"expand_at": self.expand_at}
        if self.section.kind == "impact":
            data["section"]["stop"] = self.section.stop
        if self.trajectory:
            data["trajectory"] = {"periods": self.trajectory.periods, "samples": self.trajectory.samples}
            data["trajectory"] |= {"from": "start"} if self.trajectory.begin == "start" else {}
        if self.picture_units:
            kind = {"kind": self.picture} if self.picture else {}
            data["picture"] = kind | {"units": list(self.picture_units)}
        elif self.picture:
            data["picture"] = self.picture
        return {key: value for key, value in data.items() if value or key == "observe"}

    def replace(self, **changes) -> "Scene":
        """A copy with other values of `system`, `sweep`, `start`, `transient`, `record` and the other attributes.

        Each is given as in YAML or as a Scene has it; None: the default.

        Raises SceneError for what is not a scene.
        """
        self._check_names(changes)
        data = self.data()
        units = changes.pop("picture_units", self.picture_units)
        if not (units is None or (isinstance(units, tuple) and not units)):  # in YAML one key with the picture
            kind = changes.get("picture", self.picture)
            kind = {} if kind is None else kind if isinstance(kind, Mapping) else {"kind": kind}
            changes["picture"] = {"units": units} | dict(kind)
        if "sweep" in changes:  # what is swept no longer keeps its first value
            data["system"] = system_data(self.system, ())
        result = scene_of(changed(data, changes), self.name)
        state, count = array_of(changes.get("start"), 1), 2 * result.system.masses
        if state is not None and len(state) != count:
            raise SceneError(self.name, [problem("start", state.tolist(), f"must be {count} numbers")])
        return result._with_origin(source=self.source)

    @property
    def n_starts(self) -> int:
        """Orbits at each point of the sweep."""
        return 2 if self.start.direction == "both" else self.start.count

    @property
    def sweep_shape(self) -> tuple[int, ...]:
        """The number of values of each swept number; () for one orbit."""
        return tuple(len(values) for values in self.sweep.values())

    @property
    def shape(self) -> tuple[int, ...]:
        """The sweep's dimensions, then the starts if there are several."""
        return self.sweep_shape + ((self.n_starts,) if self.n_starts > 1 else ())

    @property
    def from_rest(self) -> bool:
        """Whether orbits start at rest and zero is behind a stop somewhere: it holds them there."""
        if not self.start.rest or any(key in START.values() for key in self.sweep):
            return False
        low, high = stops_of(self.system, self.sweep)
        return not low <= 0 <= high

    @property
    def n_points(self) -> int:
        """Orbits in all."""
        return math.prod(self.shape)

    @property
    def _transient(self) -> str:
        """The length of transients, in words."""
        return f"{self.transient:,}" if self.settle is None else f"{self.transient:,} to {self.settle:,}"

    def __repr__(self) -> str:
        axes = ", ".join(f"{key} = {v[0]:g} .. {v[-1]:g} ({len(v):,} values)" for key, v in self.sweep.items())
        name = self.name if len(self.name) <= 40 else f"{self.name[:37]}..."
        periods = f"{self._transient} + {self.record:,} forcing periods"
        return f"<Scene {name!r}: {axes or 'one point'}; {periods}; {', '.join(sorted(self.observe)) or 'nothing'}>"

    def __str__(self) -> str:
        """A few lines on what is computed."""
        axes = [f"{key} = {v[0]:g} .. {v[-1]:g}{self._unit(key)} ({len(v):,} values)" for key, v in self.sweep.items()]
        state = dict(zip(start(self.system.masses), self.start.state, strict=self.start.kind != "random"))
        names = ", ".join(name.removeprefix("start_") for name in state)
        starts = {
            "state": f"from {names} = "
            + ", ".join("swept" if name in self.sweep else f"{value:g}" for name, value in state.items()),
            "random": f"from {self.start.count:,} random states, seed {self.start.seed}",
            "follow": f"following the sweep ({self.start.direction}), the first from {names} = "
            + ", ".join(f"{value:g}" for value in state.values()),
        }
        section = "t = 0 mod T" if self.section.kind == "phase" else f"impacts on the {self.section.stop} stop"
        varies = {FREQUENCY.name, CYCLES.name} & self.sweep.keys()
        if self.section.kind == "phase" and varies and self.system.numbers.get("tau") == "grazing":
            section += ", at the extreme of the free motion; with tau: 0 at the same phase of the force everywhere"
        lines = [
            " x ".join(axes) or "one point",
            self._system_text(self.sweep),
            f"  orbits    {starts[self.start.kind]}; {self._transient} + {self.record:,} forcing periods",
            f"  section   {section}",
            f"  observe   {', '.join(sorted(self.observe)) or 'nothing'}",
        ]
        if self.trajectory:
            samples, periods = self.trajectory.samples, self.trajectory.periods
            begins = " from t = 0" if self.trajectory.begin == "start" else ""
            lines.append(f"  trajectory {samples:,} samples over {periods:,} forcing periods{begins}")
        return "\n".join(lines)

    def _unit(self, key: str) -> str:
        """The unit of a swept number, in brackets."""
        known = self.system.described
        return shown_unit(unit_in(known[key].units, self.system.units)) if key in known else ""

    def parameters(self) -> dict[str, np.ndarray]:
        """Every number of the system by name, `tau` resolved, and swept numbers of the start (start_x1, ...).

        Arrays of `sweep_shape`, read-only.
        """
        return grid(self.system, self.sweep)


def parse_scene(text: str, name: str = "scene", source: Path | None = None) -> Scene:
    """A Scene from YAML text; `name` stands in messages, its stem in the scene. Raises SceneError."""
    return parsed(text, name, source, scene_of)


def scene_of(data: object, name: str) -> Scene:
    """A Scene from the data that its YAML holds; `system` may be an Oscillator. Raises SceneError."""
    if isinstance(data, dict) and "continue" in data:
        raise SceneError(name, ["continue: this is a scene of branches or curves; it sweeps nothing"])
    made = data.get("system") if isinstance(data, dict) else None
    kind, masses = (made.model.name, made.masses) if isinstance(made, Oscillator) else kind_of(data, name)
    numbers = made.described if isinstance(made, FunctionModel) else MODELS[kind].flat(masses)
    by_function, given = isinstance(made, FunctionModel), isinstance(made, Oscillator)
    scheme = form_of_function(made) if by_function else scene_form(kind, masses, given)
    try:
        form = scheme.model_validate(data)
    except ValidationError as error:
        written = data | {"system": system_data(made, ())} if isinstance(made, Oscillator) else data
        raise SceneError(name, form_problems(error, scheme, written)) from None

    form, problems = in_own_words(form)
    sweep, wrong = sweep_of(form, data.get("sweep"), numbers)
    system, more = system_of(form, sweep, kind, masses) if not problems else (None, [])
    problems += wrong + more + start_problems(form, sweep, system, masses) + combination_problems(form, data, system)
    problems += stop_problems(sweep, system) if system is not None else []
    if problems:
        raise SceneError(name, problems)
    trajectory = form.trajectory and Trajectory(
        form.trajectory.periods, form.trajectory.samples, getattr(form.trajectory, "from")
    )
    scene = Scene(
        name=Path(name).stem,
        system=system,
        dynamics=form.dynamics,
        order=form.order,
        expand_at=form.expand_at,
        sweep=sweep,
        start=start_of(form.start, masses),
        transient=form.orbit.transient,
        settle=form.orbit.settle,
        record=form.orbit.record,
        section=Section(form.section.kind, form.section.stop),
        observe=form.observe,
        trajectory=trajectory,
        picture=getattr(form.picture, "kind", form.picture),
        picture_units=tuple(getattr(form.picture, "units", None) or ()),
    )
    if problems := size_problems(scene):
        raise SceneError(name, problems)
    return scene._with_origin(checked=True)
