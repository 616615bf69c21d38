"""What files hold of curves, along which orbits bifurcate, and of the edges of planes at which they begin."""

from vibro_sweep.model.branch_columns import OF_BRANCHES
from vibro_sweep.model.column import OF_PARAMETER, Column
from vibro_sweep.tables.bifurcations import CODIMENSION_TWO, CURVES
from vibro_sweep.tables.outcomes import EDGES, names

_SHARED = {
    *("branch_period", "branch_symmetric", "branch_closed", "branch_row_size", "branch_impacts", "branch_special"),
    *("branch_begins", "branch_ends", "branch_parent", "branch_parent_special", "branch_generation"),
    *("multiplier_re", "multiplier_im", "stop_distance", "min_impact_speed", "residual", "status"),
    *("impact_t", "impact_side", "impact_v", "impact_t_off"),
    *("special_value", "special_branch", "special_point", "special_error"),
}

OF_CURVES = (  # branches are curves here, along which an orbit bifurcates
    Column("branch_type", ("branch",), "i1", "type", "type of the bifurcation along the curve", "1", CURVES),
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
        "number of multipliers outside the unit circle, without the critical ones; 0 where the curve bounds attractors",
    ),
    Column(
        "b_star",
        ("point",),
        "f8",
        "grazing clearance",
        "clearance b at which the free motion grazes both stops; NaN where there is none",
        "m",
    ),
    Column(
        "special_type",
        ("special",),
        "i1",
        "type",
        "type of the point of codimension two",
        "1",
        tuple(one.name for one in CODIMENSION_TWO),
    ),
    Column(
        "special_touches",
        ("special",),
        "i1",
        "touches",
        "whether a flight touches a stop at the special point",
        "1",
        ("no", "yes"),
    ),
)


OF_EDGES = (  # of curves that begin at the edges of a plane
    Column(
        "edge_from",
        ("edge", "parameter"),
        "f8",
        "from",
        "values of the attribute `parameters` at one point of the sweep",
        OF_PARAMETER,
    ),
    Column(
        "edge_to",
        ("edge", "parameter"),
        "f8",
        "to",
        "values of the attribute `parameters` at its neighbour, whose orbit has another period",
        OF_PARAMETER,
    ),
    Column("edge_reason", ("edge",), "i1", "reason", "why the orbits of the two points differ", "1", names(EDGES)),
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
