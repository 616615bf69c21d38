"""The lines in which two scenes differ, as a message shows them."""

from vibro_sweep.model.refusals import LONGEST
from vibro_sweep.scene.differences import differences

SYSTEM = "system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6, tau: 0.5, stops: both}"


def test_lines_that_are_equal_are_left_out():
    assert differences("a\nb\nc", "a\nd\nc\ne").split() == ["-", "b", "+", "d", "+", "e"]


def test_of_long_lines_what_differs_is_shown():
    one, other = differences(SYSTEM, SYSTEM.replace("b: 6", "b: 7")).splitlines()
    assert "b: 6, tau" in one and "b: 7, tau" in other
    assert max(len(one), len(other)) <= len("  - ") + LONGEST


def test_many_lines_are_shortened():
    assert differences("", "\n".join(map(str, range(20)))).splitlines() == [f"  + {i}" for i in range(8)] + ["  ..."]
