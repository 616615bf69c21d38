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


STATUSES = {
    NOT_COMPUTED: Status("not_computed", "not computed yet"),
    OK: Status("ok", "computed"),
    EVENT_LIMIT: Status("too_many_impacts_in_a_period", "more impacts in a forcing period than are computed"),
    NOT_FINITE: Status("not_finite", "the state left the range of floating-point numbers"),
    TOO_STIFF: Status("rates_too_far_apart", "the fastest time constant is too short compared with the forcing period"),
    UNRESOLVED: Status("contact_unresolved", "two grazes are too close together to be separated"),
    BEYOND_STOP: Status("beyond_a_stop", "mass 1 was found behind a stop by more than rounding explains"),
    NOT_SETTLED: Status(
        "not_settled", "a remark, the numbers are valid: the record is neither periodic nor stationary"
    ),
}

VALID = (OK, NOT_SETTLED)  # of points whose numbers are valid


def meaning(code: int) -> str:
    """The name of a status; a file that somebody has changed may hold other codes."""
    return STATUSES[code].name if code in STATUSES else f"unknown_status_{code}"


def is_valid(codes):
    """Whether the numbers of points with these codes are valid; elementwise."""
    return functools.reduce(operator.or_, (codes == code for code in VALID))
