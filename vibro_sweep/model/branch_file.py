"""What files of branches, windows and curves hold, declared once: names, dimensions, types, units, texts, words."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from vibro_sweep.model.any_oscillator import AnyOscillator
from vibro_sweep.model.bifurcations import (
    BRANCH_STATUSES,
    CODIMENSION_TWO,
    CRITICALITIES,
    CURVES,
    EDGES,
    KINDS,
    REASONS,
    STATUSES,
    TYPES,
)
from vibro_sweep.model.state import coordinates
from vibro_sweep.model.units import unit_in

BRANCHES, WINDOWS, CHART = "branches", "windows", "curves"  # the kinds of such files


class Column(NamedTuple):
    """A variable. An index counts from 0; -1: there is none."""

    name: str
    dimensions: tuple[str, ...]
    dtype: str
    label: str  # `long_name`
    text: str  # `description`
    units: str = "1"
    flags: tuple[str, ...] = ()  # words of the codes 0, 1, ...
    index_in: str = ""  # of an index: the dimension along which it counts
    optional: bool = False  # of an index: whether it may be -1

    def limits(self, lengths: Mapping[str, int]) -> tuple[int, int] | None:
        """The least and the largest index or code; None for other numbers. lengths : of dimensions"""
        if self.index_in:
            return -1 if self.optional else 0, lengths.get(self.index_in, 0) - 1
        return (0, len(self.flags) - 1) if self.flags else None

    def holds(self, values: np.ndarray, lengths: Mapping[str, int]) -> bool:
        """Whether all are indices or codes that there are."""
        least, most = self.limits(lengths) or (-np.inf, np.inf)
        return not np.any((values < least) | (values > most))


OF_FIRST = "of the first parameter"  # the unit that such a number has
OF_PARAMETER = "of the parameters"  # that which all of them have; where they differ there is none

_TYPES = tuple(one.name for one in TYPES)

OF_BRANCHES = (
    Column("branch_period", ("branch",), "i4", "period in T", "period of the orbits in forcing periods"),
    Column("branch_symmetric", ("branch",), "i1", "symmetric", "whether x(t + period T/2) = -x(t)", "1", ("no", "yes")),
    Column("branch_closed", ("branch",), "i1", "closed", "whether it comes back to itself", "1", ("no", "yes")),
    Column(
        "branch_row_size", ("branch",), "i4", "points", "number of points of the branch, which lie one after another"
    ),
    Column("branch_impacts", ("branch",), "i4", "impacts", "impacts of the orbit at each point of the branch"),
    Column("branch_special", ("branch",), "i4", "special points", "number of its special points, one after another"),
    Column(
        "branch_status",
        ("branch",),
        "i1",
        "status",
        "whether it was followed to both ends; of one that could not be followed at all its orbit is the only point",
        "1",
        BRANCH_STATUSES,
    ),
    Column(
        "branch_begins", ("branch",), "i4", "begin", "index of the special point that it begins at", index_in="special"
    ),
    Column("branch_ends", ("branch",), "i4", "end", "index of the special point that it ends at", index_in="special"),
    Column(
        "branch_origin", ("branch",), "i4", "origin", "index of the point that it was followed from", index_in="point"
    ),
    Column(
        "branch_parent",
        ("branch",),
        "i4",
        "parent",
        "index of the branch from which it was reached",
        index_in="branch",
        optional=True,
    ),
    Column(
        "branch_parent_special", ("branch",), "i4", "parent's point", "index of the special point it was reached at"
    ),
    Column("branch_generation", ("branch",), "i4", "generation", "special points between it and the first branches"),
    Column(
        "multiplier_re",
        ("point", "multiplier"),
        "f8",
        "multiplier, real part",
        "of Floquet multipliers over the whole period",
    ),
    Column(
        "multiplier_im",
        ("point", "multiplier"),
        "f8",
        "multiplier, imaginary part",
        "of Floquet multipliers; of a pair the positive one first",
    ),
    Column("unstable", ("point",), "i4", "unstable multipliers", "number of multipliers outside the unit circle"),
    Column("margin", ("point",), "f8", "margin", "least distance of a turning point of the gap from its stop", "m"),
    Column(
        "min_impact_speed",
        ("point",),
        "f8",
        "smallest impact speed",
        "smallest speed of the gap before an impact; infinite without impacts",
        "m s-1",
    ),
    Column(
        "residual", ("point",), "f8", "residual", "largest jump of the gap between two flights, relative to its size"
    ),
    Column("status", ("point",), "i1", "status", "whether the point is a motion", "1", STATUSES),
    Column(
        "impact_t", ("impact",), "f8", "impact time", "of each impact of each point, continuous along a branch", "s"
    ),
    Column("impact_side", ("impact",), "i1", "stop", "+1: right, R of the itinerary; -1: left, L"),
    Column("impact_v", ("impact",), "f8", "impact velocity", "of the gap before the impact", "m s-1"),
    Column(
        "impact_t_off",
        ("impact",),
        "f8",
        "end of the rest",
        "after an impact at which the mass rests; NaN where it does not",
        "s",
    ),
    Column("special_type", ("special",), "i1", "type", "of a special point", "1", _TYPES),
    Column(
        "special_value",
        ("special", "parameter"),
        "f8",
        "parameters",
        "the numbers `parameters` at the special point",
        OF_PARAMETER,
    ),
    Column("special_branch", ("special",), "i4", "branch", "index of the branch that it lies on", index_in="branch"),
    Column(
        "special_point", ("special",), "i4", "point", "index of the point that it is", index_in="point", optional=True
    ),
    Column("special_stop", ("special",), "i1", "stop", "of a graze: +1 right, -1 left; 0: no graze"),
    Column("special_kind", ("special",), "i1", "kind", "of a graze", "1", KINDS),
    Column(
        "special_impact", ("special",), "i4", "impact", "of a graze: index of the impact that vanishes; -1: one appears"
    ),
    Column(
        "special_direction",
        ("special",),
        "i1",
        "direction",
        "of a graze: +1 where the orbit without the impact exists at larger values, -1 at smaller ones",
    ),
    Column(
        "special_criticality",
        ("special",),
        "i1",
        "criticality",
        "of a flip, pitchfork or Neimark-Sacker point",
        "1",
        CRITICALITIES,
    ),
    Column("special_error", ("special",), "f8", "error", "own estimate of the parameter's error", OF_PARAMETER),
)

BRANCH_SECTIONS = Column(
    "branch_sections",
    ("branch",),
    "i4",
    "section states",
    "section states of each point: those of the orbit, then those of its mirror image",
)

OF_WINDOWS = (
    Column("window_lo", ("window",), "f8", "lower end", "the parameter at the lower end", OF_FIRST),
    Column("window_hi", ("window",), "f8", "upper end", "the parameter at the upper end", OF_FIRST),
    Column("window_lower", ("window",), "i4", "what ends it below", "index of the special point", index_in="special"),
    Column("window_upper", ("window",), "i4", "what ends it above", "index of the special point", index_in="special"),
    Column("window_period", ("window",), "i4", "period in T", "in forcing periods"),
    Column("window_symmetric", ("window",), "i1", "symmetric", "whether the orbit is", "1", ("no", "yes")),
    Column("window_branch", ("window",), "i4", "branch", "index of the branch between the two ends", index_in="branch"),
    Column("window_row", ("window",), "i4", "row", "of a plane: index of the row along the parameter"),
    Column("window_orbits", ("window",), "i4", "orbits", "orbits of the sweep that lie in it"),
    Column("window_missed", ("window",), "i4", "missed", "orbits at its values that went to another attractor"),
    Column(
        "orbit_window",
        ("orbit",),
        "i4",
        "window",
        "of each orbit of the sweep in the order of its file: index of its window",
        index_in="window",
        optional=True,
    ),
    Column(
        "orbit_reason", ("orbit",), "i1", "reason", "why an orbit of the sweep lies in no window", "1", tuple(REASONS)
    ),
)

UNSEEN = {  # of a stretch of a window on which the sweep shows other attractors only
    "window": Column(
        "unseen_window", ("unseen",), "i4", "window", "whose orbit is stable there: its index", index_in="window"
    ),
    "lo": Column(
        "unseen_lo", ("unseen",), "f8", "from", "the parameter where the sweep begins to miss the orbit", OF_FIRST
    ),
    "hi": Column(
        "unseen_hi", ("unseen",), "f8", "to", "the parameter up to which the sweep misses the orbit", OF_FIRST
    ),
    "values": Column("unseen_values", ("unseen",), "i4", "values", "values of the sweep that show other attractors"),
    "at": Column(
        "unseen_at", ("unseen",), "f8", "at", "one of these values, of which `unseen_x1` .. is a start", OF_FIRST
    ),
}


_SHARED = {
    *("branch_period", "branch_symmetric", "branch_closed", "branch_row_size", "branch_impacts", "branch_special"),
    *("branch_begins", "branch_ends", "branch_parent", "branch_parent_special", "branch_generation"),
    *("multiplier_re", "multiplier_im", "margin", "min_impact_speed", "residual", "status"),
    *("impact_t", "impact_side", "impact_v", "special_value", "special_branch", "special_point", "special_error"),
}

OF_CURVES = (  # branches are curves here, along which an orbit bifurcates
    Column("branch_type", ("branch",), "i1", "type", "what happens along the curve", "1", CURVES),
    Column(
        "branch_grazing",
        ("branch",),
        "i4",
        "grazing impact",
        "index of the impact without speed along a graze curve; of a symmetric orbit, of its first half",
    ),
    *(column for column in OF_BRANCHES if column.name in _SHARED),
    Column(
        "unstable",
        ("point",),
        "i4",
        "unstable multipliers",
        "number of multipliers outside the unit circle, beside those that the curve is about; 0: it bounds attractors",
    ),
    Column(
        "b_star",
        ("point",),
        "f8",
        "grazing clearance",
        "b at which the free motion grazes both stops; NaN: no such",
        "m",
    ),
    Column(
        "special_type",
        ("special",),
        "i1",
        "type",
        "of codimension two",
        "1",
        tuple(one.name for one in CODIMENSION_TWO),
    ),
    Column(
        "special_touches", ("special",), "i1", "touches", "whether a flight touches a stop there", "1", ("no", "yes")
    ),
)


OF_EDGES = (  # of curves that begin at the edges of a plane
    Column(
        "edge_from",
        ("edge", "parameter"),
        "f8",
        "from",
        "the numbers `parameters` at one point of the sweep",
        OF_PARAMETER,
    ),
    Column(
        "edge_to", ("edge", "parameter"), "f8", "to", "at its neighbour, whose orbit has another period", OF_PARAMETER
    ),
    Column("edge_reason", ("edge",), "i1", "reason", "why the two differ", "1", tuple(EDGES)),
    Column(
        "edge_curve",
        ("edge",),
        "i4",
        "curve",
        "index of the curve that passes between them",
        index_in="branch",
        optional=True,
    ),
)


def columns(kind: str, parameters: list[str], masses: int) -> list[Column]:
    """All variables of a file; parameters : the names of numbers along which branches lead."""
    units = {one.name: one.units for one in coordinates(masses)}
    own = [Column(name, ("point",), "f8", name, f"the parameter {name}") for name in parameters]
    own += [Column(n, ("point",), "f8", n, f"{n} at t = 0, before an impact there", units[n]) for n in units]
    if kind == CHART:
        return [*own, *OF_CURVES]
    if kind == WINDOWS:
        text = "at t = 0 mod T, of a start that stays on the window's orbit at `unseen_at`; NaN where none is known"
        starts = [Column(f"unseen_{n}", ("unseen",), "f8", n, f"{n} {text}", units[n]) for n in units]
        return [*own, *OF_BRANCHES, *OF_WINDOWS, *UNSEEN.values(), *starts]
    sections = [Column(f"section_{n}", ("section",), "f8", n, f"{n} at t = 0 mod T", units[n]) for n in units]
    return [*own, *OF_BRANCHES, BRANCH_SECTIONS, *sections]


def columns_of(kind: str, parameters: list[str], system: AnyOscillator, more: tuple[Column, ...] = ()) -> list[Column]:
    """These, and more, in the units of a system."""
    of_each = {name: system.described[name].units for name in parameters}
    first, *others = of_each.values()
    common = {OF_FIRST: first, OF_PARAMETER: first if all(one == first for one in others) else "1"}

    def unit(column: Column) -> str:
        return unit_in(of_each.get(column.name) or common.get(column.units, column.units), system.units)

    return [one._replace(units=unit(one)) for one in (*columns(kind, parameters, system.masses), *more)]


RAGGED = {  # dimension -> (counts of each branch, what each of them counts for): one branch after another
    "point": ("branch_row_size",),
    "impact": ("branch_row_size", "branch_impacts"),
    "special": ("branch_special",),
    "section": ("branch_row_size", "branch_sections"),
}
