"""What files hold of branches, declared once: names, dimensions, types, units, texts, words."""

from vibro_sweep.model.column import OF_PARAMETER, Column
from vibro_sweep.tables.bifurcations import CRITICALITIES, KINDS, TYPES
from vibro_sweep.tables.outcomes import BRANCHES, POINTS, names

OF_BRANCHES = (
    Column("branch_period", ("branch",), "i4", "period in T", "period of the orbits in forcing periods"),
    Column("branch_symmetric", ("branch",), "i1", "symmetric", "whether x(t + period T/2) = -x(t)", "1", ("no", "yes")),
    Column("branch_closed", ("branch",), "i1", "closed", "whether the branch comes back to itself", "1", ("no", "yes")),
    Column(
        "branch_row_size", ("branch",), "i4", "points", "number of points of the branch, which lie one after another"
    ),
    Column("branch_impacts", ("branch",), "i4", "impacts", "impacts of the orbit at each point of the branch"),
    Column(
        "branch_special",
        ("branch",),
        "i4",
        "special points",
        "number of special points of the branch, which lie one after another",
    ),
    Column(
        "branch_status",
        ("branch",),
        "i1",
        "status",
        "whether the branch was followed to both ends; one that could not be followed has its orbit as its only point",
        "1",
        names(BRANCHES),
    ),
    Column(
        "branch_begins",
        ("branch",),
        "i4",
        "begin",
        "index of the special point at which the branch begins",
        index_in="special",
    ),
    Column(
        "branch_ends",
        ("branch",),
        "i4",
        "end",
        "index of the special point at which the branch ends",
        index_in="special",
    ),
    Column(
        "branch_origin",
        ("branch",),
        "i4",
        "origin",
        "index of the point from which the branch was followed",
        index_in="point",
    ),
    Column(
        "branch_parent",
        ("branch",),
        "i4",
        "parent",
        "index of the branch from which this one was reached",
        index_in="branch",
        optional=True,
    ),
    Column(
        "branch_parent_special",
        ("branch",),
        "i4",
        "parent's point",
        "index of the special point at which the branch was reached",
    ),
    Column(
        "branch_generation",
        ("branch",),
        "i4",
        "generation",
        "number of special points between the branch and the first branches",
    ),
    Column(
        "multiplier_re",
        ("point", "multiplier"),
        "f8",
        "multiplier, real part",
        "real part of the Floquet multipliers over the whole period",
    ),
    Column(
        "multiplier_im",
        ("point", "multiplier"),
        "f8",
        "multiplier, imaginary part",
        "imaginary part of the Floquet multipliers; of a complex pair the positive one comes first",
    ),
    Column("unstable", ("point",), "i4", "unstable multipliers", "number of multipliers outside the unit circle"),
    Column(
        "stop_distance",
        ("point",),
        "f8",
        "stop_distance",
        "least distance of a turning point of the gap from its stop",
        "m",
    ),
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
    Column("status", ("point",), "i1", "status", "whether the point is a motion", "1", names(POINTS)),
    Column(
        "impact_t",
        ("impact",),
        "f8",
        "impact time",
        "time of each impact of each point, continuous along a branch",
        "s",
    ),
    Column("impact_side", ("impact",), "i1", "stop", "stop of each impact: +1 right, R of the itinerary; -1 left, L"),
    Column("impact_v", ("impact",), "f8", "impact velocity", "velocity of the gap before the impact", "m s-1"),
    Column(
        "impact_t_off",
        ("impact",),
        "f8",
        "end of the rest",
        "time at which the rest after an impact ends; NaN where the mass does not rest",
        "s",
    ),
    Column(
        "special_type", ("special",), "i1", "type", "type of the special point", "1", tuple(one.name for one in TYPES)
    ),
    Column(
        "special_value",
        ("special", "parameter"),
        "f8",
        "parameters",
        "values of the attribute `parameters` at the special point",
        OF_PARAMETER,
    ),
    Column(
        "special_branch",
        ("special",),
        "i4",
        "branch",
        "index of the branch on which the special point lies",
        index_in="branch",
    ),
    Column(
        "special_point",
        ("special",),
        "i4",
        "point",
        "index of the point of the branch that the special point is",
        index_in="point",
        optional=True,
    ),
    Column(
        "special_stop", ("special",), "i1", "stop", "stop that is grazed: +1 right, -1 left; 0 where nothing grazes"
    ),
    Column("special_kind", ("special",), "i1", "kind", "kind of the graze", "1", KINDS),
    Column(
        "special_impact",
        ("special",),
        "i4",
        "impact",
        "index of the impact that vanishes at the graze; -1 where one appears",
    ),
    Column(
        "special_direction",
        ("special",),
        "i1",
        "direction",
        "side on which the orbit without the grazing impact exists: +1 at larger values, -1 at smaller ones",
    ),
    Column(
        "special_criticality",
        ("special",),
        "i1",
        "criticality",
        "criticality of the flip, pitchfork or Neimark-Sacker point",
        "1",
        CRITICALITIES,
    ),
    Column("special_error", ("special",), "f8", "error", "own estimate of the error of `special_value`", OF_PARAMETER),
)

BRANCH_SECTIONS = Column(
    "branch_sections",
    ("branch",),
    "i4",
    "section states",
    "number of section states of each point: those of the orbit, then those of its mirror image",
)
