"""What a file of branches, windows or curves says in words: the tables that `info` and the commands print."""

from collections import Counter
from collections.abc import Mapping

import numpy as np

from vibro_sweep.oscillator.window_families import families
from vibro_sweep.oscillator.wording import without_rounding
from vibro_sweep.tables.bifurcations import CODIMENSION_TWO, CRITICALITIES, CURVES, KINDS, TYPES
from vibro_sweep.tables.file_columns import UNVISITED
from vibro_sweep.tables.outcomes import EDGES, REASONS

LONGEST_WORD = 12  # letters of an itinerary that is printed as it is


def windows_table(arrays: Mapping, parameters: Mapping[str, str]) -> list[str]:
    """A line for each window, then what its ends are and what no window covers.

    parameters : of the number along which they reach, and of those that were swept beside it, which a column has, the
        name and how it is headed
    """
    parameter, *held = parameters
    first = np.append(0, np.cumsum(arrays["branch_row_size"]))
    lower, upper = np.asarray(arrays["window_lower"]), np.asarray(arrays["window_upper"])
    words = [_short(word) for word in itineraries(arrays)]
    ends = ("ends with", "point")
    names = ("from", *ends, "to", *ends, "period", "impacts", "symmetric", "orbits", "other attractor")
    rows = [(*(parameters[name] for name in held), *names)]
    for w, branch in enumerate(np.asarray(arrays["window_branch"]).tolist()):
        special = int(lower[w]), int(upper[w])
        both = [word for s in special for word in (_number(arrays, s), _end_of_window(arrays, s), str(s))]
        kind = [str(arrays["window_period"][w]), words[branch], "yes" if arrays["window_symmetric"][w] else "no"]
        orbits = [str(arrays[name][w]) for name in ("window_orbits", "window_other_attractor")]
        row = [f"{arrays[name][first[branch]]:.10g}" for name in held]
        rows.append((*row, *both, *kind, *orbits))
    lines = [f"windows in {parameters[parameter]}: {len(rows) - 1}", *_aligned(rows)]
    named = Counter(TYPES[code].name for code in np.asarray(arrays["special_type"])[np.append(lower, upper)].tolist())
    lines.append("ends         " + _counted(named))
    reasons = np.asarray(arrays["orbit_reason"])
    codes, numbers = np.unique(reasons, return_counts=True)
    counts = {REASONS[code].name: int(count) for code, count in zip(codes.tolist(), numbers.tolist(), strict=True)}
    covered = counts.pop("in_a_window", 0)
    lines.append(
        f"orbits       {covered:,} of {reasons.size:,} in windows" + (f"; {_counted(counts)}" if counts else "")
    )
    return [*lines, *_families(arrays), *_unvisited(arrays, parameters)]


def _families(arrays: Mapping) -> list[str]:
    """A line for each family of windows."""
    branches, words = np.asarray(arrays["window_branch"]), itineraries(arrays)
    impacts, symmetric = [words[branch] for branch in branches.tolist()], np.asarray(arrays["window_symmetric"])
    lo, periods = np.asarray(arrays["window_lo"]), np.asarray(arrays["window_period"])
    lines = []
    for family in families(impacts, symmetric.tolist(), periods.tolist(), lo.tolist()):
        first, last = lo[family.windows[0]], lo[family.windows[-1]]
        kind = "symmetric, " if family.symmetric else ""
        listed = ", ".join(str(periods[w]) for w in family.windows)
        lines.append(f"family       {kind}{_short(family.itinerary)}: periods {listed}; from {first:.6g} to {last:.6g}")
    return lines


def _unvisited(arrays: Mapping, parameters: Mapping[str, str]) -> list[str]:
    """A line for each stretch of a window on which the sweep shows other attractors only, with a start."""
    parameter, *held = parameters
    words, branches = itineraries(arrays), np.asarray(arrays["window_branch"])
    first = np.append(0, np.cumsum(arrays["branch_row_size"]))
    names = [
        name for name in arrays if name.startswith("unvisited_") and name.removeprefix("unvisited_") not in UNVISITED
    ]
    headed = [parameters[name] for name in held]
    rows = [(*headed, "from", "to", "period", "impacts", "values", parameters[parameter], "start, as a scene has it")]
    for u, w in enumerate(np.asarray(arrays["unvisited_window"]).tolist()):
        lo, hi, at = (f"{arrays[f'unvisited_{name}'][u]:.10g}" for name in ("lo", "hi", "at"))
        start = ", ".join(f"{name.removeprefix('unvisited_')}: {float(arrays[name][u])!r}" for name in names)
        kind = str(arrays["window_period"][w]), _short(words[branches[w]])
        row = [f"{arrays[name][first[branches[w]]]:.10g}" for name in held]
        rows.append((*row, lo, hi, *kind, str(arrays["unvisited_values"][u]), at, start))
    count = len(rows) - 1
    stretches = "1 stretch of a window" if count == 1 else f"{count} stretches of windows"
    return (
        [f"coexistence  {stretches} on which the sweep shows other attractors only", *_aligned(rows)] if count else []
    )


def special_table(arrays: Mapping, parameters: Mapping[str, str]) -> list[str]:
    """A line for each special point of each branch."""
    endings = [ending(arrays, s) for s in range(len(np.asarray(arrays["special_type"])))]
    return _special(arrays, "branch", "branches", parameters, endings)


def curves_table(arrays: Mapping, parameters: Mapping[str, str]) -> list[str]:
    """A line for each special point of each curve; then how many curves of which type."""
    kinds = [CURVES[code] for code in np.asarray(arrays["branch_type"]).tolist()]
    names = [CODIMENSION_TWO[code].name for code in np.asarray(arrays["special_type"]).tolist()]
    lines = _special(arrays, "curve", "curves", parameters, names, kinds)
    lines += ["curves       " + _counted(Counter(kinds))] if kinds else []
    if "edge_reason" not in arrays:
        return lines
    codes = Counter(np.asarray(arrays["edge_reason"]).tolist())
    counts = {EDGES[code].name: count for code, count in sorted(codes.items())}
    return [*lines, f"edges        {sum(counts.values()):,} between points of different periods: {_counted(counts)}"]


def _special(
    arrays: Mapping,
    single: str,
    many: str,
    parameters: Mapping[str, str],
    types: list[str],
    of: list[str] | None = None,
) -> list[str]:
    """A line for each special point, of one of these types; of each curve the type that it is a curve `of`."""
    words = [_short(word) for word in itineraries(arrays)]
    rows = [
        ("point", single, *([] if of is None else ["of"]), *parameters.values(), "type", "period", "impacts", "error")
    ]
    values = np.asarray(arrays["special_value"])
    for s, branch in enumerate(np.asarray(arrays["special_branch"]).tolist()):
        place = [
            str(s),
            str(branch),
            *([] if of is None else [of[branch]]),
            *(repr(float(value)) for value in values[s]),
        ]
        orbit = str(arrays["branch_period"][branch]), words[branch]
        rows.append((*place, types[s], *orbit, f"{arrays['special_error'][s]:.1e}"))
    return [f"{many}: {len(words)}, special points: {len(rows) - 1}", *_aligned(rows)]


def ending(arrays: Mapping, special: int) -> str:
    """A special point in words."""
    kind = TYPES[int(arrays["special_type"][special])].name
    more = []
    if kind == "graze":
        more.append(KINDS[int(arrays["special_kind"][special])].replace("_", " "))
        more.append("right" if arrays["special_stop"][special] > 0 else "left")
    elif arrays["special_criticality"][special]:
        more.append(CRITICALITIES[int(arrays["special_criticality"][special])])
    elif kind == "boundary":
        more.append("not followed beyond")
    return kind + (f" ({', '.join(more)})" if more else "")


def _end_of_window(arrays: Mapping, special: int) -> str:
    """The end of a window in words: open where nothing is known of what lies beyond."""
    return ending(arrays, special).replace("boundary", "open")


def _number(arrays: Mapping, special: int) -> str:
    """The parameter at a special point, with the digits that are known."""
    values, error = np.asarray(arrays["special_value"])[:, 0], float(arrays["special_error"][special])
    value = without_rounding(float(values[special]), np.ptp(values))
    if not 0 < error < 1e-3:
        return f"{value:.6g}"
    return f"{value:.{min(15, max(3, int(-np.log10(error))))}f}"


def itineraries(arrays: Mapping) -> list[str]:
    """The itinerary of each branch."""
    sizes, impacts = (np.asarray(arrays[name]).astype(int) for name in ("branch_row_size", "branch_impacts"))
    first, sides = np.append(0, np.cumsum(sizes * impacts)), np.asarray(arrays["impact_side"])
    of_each = (sides[begin : begin + count] for begin, count in zip(first[:-1], impacts, strict=True))
    return ["".join("R" if side > 0 else "L" for side in events) for events in of_each]


def _short(word: str) -> str:
    """An itinerary in full where it is short."""
    return f"{word.count('R')} R {word.count('L')} L" if len(word) > LONGEST_WORD else word or "none"


def _counted(counts: Mapping[str, int]) -> str:
    return ", ".join(f"{count:,} {name.replace('_', '-')}" for name, count in counts.items())


def _aligned(rows: list[tuple[str, ...]]) -> list[str]:
    wide = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  " + "  ".join(word.ljust(width) for word, width in zip(row, wide, strict=True)).rstrip() for row in rows]
