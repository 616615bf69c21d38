"""What files hold of windows beside their branches."""

from vibro_sweep.model.column import OF_FIRST, Column
from vibro_sweep.tables.outcomes import REASONS, names

OF_WINDOWS = (
    Column("window_lo", ("window",), "f8", "lower end", "value of the parameter at the lower end", OF_FIRST),
    Column("window_hi", ("window",), "f8", "upper end", "value of the parameter at the upper end", OF_FIRST),
    Column(
        "window_lower",
        ("window",),
        "i4",
        "lower end",
        "index of the special point at the lower end",
        index_in="special",
    ),
    Column(
        "window_upper",
        ("window",),
        "i4",
        "upper end",
        "index of the special point at the upper end",
        index_in="special",
    ),
    Column("window_period", ("window",), "i4", "period in T", "period of the orbit in forcing periods"),
    Column("window_symmetric", ("window",), "i1", "symmetric", "whether x(t + period T/2) = -x(t)", "1", ("no", "yes")),
    Column("window_branch", ("window",), "i4", "branch", "index of the branch between the two ends", index_in="branch"),
    Column("window_row", ("window",), "i4", "row", "index of the row of the plane along the parameter"),
    Column("window_orbits", ("window",), "i4", "orbits", "number of orbits of the sweep that lie in the window"),
    Column(
        "window_other_attractor",
        ("window",),
        "i4",
        "other attractor",
        "number of orbits at values within the window that went to another attractor",
    ),
    Column(
        "orbit_window",
        ("orbit",),
        "i4",
        "window",
        "index of the window of each orbit of the sweep, in the order of its file",
        index_in="window",
        optional=True,
    ),
    Column(
        "orbit_reason",
        ("orbit",),
        "i1",
        "reason",
        "reason why an orbit of the sweep lies in no window",
        "1",
        names(REASONS),
    ),
)

UNVISITED = {  # of a stretch of a window on which the sweep shows other attractors only
    "window": Column(
        "unvisited_window",
        ("unvisited",),
        "i4",
        "window",
        "index of the window whose orbit is stable there",
        index_in="window",
    ),
    "lo": Column(
        "unvisited_lo",
        ("unvisited",),
        "f8",
        "from",
        "value of the parameter from which on the sweep shows other attractors only",
        OF_FIRST,
    ),
    "hi": Column(
        "unvisited_hi",
        ("unvisited",),
        "f8",
        "to",
        "value of the parameter up to which the sweep shows other attractors only",
        OF_FIRST,
    ),
    "values": Column(
        "unvisited_values", ("unvisited",), "i4", "values", "number of values of the sweep that show other attractors"
    ),
    "at": Column(
        "unvisited_at",
        ("unvisited",),
        "f8",
        "at",
        "one of these values, with `unvisited_x1` .. as a start on the orbit",
        OF_FIRST,
    ),
}
