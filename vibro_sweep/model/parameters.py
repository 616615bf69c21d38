"""The numbers of the oscillator, declared once: records, scene keys, JSON Schema, files and plot labels follow."""

import operator
from typing import Any, NamedTuple

import numpy as np

from vibro_sweep.model.errors import VibroSweepError
from vibro_sweep.model.real import number_of
from vibro_sweep.model.refusals import not_allowed

STOPS = ("both", "right", "left")
RELEASES = ("displacement", "force")

_HOLDS = {
    "exclusiveMinimum": operator.gt,
    "minimum": operator.ge,
    "maximum": operator.le,
}


class Range(NamedTuple):
    """The range of a number, in words and as JSON Schema says it."""

    text: str
    bounds: dict[str, float]

    def holds(self, numbers: np.ndarray) -> np.ndarray:
        """Whether finite numbers are in the range; of the shape of `numbers`."""
        good = np.isfinite(numbers)
        for bound, value in self.bounds.items():
            good = good & _HOLDS[bound](numbers, value)
        return good


POSITIVE = Range("a number > 0", {"exclusiveMinimum": 0})
NOT_NEGATIVE = Range("a number >= 0", {"minimum": 0})
FRACTION = Range("a number from 0 to 1", {"minimum": 0, "maximum": 1})
NUMBER = Range("a number", {})


LENGTHS = {  # of lists, for N masses
    "mass": lambda masses: masses,
    "mode": lambda masses: masses,
    "spring": lambda masses: masses + 1,  # those to both walls too
    "coefficient": lambda masses: 2,
}


class Parameter(NamedTuple):
    name: str  # of the Python argument, the scene key and the variable of the file
    symbol: str  # TeX, as in the paper
    units: str  # where the system is given in SI (model/units.py)
    range: Range
    label: str  # short: of an axis
    text: str
    equation: str = ""  # in which it first appears
    default: Any = None  # None: it must be given
    words: dict[str, str] = {}  # noqa: RUF012  # what may stand in place of a number, and what it means; read only
    free_motion: bool = False  # whether the non-impacting motion depends on it (tau only shifts that in time)
    follows: str = ""  # the number whose value it has where it is left out
    each: str = ""  # of a list: what it has one number for, a key of `LENGTHS`
    optional: bool = False  # whether it may be left out although nothing is known of it then

    @property
    def described(self) -> str:
        """Text and words."""
        return ", or ".join([self.text, *(f"`{word}`: {meaning}" for word, meaning in self.words.items())])

    @property
    def long_name(self) -> str:
        """Label and name, as plain text."""
        return f"{self.label} {self.name.removeprefix('start_')}"


# What all oscillators have.
FREQUENCY = Parameter(
    "omega", r"\omega", "rad s-1", POSITIVE, "forcing frequency", "angular frequency of the force", free_motion=True
)
RESTITUTION = Parameter(
    "R", "R", "1", FRACTION, "coefficient of restitution", "coefficient of restitution of a rigid stop", "(4)",
    optional=True,
)  # fmt: skip
CLEARANCE = Parameter(
    "b", "b", "m", Range("a number > 0; any number where there is one stop alone", {}), "clearance",
    "clearance on each side of the middle", "(4)",
)  # fmt: skip
PHASE = Parameter(
    "tau", r"\tau", "rad", Range("a number (radians) or 'grazing'", {}), "forcing phase",
    "phase of the force at t = 0 in radians", "(3)", "grazing",
    {"grazing": "the phase at which the gap of the free motion is largest at t = 0, eq. (18); 0 where there is none"},
)  # fmt: skip
OFFSET = Parameter(
    "offset", "b_0", "m", NUMBER, "offset of the stops",
    "middle of the stops: they stand at offset - b and offset + b", default=0.0,
)  # fmt: skip
RESTITUTION_LEFT = Parameter(
    "R_left", r"R_{\mathrm{left}}", "1", FRACTION, "restitution on the left",
    "coefficient of restitution of the left stop; left out: R", follows="R",
)  # fmt: skip
STIFFNESS = Parameter(
    "k_stop", r"k_{\mathrm{stop}}", "N m-1", POSITIVE, "stiffness of the stop",
    "stiffness of a compliant stop, in place of R", optional=True,
)  # fmt: skip
DAMPING = Parameter(
    "c_stop", r"c_{\mathrm{stop}}", "N s m-1", NOT_NEGATIVE, "damping of the stop",
    "damping of a compliant stop; left out: 0", optional=True,
)  # fmt: skip
PRELOAD = Parameter(
    "preload", r"p_{\mathrm{stop}}", "N", NOT_NEGATIVE, "preload of the stop",
    "force with which a compliant stop is pressed together before it is touched; left out: 0", optional=True,
)  # fmt: skip
COMPLIANT = (STIFFNESS, DAMPING, PRELOAD)
COMPLIANT_LEFT = tuple(
    one._replace(
        name=f"{one.name}_left", symbol=one.symbol.replace("stop", "left"), label=f"left {one.label.split(' ')[0]}",
        text=f"{one.name} of the left stop; left out: {one.name}", follows=one.name,
    )
    for one in COMPLIANT
)  # fmt: skip
STOP_NUMBERS = (RESTITUTION, RESTITUTION_LEFT, *COMPLIANT, *COMPLIANT_LEFT)

# Of the paper's oscillator, in the order of the kernels' records and derivatives.
PAPER = (
    Parameter("mu_m", r"\mu_m", "1", POSITIVE, "mass ratio", "mass ratio M2/M1", "(3)", free_motion=True),
    Parameter("mu_k", r"\mu_k", "1", NOT_NEGATIVE, "stiffness ratio", "stiffness ratio K2/K1", "(3)", free_motion=True),
    Parameter(
        "zeta", r"\zeta", "1", NOT_NEGATIVE, "damping ratio",
        "damping ratio C1/(2 sqrt(K1 M1))", "(3)", free_motion=True,
    ),
    Parameter(
        "f2", "f_2", "1", FRACTION, "share of force on mass 2",
        "share of the force on the second mass, P2/(P1 + P2)", "(3)", free_motion=True,
    ),
    Parameter(
        "omega", r"\omega", "rad s-1", POSITIVE, "forcing frequency", "forcing frequency Omega sqrt(M1/K1)", "(3)",
        free_motion=True,
    ),
    RESTITUTION,
    CLEARANCE._replace(text="clearance on each side, B K1/(P1 + P2)"),
    PHASE,
)  # fmt: skip

PARAMETERS = (
    *PAPER,
    OFFSET,
    RESTITUTION_LEFT,
    Parameter(
        "mu_c", r"\mu_c", "1", NOT_NEGATIVE, "ratio of dampers", "ratio of the dampers C2/C1; left out: mu_k",
        free_motion=True, follows="mu_k",
    ),
    *COMPLIANT,
    *COMPLIANT_LEFT,
)  # fmt: skip

# Physical quantities in SI units, from which these follow (section 2 of the paper).
PHYSICAL = (
    Parameter("M1", "M_1", "kg", POSITIVE, "mass 1", "mass between the stops"),
    Parameter("M2", "M_2", "kg", POSITIVE, "mass 2", "second mass"),
    Parameter("K1", "K_1", "N m-1", POSITIVE, "stiffness 1", "stiffness between the masses"),
    Parameter("K2", "K_2", "N m-1", NOT_NEGATIVE, "stiffness 2", "stiffness between the second mass and the ground"),
    Parameter("C1", "C_1", "N s m-1", NOT_NEGATIVE, "damping 1", "damping between the masses"),
    Parameter("C2", "C_2", "N s m-1", NOT_NEGATIVE, "damping 2", "damping between the second mass and the ground"),
    Parameter("P1", "P_1", "N", NOT_NEGATIVE, "force 1", "amplitude of the force on the first mass"),
    Parameter("P2", "P_2", "N", NOT_NEGATIVE, "force 2", "amplitude of the force on the second mass"),
    Parameter(
        "Omega",
        r"\Omega",
        "rad s-1",
        POSITIVE,
        "forcing frequency",
        "angular frequency of the force, 2 pi times that in Hz",
    ),
    RESTITUTION,
    CLEARANCE._replace(name="B", symbol="B", text="clearance on each side, from the middle to a stop"),
    Parameter(
        "B0",
        "B_0",
        "m",
        NUMBER,
        "offset of the stops",
        "middle of the stops, from where the first mass rests without a force",
        default=0.0,
    ),
    RESTITUTION_LEFT,
    *COMPLIANT,
    *COMPLIANT_LEFT,
)

B_STAR = Parameter(
    "b_star", "b^*", "m", POSITIVE, "grazing clearance",
    "clearance b* at which the non-impacting motion touches the stops (Theorem 1)", "(16)",
)  # fmt: skip

B_RIGHT, B_LEFT = (
    Parameter(
        f"b_{side}", f"b_{{\\mathrm{{{side}}}}}", "m", NUMBER, f"grazing, {side} stop",
        f"clearance at which the free motion touches the {side} stop", "(16)",
    )
    for side in ("right", "left")
)  # fmt: skip

NAMES = tuple(parameter.name for parameter in PAPER)
FREE_MOTION = tuple(parameter.name for parameter in PAPER if parameter.free_motion)
FOLLOWING = ("tau", B_STAR.name, B_RIGHT.name, B_LEFT.name)  # where others are swept, these may follow from them
BY_NAME = {parameter.name: parameter for parameter in PARAMETERS}


class ParameterError(VibroSweepError, ValueError):
    """A parameter outside its range; carries `key`, `value` and `allowed`.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> try:
    ...     system.replace(R=1.2)
    ... except vs.ParameterError as error:
    ...     print(error)
    ...     print(error.key, error.value)
    R: 1.2 is not allowed; it must be a finite number from 0 to 1
    R 1.2
    """

    def __init__(self, key: str, value: object, allowed: str):
        super().__init__(key, value, allowed)
        self.key, self.value, self.allowed = key, value, allowed

    def __str__(self):
        return not_allowed(self.key, self.value, self.allowed)


def range_of(parameter: Parameter, stops: str) -> Range:
    """The range of a number where there are these stops: one alone may stand anywhere."""
    if parameter.name not in (CLEARANCE.name, "B"):
        return parameter.range
    return POSITIVE if stops == "both" else NUMBER


def check_value(parameter: Parameter, value: object, stops: str = "both", key: str | None = None) -> None:
    """Raise `ParameterError` unless `value` (a number or an array of numbers) is allowed for the parameter.

    key : what the error names, by default the parameter
    """
    allowed, key = range_of(parameter, stops), key or parameter.name
    numbers = np.asarray(value)
    if numbers.dtype.kind not in "fiu":
        raise ParameterError(key, value, allowed.text)
    good = allowed.holds(numbers)
    if not np.all(good):
        wanted = allowed.text.replace("a number", "a finite number", 1)
        raise ParameterError(key, numbers[~good].flat[0].item(), wanted)


def checked_number(parameter: Parameter, value: object, stops: str = "both", key: str | None = None) -> float:
    """A number as a float. Raises `ParameterError`, with the value as it was given, unless it is allowed."""
    number, key = number_of(value), key or parameter.name
    if number is None:
        raise ParameterError(key, value, range_of(parameter, stops).text)
    try:
        check_value(parameter, number, stops, key)
    except ParameterError as error:
        raise ParameterError(key, value, error.allowed) from None
    return number


def physical_range(name: str, stops: str) -> Range:
    """The range of a physical quantity, which must be finite."""
    found = range_of(next(quantity for quantity in PHYSICAL if quantity.name == name), stops)
    return found._replace(text=found.text.replace("a number", "a finite number"))
