"""The impact oscillator (eqs. 3, 4) with its parameters, and from physical quantities."""

import inspect
import math
from dataclasses import dataclass, fields
from dataclasses import replace as dataclass_replace
from fractions import Fraction
from typing import Any, ClassVar, Literal

import numpy as np

from vibro_sweep.checks.arguments import check_type
from vibro_sweep.checks.real import number_of
from vibro_sweep.checks.refusals import ParameterError
from vibro_sweep.model.any_oscillator import AnyOscillator
from vibro_sweep.model.checked_numbers import UNITS_ALLOWED, checked_number, range_of, units_from
from vibro_sweep.model.contact_laws import OTHER_STOPS
from vibro_sweep.model.contact_laws.rigid import RESTITUTION, RESTITUTION_LEFT
from vibro_sweep.model.grazing import resolved, with_phase
from vibro_sweep.model.linear import Family
from vibro_sweep.model.models.declaration import OF_STOPS, STOPS, Model
from vibro_sweep.model.models.two_mass import MODEL, PARAMETERS
from vibro_sweep.model.modes import Modes, modes
from vibro_sweep.model.stops import check_stops, completed
from vibro_sweep.tables.parameters import CLEARANCE, OFFSET
from vibro_sweep.tables.quantity import NOT_NEGATIVE, POSITIVE, Parameter
from vibro_sweep.tables.units import Units

Stops = Literal["both", "right", "left"]
Release = Literal["displacement", "force"]

PHYSICAL = (  # quantities in SI units, from which the numbers of a System follow (section 2 of the paper)
    Parameter("M1", "mass 1", "mass between the stops", "M_1", "kg", POSITIVE),
    Parameter("M2", "mass 2", "second mass", "M_2", "kg", POSITIVE),
    Parameter("K1", "stiffness 1", "stiffness between the masses", "K_1", "N m-1", POSITIVE),
    Parameter("K2", "stiffness 2", "stiffness between the second mass and the ground", "K_2", "N m-1", NOT_NEGATIVE),
    Parameter("C1", "damping 1", "damping between the masses", "C_1", "N s m-1", NOT_NEGATIVE),
    Parameter("C2", "damping 2", "damping between the second mass and the ground", "C_2", "N s m-1", NOT_NEGATIVE),
    Parameter("P1", "force 1", "amplitude of the force on the first mass", "P_1", "N", NOT_NEGATIVE),
    Parameter("P2", "force 2", "amplitude of the force on the second mass", "P_2", "N", NOT_NEGATIVE),
    Parameter("Omega", "forcing frequency", "angular frequency of the force, 2 pi times that in Hz", r"\Omega",
              "rad s-1", POSITIVE),
    RESTITUTION,
    dataclass_replace(CLEARANCE, name="B", symbol="B", text="clearance on each side, from the middle to a stop"),
    dataclass_replace(OFFSET, name="B0", symbol="B_0",
                      text="middle of the stops, from where the first mass rests without a force"),
    RESTITUTION_LEFT,
    *OTHER_STOPS,
)  # fmt: skip


@dataclass(frozen=True)
class System(AnyOscillator):
    """The impact oscillator (3), (4). Raises ParameterError for a parameter outside its range.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> round(system.period, 6), round(system.divergence, 6)
    (9.97331, -0.16)
    """

    mu_m: float
    mu_k: float
    zeta: float
    f2: float
    omega: float
    R: float | None = None
    b: float | None = None  # it must be given
    tau: float | Literal["grazing"] = "grazing"
    stops: Stops = "both"
    offset: float = 0.0
    R_left: float | None = None
    mu_c: float | None = None
    k_stop: float | None = None
    c_stop: float | None = None
    preload: float | None = None
    k_stop_left: float | None = None
    c_stop_left: float | None = None
    preload_left: float | None = None
    release: Release = "displacement"
    units: Units | None = None
    model: ClassVar[Model] = MODEL

    def __post_init__(self):
        _check_word("stops", self.stops, STOPS)
        if self.units is not None:
            if (units := units_from(self.units)) is None:
                raise ParameterError("units", self.units, UNITS_ALLOWED)
            object.__setattr__(self, "units", units)
        for one in PARAMETERS:
            value = getattr(self, one.name)
            left_out = value is None and one.optional
            if not (isinstance(value, str) and value in one.words) and not left_out:
                object.__setattr__(self, one.name, checked_number(one, value, self.stops))
        for one in OF_STOPS:
            _check_word(one.name, getattr(self, one.name), one.words)
        check_stops(vars(self))

    @property
    def family(self) -> Family:
        """The same oscillator by its numbers, with their derivatives."""
        return Family(MODEL.build, completed(self.numbers) | {"stops": self.stops, "release": self.release})

    @property
    def described(self) -> dict[str, Parameter]:
        """The numbers of the system by name."""
        return {one.name: one for one in PARAMETERS}

    @property
    def numbers(self) -> dict[str, Any]:
        """Their values; `tau` may be a word, R_left and mu_c None."""
        return {one.name: getattr(self, one.name) for one in PARAMETERS}

    @property
    def options(self) -> dict[str, Any]:
        """What is not a number: which stops there are, and the units."""
        return {"stops": self.stops, "release": self.release, "units": self.units}

    masses = 2
    gap_is_x1 = True

    def __repr__(self) -> str:
        """The call that makes it, without the numbers of compliant stops where there is none."""
        left_out = {one.name: None for one in OTHER_STOPS} | {one.name: one.default for one in OF_STOPS}
        given = {one.name: getattr(self, one.name) for one in fields(self)}
        shown = (f"{name}={value!r}" for name, value in given.items() if value != left_out.get(name, ...))
        return f"System({', '.join(shown)})"

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
        B: float,
        R: float | None = None,
        B0: float = 0.0,
        R_left: float | None = None,
        k_stop: float | None = None,
        c_stop: float | None = None,
        preload: float | None = None,
        k_stop_left: float | None = None,
        c_stop_left: float | None = None,
        preload_left: float | None = None,
        release: Release = "displacement",
        tau: float | Literal["grazing"] = "grazing",
        stops: Stops = "both",
    ) -> "System":
        """The system with these physical quantities in SI units: kg, m, s, N (section 2 of the paper). Raises
        `ParameterError`.

        Its `units` say what its own, nondimensional numbers are measured in.
        The stops stand at B0 - B and B0 + B; R_left, of the left one, is R where it is left out. k_stop in N/m, c_stop
        in N s/m and preload in N of compliant stops, in place of R, are as those of a System.

        Examples
        --------
        >>> import vibro_sweep as vs
        >>> system = vs.System.physical(
        ...     M1=2, M2=20, K1=800, K2=4000, C1=4, C2=20, P1=10, P2=0, Omega=12.6, R=0.8, B=0.05
        ... )
        >>> round(system.omega, 6), round(system.b, 6), round(system.zeta, 6)
        (0.63, 4.0, 0.05)
        """
        _check_word("stops", stops, STOPS)
        physical = {one.name: one for one in PHYSICAL}
        given = dict(M1=M1, M2=M2, K1=K1, K2=K2, C1=C1, C2=C2, P1=P1, P2=P2, Omega=Omega, B=B, B0=B0)
        for name, value in given.items():
            allowed, number = range_of(physical[name], stops), number_of(value)
            if number is None or not (math.isfinite(number) and allowed.holds(number)):
                raise ParameterError(name, value, allowed.text.replace("a number", "a finite number"))
            given[name] = number
        M1, M2, K1, K2, C1, C2, P1, P2, Omega, B, B0 = given.values()
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
            if not math.isfinite(value) or (value == 0) != (given[key] == 0):
                raise ParameterError(key, given[key], f"such that {name} = {value!r} is in the range of the floats")
        stop = dict(k_stop=k_stop, c_stop=c_stop, preload=preload)
        stop |= dict(k_stop_left=k_stop_left, c_stop_left=c_stop_left, preload_left=preload_left)
        sizes = 2 * [K1, frequency * M1, P1 + P2]
        for (name, value), size in zip(stop.items(), sizes, strict=True):
            stop[name] = value if number_of(value) is None else number_of(value) / size
        units = units_from((M1, (P1 + P2) / K1, 1 / frequency))  # none where they leave the range
        made = {name: value for name, (_, value) in numbers.items()}
        system = cls(**made, **stop, R=R, R_left=R_left, tau=tau, stops=stops, release=release, units=units)
        one, other = Fraction(C1) * Fraction(K2), Fraction(C2) * Fraction(K1)
        if abs(one - other) <= max(one, other) / 10**9:  # proportional, but for the rounding of the input
            return system
        if C1 == 0:
            raise ParameterError("C1", C1, "> 0 where C2 > 0: the damping ratio of the second damper is C2/C1")
        return system.replace(mu_c=C2 / C1)

    def replace(self, **changes: Any) -> "System":
        """A copy with other parameters. Raises ParameterError, also for a name that is not one of them.

        Examples
        --------
        >>> import vibro_sweep as vs
        >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
        >>> system.replace(b=4.5).b
        4.5
        """
        for name in changes:
            if name not in (known := [one.name for one in fields(self)]):
                raise ParameterError(name, changes[name], f"one of {', '.join(known)}")
        return dataclass_replace(self, **changes)

    @property
    def phase(self) -> float:
        """tau in radians, `grazing` resolved."""
        return float(with_phase(vars(self))["tau"])

    @property
    def modes(self) -> Modes:
        """The modes of the motion between the stops (eq. 5)."""
        return modes(self.mu_m, self.mu_k)

    @property
    def eta(self) -> np.ndarray:
        """Modal damping eta_j = zeta omega_j^2, (2,), if mu_c = mu_k.

        Non-impacting exponents: -eta_1, -eta_1, -eta_2, -eta_2.
        """
        return self.zeta * self.modes.omega_squared

    @property
    def divergence(self) -> float:
        """-tr(M^-1 C): the sum of the Lyapunov exponents of a non-impacting orbit."""
        return -2 * self.zeta * (1 + (1 + (self.mu_k if self.mu_c is None else self.mu_c)) / self.mu_m)

    def parameters(self) -> dict[str, float]:
        """The numbers by name, `tau` resolved, and R_left and mu_c where they follow."""
        return resolved(self.numbers)


def _check_word(name: str, value: object, words: tuple[str, ...]) -> None:
    if not (isinstance(value, str) and value in words):
        raise ParameterError(name, value, f"{', '.join(words[:-1])} or {words[-1]}")


def checked_system(system: object) -> None:
    """Raise TypeError unless it is a System or an Oscillator."""
    check_type("system", system, AnyOscillator, "a System or an Oscillator")


# what `help` shows of the parameters; absent where docstrings are (python -OO)
_said, _, _examples = inspect.cleandoc(System.__doc__ or "").partition("\n\nExamples\n")
if _examples:
    _parameters = [f"{one.name} : {one.described}; {one.range.text}" for one in PARAMETERS]
    _parameters += [f"stops : {', '.join(STOPS)}", f"units : for labels; {UNITS_ALLOWED}; left out: none"]
    System.__doc__ = "\n".join([_said, "\nParameters\n----------", *_parameters, "\nExamples", _examples])
