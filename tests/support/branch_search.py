"""A search for branches on which something is wrong: random ones, followed from several starts with several steps."""

import traceback

import numpy as np

from support import conditions
from support.drawn_branches import MODELS, beyond, drawn_case
from support.same_branch import TooLongError, differences, follow, listed, other_starts
from support.searching import Report, new_report

OFF = 1e-7


def study(seed: int, models=MODELS, deep: int = 4) -> Report:
    """Of a drawn oscillator a branch, and branches beyond its special points."""
    rng, report = np.random.default_rng(seed), new_report(drawn=1)
    case = drawn_case(models[seed % len(models)], rng)
    for depth in range(deep):
        if case is None:
            return report
        branch = examine(report, f"seed {seed}.{depth}, {models[seed % len(models)]}, {case}", case, rng)
        if branch is None:
            return report
        try:
            case = beyond(branch, case, rng)
        except Exception as error:
            report.wrong.append(f"seed {seed}.{depth}: switch raises {error!r:.200}")
            return report
    return report


def examine(report: Report, where: str, case, rng):
    """Follow a branch in several ways, and check it; the branch, or None."""

    def wrong(kind, words):
        report.wrong.append(f"{where}: {kind}: {words}")

    try:
        branch = follow(case)
    except TooLongError:
        report.counted["too long"] += 1
        return None
    except Exception as error:
        wrong(
            f"raises {type(error).__name__}",
            f"{error!r:.200}" + traceback.format_exc()[-400:] * (not isinstance(error, ValueError)),
        )
        return None
    report.counted["branches"] += 1
    for kind, words in conditions.not_reduced(case.orbit, case.name):
        wrong(kind, words)
    report.counted["points"] += branch.points.sizes["point"]
    size = case.bounds[1] - case.bounds[0]
    expected = listed(branch)
    report.counted.update(one.type for one in branch.special)
    runs = [(f"steps times {factor}", case.orbit, factor) for factor in (0.5, 2.0)]
    try:
        runs += [(words, orbit, 1.0) for words, orbit in other_starts(branch, case, rng)]
    except Exception as error:
        wrong(f"start raises {type(error).__name__}", f"{error!r:.200}")
    for words, orbit, factor in runs:
        if not orbit.ok:
            report.counted["starts not found"] += 1
            continue
        kinds = (orbit.period, orbit.itinerary, orbit.symmetric)
        if factor == 1.0 and kinds != (case.orbit.period, case.orbit.itinerary, case.orbit.symmetric):
            report.counted["starts of another kind"] += 1
            continue
        try:
            again = follow(case._replace(orbit=orbit), factor)
        except TooLongError:
            report.counted["too long"] += 1
            continue
        except Exception as error:
            wrong(f"raises {type(error).__name__} from another start", f"{words}: {error!r:.200}")
            continue
        report.counted["runs"] += 1
        if factor < 1 and not again._start.rests:
            for kind, difference in conditions.unexplained(conditions.Pieces(again, case)):
                wrong(kind, f"{words}: {difference}")
        if branch.closed != again.closed:
            wrong("closed or not", words)
            continue
        for kind, difference in dict(differences(expected, listed(again), size, branch.closed)).items():
            wrong(kind, f"{words}: {difference}")
    if branch._start.rests:
        report.counted["rests"] += 1
        return branch
    check(report, wrong, branch, case)
    return branch


def check(report, wrong, branch, case) -> None:
    """Conditions of special points, and stability along the branch, by other means."""
    for special in branch.special:
        far, words = conditions.distance(special)
        if np.isnan(far):
            continue
        report.counted["conditions"] += 1
        if not far < conditions.MEETS:
            wrong(f"condition of {special.type}", f"at {special.parameters[case.name]!r}: {far:.1e}, {words}")
    pieces = conditions.Pieces(branch, case)
    report.counted["sure points"] += int(pieces.sure.sum())
    inner = slice(1, -1)
    off = pieces.off[inner]
    if len(off) and not np.nanmax(off) < OFF:
        k = int(np.nanargmax(off)) + 1
        wrong("not an orbit", f"point {k}, {pieces.values[k]!r}: {pieces.off[k]:.1e}")
    for kind, words in [
        *conditions.unexplained(pieces),
        *conditions.passing(pieces),
        *conditions.free_passes(branch, case),
    ]:
        wrong(kind, words)
    own = branch.points.multiplier_re.values + 1j * branch.points.multiplier_im.values
    theirs = pieces.multipliers**2 if pieces.symmetric else pieces.multipliers
    with np.errstate(all="ignore"):
        largest = np.abs(np.abs(own).max(1) / np.abs(theirs).max(1) - 1)[inner]
    if len(largest) and np.any(largest > 1e-5):
        k = int(np.nanargmax(largest)) + 1
        wrong("multipliers", f"point {k}, {pieces.values[k]!r}: {own[k]} and {theirs[k]}")
