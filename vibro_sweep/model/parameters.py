"""The numbers of the oscillator, declared once: records, scene keys, JSON Schema, files and plot labels follow."""

import numpy as np

from vibro_sweep.model.contact_laws import LAWS, RIGID
from vibro_sweep.model.errors import VibroSweepError
from vibro_sweep.model.parameter import FRACTION, NOT_NEGATIVE, NUMBER, POSITIVE, Parameter, Range
from vibro_sweep.model.real import number_of
from vibro_sweep.model.refusals import not_allowed

STOPS = ("both", "right", "left")

# What all oscillators have.
FREQUENCY = Parameter(
    "omega", r"\omega", "rad s-1", POSITIVE, "forcing frequency", "angular frequency of the force", free_motion=True
)
CLEARANCE = Parameter(
    "b", "b", "m", Range("a number > 0; any number where there is one stop alone", {}), "clearance",
    "clearance on each side of the middle", "(4)",
    instead="where two soft stops meet, describe the softer one as a spring of the machine, and what the other one has "
    "more as a single stop (stops: right, b: 0)",
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
RESTITUTION, RESTITUTION_LEFT = RIGID.numbers[0], RIGID.left[0]
OTHER_STOPS = tuple(one for law in LAWS.values() if law is not RIGID for one in law.numbers_of_both)  # none is rigid
STOP_NUMBERS = (*RIGID.numbers_of_both, *OTHER_STOPS)

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
    *OTHER_STOPS,
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
    *OTHER_STOPS,
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
        wanted, bad = allowed.text.replace("a number", "a finite number", 1), numbers[~good].flat[0].item()
        beyond = bad == 0 or (-np.inf < bad < 0 and allowed.holds(np.zeros(())))
        raise ParameterError(key, bad, f"{wanted}; {parameter.instead}" if parameter.instead and beyond else wanted)


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
