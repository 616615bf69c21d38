"""How the keys of a scene must fit each other: none contradicts another, none is without effect."""

from collections.abc import Mapping

import numpy as np

from vibro_sweep.oscillator.contact_laws.compliant import LAW as COMPLIANT
from vibro_sweep.oscillator.contact_laws.compliant import StopLaw
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.oscillator.stops import DAMPER_ALONE, NOT_PRESSED, why_rigid
from vibro_sweep.tables.exponents import LEAST_RECORD
from vibro_sweep.tables.observables import WORDS
from vibro_sweep.tables.parameters import CYCLES, STOP_LEFT, STOP_RIGHT
from vibro_sweep.tables.units import display_of, why_no_display

from .fields import Form
from .problems import problem


def combination_problems(form: Form, data: dict, system: Oscillator | None) -> list[str]:
    """The problems of a scene of the right form; data: as it was read; system: None where it is wrong itself."""
    section, stops = form.section, getattr(form.system, "stops", "both")
    problems = _map_problems(form) + (_contact_problems(form, system) if system is not None else [])
    for name in sorted(form.observe):
        if data.get("observe", []).count(name) > 1:
            problems.append(problem("observe", data["observe"], f"names {name} twice"))
    problems += _settle_problems(form.orbit)
    if section.kind == "impact" and "section" not in form.observe:
        text = "the section is not observed, and would have no effect; leave it out, or observe section"
        problems.append(problem("section.kind", section.kind, text))
    if section.kind == "impact" and stops not in ("both", section.stop):
        problems.append(problem("section.stop", section.stop, f"the system has no such stop (stops: {stops})"))
    if section.kind == "phase" and "stop" in section.model_fields_set:
        problems.append(problem("section.stop", section.stop, "belongs to `kind: impact`; leave it out"))
    written = data.get("system") if isinstance(data.get("system"), Mapping) else {}
    stands = [key for key in (STOP_RIGHT.name, STOP_LEFT.name) if key in written]
    if stands and "stops" in written:
        text = f"must be left out where {stands[0]} is given, in place of which it stands"
        problems.append(problem("system.stops", stops, text))
    if "physical" in written and form.sweep and CYCLES.name in form.sweep.model_fields_set:
        text = "is nondimensional beside `physical`, where frequency is in Hz; sweep omega"
        problems.append(problem(f"sweep.{CYCLES.name}", data["sweep"][CYCLES.name], text))
    problems += units_problems(getattr(form.picture, "units", None), system)
    if getattr(form.trajectory, "from", "end") == "start" and hasattr(form.start, "follow"):
        text = "orbits that follow the sweep begin where the last one ended; leave it out, or give one start"
        problems.append(problem("trajectory.from", "start", text))
    if not form.observe and form.trajectory is None:
        text = f"nothing would be computed; name some of {', '.join(WORDS)}, or ask for a trajectory"
        problems.append(problem("observe", [], text))
    return problems


def units_problems(units: list[str] | None, system: Oscillator | None) -> list[str]:
    """What is wrong with the units of pictures, where there are any."""
    if units is not None and display_of(units) is None:
        return [problem("picture.units", units, why_no_display(units))]
    if units and system is not None and system.units is None:
        return [problem("picture.units", units, "the system has no units; give it some, by `units`")]
    return []


def _settle_problems(orbit: Form) -> list[str]:
    if orbit.settle is None:
        return []
    problems = []
    if orbit.settle <= orbit.transient:
        text = f"must be above transient = {orbit.transient}, which every orbit has; leave it out to let none go on"
        problems.append(problem("orbit.settle", orbit.settle, text))
    if orbit.record < LEAST_RECORD:
        text = f"must be at least {LEAST_RECORD} with `settle`: fewer section points do not tell what is under way"
        problems.append(problem("orbit.record", orbit.record, text))
    return problems


def stop_problems(sweep: Mapping[str, np.ndarray], system: Oscillator) -> list[str]:
    """The problems of swept stiffnesses of stops: 0 is that of a damper alone."""
    problems, numbers = [], system.numbers
    for names in COMPLIANT.names.values():
        law = StopLaw(*(sweep.get(name, np.array(numbers.get(name) or 0.0)) for name in names))
        if names[0] in sweep and law.k.min() == 0 and (law.c.min() == 0 or law.p.max() > 0):
            problems.append(problem(f"sweep.{names[0]}", 0, f"must be > 0 {DAMPER_ALONE}"))
    return problems


def _contact_problems(form: Form, system: Oscillator) -> list[str]:
    """What compliant stops have no part in, and rigid ones."""
    q = system.linear
    if not q.compliant:
        text = f"{NOT_PRESSED}; observe impacts"
        return [problem("observe", sorted(form.observe), text)] if "contacts" in form.observe else []
    problems = []
    if form.dynamics == "map":
        problems.append(problem("dynamics", form.dynamics, f"needs rigid stops: {why_rigid('map')}"))
    if form.section.kind == "impact" and q.contact.is_compliant(1 if form.section.stop == "right" else -1):
        text = f"{why_rigid('section')}; take `kind: phase`, or the other stop"
        problems.append(problem("section.stop", form.section.stop, text))
    return problems


def _map_problems(form: Form) -> list[str]:
    if form.dynamics == "flow":
        text = "belongs to `dynamics: map`; leave it out"
        return [
            problem(key, getattr(form, key), text) for key in ("order", "expand_at") if key in form.model_fields_set
        ]
    problems = []
    if form.expand_at is not None and form.expand_at <= 0:
        problems.append(problem("expand_at", form.expand_at, "must be a number > 0"))
    if form.system.tau != "grazing" or (form.sweep and "tau" in form.sweep.model_fields_set):
        text = "the map's section is the phase of the graze; leave tau out, or say grazing"
        problems.append(problem("system.tau", form.system.tau, text))
    for key in ("offset", "R_left", "constant"):
        value, default = getattr(form.system, key, None), type(form.system).model_fields.get(key)
        keys = form.sweep.model_fields_set if form.sweep is not None else ()
        swept = [name for name in sorted(keys) if name.rstrip("0123456789") == key]  # a list's are constant1, ...
        if default is not None and (value != default.default or swept):
            text = "the map's two halves are mirror images: equal stops about 0, no constant force; leave it out"
            path, value = (f"sweep.{swept[0]}", None) if swept else (f"system.{key}", value)
            problems.append(problem(path, value, text))
    if "energy" in form.observe:
        text = "the map has no motion between its points; leave energy out"
        problems.append(problem("observe", sorted(form.observe), text))
    if form.trajectory:
        text = "the map has no motion between its points; leave it out"
        problems.append(problem("trajectory", form.trajectory.model_dump(), text))
    return problems
