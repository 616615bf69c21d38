"""A contact as an element of its own: a gap, the stops that bound it, and their laws."""

from __future__ import annotations  # help() says ArrayLike, and not all that this may be

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from vibro_sweep.checks.refusals import ParameterError
from vibro_sweep.oscillator.checked_model import checked_option
from vibro_sweep.oscillator.checked_numbers import checked_normal, checked_number
from vibro_sweep.oscillator.linear import LinearContact, contact
from vibro_sweep.oscillator.models.declaration import CONTACT, OF_STOPS, WHICH_STOPS
from vibro_sweep.oscillator.stops import check_stops
from vibro_sweep.tables.parameters import FREQUENCY, PHASE

NUMBERS = tuple(quantity for quantity in CONTACT if quantity not in (FREQUENCY, PHASE))


@dataclass(frozen=True)
class Contact:
    """A gap g = n . x between stops at offset - b and offset + b, or with `stops` one of them.

    contact_normal : (N,) n
    R, k_stop, c_stop, preload, .._left, release : the law of the stops, as of an `Oscillator`

    Raises ParameterError for what cannot be.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> wall, between = vs.Contact([1, 0], b=1.0, R=0.8), vs.Contact([-1, 1], b=0.2, stops="right", k_stop=100.0)
    >>> system = vs.Oscillator([[1, 0], [0, 2]], [[2, -1], [-1, 1]], force=[1, 0], omega=0.8, contacts=[wall, between])
    >>> len(system.contacts), system.contacts[0] == wall
    (2, True)
    """

    contact_normal: ArrayLike
    b: float
    offset: float = 0.0
    R: float | None = None
    R_left: float | None = None
    k_stop: float | None = None
    c_stop: float | None = None
    preload: float | None = None
    k_stop_left: float | None = None
    c_stop_left: float | None = None
    preload_left: float | None = None
    release: Literal["displacement", "force"] = "displacement"
    stops: Literal["both", "right", "left"] = "both"

    def __post_init__(self):
        for quantity in (WHICH_STOPS, *OF_STOPS):
            checked_option(quantity, getattr(self, quantity.name))
        object.__setattr__(self, "contact_normal", checked_normal(self.contact_normal))
        for quantity in NUMBERS:
            value = getattr(self, quantity.name)
            if not (value is None and quantity.optional):
                object.__setattr__(self, quantity.name, checked_number(quantity, value, self.stops))
        check_stops(vars(self))

    @property
    def linear(self) -> LinearContact:
        """Its numbers, as the engine sees them."""
        numbers = {entry.name: getattr(self, entry.name) for entry in fields(self)}
        return contact(np.array(numbers.pop("contact_normal")), **numbers)

    def __repr__(self) -> str:
        arguments = {entry.name: getattr(self, entry.name) for entry in fields(self)}
        left_out = {entry.name: entry.default for entry in fields(self)}
        shown = [f"{name}={value!r}" for name, value in arguments.items() if value != left_out[name]]
        return f"Contact({', '.join(shown).replace('contact_normal=', '', 1)})"


NAMES = tuple(entry.name for entry in fields(Contact))


def contacts_in(value: object) -> tuple[Contact, ...]:
    """Contacts of a list of them, or of mappings with their arguments. Raises ParameterError."""
    if not isinstance(value, (list, tuple)) or not value:
        raise ParameterError("contacts", value, "a list of one Contact or more")
    return tuple(_contact(f"contacts[{i}]", contact) for i, contact in enumerate(value))


def _contact(key: str, value: object) -> Contact:
    if isinstance(value, Contact):
        return value
    if not isinstance(value, Mapping) or not set(value) <= {*NAMES} or not {"contact_normal", "b"} <= set(value):
        raise ParameterError(key, value, f"a Contact, or its {', '.join(NAMES)}")
    return Contact(**value)


def check_left_out(arguments: Mapping[str, Any]) -> None:
    """Raise ParameterError for a number of a contact that is given beside the list of contacts."""
    usual = {entry.name: entry.default for entry in fields(Contact)}
    for name in NAMES:
        if arguments.get(name) is not None and arguments[name] != usual[name]:
            raise ParameterError(name, arguments[name], "left out where `contacts` are given, which have it")
