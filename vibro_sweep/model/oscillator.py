"""The impact oscillator (eqs. 3, 4) with its parameters, and from physical quantities."""

import math
from dataclasses import dataclass
from dataclasses import replace as dataclass_replace
from fractions import Fraction
from typing import Any, Literal

import numpy as np

from vibro_sweep.model.arguments import check_type
from vibro_sweep.model.grazing import with_phase
from vibro_sweep.model.modes import Modes, modes
from vibro_sweep.model.parameters import BY_NAME, NAMES, PARAMETERS, STOPS, ParameterError, check_value, physical_range

Stops = Literal["both", "right", "left"]


@dataclass(frozen=True)
class System:
    """The impact oscillator (3), (4). Raises ParameterError for a parameter outside its range."""

    mu_m: float
    mu_k: float
    zeta: float
    f2: float
    omega: float
    R: float
    b: float
    tau: float | Literal["grazing"] = "grazing"
    stops: Stops = "both"

    def __post_init__(self):
        for name in NAMES:
            value = getattr(self, name)
            if name == "tau" and value == "grazing":
                if not math.isfinite(self.phase):
                    raise ParameterError(
                        "tau",
                        value,
                        "a number: no finite steady motion exists, an undamped mode is in resonance or nearly",
                    )
                continue
            number = _number(value)
            if number is None:
                raise ParameterError(name, value, BY_NAME[name].range.text)
            try:
                check_value(name, number)
            except ParameterError as error:
                raise ParameterError(name, value, error.allowed) from None
            object.__setattr__(self, name, number)
        if self.stops not in STOPS:
            raise ParameterError("stops", self.stops, "both, right or left")

    @classmethod
    def physical(
        cls,
        *,
        M1: float,
        M2: float,
        K1: float,
        K2: float,
        C1: float,
        C2: float,
        P1: float,
        P2: float,
        Omega: float,
        R: float,
        B: float,
        tau: float | Literal["grazing"] = "grazing",
        stops: Stops = "both",
    ) -> "System":
        """From physical quantities in any consistent units (section 2 of the paper; mu_c = C2/C1 there).

        Raises `ParameterError` also where C1/K1 differs from C2/K2: the damping must be proportional.
        """
        given = {"M1": M1, "M2": M2, "K1": K1, "K2": K2, "C1": C1, "C2": C2, "P1": P1, "P2": P2, "Omega": Omega, "B": B}
        for name, value in given.items():
            allowed, number = physical_range(name), _number(value)
            if number is None or not (math.isfinite(number) and allowed.holds(number)):
                raise ParameterError(name, value, allowed.text)
            given[name] = number
        M1, M2, K1, K2, C1, C2, P1, P2, Omega, B = given.values()
        if P1 + P2 == 0:
            raise ParameterError("P1", P1, "such that P1 + P2 > 0: lengths are measured in (P1 + P2)/K1")
        one, other = Fraction(C1) * Fraction(K2), Fraction(C2) * Fraction(K1)
        if abs(one - other) > max(one, other) / 10**9:
            raise ParameterError(
                "C2",
                C2,
                f"{C1 * (K2 / K1)!r}: C1/K1 = {C1 / K1!r} and C2/K2 = {C2 / K2!r} differ, damping must be proportional",
            )
        frequency = math.sqrt(K1) / math.sqrt(M1)  # no product of two given numbers: it could leave the range
        numbers = {
            "mu_m": ("M2", M2 / M1),
            "mu_k": ("K2", K2 / K1),
            "zeta": ("C1", C1 / (2 * math.sqrt(K1) * math.sqrt(M1))),
            "f2": ("P2", P2 / (P1 + P2)),
            "omega": ("Omega", Omega / frequency),
            "b": ("B", B / (P1 + P2) * K1),
        }
        for name, (key, value) in numbers.items():
            if not math.isfinite(value) or (value == 0) != (given[key] == 0):
                raise ParameterError(key, given[key], f"such that {name} = {value!r} is in the range of the floats")
        return cls(**{name: value for name, (_, value) in numbers.items()}, R=R, tau=tau, stops=stops)

    def replace(self, **changes: Any) -> "System":
        """A copy with other parameters. Raises ParameterError, also for a name that is none of them."""
        for name in changes:
            if name not in (*NAMES, "stops"):
                raise ParameterError(name, changes[name], f"one of {', '.join(NAMES)}, stops")
        return dataclass_replace(self, **changes)

    @property
    def phase(self) -> float:
        """tau in radians, `grazing` resolved."""
        return float(with_phase(vars(self))["tau"])

    @property
    def period(self) -> float:
        """The forcing period T = 2 pi/omega."""
        return 2 * math.pi / self.omega

    @property
    def modes(self) -> Modes:
        return modes(self.mu_m, self.mu_k)

    @property
    def eta(self) -> np.ndarray:
        """Modal damping eta_j = zeta omega_j^2, (2,). Non-impacting exponents: -eta_1, -eta_1, -eta_2, -eta_2."""
        return self.zeta * self.modes.omega_squared

    @property
    def divergence(self) -> float:
        """-tr(M^-1 C): the sum of the Lyapunov exponents of a non-impacting orbit."""
        return -2 * self.zeta * (1 + (1 + self.mu_k) / self.mu_m)

    def parameters(self) -> dict[str, float]:
        """The numbers by name, `tau` resolved."""
        return {name: getattr(self, name) for name in NAMES} | {"tau": self.phase}


def _number(value: object) -> float | None:
    """A real number of Python's or NumPy's as a float, infinite beyond the range of the floats; None for no number."""
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, float, np.integer, np.floating)):
        return None
    try:
        return float(value)
    except OverflowError:
        return math.inf


def checked_system(system: object) -> None:
    """Raise TypeError unless it is a System."""
    check_type("system", system, System, "a System")


# what `help` shows of the parameters; absent where docstrings are (python -OO)
if System.__doc__:
    System.__doc__ += "\n\nParameters\n----------\n"
    System.__doc__ += "\n".join(f"{one.name} : {one.described}; {one.range.text}" for one in PARAMETERS)
    System.__doc__ += f"\nstops : {', '.join(STOPS)}\n"
