"""The numbers that every oscillator has, and those that follow from the others of one with two stops."""

from vibro_sweep.tables.quantity import POSITIVE, Parameter, Range

FREQUENCY = Parameter("omega", "forcing frequency", "angular frequency of the force", r"\omega", "rad s-1", POSITIVE,
    free_motion=True,
)  # fmt: skip
CYCLES = Parameter("frequency", "forcing frequency", "frequency of the force in cycles per unit of time, in place of "
    "omega = 2 pi frequency; Hz where units are SI", "f", "Hz", POSITIVE, free_motion=True,
)  # fmt: skip
CLEARANCE = Parameter("b", "clearance", "clearance on each side of the middle", "b", "m",
    Range("a number > 0; any number where there is one stop alone", {}), "(4)",
    instead="where two soft stops meet, describe the softer one as a spring of the machine, and what the other one has "
    "more as a single stop (stops: right, b: 0)",
)  # fmt: skip
PHASE = Parameter("tau", "forcing phase", "phase of the force at t = 0 in radians",
    r"\tau", "rad",
    Range("a number (radians), a text such as 'pi/2', 'cos', which is that, or 'grazing'", {}), "(3)", "grazing",
    words={
        "grazing": "the phase at which the gap of the free motion is largest at t = 0, eq. (18); 0 where there is none"
    },
)  # fmt: skip
OFFSET = Parameter("offset", "offset of the stops", "middle of the stops: they stand at offset - b and offset + b",
    "b_0", "m", default=0.0,
)  # fmt: skip

STOP_RIGHT, STOP_LEFT = (
    Parameter(
        f"stop_{side}", f"{side} stop", f"where the {side} stop stands, in place of b, offset and stops",
        f"s_{{{letter}}}", "m",
    )
    for side, letter in (("right", "R"), ("left", "L"))
)  # fmt: skip

B_STAR = Parameter("b_star", "grazing clearance",
    "clearance b* at which the non-impacting motion touches the stops (Theorem 1)", "b^*", "m", POSITIVE, "(16)",
)  # fmt: skip
B_RIGHT, B_LEFT = (
    Parameter(
        f"b_{side}", f"grazing, {side} stop", f"clearance at which the free motion touches the {side} stop",
        f"b_{{\\mathrm{{{side}}}}}", "m", equation="(16)",
    )
    for side in ("right", "left")
)  # fmt: skip
FOLLOWING = tuple(
    parameter.name for parameter in (PHASE, B_STAR, B_RIGHT, B_LEFT, FREQUENCY)
)  # these may follow from swept numbers
