"""What commands print of their results."""

from pathlib import Path
from typing import TYPE_CHECKING

from vibro_sweep.model.grazing import Grazing

if TYPE_CHECKING:
    from .driver.sweep import RunReport


def grazing_text(touch: Grazing, stops: str) -> str:
    """What `grazing` prints of Theorem 1, with the stops that there are."""
    b, _, x2, v2 = touch.state
    side = -1 if stops == "left" else 1
    both = "   (right stop; left stop: its negative)"
    where = {"both": both, "right": "   (right stop, t = 0)", "left": "   (left stop, t = T/2)"}[stops]
    holds = "holds" if touch.satisfied else "does not hold"
    return (
        f"b*    = {b!r}\ntau*  = {touch.tau!r}\n"
        f"state = x1: {side * b!r}, v1: 0, x2: {side * x2!r}, v2: {side * v2!r}{where}\n"
        f"the existence condition (19) {holds}; determinant (15): {touch.determinant:.6g}"
    )


def summary(output: Path, report: "RunReport") -> str:
    """What `run` prints at its end."""
    from .driver.cost import duration

    unsettled = report.statuses.get("not_settled", 0)
    bad = {name: count for name, count in report.statuses.items() if name not in ("ok", "not_settled") and count}
    named = ", ".join(f"{name} {count}" for name, count in bad.items())
    state = f"{report.bad} with a bad status ({named})" if report.bad else "all ok"
    state += f"; {unsettled:,} not settled yet: a longer transient or record may tell" if unsettled else ""
    if not report.computed:
        return f"{output} is complete already, from the same scene: {points(report.points)}, {state}"
    return f"{output}: {points(report.points)} in {duration(report.seconds)}, {state}"


def points(count: int) -> str:
    return f"{count:,} point" + "s" * (count != 1)


def size_of(size: float) -> str:
    for unit in ("B", "kB", "MB"):
        if size < 1000:
            return f"{size:.3g} {unit}"
        size /= 1000
    return f"{size:.3g} GB"
