"""What files hold of branches, curves and windows, declared once: dimensions, types, names, texts, units, words."""

from typing import Any

from vibro_sweep.tables.bifurcations import CODIMENSION_TWO, CRITICALITIES, CURVES, KINDS, TYPES
from vibro_sweep.tables.coordinates import coordinates
from vibro_sweep.tables.outcomes import BRANCHES as OUTCOMES
from vibro_sweep.tables.outcomes import EDGES, POINTS, REASONS, names
from vibro_sweep.tables.quantity import Quantity

BRANCHES, WINDOWS, CHART = "branches", "windows", "curves"  # the kinds of such files
RAGGED_KINDS = (BRANCHES, WINDOWS, CHART)
SWEEP = "sweep"  # the kind of other HDF5 files
OF_FIRST = "of the first parameter"  # the unit that such a number has
OF_PARAMETER = "of the parameters"  # that which all of them have; where they differ there is none
_NO_YES = ("no", "yes")


def _column(dimensions: str, dtype: str, name: str, label: str, text: str, units: str = "1", **more: Any) -> Quantity:
    return Quantity(name, label, text, units=units, dimensions=tuple(dimensions.split()), dtype=dtype, **more)


OF_BRANCHES = (
    _column("branch", "i4", "branch_period", "period in T", "period of the orbits in forcing periods"),
    _column("branch", "i1", "branch_symmetric", "symmetric", "whether x(t + period T/2) = -x(t)", flags=_NO_YES),
    _column("branch", "i1", "branch_closed", "closed", "whether the branch comes back to itself", flags=_NO_YES),
    _column("branch", "i4", "branch_row_size", "points",
            "number of points of the branch, which lie one after another"),
    _column("branch", "i4", "branch_impacts", "impacts", "impacts of the orbit at each point of the branch"),
    _column("branch", "i4", "branch_special", "special points",
            "number of special points of the branch, which lie one after another"),
    _column("branch", "i1", "branch_status", "status",
            "whether the branch was followed to both ends; one that could not be followed has its orbit as its only "
            "point", flags=names(OUTCOMES)),
    _column("branch", "i4", "branch_begins", "begin",
            "index of the special point at which the branch begins", index_in="special"),
    _column("branch", "i4", "branch_ends", "end",
            "index of the special point at which the branch ends", index_in="special"),
    _column("branch", "i4", "branch_origin", "origin",
            "index of the point from which the branch was followed", index_in="point"),
    _column("branch", "i4", "branch_parent", "parent",
            "index of the branch from which this one was reached", index_in="branch", least=-1),
    _column("branch", "i4", "branch_parent_special", "parent's point",
            "index of the special point at which the branch was reached"),
    _column("branch", "i4", "branch_generation", "generation",
            "number of special points between the branch and the first branches"),
    _column("point multiplier", "f8", "multiplier_re", "multiplier, real part",
            "real part of the Floquet multipliers over the whole period"),
    _column("point multiplier", "f8", "multiplier_im", "multiplier, imaginary part",
            "imaginary part of the Floquet multipliers; of a complex pair the positive one comes first"),
    _column("point", "i4", "unstable", "unstable multipliers", "number of multipliers outside the unit circle"),
    _column("point", "f8", "stop_distance", "stop_distance",
            "least distance of a turning point of the gap from its stop", "m"),
    _column("point", "f8", "min_impact_speed", "smallest impact speed",
            "smallest speed of the gap before an impact; infinite without impacts", "m s-1"),
    _column("point", "f8", "residual", "residual", "largest jump of the gap between two flights, relative to its size"),
    _column("point", "i1", "status", "status", "whether the point is a motion", flags=names(POINTS)),
    _column("impact", "f8", "impact_t", "impact time",
            "time of each impact of each point, continuous along a branch", "s"),
    _column("impact", "i1", "impact_side", "stop",
            "stop of each impact: +1 right, R of the itinerary; -1 left, L"),
    _column("impact", "f8", "impact_v", "impact velocity", "velocity of the gap before the impact", "m s-1"),
    _column("impact", "f8", "impact_t_off", "end of the rest",
            "time at which the rest after an impact ends; NaN where the mass does not rest", "s"),
    _column("special", "i1", "special_type", "type", "type of the special point",
            flags=tuple(row.name for row in TYPES)),
    _column("special parameter", "f8", "special_value", "parameters",
            "values of the attribute `parameters` at the special point", OF_PARAMETER),
    _column("special", "i4", "special_branch", "branch",
            "index of the branch on which the special point lies", index_in="branch"),
    _column("special", "i4", "special_point", "point",
            "index of the point of the branch that the special point is", index_in="point", least=-1),
    _column("special", "i1", "special_stop", "stop",
            "stop that is grazed: +1 right, -1 left; 0 where nothing grazes"),
    _column("special", "i1", "special_kind", "kind", "kind of the graze", flags=KINDS),
    _column("special", "i4", "special_impact", "impact",
            "index of the impact that vanishes at the graze; -1 where one appears"),
    _column("special", "i1", "special_direction", "direction",
            "side on which the orbit without the grazing impact exists: +1 at larger values, -1 at smaller ones"),
    _column("special", "i1", "special_criticality", "criticality",
            "criticality of the flip, pitchfork or Neimark-Sacker point", flags=CRITICALITIES),
    _column("special", "f8", "special_error", "error", "own estimate of the error of `special_value`", OF_PARAMETER),
)  # fmt: skip

OF_CONTACTS = (  # of branches where `observe` has contacts
    _column("point", "f8", "contact_force_max", "largest contact force",
            "largest force of a compliant stop in a period, where `observe` has contacts; NaN without any", "N"),
    _column("point", "f8", "penetration_max", "largest penetration",
            "how far the mass is behind a compliant stop at most, where `observe` has contacts; NaN without any", "m"),
)  # fmt: skip

BRANCH_SECTIONS = _column("branch", "i4", "branch_sections", "section states",
    "number of section states of each point: those of the orbit, then those of its mirror image",
)  # fmt: skip

_SHARED = {
    *("branch_period", "branch_symmetric", "branch_closed", "branch_row_size", "branch_impacts", "branch_special"),
    *("branch_begins", "branch_ends", "branch_parent", "branch_parent_special", "branch_generation"),
    *("multiplier_re", "multiplier_im", "stop_distance", "min_impact_speed", "residual", "status"),
    *("impact_t", "impact_side", "impact_v", "impact_t_off"),
    *("special_value", "special_branch", "special_point", "special_error"),
}

OF_CURVES = (  # branches are curves here, along which an orbit bifurcates
    _column("branch", "i1", "branch_type", "type", "type of the bifurcation along the curve", flags=CURVES),
    _column("branch", "i4", "branch_grazing", "grazing impact",
            "index of the impact without speed along a graze curve; of a symmetric orbit, of its first half"),
    *(row for row in OF_BRANCHES if row.name in _SHARED),
    _column("point", "i4", "unstable", "unstable multipliers",
            "number of multipliers outside the unit circle, without the critical ones; 0 where the curve bounds "
            "attractors"),
    _column("point", "f8", "b_star", "grazing clearance",
            "clearance b at which the free motion grazes both stops; NaN where there is none", "m"),
    _column("special", "i1", "special_type", "type", "type of the point of codimension two",
            flags=tuple(row.name for row in CODIMENSION_TWO)),
    _column("special", "i1", "special_touches", "touches",
            "whether a flight touches a stop at the special point", flags=_NO_YES),
)  # fmt: skip

OF_EDGES = (  # of curves that begin at the edges of a plane
    _column("edge parameter", "f8", "edge_from", "from",
            "values of the attribute `parameters` at one point of the sweep", OF_PARAMETER),
    _column("edge parameter", "f8", "edge_to", "to",
            "values of the attribute `parameters` at its neighbour, whose orbit has another period", OF_PARAMETER),
    _column("edge", "i1", "edge_reason", "reason", "why the orbits of the two points differ", flags=names(EDGES)),
    _column("edge", "i4", "edge_curve", "curve",
            "index of the curve that passes between them", index_in="branch", least=-1),
)  # fmt: skip

OF_WINDOWS = (
    _column("window", "f8", "window_lo", "lower end", "value of the parameter at the lower end", OF_FIRST),
    _column("window", "f8", "window_hi", "upper end", "value of the parameter at the upper end", OF_FIRST),
    _column("window", "i4", "window_lower", "lower end",
            "index of the special point at the lower end", index_in="special"),
    _column("window", "i4", "window_upper", "upper end",
            "index of the special point at the upper end", index_in="special"),
    _column("window", "i4", "window_period", "period in T", "period of the orbit in forcing periods"),
    _column("window", "i1", "window_symmetric", "symmetric", "whether x(t + period T/2) = -x(t)", flags=_NO_YES),
    _column("window", "i4", "window_branch", "branch",
            "index of the branch between the two ends", index_in="branch"),
    _column("window", "i4", "window_row", "row", "index of the row of the plane along the parameter"),
    _column("window", "i4", "window_orbits", "orbits", "number of orbits of the sweep that lie in the window"),
    _column("window", "i4", "window_other_attractor", "other attractor",
            "number of orbits at values within the window that went to another attractor"),
    _column("orbit", "i4", "orbit_window", "window",
            "index of the window of each orbit of the sweep, in the order of its file", index_in="window", least=-1),
    _column("orbit", "i1", "orbit_reason", "reason",
            "reason why an orbit of the sweep lies in no window", flags=names(REASONS)),
)  # fmt: skip

UNVISITED = {  # of a stretch of a window on which the sweep shows other attractors only
    "window": _column("unvisited", "i4", "unvisited_window", "window",
                      "index of the window whose orbit is stable there", index_in="window"),
    "lo": _column("unvisited", "f8", "unvisited_lo", "from",
                  "value of the parameter from which on the sweep shows other attractors only", OF_FIRST),
    "hi": _column("unvisited", "f8", "unvisited_hi", "to",
                  "value of the parameter up to which the sweep shows other attractors only", OF_FIRST),
    "values": _column("unvisited", "i4", "unvisited_values", "values",
                      "number of values of the sweep that show other attractors"),
    "at": _column("unvisited", "f8", "unvisited_at", "at",
                  "one of these values, with `unvisited_x1` .. as a start on the orbit", OF_FIRST),
}  # fmt: skip

RAGGED = {  # dimension -> (counts of each branch, what each of them counts for): one branch after another
    "point": ("branch_row_size",),
    "impact": ("branch_row_size", "branch_impacts"),
    "special": ("branch_special",),
    "section": ("branch_row_size", "branch_sections"),
}


def columns(kind: str, parameters: list[str], masses: int) -> list[Quantity]:
    """All variables of a file; parameters : the names of numbers along which branches lead."""
    result = [_column("point", "f8", name, name, f"value of the parameter {name}") for name in parameters]
    result += _states("point", "", "at t = 0, before an impact there", masses)
    if kind == CHART:
        return [*result, *OF_CURVES]
    if kind == WINDOWS:
        text = "at t = 0 mod T, of a start that stays on the window's orbit at `unvisited_at`; NaN where none is known"
        starts = _states("unvisited", "unvisited_", text, masses)
        return [*result, *OF_BRANCHES, *OF_WINDOWS, *UNVISITED.values(), *starts]
    return [*result, *OF_BRANCHES, BRANCH_SECTIONS, *_states("section", "section_", "at t = 0 mod T", masses)]


def _states(dimension: str, prefix: str, text: str, masses: int) -> list[Quantity]:
    """A state for each row, coordinate by coordinate."""
    return [
        _column(dimension, "f8", f"{prefix}{row.name}", row.name, f"value of {row.name} {text}", row.units)
        for row in coordinates(masses)
    ]
