"""The law of contact of each stop: which it has, what it follows, and what needs rigid stops."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from vibro_sweep.checks.refusals import ParameterError
from vibro_sweep.oscillator.contact_laws import LAWS, RIGID, STOP_NUMBERS
from vibro_sweep.oscillator.contact_laws.compliant import LAW as COMPLIANT
from vibro_sweep.oscillator.contact_laws.contact_law import ContactLaw

NUMBERS = tuple(one.name for one in STOP_NUMBERS)
RIGID_ALONE = (
    "with k_stop there are sweeps of the flow, `simulate`, `lyapunov`, periodic orbits, branches, curves and windows"
)
DAMPER_ALONE = "unless the stop is a damper alone, with c_stop > 0 and without a preload"
NEEDS_IMPACTS = {  # what rigid stops have alone, and why
    "map": "the discontinuity mapping takes the place of impacts",
    "period map": "the derivatives of a period map are those of impacts",
    "born at grazing": "orbits are born at the grazing of rigid stops",
    "section": "a compliant stop is pressed, and has no impacts",
}


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


def stop_of(given: Mapping[str, Any], side: str) -> Stop:
    """The stop on a side, right or left; what is left out of the left one follows the right one."""
    own = law_given(given, side)
    law = own or law_given(given, "right")
    if law is None:
        return Stop(None, {})
    pairs = zip(law.names["right"], law.names[side], strict=True)
    return Stop(law, {name: given.get(name) if given.get(one) is None else given[one] for name, one in pairs})


def compliance_of(given: Mapping[str, Any], side: str) -> tuple[float, float, float] | None:
    """Stiffness, damping and preload of the stop on a side, right or left; None where it is rigid."""
    stop = stop_of(given, side)
    return tuple(stop.number(name, 0.0) for name in COMPLIANT.names["right"]) if stop.law is COMPLIANT else None


def completed(numbers: Mapping[str, Any]) -> dict[str, Any]:
    """The same numbers, with 0 for the damping and the preload of a compliant stop where they are left out."""
    unsaid = {}
    for side in ("left", "right"):
        if law_given(numbers, side) is COMPLIANT and (side == "right" or law_given(numbers, "right") is not COMPLIANT):
            unsaid |= {name: 0.0 for name in COMPLIANT.names[side] if numbers.get(name) is None}
    return {**numbers, **unsaid}


def has_compliant(given: Mapping[str, Any]) -> bool:
    """Whether numbers of a compliant stop are given."""
    return any(law_given(given, side) is COMPLIANT for side in ("right", "left"))


def law_given(given: Mapping[str, Any], side: str) -> ContactLaw | None:
    """The law that the numbers of this side alone say."""
    return next((law for law in LAWS.values() if given.get(law.names[side][0]) is not None), None)


def followers(given: Mapping[str, Any]) -> dict[str, Any]:
    """The numbers of a left stop that are left out and follow those of the right one."""
    law = stop_of(given, "left").law
    pairs = zip(law.names["left"], law.names["right"], strict=True) if law else ()
    return {name: given[one] for name, one in pairs if given.get(name) is None and given.get(one) is not None}


def check_stops(given: Mapping[str, Any]) -> None:
    """Raise ParameterError unless the numbers and options of the stops fit together."""
    stops = given.get("stops", "both")
    for side in ("right", "left"):
        keys = [law.names[side][0] for law in LAWS.values() if given.get(law.names[side][0]) is not None]
        for key in keys[1:]:
            raise ParameterError(key, given[key], f"left out where {keys[0]} is given: a stop is {' or '.join(LAWS)}")
    right, left = law_given(given, "right"), stop_of(given, "left").law
    for law in LAWS.values():
        of_right, of_left = law.names["right"], law.names["left"]
        if law not in (right, left):
            _refuse(given, of_right[1:], f"it belongs to a stop with {of_right[0]}")
            for one in law.options:
                if given.get(one.name, one.words[0]) != one.words[0]:
                    raise ParameterError(one.name, given[one.name], f"left out where no stop is {law.name}")
        if left is not law:
            _refuse(given, of_left[1:], f"it belongs to a stop with {of_left[0]}")
        if stops == "right" and (law is not RIGID or right is not RIGID):
            _refuse(given, of_left, "there is no left stop")
    if (left if stops == "left" else right) is None:
        keys = [f"{law.names['right'][0]}, of a {law.name} stop" for law in LAWS.values() if law is not RIGID]
        raise ParameterError("R", None, f"given; or {' or '.join(keys)}")
    for side in ("right", "left"):
        _check_stiffness(given, side)


def _check_stiffness(given: Mapping[str, Any], side: str) -> None:
    """Raise ParameterError for a stop without stiffness that is no damper alone."""
    key = COMPLIANT.names[side][0]
    if given.get(key) != 0:
        return
    _, damping, preload = compliance_of(given, side)
    if damping == 0 or preload > 0:
        raise ParameterError(key, given[key], f"a number > 0 {DAMPER_ALONE}")


def _refuse(given: Mapping[str, Any], names: tuple[str, ...], wrong: str) -> None:
    """Refuse the numbers with these names that are given. wrong: why."""
    for name in names:
        if given.get(name) is not None:
            raise ParameterError(name, given[name], f"left out: {wrong}")
