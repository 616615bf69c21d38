"""The paper's oscillator in physical quantities, from which its numbers follow (section 2 of the paper)."""

import math
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any

from vibro_sweep.checks.real import number_of
from vibro_sweep.checks.refusals import ParameterError
from vibro_sweep.oscillator.checked_numbers import range_of, units_from
from vibro_sweep.oscillator.contact_laws import OTHER_STOPS
from vibro_sweep.oscillator.contact_laws.rigid import RESTITUTION, RESTITUTION_LEFT
from vibro_sweep.tables.parameters import CLEARANCE, OFFSET
from vibro_sweep.tables.quantity import NOT_NEGATIVE, POSITIVE, Parameter

OMEGA = Parameter("Omega", "forcing frequency", "angular frequency of the force; or `frequency`, in Hz", r"\Omega",
    "rad s-1", POSITIVE,
)  # fmt: skip
PHYSICAL = (  # quantities in SI units, from which the numbers of a System follow (section 2 of the paper)
    Parameter("M1", "mass 1", "mass between the stops", "M_1", "kg", POSITIVE),
    Parameter("M2", "mass 2", "second mass", "M_2", "kg", POSITIVE),
    Parameter("K1", "stiffness 1", "stiffness between the masses", "K_1", "N m-1", POSITIVE),
    Parameter("K2", "stiffness 2", "stiffness between the second mass and the ground", "K_2", "N m-1", NOT_NEGATIVE),
    Parameter("C1", "damping 1", "damping between the masses", "C_1", "N s m-1", NOT_NEGATIVE),
    Parameter("C2", "damping 2", "damping between the second mass and the ground", "C_2", "N s m-1", NOT_NEGATIVE),
    Parameter("P1", "force 1", "amplitude of the force on the first mass", "P_1", "N", NOT_NEGATIVE),
    Parameter("P2", "force 2", "amplitude of the force on the second mass", "P_2", "N", NOT_NEGATIVE),
    OMEGA,
    RESTITUTION,
    replace(CLEARANCE, name="B", symbol="B", text="clearance on each side, from the middle to a stop"),
    replace(OFFSET, name="B0", symbol="B_0",
                      text="middle of the stops, from where the first mass rests without a force"),
    RESTITUTION_LEFT,
    *OTHER_STOPS,
)  # fmt: skip

CONVERTED = ("M1", "M2", "K1", "K2", "C1", "C2", "P1", "P2", "Omega", "B", "B0")


def in_numbers(arguments: Mapping[str, Any], stops: str) -> dict[str, Any]:
    """The numbers and units of a System with these quantities. Raises ParameterError."""
    M1, M2, K1, K2, C1, C2, P1, P2, Omega, B, B0 = (_checked(name, arguments[name], stops) for name in CONVERTED)
    if P1 + P2 == 0:
        raise ParameterError("P1", P1, "such that P1 + P2 > 0: lengths are measured in (P1 + P2)/K1")
    frequency = math.sqrt(K1) / math.sqrt(M1)  # no product of two given numbers: it could leave the range
    numbers = {
        "mu_m": ("M2", M2 / M1),
        "mu_k": ("K2", K2 / K1),
        "zeta": ("C1", C1 / (2 * math.sqrt(K1) * math.sqrt(M1))),
        "f2": ("P2", P2 / (P1 + P2)),
        "omega": ("Omega", Omega / frequency),
        "b": ("B", B / (P1 + P2) * K1),
        "offset": ("B0", B0 / (P1 + P2) * K1),
    }
    for name, (key, value) in numbers.items():
        if not math.isfinite(value) or (value == 0) != (arguments[key] == 0):
            raise ParameterError(key, arguments[key], f"such that {name} = {value!r} is in the range of the floats")
    result = {name: value for name, (_, value) in numbers.items()}
    sizes = 2 * [K1, frequency * M1, P1 + P2]
    for name_of_stop, size in zip(OTHER_STOPS, sizes, strict=True):
        value = number_of(arguments[name_of_stop.name])
        result[name_of_stop.name] = arguments[name_of_stop.name] if value is None else value / size
    first, second = Fraction(C1) * Fraction(K2), Fraction(C2) * Fraction(K1)
    if abs(first - second) > max(first, second) / 10**9:  # not proportional, beyond the rounding of the input
        if C1 == 0:
            raise ParameterError("C1", C1, "> 0 where C2 > 0: the damping ratio of the second damper is C2/C1")
        result["mu_c"] = C2 / C1
    return result | {"units": units_from((M1, (P1 + P2) / K1, 1 / frequency))}  # none where they leave the range


def _checked(name: str, value: Any, stops: str) -> float:
    quantity = next(name_of_stop for name_of_stop in PHYSICAL if name_of_stop.name == name)
    allowed, number = range_of(quantity, stops), number_of(value)
    if number is None or not (math.isfinite(number) and allowed.holds(number)):
        raise ParameterError(name, value, allowed.text.replace("a number", "a finite number"))
    return number
