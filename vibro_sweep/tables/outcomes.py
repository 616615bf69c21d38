"""Outcomes of points, periodic orbits, branches, windows and edges of planes: what each means, and what to do.

Numerical outcomes travel with the data as codes: the places of outcomes in these tables.
"""

import functools
import operator
from collections.abc import Sequence
from typing import NamedTuple


class Outcome(NamedTuple):
    """An outcome, what it means, and what a user can do about it; "" where nothing is to be done."""

    name: str  # one word for CF's `flag_meanings`
    text: str
    advice: str = ""


STATUSES = (  # of points; the code of the first is -1
    Outcome("not_computed", "not computed yet",
            "The run was interrupted, or still goes on. `vibro-sweep run SCENE.yaml --resume`, or `mode='resume'`, "
            "completes its file."),
    Outcome("ok", "computed"),
    Outcome("too_many_impacts_in_a_period", "more impacts in a forcing period than are computed",
            "There are more than 100 000, as with R near 1 and a tiny clearance. Check the unit of the clearance; a "
            "smaller R, or a larger clearance, has fewer impacts. A mass that drops on a preloaded stop bounces ever "
            "lower and comes to rest only in the limit: start it at rest on the stop."),
    Outcome("not_finite", "the state left the range of floating-point numbers",
            "The motion grows without bounds, or the start is too large. Check the size of the start, and the "
            "damping: an undamped mode in resonance grows for ever."),
    Outcome("rates_too_far_apart", "the fastest time constant is too short compared with the forcing period",
            "The fastest time constant is shorter than 10^-7 of a period. Check that all numbers are in one system "
            "of units. Leave out modes as fast as that (modal truncation), or lower their damping; of a compliant "
            "stop that holds the mass for long lower `c_stop`."),
    Outcome("contact_unresolved", "two grazes are too close together to be separated",
            "No oscillator is known in which this happens. A change of a parameter in its last digits may avoid it. "
            "Please report the scene."),
    Outcome("beyond_a_stop", "mass 1 was found behind a stop by more than rounding explains",
            "This has not been seen and would be a bug. Please report the scene."),
    Outcome("not_settled", "a remark, the numbers are valid: the orbit is still on its way to a periodic one",
            "Let such orbits go on by `settle`, as far as `info` says, or `approached_distance` and "
            "`approached_factor`; lengthen `record` where a long period is expected. Chaos that ends after the "
            "record cannot be distinguished from chaos that lasts."),
)  # fmt: skip
NOT_COMPUTED, OK, EVENT_LIMIT, NOT_FINITE, TOO_STIFF, UNRESOLVED, BEYOND_STOP, NOT_SETTLED = range(-1, 7)
VALID = (OK, NOT_SETTLED)  # of points whose numbers are valid; `not_settled` is a remark


def status_of(code: int) -> Outcome:
    """The status of a point by its code; a file that somebody has changed may hold other codes."""
    index = int(code) - NOT_COMPUTED
    return STATUSES[index] if 0 <= index < len(STATUSES) else Outcome(f"unknown_status_{code}", "")


def is_valid(codes):
    """Whether the numbers of points with these codes are valid; elementwise."""
    return functools.reduce(operator.or_, (codes == code for code in VALID))


ORBITS = (  # `PeriodicOrbit.status`
    Outcome("ok", "a periodic orbit, certified"),
    Outcome("not_converged", "Newton's method found no orbit near the guess",
            "Give a state nearer to the orbit: `simulate` over more periods where it is stable, or the orbit at a "
            "nearby value of a parameter, followed by `continue_orbit`. Check that `periods` is a multiple of its "
            "period."),
    Outcome("inadmissible", "a solution of the equations that passes a stop, or whose impulse pulls",
            "There is no such motion at these numbers: another itinerary holds here. `continue_orbit` from a value "
            "where the orbit exists says at which graze it ends."),
    Outcome("unrelaxed",
            "a stop is touched before it has relaxed from the contact before: `release: force` is not computed there",
            "Simulate it (`simulate`, `sweep`), or give the stop less damping: it relaxes like e^(-k_stop t/c_stop), "
            "and has to be at rest to below rounding."),
    Outcome("permanent_contact", "the mass never leaves a compliant stop: its motion is that of a linear oscillator",
            "`simulate` and `sweep` compute it. A branch of orbits that leave the stop ends where it begins."),
    Outcome("sticking", "the orbit rests on a stop after infinitely many impacts: they are not a finite list",
            "Simulate it (`simulate`, `sweep`): rests are computed there. `sticking_onset` says where such rests "
            "begin."),
    Outcome("resonance",
            "an undamped mode repeats itself after the period: such orbits do not exist, or are not isolated",
            "Give the mode some damping, or change `omega` a little."),
    Outcome("turning",
            "nothing holds the masses where the contact does not see them, as the angles of a drive: those have no "
            "period",
            "`simulate` and `sweep` compute such motions; of a contact between masses the file has the `gap`, which "
            "may have a period. A weak spring to the ground, far below all others, holds the masses."),
    Outcome("too_stiff", "the rates of the oscillator, or of a contact with its stop, are too far apart",
            "Leave out the fastest modes, or give them, or the stop, less damping: see `rates_too_far_apart` above."),
)  # fmt: skip

BRANCHES = (  # `Branch.status`, `branch_status`
    Outcome("ok", "followed to both of its ends"),
    Outcome("failed", "it could not be followed to an end, or not at all",
            "The points that are there are valid. Begin again from another orbit of the branch, beyond the place "
            "where it failed, or follow another parameter across it."),
)  # fmt: skip

POINTS = (  # `status` of points of branches and curves
    Outcome("ok", "the point is a motion"),
    Outcome("inadmissible", "a solution of the equations that passes a stop, or whose impulse pulls",
            "Curves go on through such points, and pictures draw them dotted. `bifurcation_curve(..., "
            "virtual=False)` ends a curve where its orbit ceases to be a motion."),
)  # fmt: skip

REASONS = (  # why a point of a sweep lies in no window; 0: it lies in one
    Outcome("in_a_window", "in a window"),
    Outcome("chaos", "the largest Lyapunov exponent is positive"),
    Outcome("quasi_periodic", "the largest Lyapunov exponent is zero within its error, and the orbit not periodic",
            "If a periodic orbit of long period is expected, lengthen `record` to more than twice that period."),
    Outcome("sticking",
            "the mass rests on a stop after infinitely many impacts: such orbits have no finite list of impacts",
            "The sweep's own numbers are valid there. `sticking_onset` finds where such rests begin."),
    Outcome("not_settled",
            "neither periodic within the record nor known to be anything else, or not yet where it attracts to",
            "Sweep again with `settle`, or a longer `transient`; with a longer `record` too, to recognise longer "
            "periods."),
    Outcome("failed", "the orbit, or the equations of its impacts, could not be computed",
            "See `status` of the sweep at this point; where it is `ok`, its orbit grazes or is too long to be "
            "certified."),
    Outcome("not_computed", "the file has no orbit there", "Complete the sweep by `--resume`, and search again."),
    Outcome("not_isolated",
            "one of a family of orbits: of a mass that nothing holds, or of a mode without losses in resonance",
            "Windows need isolated orbits: give the mode some damping, or the mass a weak spring."),
    Outcome("permanent_contact", "the mass never leaves a compliant stop: its motion is that of a linear oscillator",
            "The sweep's own numbers are valid there. A window of orbits that leave the stop ends where it begins."),
    Outcome("unrelaxed", "a stop is touched before it has relaxed from the contact before",
            "The sweep's own numbers are valid there; windows need stops that are at rest again at their next touch."),
    Outcome("turning",
            "nothing holds the masses where the contact does not see them, as the angles of a drive: those have no "
            "period",
            "The sweep's own numbers are valid there; the `gap` may have a period. Windows need masses that "
            "something holds, be it a weak spring."),
)  # fmt: skip
ATTRACTORS = ("chaos", "quasi_periodic", "sticking", "permanent_contact")  # reasons that say where an orbit went to

EDGES = (  # of a plane between points of different periods: why; what says most comes first
    Outcome("curve", "a curve passes between the two points on which one of their orbits ends or loses its stability"),
    Outcome("no_curve", "an orbit ends or loses its stability between the points, but no curve was followed from there",
            "Follow the orbit across the edge by `continue_orbit`: its special point says what happens there."),
    Outcome("stable_at_both",
            "the periodic orbits are stable at both points; other starts, or a record that has not settled",
            "Both attractors coexist. Use several starts, and compare their shares of the starts."),
    Outcome("not_settled", "the recorded orbit is not yet the periodic one that it approaches",
            "Sweep again with `settle`."),
    Outcome("failed", "the orbit could not be followed",
            "Follow it by hand, with `periodic_orbit` and `continue_orbit`."),
    Outcome("open", "not looked at", "Complete the file by `--resume`."),
)  # fmt: skip


def names(outcomes: Sequence[Outcome]) -> tuple[str, ...]:
    """Their names, in the order of their codes."""
    return tuple(outcome.name for outcome in outcomes)


def codes(outcomes: Sequence[Outcome]) -> dict[str, int]:
    """Their codes by name."""
    return {outcome.name: code for code, outcome in enumerate(outcomes)}


def named(outcomes: Sequence[Outcome], name: str) -> Outcome:
    """The outcome with this name."""
    return outcomes[codes(outcomes)[name]]
