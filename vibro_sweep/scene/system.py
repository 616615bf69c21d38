"""From the data of a scene to its oscillator and what is swept of it."""

import numpy as np

from vibro_sweep.checks.meant import did_you_mean
from vibro_sweep.checks.refusals import ParameterError
from vibro_sweep.oscillator.checked_numbers import check_value
from vibro_sweep.oscillator.function_model import FunctionModel
from vibro_sweep.oscillator.models import DEFAULT, MODELS
from vibro_sweep.oscillator.models.declaration import OF_STOPS, entries
from vibro_sweep.oscillator.oscillator import Oscillator, System
from vibro_sweep.oscillator.other_words import in_own_numbers, own_name, with_omega
from vibro_sweep.tables.coordinates import START
from vibro_sweep.tables.parameters import CYCLES, FREQUENCY
from vibro_sweep.tables.quantity import Parameter

from .axes import axis_values
from .fields import Form
from .problems import SceneError, problem
from .slips import model_meant
from .systems import PhysicalSystemForm


def kind_of(data: object, name: str) -> tuple[str, int]:
    """The model of a scene and its number of masses, as far as its data say. Raises SceneError for no model."""
    system = data.get("system") if isinstance(data, dict) else None
    kind = system.get("type", DEFAULT) if isinstance(system, dict) else DEFAULT
    if isinstance(system, dict) and (meant := model_meant(system)):
        raise SceneError(name, [f"system.type: missing; these are keys of another model: write type: {meant}"])
    if not (isinstance(kind, str) and kind in MODELS):
        raise SceneError(
            name, [problem("system.type", kind, f"{did_you_mean(kind, MODELS)}allowed: {', '.join(MODELS)}")]
        )
    try:
        return kind, MODELS[kind].masses(system) if isinstance(system, dict) else 2
    except (KeyError, TypeError):  # what they follow from is missing, or no list: the form says so
        return kind, 1


def sweep_of(form: Form, keys, numbers: dict[str, Parameter]) -> tuple[dict[str, np.ndarray], list[str]]:
    """The axes in the order of the text, and what is wrong with them; an axis with a problem is left out."""
    if form.sweep is None:
        return {}, []
    if not 1 <= len(keys) <= 2:
        return {}, [problem("sweep", list(keys), "must have one key or two, or be left out")]
    sweep, problems = {}, []
    if {CYCLES.name, FREQUENCY.name} <= set(keys):
        text = f"{CYCLES.name} stands in place of {FREQUENCY.name}; leave one out"
        return {}, [problem("sweep", list(keys), text)]
    for key in keys:
        values, wrong = axis_values(f"sweep.{key}", getattr(form.sweep, key))
        if values is not None and key in numbers:
            wrong = _number_problems("sweep", numbers[key], values, getattr(form.system, "stops", "both"))
        if not wrong:
            sweep[START.get(key, key)] = values
        problems += wrong
    return sweep, problems


def _number_problems(path: str, number: Parameter, value, stops: str) -> list[str]:
    try:
        check_value(number, value, stops)
    except ParameterError as error:
        return [problem(f"{path}.{error.key}", error.value, f"must be {error.allowed}")]
    return []


def in_own_words(form: Form) -> tuple[Form, list[str]]:
    """The form with omega, b, offset and stops of its system in place of other words, and what is wrong with these."""
    if isinstance(form.system, (Oscillator, PhysicalSystemForm)):
        return form, []
    named = {name: getattr(form.system, name) for name in form.system.model_fields_set}
    try:
        own = in_own_numbers(named)
    except ParameterError as error:
        return form, [problem(f"system.{error.key}", error.value, f"must be {error.allowed}")]
    changes = {name: value for name, value in own.items() if name not in named}
    system = form.system.model_copy(update=changes) if changes else form.system
    return form.model_copy(update={"system": system}), []


def system_of(form: Form, sweep, kind: str, masses: int) -> tuple[Oscillator | None, list[str]]:
    """The base system with the first swept values in it, or None and what is wrong."""
    if isinstance(form.system, FunctionModel):
        return form.system, []
    model = MODELS[kind]
    numbers = model.flat(masses)
    first = with_omega({key: float(values[0]) for key, values in sweep.items() if key in numbers})
    if isinstance(form.system, PhysicalSystemForm):
        physical = form.system.physical.model_dump()
        if physical["Omega"] is None and physical[CYCLES.name] is None:
            return None, ["system.physical.Omega: missing; it must be given, in rad/s, or frequency in Hz"]
        try:
            options = {number.name: getattr(form.system, number.name) for number in OF_STOPS}
            system = System.physical(**physical, tau=form.system.tau, stops=form.system.stops, **options)
            return system.replace(**first), []
        except ParameterError as error:
            path = "sweep" if error.key in first else "system.physical" if error.key in physical else "system"
            return None, [problem(f"{path}.{error.key}", error.value, f"must be {error.allowed}")]
    if isinstance(form.system, Oscillator):
        return _with_numbers(form.system, first)
    axes = getattr(form, "sweep", None)  # scenes of branches have none
    swept = {own_name(key) for key in axes.model_fields_set.intersection(numbers)} if axes else set()
    problems, arguments = [], {}
    stops = getattr(form.system, "stops", "both")
    for number in model.numbers:
        value = getattr(form.system, number.name)
        if value is None and number.each:
            text = f"is one of {number.name}, which is not given; write it in system, one number for each {number.each}"
            problems += [
                f"sweep.{key}: {text}" for key in sorted(swept & {each.name for each in entries(number, masses)})
            ]
        if value is None and number.name not in first and not number.each and not number.optional:
            if number.name not in swept:
                other = " or frequency" if number.name == FREQUENCY.name else ""
                problems.append(f"system.{number.name}: missing; it{other} must be given unless it is swept")
        elif value is not None and not number.each and not isinstance(value, str):
            problems += _number_problems("system", number, value, stops)
        if value is not None:
            arguments[number.name] = value
    if problems or not swept <= first.keys():
        return None, problems
    arguments |= {name: value for name, value in first.items() if name in (number.name for number in model.numbers)}
    arguments |= {number.name: getattr(form.system, number.name) for number in model.options}
    try:
        system = Oscillator.named(kind, **arguments)
    except ParameterError as error:
        path = "sweep" if error.key in first else "system"
        return None, [problem(f"{path}.{error.key}", error.value, f"must be {error.allowed}")]
    return _with_numbers(system, first)


def _with_numbers(system: Oscillator, first: dict[str, float]) -> tuple[Oscillator | None, list[str]]:
    """The system with the first swept values in it, or None and what is wrong."""
    try:
        return system.replace(**first) if first else system, []
    except ParameterError as error:
        path = "sweep" if error.key in first else "system"
        return None, [problem(f"{path}.{error.key}", error.value, f"must be {error.allowed}")]
