"""From a YAML text to a Scene: everything that a computation needs to know, checked as a whole."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from pydantic import ValidationError

from .scene_axes import axis_values
from .scene_form import PhysicalSystemForm, SceneForm, json_schema
from .scene_problems import SceneError, form_problems, problem
from .scene_starts import SWEPT, Start, start_of, start_problems
from .system import NAMES, ParameterError, System, check_value, grazing_phase
from .yaml_text import MAX_BYTES, YAMLTextError, read_yaml

__all__ = [
    "Scene",
    "SceneError",
    "Section",
    "Start",
    "Trajectory",
    "json_schema",
    "load_scene",
    "parse_scene",
]

MAX_POINTS = 10**9
MAX_NUMBERS = 10**11  # doubles in the file, about a terabyte


@dataclass(frozen=True)
class Section:
    """`kind`: "phase" (t = 0 mod T) | "impact" (just before each impact on `stop`: "right" | "left")."""

    kind: str = "phase"
    stop: str = "right"


@dataclass(frozen=True)
class Trajectory:
    """The continuous orbit after the last section point: `samples` times over `periods` forcing periods."""

    periods: int
    samples: int


@dataclass(frozen=True, eq=False)
class Scene:
    """What to compute. `system` is the base; at each point of the sweep the swept numbers replace its own."""

    name: str
    text: str
    system: System
    model: str
    order: int  # of the map
    expand_at: float | None  # clearance at which the map is expanded; None: b*
    sweep: dict[str, np.ndarray]  # 0, 1 or 2 in the order of the file's dimensions; of the start: start_x1, ...
    start: Start
    transient: int  # forcing periods
    record: int  # forcing periods
    section: Section
    observe: frozenset[str]
    trajectory: Trajectory | None

    @property
    def n_starts(self) -> int:
        """Orbits at each point of the sweep."""
        return 2 if self.start.direction == "both" else self.start.count

    @property
    def sweep_shape(self) -> tuple[int, ...]:
        return tuple(len(values) for values in self.sweep.values())

    @property
    def shape(self) -> tuple[int, ...]:
        """The sweep's dimensions, then the starts if there are several."""
        return self.sweep_shape + ((self.n_starts,) if self.n_starts > 1 else ())

    @property
    def n_points(self) -> int:
        """Orbits in all."""
        return math.prod(self.shape)

    def __str__(self) -> str:
        """What is computed, in a few lines."""
        system = ", ".join(f"{name} = {getattr(self.system, name)}" for name in NAMES if name not in self.sweep)
        axes = [f"{key} = {v[0]:g} .. {v[-1]:g} ({len(v):,} values)" for key, v in self.sweep.items()]
        state = dict(zip(SWEPT.values(), self.start.state, strict=True))
        starts = {
            "state": "from x1, v1, x2, v2 = "
            + ", ".join("swept" if name in self.sweep else f"{value:g}" for name, value in state.items()),
            "random": f"from {self.start.count:,} random states, seed {self.start.seed}",
            "follow": f"following the sweep ({self.start.direction})",
        }
        section = "t = 0 mod T" if self.section.kind == "phase" else f"impacts on the {self.section.stop} stop"
        lines = [
            " x ".join(axes) or "one point",
            f"  system    {system}, stops = {self.system.stops}",
            f"  orbits    {starts[self.start.kind]}; {self.transient:,} + {self.record:,} forcing periods",
            f"  section   {section}",
            f"  observe   {', '.join(sorted(self.observe)) or 'nothing'}",
        ]
        if self.trajectory:
            samples, periods = self.trajectory.samples, self.trajectory.periods
            lines.append(f"  trajectory {samples:,} samples over {periods:,} forcing periods")
        return "\n".join(lines)

    def parameters(self) -> dict[str, np.ndarray]:
        """Every number of the system by name, `tau` resolved, and swept numbers of the start (start_x1, ...).

        Arrays of `sweep_shape`, read-only.
        """
        return grid(self.system, self.sweep)


def grid(system: System, axes: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Every number of the system by name, `tau` resolved, and the axes, at each point of a grid of values for some.

    Read-only arrays with one dimension for each of `axes`, in their order.
    """
    numbers = {name: getattr(system, name) for name in NAMES}
    numbers.update(zip(axes, np.meshgrid(*axes.values(), indexing="ij", sparse=True), strict=True))
    if "tau" not in axes and system.tau == "grazing":
        numbers["tau"] = grazing_phase(*(numbers[name] for name in ("mu_m", "mu_k", "zeta", "f2", "omega")))
    shape = tuple(len(values) for values in axes.values())
    return {name: np.broadcast_to(value, shape) for name, value in numbers.items()}


def load_scene(path) -> Scene:
    """Read a scene from a YAML file.

    Raises SceneError for what is wrong with it, OSError where the file cannot be read.
    """
    path = Path(path)
    with path.open("rb") as file:
        data = file.read(MAX_BYTES + 1)
    if len(data) > MAX_BYTES:
        raise SceneError(path.name, [f"longer than {MAX_BYTES} bytes"])
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise SceneError(path.name, [f"byte {error.start} is not UTF-8 text"]) from None
    return parse_scene(text, path.name)


def parse_scene(text: str, name: str = "scene") -> Scene:
    """A Scene from YAML text; `name` stands in messages, its stem in the scene. Raises SceneError."""
    try:
        data = read_yaml(text)
        form = SceneForm.model_validate(data)
    except YAMLTextError as error:
        raise SceneError(name, [str(error)]) from None
    except ValidationError as error:
        raise SceneError(name, form_problems(error)) from None

    sweep, problems = _sweep(form, data.get("sweep"))
    system, more = _system(form, sweep)
    problems += more + start_problems(form, sweep, system) + _combination_problems(form)
    if problems:
        raise SceneError(name, problems)
    trajectory = form.trajectory and Trajectory(form.trajectory.periods, form.trajectory.samples)
    scene = Scene(
        name=Path(name).stem,
        text=text,
        system=system,
        model=form.model,
        order=form.order,
        expand_at=form.expand_at,
        sweep=sweep,
        start=start_of(form.start),
        transient=form.orbit.transient,
        record=form.orbit.record,
        section=Section(form.section.kind, form.section.stop),
        observe=form.observe,
        trajectory=trajectory,
    )
    problems = _size_problems(scene) or _phase_problems(scene)
    if problems:
        raise SceneError(name, problems)
    return scene


def _sweep(form: SceneForm, keys) -> tuple[dict[str, np.ndarray], list[str]]:
    """The axes in the order of the text, and what is wrong with them; an axis with a problem is left out."""
    if form.sweep is None:
        return {}, []
    if not 1 <= len(keys) <= 2:
        return {}, [problem("sweep", list(keys), "must have one key or two, or be left out")]
    sweep, problems = {}, []
    for key in keys:
        values, wrong = axis_values(f"sweep.{key}", getattr(form.sweep, key))
        if values is not None and key in NAMES:
            wrong = _number_problems("sweep", key, values)
        if not wrong:
            sweep[SWEPT.get(key, key)] = values
        problems += wrong
    return sweep, problems


def _number_problems(path: str, key: str, value) -> list[str]:
    try:
        check_value(key, value)
    except ParameterError as error:
        return [problem(f"{path}.{key}", error.value, f"must be {error.allowed}")]
    return []


def _system(form: SceneForm, sweep) -> tuple[System | None, list[str]]:
    """The base system with the first swept values in it, or None and what is wrong."""
    first = {key: float(values[0]) for key, values in sweep.items() if key in NAMES}
    if isinstance(form.system, PhysicalSystemForm):
        physical = form.system.physical.model_dump()
        try:
            system = System.physical(**physical, tau=form.system.tau, stops=form.system.stops)
            return system.replace(**first), []
        except ParameterError as error:
            path = "system.physical" if error.key in physical else "system"
            return None, [problem(f"{path}.{error.key}", error.value, f"must be {error.allowed}")]
    swept = form.sweep.model_fields_set.intersection(NAMES) if form.sweep else set()
    problems, numbers = [], {}
    for key in NAMES:
        value = getattr(form.system, key)
        if value is None:
            if key not in swept:
                problems.append(f"system.{key}: missing; it must be given unless it is swept")
        elif value != "grazing":
            problems += _number_problems("system", key, value)
        numbers[key] = value
    if problems or swept != first.keys():
        return None, problems
    try:
        return System(**(numbers | first), stops=form.system.stops), []
    except ParameterError as error:
        return None, [problem(f"system.{error.key}", error.value, f"must be {error.allowed}")]


def _combination_problems(form: SceneForm) -> list[str]:
    problems = []
    section, stops = form.section, form.system.stops
    problems += _map_problems(form)
    if section.kind == "impact" and stops not in ("both", section.stop):
        problems.append(problem("section.stop", section.stop, f"the system has no such stop (stops: {stops})"))
    if section.kind == "phase" and "stop" in section.model_fields_set:
        problems.append(problem("section.stop", section.stop, "belongs to `kind: impact`; leave it out"))
    if not form.observe and form.trajectory is None:
        text = "nothing would be computed; name section, lyapunov, impacts or attractors, or ask for a trajectory"
        problems.append(problem("observe", [], text))
    return problems


def _map_problems(form: SceneForm) -> list[str]:
    if form.model == "flow":
        text = "belongs to `model: map`; leave it out"
        return [
            problem(key, getattr(form, key), text) for key in ("order", "expand_at") if key in form.model_fields_set
        ]
    problems = []
    if form.expand_at is not None and form.expand_at <= 0:
        problems.append(problem("expand_at", form.expand_at, "must be a number > 0"))
    if form.system.tau != "grazing" or (form.sweep and "tau" in form.sweep.model_fields_set):
        text = "the map's section is the phase of the graze; leave tau out, or say grazing"
        problems.append(problem("system.tau", form.system.tau, text))
    if form.trajectory:
        text = "the map has no motion between its points; leave it out"
        problems.append(problem("trajectory", form.trajectory.model_dump(), text))
    return problems


def _size_problems(scene: Scene) -> list[str]:
    if scene.n_points > MAX_POINTS:
        size = " x ".join(str(length) for length in scene.shape)
        return [
            problem(
                "sweep",
                list(scene.sweep),
                f"{size} = {scene.n_points:.6g} points; at most {MAX_POINTS:.0e} are allowed",
            )
        ]
    samples = scene.trajectory.samples if scene.trajectory else 0
    recorded = 5 * scene.record if "section" in scene.observe else 0
    numbers = scene.n_points * (recorded + 4 * samples)
    if numbers > MAX_NUMBERS:
        path, value = ("orbit.record", scene.record) if recorded > samples else ("trajectory.samples", samples)
        text = f"the file would hold {numbers:.6g} numbers; at most {MAX_NUMBERS:.0e} are allowed"
        return [problem(path, value, text)]
    return []


def _phase_problems(scene: Scene) -> list[str]:
    undamped = 0 in scene.sweep.get("zeta", [scene.system.zeta])
    if not undamped or np.isfinite(scene.parameters()["tau"]).all():
        return []
    text = "somewhere in the sweep an undamped mode is in resonance and no steady motion exists; give a number"
    return [problem("system.tau", scene.system.tau, text)]
