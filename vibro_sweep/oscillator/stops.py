"""The law of contact of each stop: which it has, what it follows, and what needs rigid stops."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from vibro_sweep.checks.refusals import ParameterError
from vibro_sweep.oscillator.contact_laws import LAWS, RIGID, STOP_NUMBERS
from vibro_sweep.oscillator.contact_laws.compliant import LAW as COMPLIANT
from vibro_sweep.oscillator.contact_laws.compliant import StopLaw
from vibro_sweep.oscillator.contact_laws.contact_law import ContactLaw

NUMBERS = tuple(option.name for option in STOP_NUMBERS)
RIGID_ALONE = (
    "with k_stop there are sweeps of the flow, `simulate`, `lyapunov`, periodic orbits, branches, curves and windows"
)
DAMPER_ALONE = "unless the stop is a damper alone, with c_stop > 0 and without a preload"
NEEDS_IMPACTS = {  # what rigid stops have alone, and why
    "map": "the discontinuity mapping takes the place of impacts",
    "born at grazing": "orbits are born at the grazing of rigid stops",
    "section": "a compliant stop is pressed, and has no impacts",
}


NOT_PRESSED = "both stops are rigid, which are struck and not pressed"


def why_rigid(what: str) -> str:
    """Why `what`, a key of `NEEDS_IMPACTS`, needs rigid stops, and what there is with others."""
    return f"{NEEDS_IMPACTS[what]}; {RIGID_ALONE}"


class Stop(NamedTuple):
    """The law of one stop, None where no number says it, and its numbers, by the names that the right stop's have."""

    law: ContactLaw | None
    numbers: dict[str, Any]

    def number(self, name: str, missing: float) -> Any:
        """The value; `missing` where the law has no such number, or it is left out."""
        value = self.numbers.get(name)
        return missing if value is None else value


def stop_of(arguments: Mapping[str, Any], side: str) -> Stop:
    """The stop on a side, right or left; what is left out of the left one follows the right one."""
    law_of_side = law_given(arguments, side)
    law = law_of_side or law_given(arguments, "right")
    if law is None:
        return Stop(None, {})
    pairs = zip(law.names["right"], law.names[side], strict=True)
    return Stop(
        law,
        {name: arguments.get(name) if arguments.get(option) is None else arguments[option] for name, option in pairs},
    )


def compliance_of(arguments: Mapping[str, Any], side: str) -> StopLaw | None:
    """The law of the stop on a side, right or left; None where it is rigid."""
    stop = stop_of(arguments, side)
    return StopLaw(*(stop.number(name, 0.0) for name in COMPLIANT.names["right"])) if stop.law is COMPLIANT else None


def completed(numbers: Mapping[str, Any]) -> dict[str, Any]:
    """The same numbers, with 0 for the damping and the preload of a compliant stop where they are left out."""
    unsaid = {}
    for side in ("left", "right"):
        if law_given(numbers, side) is COMPLIANT and (side == "right" or law_given(numbers, "right") is not COMPLIANT):
            unsaid |= {name: 0.0 for name in COMPLIANT.names[side] if numbers.get(name) is None}
    return {**numbers, **unsaid}


def has_compliant(arguments: Mapping[str, Any]) -> bool:
    """Whether numbers of a compliant stop are given."""
    return any(law_given(arguments, side) is COMPLIANT for side in ("right", "left"))


def law_given(arguments: Mapping[str, Any], side: str) -> ContactLaw | None:
    """The law that the numbers of this side alone say."""
    return next((law for law in LAWS.values() if arguments.get(law.names[side][0]) is not None), None)


def followers(arguments: Mapping[str, Any]) -> dict[str, Any]:
    """The numbers of a left stop that are left out and follow those of the right one."""
    law = stop_of(arguments, "left").law
    pairs = zip(law.names["left"], law.names["right"], strict=True) if law else ()
    return {
        name: arguments[option]
        for name, option in pairs
        if arguments.get(name) is None and arguments.get(option) is not None
    }


def check_stops(arguments: Mapping[str, Any]) -> None:
    """Raise ParameterError unless the numbers and options of the stops fit together."""
    stops = arguments.get("stops", "both")
    for side in ("right", "left"):
        keys = [law.names[side][0] for law in LAWS.values() if arguments.get(law.names[side][0]) is not None]
        for key in keys[1:]:
            raise ParameterError(
                key, arguments[key], f"left out where {keys[0]} is given: a stop is {' or '.join(LAWS)}"
            )
    right, left = law_given(arguments, "right"), stop_of(arguments, "left").law
    for law in LAWS.values():
        of_right, of_left = law.names["right"], law.names["left"]
        if law not in (right, left):
            _refuse(arguments, of_right[1:], f"it belongs to a stop with {of_right[0]}")
            for option in law.options:
                if arguments.get(option.name, option.words[0]) != option.words[0]:
                    raise ParameterError(option.name, arguments[option.name], f"left out where no stop is {law.name}")
        if left is not law:
            _refuse(arguments, of_left[1:], f"it belongs to a stop with {of_left[0]}")
        if stops == "right" and (law is not RIGID or right is not RIGID):
            _refuse(arguments, of_left, "there is no left stop")
    if (left if stops == "left" else right) is None:
        keys = [f"{law.names['right'][0]}, of a {law.name} stop" for law in LAWS.values() if law is not RIGID]
        raise ParameterError("R", None, f"given; or {' or '.join(keys)}")
    for side in ("right", "left"):
        _check_stiffness(arguments, side)


def _check_stiffness(arguments: Mapping[str, Any], side: str) -> None:
    """Raise ParameterError for a stop without stiffness that is no damper alone."""
    key = COMPLIANT.names[side][0]
    if arguments.get(key) != 0:
        return
    law = compliance_of(arguments, side)
    if law.c == 0 or law.p > 0:
        raise ParameterError(key, arguments[key], f"a number > 0 {DAMPER_ALONE}")


def _refuse(arguments: Mapping[str, Any], names: tuple[str, ...], wrong: str) -> None:
    """Refuse the numbers with these names that are given. wrong: why."""
    for name in names:
        if arguments.get(name) is not None:
            raise ParameterError(name, arguments[name], f"left out: {wrong}")
