"""The law of contact of each stop: rigid with a restitution R, or compliant with a stiffness, damping and preload.

rigid        v -> -R v
compliant    F = k_stop delta + c_stop delta' + preload,    delta >= 0 how far the mass is behind the stop
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from vibro_sweep.model.parameters import COMPLIANT, COMPLIANT_LEFT, RELEASES, ParameterError

RIGID_ALONE = "with k_stop there are sweeps of the flow, `simulate` and `lyapunov` so far"
LEFT_OUT = "left out where {} is given: a stop is rigid or compliant"


class Stop(NamedTuple):
    """The numbers of one stop, as given; either R or k_stop."""

    R: Any
    k_stop: Any
    c_stop: Any = None
    preload: Any = None

    def left(self, R: Any, k_stop: Any, c_stop: Any, preload: Any) -> "Stop":
        """The left stop, where this is the right one: what is None of it follows."""
        if R is not None or (k_stop is None and self.k_stop is None):
            return Stop(self.R if R is None else R, None)
        given = zip((k_stop, c_stop, preload), (self.k_stop, self.c_stop, self.preload), strict=True)
        return Stop(None, *(leader if value is None else value for value, leader in given))

    @property
    def R_or_nan(self) -> Any:
        return np.nan if self.R is None else self.R

    @property
    def compliance(self) -> tuple:
        """Stiffness, damping and preload; zeros of a rigid stop."""
        if self.k_stop is None:
            return 0.0, 0.0, 0.0
        return self.k_stop, *(0.0 if value is None else value for value in (self.c_stop, self.preload))


def followers(numbers: Mapping[str, Any]) -> dict[str, Any]:
    """The numbers of a left stop that are left out and follow those of the right one."""
    given = {name: numbers.get(name) for name in ("R", "R_left", *_NAMES, *_NAMES_LEFT)}
    if given["R_left"] is not None:
        return {}
    if given["k_stop_left"] is None and given["k_stop"] is None:
        return {"R_left": given["R"]} if given["R"] is not None else {}
    pairs = zip(_NAMES_LEFT, _NAMES, strict=True)
    return {name: given[one] for name, one in pairs if given[name] is None and given[one] is not None}


_NAMES, _NAMES_LEFT = (tuple(one.name for one in numbers) for numbers in (COMPLIANT, COMPLIANT_LEFT))


def check_stops(given: Mapping[str, Any]) -> None:
    """Raise ParameterError unless the numbers and options of the stops fit together."""
    stops, release = given.get("stops", "both"), given.get("release", RELEASES[0])
    right = [given.get(name) for name in _NAMES]
    left = [given.get(name) for name in _NAMES_LEFT]
    R, R_left = given.get("R"), given.get("R_left")
    for rigid, numbers, names, R_name in ((R, right, _NAMES, "R"), (R_left, left, _NAMES_LEFT, "R_left")):
        if rigid is not None and numbers[0] is not None:
            raise ParameterError(names[0], numbers[0], LEFT_OUT.format(R_name))
    wanted = [R, right[0]] if stops != "left" else [R, right[0], R_left, left[0]]
    if all(one is None for one in wanted):
        raise ParameterError("R", None, "given; or k_stop, of a compliant stop")
    left_compliant = R_left is None and (left[0] is not None or right[0] is not None)
    if right[0] is None:
        _refuse(zip(_NAMES[1:], right[1:], strict=True), "k_stop", left_compliant)
    if not left_compliant or (stops == "right" and left[0] is None):
        _refuse(zip(_NAMES_LEFT[1:], left[1:], strict=True), "k_stop_left", False)
    if release != RELEASES[0] and right[0] is None and not left_compliant:
        raise ParameterError("release", release, "left out where both stops are rigid")


def _refuse(numbers, stiffness: str, followed: bool) -> None:
    for name, value in numbers:
        if value is not None and not followed:
            raise ParameterError(name, value, f"left out: it belongs to a stop with {stiffness}")
