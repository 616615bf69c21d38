"""Numbers that may be given in other words: the frequency of the force in cycles, and where the stops stand."""

import math
from collections.abc import Collection, Mapping
from typing import Any

from vibro_sweep.checks.refusals import ParameterError
from vibro_sweep.oscillator.checked_numbers import checked_number
from vibro_sweep.tables.parameters import CLEARANCE, CYCLES, FREQUENCY, OFFSET, STOP_LEFT, STOP_RIGHT

OTHER_WORDS = (CYCLES, STOP_RIGHT, STOP_LEFT)  # of every model
STANDS_FOR = {  # of each, the numbers and words in place of which it is given
    CYCLES.name: (FREQUENCY.name,),
    STOP_RIGHT.name: (CLEARANCE.name, OFFSET.name, "stops"),
    STOP_LEFT.name: (CLEARANCE.name, OFFSET.name, "stops"),
}
_USUAL = {OFFSET.name: 0.0, "stops": "both"}


def with_omega(changes: Mapping[str, Any], numbers: Collection[str] = ()) -> dict[str, Any]:
    """The same numbers, with omega = 2 pi frequency in place of a frequency; numbers : that an oscillator has itself,
    whatever that of a function of the user's calls so."""
    result = dict(changes)
    if CYCLES.name in result and CYCLES.name not in numbers:
        result[FREQUENCY.name] = 2 * math.pi * result.pop(CYCLES.name)
    return result


def own_name(name: str) -> str:
    """The number that changes with this one: omega with the frequency."""
    return FREQUENCY.name if name == CYCLES.name else name


def in_own_numbers(arguments: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments of an oscillator with omega, b, offset and stops in place of other words. Raises ParameterError for
    what is given twice."""
    known = {number.name: arguments[number.name] for number in OTHER_WORDS if arguments.get(number.name) is not None}
    others = {name: value for name, value in arguments.items() if name not in STANDS_FOR}
    for name, value in known.items():
        for other in STANDS_FOR[name]:
            if others.get(other) not in (None, _USUAL.get(other)):
                raise ParameterError(name, value, f"left out where {other} is given, in place of which it stands")
    number = {word.name: checked_number(word, known[word.name]) for word in OTHER_WORDS if word.name in known}
    if CYCLES.name in number:
        others |= with_omega({CYCLES.name: number[CYCLES.name]})
    return others | _where_stops_stand(number.get(STOP_LEFT.name), number.get(STOP_RIGHT.name))


def _where_stops_stand(left: float | None, right: float | None) -> dict[str, Any]:
    """b, offset and stops: the stops stand at offset - b and offset + b."""
    if left is None and right is None:
        return {}
    if left is None:
        return {"b": right, "stops": "right"}
    if right is None:
        return {"b": 0.0 - left, "stops": "left"}
    if not left < right:
        raise ParameterError(STOP_RIGHT.name, right, f"above {STOP_LEFT.name} = {left!r}")
    return {"b": (right - left) / 2, "offset": (right + left) / 2, "stops": "both"}
