"""Oscillators that a function of the caller's makes from numbers of any name, for `sweep`."""

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any

import numpy as np

from vibro_sweep.checks.arguments import check_type
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.oscillator.family import Family
from vibro_sweep.oscillator.linear import Linear
from vibro_sweep.oscillator.models.declaration import Model
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.tables.quantity import Parameter
from vibro_sweep.tables.units import Units

BUILD = "build"  # the `type` of files of such sweeps
STORED = {  # of a Linear, with the symbol that it has in files
    "M": "M", "K": "K", "C": "C", "normal": "n", "constant": "f_0", "sine": "f_s", "cosine": "f_c",
}  # fmt: skip


class FunctionModel(Oscillator):
    """The System or Oscillator that `function(**numbers)` returns. Raises TypeError where it is neither."""

    tau = "grazing"  # whatever the function says of it, it may change with every number

    def __init__(self, function: Callable[..., Oscillator], numbers: Mapping[str, float], same_units: bool = True):
        base = _made(function, numbers)
        named = tuple(Parameter(name, name, name, rf"\mathrm{{{name}}}", free_motion=True) for name in numbers)
        model = Model(BUILD, _name(function), "", "", "", named, (), lambda arguments: base.masses, self._linear)
        vars(self).update(
            function=function, base=base, model=model, arguments=dict(numbers), same_units=same_units, others=()
        )

    def __eq__(self, other):
        return isinstance(other, FunctionModel) and (self.function, self.arguments) == (other.function, other.arguments)

    def __hash__(self):
        return hash((self.function, tuple(self.arguments.items())))

    def __reduce__(self):
        return FunctionModel, (self.function, self.arguments, self.same_units)

    def _linear(self, **numbers) -> Linear:
        made = _made(self.function, numbers)
        if made.masses != self.base.masses:
            named = ", ".join(f"{name}={value!r}" for name, value in numbers.items())
            allowed = f"as many as at the first point, {self.base.masses}"
            raise ArgumentError(f"{self.name}({named}): {made.masses} masses are not allowed; there must be {allowed}")
        return made.linear

    @property
    def units(self) -> Units | None:
        return self.base.units if self.same_units else None

    def compare_units(self, numbers: Mapping[str, float]) -> None:
        """It has none from now on if those of the oscillator of these numbers are others."""
        vars(self)["same_units"] = self.same_units and _made(self.function, numbers).units == self.base.units

    @property
    def name(self) -> str:
        return _name(self.function)

    @property
    def stops(self) -> str:
        return self.base.options.get("stops", "both")

    @property
    def options(self) -> dict[str, Any]:
        return {BUILD: self.name, "stops": self.stops}

    @property
    def family(self) -> Family:
        return Family(self._linear, self.arguments)

    @cached_property
    def linear(self) -> Linear:
        return self.base.linear

    @property
    def omega(self) -> float:
        return self.base.omega

    def replace(self, **changes: Any) -> "FunctionModel":
        return FunctionModel(self.function, self.arguments | changes, self.same_units)


def _made(function: Callable[..., Oscillator], numbers: Mapping[str, float]) -> Oscillator:
    made = function(**numbers)
    check_type(f"system, {_name(function)}(...)", made, Oscillator, "a System or an Oscillator")
    return made


def _name(function: Callable) -> str:
    return getattr(function, "__name__", "function")


def sizes_of(q: Linear) -> dict[str, np.ndarray]:
    """The sizes (...) that random starts and comparisons need, by the names that they have for all oscillators."""
    low, high = np.asarray(q.contact.low), np.asarray(q.contact.high)
    two, right = np.isfinite(low) & np.isfinite(high), np.isfinite(high)
    with np.errstate(invalid="ignore"):  # of one stop
        b = np.where(two, (high - low) / 2, np.where(right, high, -low))
        offset = np.where(two, (high + low) / 2, 0.0)
    return {"omega": q.omega, "tau": q.tau, "b": b, "offset": offset}


def stored_of(q: Linear) -> dict[str, np.ndarray]:
    """Every number (...) of a stack by the name that files have for it: M11, M12, ..; along1; omega; low; R_low; ..."""
    numbers_of_fields = {}
    for field in STORED:
        values = getattr(q.contact if field == "normal" else q, field)
        n = values.shape[-1]
        if field in ("M", "K", "C"):
            numbers_of_fields |= {f"{field}{i + 1}{j + 1}": values[..., i, j] for i in range(n) for j in range(i, n)}
        else:
            numbers_of_fields |= {f"{field}{i + 1}": values[..., i] for i in range(n)}
    stops = {name: getattr(q.contact, name) for name in ("low", "high", "R_low", "R_high")}
    return numbers_of_fields | {"omega": q.omega, "tau": q.tau} | stops


def stored_names(masses: int) -> dict[str, Parameter]:
    """These, as files describe them."""
    square = [f"{i}{j}" for i in range(1, masses + 1) for j in range(i, masses + 1)]
    places = {field: square if field in ("M", "K", "C") else [f"{i}" for i in range(1, masses + 1)] for field in STORED}
    units = {"M": "kg", "K": "N m-1", "C": "N s m-1", "normal": "1"}
    texts = {"low": "left stop", "high": "right stop", "R_low": "restitution, left", "R_high": "restitution, right"}
    texts |= {"omega": "forcing frequency", "tau": "forcing phase"}
    named = {
        f"{field}{place}": Parameter(
            f"{field}{place}", "entry", f"{field}, {place}", f"{STORED[field]}_{{{place}}}", units.get(field, "N")
        )
        for field, all_of_it in places.items()
        for place in all_of_it
    }
    more = {"low": "m", "high": "m", "omega": "rad s-1"}
    return named | {name: Parameter(name, text, text, name, more.get(name, "1")) for name, text in texts.items()}
