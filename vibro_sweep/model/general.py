"""Any linear oscillator with one contact: `Oscillator`, by its matrices or as a model with a name."""

from __future__ import annotations  # help() says ArrayLike, and not all that this may be

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cached_property, partial
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from vibro_sweep.checks.not_computed import why_not_computed
from vibro_sweep.checks.real import array_of, number_of
from vibro_sweep.checks.refusals import ParameterError
from vibro_sweep.model import wording
from vibro_sweep.model.any_oscillator import AnyOscillator
from vibro_sweep.model.checked_numbers import UNITS_ALLOWED, checked_number, units_from
from vibro_sweep.model.linear import Family, Linear
from vibro_sweep.model.models import MODELS, model_named
from vibro_sweep.model.models.declaration import Model, Option, linear_of
from vibro_sweep.model.stops import check_stops, completed
from vibro_sweep.tables.coordinates import MOST_MASSES
from vibro_sweep.tables.quantity import LENGTHS, Parameter
from vibro_sweep.tables.units import Units


class Oscillator(AnyOscillator):
    """M x'' + C x' + K x = constant + omega^force_power (force sin(omega t + tau) + force_cos cos(omega t + tau)).

    The stops keep the gap g = n . x, n the contact normal, from offset - b to offset + b; an impact takes g' to -R g'.

    Parameters
    ----------
    M, K : (N, N), symmetric; M positive definite, K positive semidefinite
    C, modal_damping, rayleigh : at most one; a matrix as K, a ratio for each mode, alpha and beta of alpha M + beta K
    force, force_cos, constant, contact_normal : (N,); a force of 0 acts on no mass
    R, R_left : restitution of rigid stops; R_left, of the left one, is R where it is left out
    k_stop, c_stop, preload : of compliant stops, in place of R: in contact the force k_stop delta + c_stop delta' +
        preload acts on the gap, delta the way behind the stop; with `_left` of the left one
    release : displacement, a contact ends where delta = 0; force, where its force is zero
    tau : phase in radians, or "grazing": where the gap of the free motion is largest at t = 0
    stops : both, right, left; b may be <= 0 where there is one
    units : for labels: SI; or what a mass, a length and a time of 1 are in kg, m and s; left out: nondimensional

    Numbers are attributes: `force`, and `force1`, `force2`, ... too. Raises ParameterError for what cannot be.
    `Oscillator.named("chain", m=..., ...)` makes the other models (`vibro-sweep models`).

    Examples
    --------
    A mass on a spring: its motion without stops has the amplitude 1/sqrt((1 - omega^2)^2 + (2 zeta omega)^2).

    >>> import vibro_sweep as vs
    >>> mass = vs.Oscillator([[1]], [[1]], modal_damping=0.05, force=[1], contact_normal=[1], omega=0.8, R=0.7, b=1.5)
    >>> round(vs.grazing(mass).b, 6)
    2.711631
    """

    def __init__(
        self, M: ArrayLike, K: ArrayLike, C: ArrayLike | None = None, *, modal_damping: ArrayLike | None = None,
        rayleigh: ArrayLike | None = None, force: ArrayLike = 0, force_cos: ArrayLike = 0, constant: ArrayLike = 0,
        force_power: float = 0, contact_normal: ArrayLike, omega: float, b: float, offset: float = 0.0,
        R: float | None = None, R_left: float | None = None, k_stop: float | None = None, c_stop: float | None = None,
        preload: float | None = None, k_stop_left: float | None = None, c_stop_left: float | None = None,
        preload_left: float | None = None, release: Literal["displacement", "force"] = "displacement",
        tau: float | Literal["grazing"] = "grazing",
        stops: Literal["both", "right", "left"] = "both",
        units: Literal["SI"] | ArrayLike | None = None,
    ) -> None:  # fmt: skip
        given = {name: value for name, value in locals().items() if name != "self"}
        self._set(MODELS["linear"], given)

    @classmethod
    def named(cls, name: str, **given: Any) -> AnyOscillator:
        """A model by its name, as it is in a scene; of `two_mass` a System.

        Examples
        --------
        >>> import vibro_sweep as vs
        >>> ball = vs.Oscillator.named(
        ...     "one_mass", k=0, zeta=0, F=1, constant=-0.5, omega=1, R=0.5, b=0, stops="left"
        ... )
        >>> ball.masses, ball.replace(R=0.6).R
        (1, 0.6)
        """
        from vibro_sweep.model.oscillator import System

        model = model_named(name)
        return System(**checked(model, given)) if model.name == System.model.name else _again(model.name, given)

    def _set(self, model: Model, given: Mapping[str, Any]) -> None:
        object.__setattr__(self, "model", model)
        object.__setattr__(self, "given", checked(model, given))

    def __setattr__(self, name, value):
        raise AttributeError(f"{name}: an Oscillator is not changed; `replace` makes another one")

    def __getattr__(self, name: str):
        if name.startswith("_") or name in ("model", "given"):  # while it is unpickled there is nothing yet
            raise AttributeError(name)
        if name in self.given:
            return self.given[name]
        if name in self.described:
            return self.numbers[name]
        raise AttributeError(f"{name!r} is not a number of the model {self.model.name}")

    def __dir__(self) -> list[str]:
        """The attributes and the numbers, those of lists one by one, for a prompt that completes names."""
        return [*super().__dir__(), *self.given, *self.described]

    def __reduce__(self):
        return _again, (self.model.name, self.given)

    def __eq__(self, other):
        return isinstance(other, Oscillator) and (self.model.name, self.given) == (other.model.name, other.given)

    def __hash__(self):
        return hash((self.model.name, tuple(self.given.values())))

    def __repr__(self) -> str:
        arguments, complete = wording.arguments(self.given)
        by_call = complete and self.model.name == "linear"
        return f"Oscillator({arguments})" if by_call else f"<{self.model.name}: {arguments}>"

    @cached_property
    def described(self) -> dict[str, Parameter]:
        """The numbers, those of lists one by one: m1, m2, ..."""
        numbers, units = self.numbers, self.model.depending(self.given)
        flat = self.model.flat(self.masses)
        return {name: replace(one, units=units.get(name, one.units)) for name, one in flat.items() if name in numbers}

    @property
    def numbers(self) -> dict[str, Any]:
        """Their values; `tau` may be a word, R_left None."""
        result = {}
        for one in self.model.numbers:
            value = self.given[one.name]
            if one.each:
                result |= {f"{one.name}{i}": entry for i, entry in enumerate(value or (), 1)}
            else:
                result[one.name] = value
        return result

    @property
    def options(self) -> dict[str, Any]:
        return {one.name: self.given[one.name] for one in self.model.options}

    @property
    def units(self) -> Units | None:
        return self.given["units"]

    @property
    def masses(self) -> int:
        return self.model.masses(self.given)

    @property
    def family(self) -> Family:
        return Family(_builder(self.model.name, tuple(self.given.items())), completed(self.numbers))

    @cached_property
    def linear(self) -> Linear:
        return self.family.linear

    def replace(self, **changes: Any) -> Oscillator:
        """A copy with other numbers. Raises ParameterError, also for a name that is not one of them."""
        given = dict(self.given)
        for name, value in changes.items():
            if name in given:
                given[name] = value
            elif name in self.numbers:
                lists = next(
                    one.name
                    for one in self.model.numbers
                    if one.each and name[len(one.name) :].isdecimal() and name.startswith(one.name)
                )
                entries = list(given[lists])
                entries[int(name[len(lists) :]) - 1] = value
                given[lists] = entries
            else:
                raise ParameterError(name, value, f"one of {', '.join(given)}")
        return _again(self.model.name, given)


def _again(name: str, given: Mapping[str, Any]) -> Oscillator:
    made = Oscillator.__new__(Oscillator)
    made._set(MODELS[name], given)
    return made


def _builder(name: str, given: tuple[tuple[str, Any], ...]) -> Callable[..., Linear]:
    return partial(_build, name, given)


def _build(name: str, given: tuple[tuple[str, Any], ...], /, **numbers) -> Linear:
    return linear_of(MODELS[name], dict(given) | numbers)


def checked(model: Model, given: Mapping[str, Any]) -> dict[str, Any]:
    """Everything the model needs, in its order: floats, tuples of floats, words. Raises ParameterError."""
    known = {one.name: one for one in (*model.options, *model.numbers)}
    for name, value in given.items():
        if name not in known:
            why = why_not_computed(name) or f"{model.name} has {', '.join(known)}"
            raise ParameterError(name, value, f"left out; {why}")
    result = {}
    for one in model.options:
        result[one.name] = _option(one, given.get(one.name, one.default))
    stops = result.get("stops", "both")
    lists = [one for one in model.numbers if one.each]
    for one in sorted(lists, key=lambda one: one.default is not None or one.optional):  # those that must be given first
        value = given.get(one.name, one.default)
        if value is None and one.optional:
            result[one.name] = None
            continue
        if value is None:
            raise ParameterError(one.name, None, f"given: a list of numbers, one for each {one.each}")
        first = one.name not in result and not result.get("M") and one is lists[0]
        length = len(_entries(one, value)) if first else LENGTHS[one.each](model.masses(result))
        result[one.name] = _checked_list(one, value, length)
    masses = model.masses(result)
    if not 1 <= masses <= MOST_MASSES:
        name = "M" if "M" in result else lists[0].name
        raise ParameterError(name, wording.plain(result[name]), f"of 1 to {MOST_MASSES} masses")
    model.check(result)
    for one in model.numbers:
        if not one.each:
            value = given.get(one.name, one.default)
            words = isinstance(value, str) and value in one.words
            left_out = value is None and one.optional
            result[one.name] = value if words or left_out else checked_number(one, value, stops)
    check_stops(result)
    return {name: result[name] for name in known}


def _checked_list(one: Parameter, value: Any, length: int) -> tuple[float, ...]:
    if one.default is not None and number_of(value) == one.default:
        value = [value] * length  # nothing anywhere
    values = _entries(one, value)
    if len(values) != length:
        walls = ", to both walls too, where 0 is none" if one.each == "spring" else ""
        raise ParameterError(one.name, value, f"a list of {length} numbers, one for each {one.each}{walls}")
    return tuple(checked_number(one, entry, key=f"{one.name}[{i}]") for i, entry in enumerate(values))


def _entries(one: Parameter, value: Any) -> list:
    if number_of(value) is not None:
        return [value]  # of one mass
    numbers = array_of(value, 1)
    if numbers is None and not isinstance(value, (list, tuple)):  # of which the entry is named that is not a number
        raise ParameterError(one.name, value, f"a list of numbers, one for each {one.each}")
    return list(value) if numbers is None else numbers.tolist()


def _option(one: Option, value: Any) -> Any:
    if one.optional and (
        value is None or (one.kind == "matrix" and number_of(value) == 0)
    ):  # a matrix of zeros: nothing
        return None
    if one.kind == "word":
        if not (isinstance(value, str) and value in one.words):
            raise ParameterError(one.name, value, f"{', '.join(one.words[:-1])} or {one.words[-1]}")
    elif one.kind == "flag":
        if not isinstance(value, (bool, np.bool_)):
            raise ParameterError(one.name, value, "true or false")
        return bool(value)
    elif one.kind == "units":
        if (units := units_from(value)) is None:
            raise ParameterError(one.name, value, UNITS_ALLOWED)
        return units
    elif one.kind == "whole":
        if not isinstance(value, (int, np.integer)) or number_of(value) is None:
            raise ParameterError(one.name, value, "a whole number")
        return int(value)
    else:
        return _array(one, value)
    return value


def _array(one: Option, value: Any) -> tuple:
    """A matrix or a vector as nested tuples of floats."""
    allowed = "a square matrix of finite numbers" if one.kind == "matrix" else "a list of finite numbers"
    dimensions, one_mass = 2 if one.kind == "matrix" else 1, number_of(value)
    array = array_of(value, dimensions) if one_mass is None else np.full((1,) * dimensions, one_mass)
    if array is None or len({*array.shape}) != 1 or array.size == 0 or not np.isfinite(array).all():
        raise ParameterError(one.name, value, allowed)
    numbers = array.tolist()
    return tuple(tuple(row) for row in numbers) if one.kind == "matrix" else tuple(numbers)
