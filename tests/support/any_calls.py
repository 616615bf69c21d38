"""Every public function, method and class by name, with valid values for each of its arguments."""

import functools
import inspect
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

import vibro_sweep as vs

SYSTEM = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.6)
PAIR = vs.Oscillator(
    np.eye(2), [[2, -1], [-1, 2]], rayleigh=[0.1, 0], force=[1, 0], contact_normal=[1, 0], omega=0.7, b=1, R=0.5
)
REST = (0.0, 0.0, 0.0, 0.0)
BRANCHES = """
system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 0.4}
continue: {from: {itinerary: LLLRRR}, parameter: {b: [0.39, 0.41]}, depth: 0}
"""
TEXT = """
system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8}
sweep: {b: {values: [6.5, 6.6]}}
orbit: {transient: 0, record: 4}
observe: [section]
"""
SLOW = 20  # times as many other draws as of functions that compute for longer
COMPUTING = ("windows", "plot", "follow_branches", "bifurcation_curve", "BifurcationCurve.plot", "continue_orbit")
COMPUTING += ("estimate", "Branch.plot", "Branch.save", "BifurcationCurve.save", "load")
COMPUTING += ("Orbit.plot", "PeriodicOrbit.plot", "switch", "sticking_onset", "sweep", "run", "born_at_grazing", "open")
COMPUTING += ("Orbit.animate", "explore", "page")


@dataclass(frozen=True)
class Call:
    """A function and, by argument, what else is given for valid values: the first of all are given by default."""

    function: Callable
    valid: dict[str, list[dict[str, Any]]]

    def given(self, changed: dict[str, Any]) -> dict[str, Any]:
        """All arguments."""
        return {key: value for values in self.valid.values() for key, value in values[0].items()} | changed

    def __call__(self, given: dict[str, Any]):
        """Call it; arguments without a name by their place."""
        parameters = inspect.signature(self.function).parameters.values()
        variadic = [one.name for one in parameters if one.kind is one.VAR_POSITIONAL]
        return self.function(*[given.pop(name) for name in variadic], **given)


def each(name: str, *values: Any) -> dict[str, list[dict[str, Any]]]:
    return {name: [{name: value} for value in values]}


OF_STOPS = {name: [{name: None}] for name in ("c_stop", "preload", "c_stop_left", "preload_left")}
OF_STOPS |= {"k_stop": [{"k_stop": None}, {"k_stop": 29, "R": None}, {"k_stop": np.float64(1e4), "R": None}]}
OF_STOPS |= {"k_stop_left": [{"k_stop_left": None}, {"k_stop_left": 100.0}]} | each("release", "displacement")


def objects() -> dict[str, Any]:
    """Public objects of all kinds."""
    orbit = vs.periodic_orbit(SYSTEM.replace(b=0.4), itinerary="LLLRRR")
    branch = vs.continue_orbit(orbit, "b", (0.37, 0.42))
    special = next(one for one in branch.special if one.type == "pitchfork")
    return {
        "System": SYSTEM,
        "Oscillator": PAIR,
        "Orbit": vs.simulate(SYSTEM, REST, 2),
        "PeriodicOrbit": orbit,
        "not ok": vs.periodic_orbit(PAIR.replace(rayleigh=None, omega=1), itinerary=""),
        "Branch": branch,
        "SpecialPoint": special,
        "BifurcationCurve": vs.bifurcation_curve(special, ("b", "R"), around(special)),
        "Exponents": vs.lyapunov(SYSTEM, REST, 1, 2),
        "Grazing": vs.grazing(SYSTEM),
        "DiscontinuityMap": vs.discontinuity_map(SYSTEM),
        "Scene": vs.load_scene("scene.yaml"),
        "Continuation": vs.load_scene("branches.yaml"),
        "Dataset of a sweep": vs.open("sweep.h5").load(),
        "ParameterError": vs.ParameterError("b", 1, "2"),
        "Executor": ThreadPoolExecutor(1),
        "Axes": plt.figure().add_subplot(),
    }


def around(special) -> tuple:
    b = special.parameters["b"]
    return ((b - 1e-3, b + 1e-3), (0.799, 0.801))


def calls(made: dict[str, Any]) -> dict[str, Call]:
    """By name, as Python has it: "simulate", "System.replace"."""
    special, orbit = made["SpecialPoint"], made["PeriodicOrbit"]
    system = each("system", SYSTEM, made["Oscillator"])
    state = each("state", REST, np.zeros(4), [0, 0, 0, 0], xr.DataArray(np.zeros(4)), np.ma.zeros(4), range(4))
    state["state"].pop()
    numbers = dict(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.6)
    of_system = {
        name: [{name: value}, {name: np.float64(value)}, {name: np.array(value)}] for name, value in numbers.items()
    }
    of_system |= each("tau", "grazing", 0.1, np.str_("grazing")) | each("stops", "both", "right", np.str_("left"))
    of_system |= each("offset", 0.0, 1) | each("R_left", None, 0.5) | each("mu_c", None, 2) | OF_STOPS
    units = each("units", None, "SI", np.str_("SI"), (1, 0.1, 2.0), np.ones(3))
    of_system |= units
    physical = dict(M1=1, M2=10, K1=1, K2=5, C1=0.1, C2=0.5, P1=1, P2=0, Omega=0.63, R=0.8, B=6)
    of_physical = {name: [{name: value}, {name: np.float64(value)}] for name, value in physical.items()}
    of_physical |= each("tau", "grazing", 1) | each("stops", "both") | each("B0", 0.0, 1) | each("R_left", None, 0.5)
    of_physical |= OF_STOPS
    M, K = np.eye(2), [[2.0, -1.0], [-1.0, 2.0]]
    pair = each("M", M, M.tolist(), xr.DataArray(M), np.ma.array(M)) | each("K", K, np.array(K))
    pair |= each("C", None, np.eye(2), 0) | each("modal_damping", None, [0.1, 0.1], np.ones(2))
    pair |= each("rayleigh", None, (0.1, 0.0)) | each("force", [1, 0], np.ones(2), 0) | each("force_cos", 0, [0, 1])
    pair |= each("constant", 0, [0, 1]) | each("force_power", 0, 2) | each("contact_normal", [1, 0], np.ones(2))
    pair |= each("omega", 1, 1.5) | each("b", 1, np.float32(1)) | each("offset", 0.0, 1) | each("R", 0.5, 1)
    pair |= OF_STOPS
    pair |= each("R_left", None, 0.5) | each("tau", "grazing", 0.0) | each("stops", "both", "right") | units
    of_pair = {name: values for name, values in pair.items() if name not in ("C", "modal_damping")}
    of_pair |= each("force1", 1.0, 0)  # it has rayleigh
    bounds = each("bounds", (0.39, 0.41), [0.39, 0.41], np.array([0.39, 0.41]), xr.DataArray([0.39, 0.41]))
    progress = each("progress", None, print_nothing)
    parameter = each("parameter", "b", np.str_("b"))
    observed = each("observe", (), [], np.array([]))
    step = each("step", 1.0, 2, np.float64(0.5))
    how = each("workers", None, 1, 2) | each("mode", "new", "overwrite", "resume")
    how |= each("output", "out.h5", Path("out.h5")) | each("progress", None, print_nothing, False)
    width = each("width", None, 85, np.float64(178.0))
    axes = each("axes", {"b": [6.5, 6.6]}, {"b": np.array([6.5, 6.6])}, {"b": (6.5,)}, {"b": xr.DataArray([6.5, 6.6])})
    axes["axes"] += [{"axes": {"b": {"start": 6.5, "stop": 6.6, "num": 2}}}, {"axes": {"b": range(6, 8)}}]
    axes["axes"] += [{"axes": {"x1": [0.0], "b": np.ma.array([6.5, 6.6])}}]
    short = each("transient", 0, 1, np.int64(0)) | each("record", 4, 5.0) | each("settle", None)
    start = each("start", None, REST, np.zeros(4), {"x1": 0.1}, {"random": 2}, xr.DataArray(np.zeros(4)))
    section = each("section", None, {"kind": "phase"}, {"kind": "impact", "stop": "left"})
    observe = each("observe", ["section"], {"section"}, ("section", "impacts"), (word for word in ["section"]))
    observe["observe"][-1] = {"observe": np.array(["section"])}
    trajectory = each("trajectory", None, {"periods": 1, "samples": 3})
    steps = np.eye(6) - np.eye(6, k=1)
    bar = each("M", np.eye(6), np.eye(6).tolist()) | each("K", steps.T @ steps) | each("C", None, np.eye(6))
    bar |= each("modes", 2, 1.0) | each("contact_normal", [1, 0, 0, 0, 0, 0], np.ones(6)) | each("force", 0, np.ones(6))
    bar |= each("force_cos", 0) | each("constant", 0, [0.0, 1, 0, 0, 0, 0]) | each("modal_damping", None)
    bar |= {"options": [{}]} | each("omega", 1, np.float64(1.5)) | each("R", 0.5, 1) | each("b", 1, 0.5)
    of_contact = {"contact_normal": [{"contact_normal": [1, 0]}, {"contact_normal": np.array([1.0])}]}
    of_contact |= each("b", 1, np.float64(0.5)) | each("offset", 0.0, 1) | each("R", 0.8, 1) | each("R_left", None, 0.5)
    of_contact |= each("stops", "both", "left") | OF_STOPS
    of_model = each("name", "one_mass", np.str_("one_mass"))
    of_one_mass = {"zeta": 0.1, "F": 1, "omega": 1, "R": 0.5, "b": 0.3}
    of_model["arguments"] = [of_one_mass | {"base": base} for base in (True, False)]
    simulated, mapping, scene = made["Orbit"], made["DiscontinuityMap"], made["Scene"]
    times = each("times", 0.0, [0.0, 1.0], np.array([1.0]), [], xr.DataArray([0.5]), range(2))
    return {
        "System": Call(vs.System, of_system),
        "System.physical": Call(vs.System.physical, of_physical),
        "System.replace": Call(SYSTEM.replace, any_of("changes", of_system)),
        "Oscillator": Call(
            vs.Oscillator,
            pair | each("contacts", None)
            | {"frequency": [{"frequency": None}, {"frequency": 0.1, "omega": None}]}
            | {name: [{name: None}, {name: 1.0, "b": None}] for name in ("stop_right", "stop_left")},
        ),
        "Contact": Call(vs.Contact, of_contact),
        "Oscillator.reduced": Call(vs.Oscillator.reduced, bar),
        "System.reduced": Call(vs.System.reduced, bar),
        "Oscillator.named": Call(vs.Oscillator.named, of_model),
        "System.named": Call(vs.System.named, of_model),
        "Oscillator.replace": Call(made["Oscillator"].replace, any_of("changes", of_pair)),
        "grazing": Call(vs.grazing, system),
        "quiet": Call(vs.quiet, system | parameter | each("bounds", (6, 7), [6.5, 7], np.array([1.0, 7.0]))),
        "simulate": Call(
            vs.simulate,
            system | state | each("periods", 1, 2.0, np.array(1)) | each("start_time", 0.0, 1, np.float32(1)),
        ),
        "Orbit.sample": Call(simulated.sample, times),
        "Orbit.plot": Call(simulated.plot, each("periods", 1, 4.0) | each("kind", None) | width | each("units", None)),
        "Orbit.animate": Call(simulated.animate, each("periods", 1, 4.0)),
        "Orbit.to_xarray": Call(simulated.to_xarray, {}),
        "lyapunov": Call(vs.lyapunov, system | state | each("transient", 1, 2.0) | each("record", 2, np.int8(3))),
        "discontinuity_map": Call(
            vs.discontinuity_map,
            system | each("order", 1, 2, np.int8(1)) | each("expand_at", None, 6.7, np.float32(1)),
        ),
        "DiscontinuityMap.__call__": Call(mapping.__call__, state),
        "DiscontinuityMap.jacobian": Call(mapping.jacobian, state),
        "periodic_orbit": Call(
            vs.periodic_orbit,
            each("system", SYSTEM.replace(b=0.4))
            | {"state": [{"state": None}, *({"state": one, "guess": None} for one in (REST, np.zeros(4)))]}
            | each("periods", 1, 2.0)
            | {"itinerary": [{"itinerary": None}, {"itinerary": "", "guess": None}, {"itinerary": "LLLRRR"}]}
            | each("guess", impacts(orbit), np.array(impacts(orbit)), [list(one) for one in impacts(orbit)])
            | each("which", 0, 0.0),
        ),
        "PeriodicOrbit.sample": Call(orbit.sample, times),
        "PeriodicOrbit.plot": Call(orbit.plot, each("kind", None) | width | each("units", None)),
        "PeriodicOrbit.save": Call(orbit.save, each("path", "new.json", Path("new.json"))),
        "Branch.save": Call(made["Branch"].save, each("path", "new.h5", Path("new.h5"))),
        "Branch.plot": Call(made["Branch"].plot, any_of("options", width | each("variable", "v1"))),
        "BifurcationCurve.save": Call(made["BifurcationCurve"].save, each("path", "new.h5", Path("new.h5"))),
        "load": Call(vs.load, each("path", "orbit.json", Path("orbit.json"))),
        "born_at_grazing": Call(vs.born_at_grazing, system | each("periods", 1, 1.0)),
        "Branch.orbit": Call(made["Branch"].orbit, each("point", 0, -1, np.int64(1))),
        "continue_orbit": Call(
            vs.continue_orbit, each("orbit", orbit) | parameter | bounds | progress | step | observed
        ),
        "follow_branches": Call(
            vs.follow_branches,
            each("orbit", orbit) | parameter | bounds | each("follow", ("graze",), [], ["flip", "pitchfork"])
            | each("depth", 0, 1.0) | progress | observed,
        ),
        "switch": Call(vs.switch, each("special", special)),
        "sticking_onset": Call(vs.sticking_onset, each("special", special)),
        "bifurcation_curve": Call(
            vs.bifurcation_curve,
            each("special", special) | each("parameters", ("b", "R"), ["b", "R"])
            | each("bounds", around(special), np.array(around(special)), [list(one) for one in around(special)])
            | progress | each("virtual", True, False, np.bool_(True)) | step,
        ),
        "BifurcationCurve.plot": Call(made["BifurcationCurve"].plot, each("others", made["BifurcationCurve"]) | width),
        "sweep": Call(vs.sweep, system | axes | observe | start | short | section | trajectory | how),
        "load_scene": Call(vs.load_scene, each("path", "scene.yaml", Path("scene.yaml"))),
        "Scene.replace": Call(
            scene.replace,
            any_of(
                "changes",
                each("system", SYSTEM) | {"sweep": [{"sweep": one["axes"]} for one in axes["axes"]]} | observe | start
                | short | section | trajectory | each("dynamics", "flow") | each("order", None)
                | each("expand_at", None) | each("picture", None, "bifurcation") | each("picture_units", ()),
            ),
        ),
        "Scene.to_yaml": Call(scene.to_yaml, {}),
        "estimate": Call(vs.estimate, each("scene", scene) | each("workers", None, 1, 2)),
        "Continuation.to_yaml": Call(made["Continuation"].to_yaml, {}),
        "Continuation.replace": Call(
            made["Continuation"].replace,
            any_of(
                "changes", each("depth", 0, 1) | each("follow", (), ["flip"]) | each("parameter", {"b": (0.39, 0.41)})
            ),
        ),
        "explore": Call(
            explored,
            each("system", SYSTEM, made["Oscillator"])
            | {"parameter": [{"parameter": None}, {"parameter": "b"}, {"parameter": np.str_("omega"), "bounds": None}]}
            | each("bounds", None, (6.5, 6.7), np.array([6.5, 6.7])),
        ),
        "page": Call(
            vs.page,
            each("system", SYSTEM)
            | {"parameter": [{"parameter": None}, {"parameter": "b"}, {"parameter": np.str_("omega"), "bounds": None}]}
            | each("bounds", None, (6.5, 6.7), np.array([6.5, 6.7])) | each("output", "p.html", Path("p.html"))
            | each("overwrite", True, np.True_),
        ),
        "run": Call(
            vs.run,
            each("scene", scene, made["Continuation"]) | how | each("executor", None, made["Executor"])
            | each("block", None, 1),
        ),
        "open": Call(vs.open, each("path", "sweep.h5", Path("sweep.h5"))),
        "windows": Call(
            vs.windows,
            each("data", "sweep.h5", Path("sweep.h5"), made["Dataset of a sweep"]) | each("parameter", None, "b") | how
            | each("output", "w.h5", Path("w.h5")),
        ),
        "plot": Call(
            vs.plot,
            each("data", "sweep.h5", Path("sweep.h5"), made["Dataset of a sweep"])
            | each("kind", None, "bifurcation", "iteration") | each("ax", None, made["Axes"])
            | each("at", None, {}, {"b": np.float32(6.5)}) | each("variable", None, "v1", np.str_("x1")) | width
            | each("xlim", None, (6.5, 6.6), np.array([6.5, 6.6])) | each("ylim", None, [0, 1]) | each("size", None)
            | each("dpi", None, 100, np.float32(80)) | each("windows", None) | each("over", None)
            | each("relative", False, np.bool_(False)) | each("units", None, "", [])
            | each("points", None, {"b": [6.5], "x1": [2.0]}) | each("output", None, "new.png", Path("new.svg"))
            | each("overwrite", False, True),
        ),
    }  # fmt: skip


def inside(argument: str, one: Any) -> list[Any]:
    """Values of an argument that hold this one."""
    found = {
        "state": [(0.0, one, 0.0, 0.0)],
        "times": [[0.0, one]],
        "guess": [[one], [(one, 1, 1.0)], [(0.0, one, 1.0)]],
        "bounds": [(one, 0.41), ((one, 0.5), (0.7, 0.9)), (one, (0.7, 0.9))],
        "follow": [["graze", one]],
        "parameters": [("b", one)],
        "axes": [{"b": one}, {"b": [6.5, one]}, {"b": {"start": one, "stop": 6.6, "num": 2}}, {"b": {"values": one}}],
        "start": [{"x1": one}, (0.0, one, 0.0, 0.0), {"random": one}, {"follow": one}],
        "observe": [["section", one]],
        "section": [{"kind": one}, {"kind": "impact", "stop": one}],
        "trajectory": [{"periods": one, "samples": 3}],
        "at": [{"b": one}],
        "M": [[[one, 0], [0, 1]], [[1, 0], one]],
        "force": [[one, 1]],
        "contact_normal": [(1, one)],
        "units": [(1, one, 2.0)],
    }
    return found.get(argument, [])


def any_of(name: str, valid: dict[str, list[dict[str, Any]]]) -> dict[str, list[dict[str, Any]]]:
    """Of `**name`: any of these, one at a time."""
    return {name: [{}]} | {key: [{}, *values] for key, values in valid.items()}


def impacts(orbit) -> list[tuple[float, int, float]]:
    return [(float(one["t"]), int(one["side"]), float(one["v1"])) for one in orbit.impacts]


@functools.wraps(vs.explore)
def explored(*arguments: Any, **options: Any) -> None:
    """A page that is served no longer than this call."""
    vs.explore(*arguments, **options).close()


def print_nothing(*_: Any) -> None:
    """Progress that nobody looks at."""


def public() -> Iterator[tuple[str, str]]:
    """Every public function, method and class with each of its arguments, but errors: these are raised, not called."""
    for name in vs.__all__:
        one = getattr(vs, name)
        if isinstance(one, type) and issubclass(one, Exception):
            continue
        yield from ((name, argument) for argument in inspect.signature(one).parameters)
        if isinstance(one, type):
            yield from _methods(one, name)


def methods(made: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """Those of objects that public functions return."""
    for one in made.values():
        if type(one).__module__.startswith("vibro_sweep.") and not isinstance(one, Exception):
            yield from _methods(type(one), type(one).__name__)


def _methods(kind: type, name: str) -> Iterator[tuple[str, str]]:
    for method, function in inspect.getmembers(kind, callable):
        ours = getattr(function, "__module__", None) or ""
        if (
            ours.startswith("vibro_sweep.")
            and not isinstance(function, type)
            and (method[0] != "_" or method == "__call__")
        ):
            for argument in inspect.signature(function).parameters:
                if argument != "self":
                    yield f"{name}.{method}", argument
