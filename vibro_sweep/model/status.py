"""The status of a point: numerical outcomes travel with the data, as codes with a meaning."""

import functools
import operator
from typing import NamedTuple

NOT_COMPUTED = -1
OK = 0
EVENT_LIMIT = 1
NOT_FINITE = 2
TOO_STIFF = 3
UNRESOLVED = 4
BEYOND_STOP = 5
NOT_SETTLED = 6  # a remark: the numbers stand


class Status(NamedTuple):
    name: str  # one word for CF's `flag_meanings`
    text: str
    advice: str = ""  # what a user can do


STATUSES = {
    NOT_COMPUTED: Status(
        "not_computed",
        "not computed yet",
        "The run was interrupted, or still goes on. `vibro-sweep run SCENE.yaml --resume`, or `mode='resume'`, "
        "completes its file.",
    ),
    OK: Status("ok", "computed"),
    EVENT_LIMIT: Status(
        "too_many_impacts_in_a_period",
        "more impacts in a forcing period than are computed",
        "There are more than 100 000, as with R near 1 and a tiny clearance. Check the unit of "
        "the clearance; a smaller R, or a larger clearance, has fewer impacts. A mass that drops on a preloaded stop "
        "bounces ever lower and comes to rest only in the limit: start it at rest on the stop.",
    ),
    NOT_FINITE: Status(
        "not_finite",
        "the state left the range of floating-point numbers",
        "The motion grows without bounds, or the start is too large. Check the size of the start, and the "
        "damping: an undamped mode in resonance grows for ever.",
    ),
    TOO_STIFF: Status(
        "rates_too_far_apart",
        "the fastest time constant is too short compared with the forcing period",
        "The fastest time constant is shorter than 10^-7 of a period. Check that all numbers are in one system of "
        "units. Leave out modes as fast as that (modal truncation), or lower their damping; of a compliant stop that "
        "holds the mass for long lower `c_stop`.",
    ),
    UNRESOLVED: Status(
        "contact_unresolved",
        "two grazes are too close together to be separated",
        "No oscillator is known in which this happens. A change of a parameter in its last digits may avoid it. Please "
        "report the scene.",
    ),
    BEYOND_STOP: Status(
        "beyond_a_stop",
        "mass 1 was found behind a stop by more than rounding explains",
        "This has not been seen and would be a bug. Please report the scene.",
    ),
    NOT_SETTLED: Status(
        "not_settled",
        "a remark, the numbers are valid: the orbit is still on its way to a periodic one",
        "Let such orbits go on by `settle`, as far as `info` says, or `approached_distance` and `approached_factor`; "
        "lengthen `record` where a long period is expected. Chaos that ends after the record cannot be distinguished "
        "from chaos that lasts.",
    ),
}

VALID = (OK, NOT_SETTLED)  # of points whose numbers are valid


def meaning(code: int) -> str:
    """The name of a status; a file that somebody has changed may hold other codes."""
    return STATUSES[code].name if code in STATUSES else f"unknown_status_{code}"


def is_valid(codes):
    """Whether the numbers of points with these codes are valid; elementwise."""
    return functools.reduce(operator.or_, (codes == code for code in VALID))
