"""Variables of the motion after the last section point: continuous, at its sections and at its impacts."""

from typing import Any

from vibro_sweep.model.state import coordinates
from vibro_sweep.model.variable import Variable

TRAJECTORY = "trajectory"  # the scene's key that asks for them


def _trajectory(name: str, label: str, text: str, dimension: str | None, dtype: str = "f8", **more: Any) -> Variable:
    dimensions = (dimension,) if dimension else ()
    return Variable(f"trajectory_{name}", (TRAJECTORY,), label, text, dimensions, dtype, in_kernel=False, **more)


def of_a_trajectory(masses: int, gap: bool) -> tuple[Variable, ...]:
    """The continuous motion, its sections and its impacts."""
    along, at_impacts = "t_over_T", "trajectory_impact"
    other = coordinates(masses) if gap else coordinates(masses)[2:]  # at an impact x1 is at the stop, v1 jumps
    speed, mass = ("gap velocity", "of the gap") if gap else ("velocity v1", "of mass 1")
    return (
        *(
            variable
            for name, _, label, text, units in coordinates(masses)
            for variable in (
                _trajectory(name, label, f"{text} along the orbit", along, units=units),
                _trajectory(
                    f"section_{name}", label, f"{text} at the section t = 0 mod T along the orbit",
                    "trajectory_section", units=units,
                ),
            )
        ),
        _trajectory(
            "impacts", "impacts", "number of impacts along the orbit; of too many the fastest are stored", None, "i8",
        ),
        _trajectory(
            "impact_t_over_T", "time of impact, t/T", "forcing periods from the last section point to an impact",
            at_impacts,
        ),
        _trajectory(
            "impact_side", "stop of impact", "stop of an impact: 1 right, -1 left; 0: none", at_impacts, "i1",
            missing=0,
        ),
        _trajectory(f"impact_{before(gap)}", f"{speed} before impact", f"velocity {mass} before an impact", at_impacts,
            units="m s-1",
        ),
        _trajectory(
            f"impact_{before(gap)}_after", f"{speed} after impact", f"velocity {mass} after an impact", at_impacts,
            units="m s-1",
        ),
        *(
            _trajectory(f"impact_{name}", f"{label} at impact", f"{text} at an impact", at_impacts, units=units)
            for name, _, label, text, units in other
        ),
    )  # fmt: skip


def before(gap: bool) -> str:
    """The coordinate that an impact reverses."""
    return "gap_velocity" if gap else "v1"
