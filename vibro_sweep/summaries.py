"""What commands print of their results."""

from pathlib import Path
from typing import TYPE_CHECKING

from vibro_sweep.model.grazing import Grazing
from vibro_sweep.model.models import MODELS
from vibro_sweep.model.models.declaration import Model, Option
from vibro_sweep.model.parameters import Parameter

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


def model_list() -> str:
    """What `models` prints: a line each."""
    return "\n".join(f"{name:<16} {one.title}" for name, one in MODELS.items())


def model_text(model: Model) -> str:
    """What `models NAME` prints: equations, sketch, numbers with their ranges, options, source."""
    numbers = [(one.name, one.range.text, one) for one in model.numbers]
    options = [(one.name, _allowed(one), one) for one in model.options]
    wide = [max(len(row[column]) for row in numbers + options) for column in (0, 1)]
    rows = [
        f"  {name:<{wide[0]}}  {allowed:<{wide[1]}}  {one.text}{_each(one)}{_default(one)}"
        for name, allowed, one in numbers + options
    ]
    sketch, equations = model.sketch.strip("\n"), model.equations.strip("\n")
    return "\n".join(
        [f"{model.name}: {model.title}", "", sketch, "", equations, "", *rows, "", f"source: {model.source}"]
    )


def _allowed(one: Option) -> str:
    kinds = {"flag": "true or false", "whole": "a whole number", "matrix": "a matrix", "vector": "a list of numbers"}
    return kinds.get(one.kind) or " or ".join(one.words)


def _each(one: Parameter | Option) -> str:
    each = getattr(one, "each", "")
    return f"; a list, one for each {each}" if each else ""


def _default(one: Parameter | Option) -> str:
    if one.default is None:
        return ""
    return f" [{str(one.default).lower() if isinstance(one.default, bool) else one.default}]"


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
