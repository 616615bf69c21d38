"""Types of special points of branches, and of points of codimension two of curves."""

from collections.abc import Iterable, Iterator

from vibro_sweep.model.bifurcations import CODIMENSION_TWO, CURVES, TYPES, WAYS

from .markdown import head, listed, table


def page() -> Iterator[str]:
    yield from head(
        "Bifurcations",
        "The types of special points, with the letters by which pictures mark them. [Statuses](statuses.md) says\n"
        "what to do where a branch or a window ends at one.",
    )
    yield "## Types of special points\n"
    yield "Of branches (`special_type`), and which of them are followed as curves: by `bifurcation_curve`, and in files"
    yield "(`branch_type`).\n"
    rows = (
        (
            f"`{one.name}`",
            one.text,
            one.label,
            "yes" if one.name in CURVES else "not in files" if one.condition else "",
            f"`{one.name}`" if one.name in WAYS else "",
        )
        for one in TYPES
    )
    yield from table(("type", "meaning", "in pictures", "curve", "word of `follow`"), rows)
    yield "## Types of points of codimension two\n"
    yield "Of curves (`special_type` of their files), with the curves of orbits of a longer period that begin there.\n"
    rows = (
        (
            f"`{one.name}`",
            one.text,
            one.label,
            _types({condition for condition, _ in one.tests} | ({"torus"} if one.turn else set()), one.sigma),
            _types(one.begins, 1),
        )
        for one in CODIMENSION_TWO
    )
    yield from table(("type", "meaning", "in pictures", "on which curves", "begins"), rows)


def _types(conditions: Iterable[str], sigma: int) -> str:
    """The types of curves of orbits with this sigma, or any, along which one of these conditions holds."""
    return listed(one.name for one in TYPES if one.condition in conditions and sigma * one.sigma >= 0)
