"""What files hold of windows beside their branches."""

from vibro_sweep.model.bifurcations import REASONS
from vibro_sweep.model.column import OF_FIRST, Column

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
    Column(
        "window_other_attractor",
        ("window",),
        "i4",
        "other attractor",
        "orbits at its values that went to another attractor",
    ),
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

UNVISITED = {  # of a stretch of a window on which the sweep shows other attractors only
    "window": Column(
        "unvisited_window", ("unvisited",), "i4", "window", "whose orbit is stable there: its index", index_in="window"
    ),
    "lo": Column(
        "unvisited_lo", ("unvisited",), "f8", "from", "the parameter where the sweep begins to miss the orbit", OF_FIRST
    ),
    "hi": Column(
        "unvisited_hi", ("unvisited",), "f8", "to", "the parameter up to which the sweep misses the orbit", OF_FIRST
    ),
    "values": Column(
        "unvisited_values", ("unvisited",), "i4", "values", "values of the sweep that show other attractors"
    ),
    "at": Column(
        "unvisited_at",
        ("unvisited",),
        "f8",
        "at",
        "one of these values, of which `unvisited_x1` .. is a start",
        OF_FIRST,
    ),
}
