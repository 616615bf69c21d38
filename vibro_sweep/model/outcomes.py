"""Outcomes of periodic orbits, branches, windows and edges of planes, by name: what each means, and what to do."""

from typing import NamedTuple


class Outcome(NamedTuple):
    """The meaning of an outcome, and what a user can do about it; "" where nothing is to be done."""

    text: str
    advice: str = ""


ORBITS = {  # `PeriodicOrbit.status`
    "ok": Outcome("a periodic orbit, certified"),
    "not_converged": Outcome(
        "Newton's method found no orbit near the guess",
        "Give a state nearer to the orbit: `simulate` over more periods where it is stable, or the orbit at a nearby "
        "value of a parameter, followed by `continue_orbit`. Check that `periods` is a multiple of its period.",
    ),
    "inadmissible": Outcome(
        "a solution of the equations that passes a stop, or whose impulse pulls",
        "There is no such motion at these numbers: another itinerary holds here. `continue_orbit` from a value where "
        "the orbit exists says at which graze it ends.",
    ),
    "unrelaxed": Outcome(
        "a stop is touched before it has relaxed from the contact before: `release: force` is not computed there",
        "Simulate it (`simulate`, `sweep`), or give the stop less damping: it relaxes like e^(-k_stop t/c_stop), and "
        "has to be at rest to below rounding.",
    ),
    "permanent_contact": Outcome(
        "the mass never leaves a compliant stop: its motion is that of a linear oscillator",
        "`simulate` and `sweep` compute it. A branch of orbits that leave the stop ends where it begins.",
    ),
    "sticking": Outcome(
        "the orbit rests on a stop after infinitely many impacts: they are not a finite list",
        "Simulate it (`simulate`, `sweep`): rests are computed there. `sticking_onset` says where such rests begin.",
    ),
    "resonance": Outcome(
        "an undamped mode repeats itself after the period: such orbits do not exist, or are not isolated",
        "Give the mode some damping, or change `omega` a little.",
    ),
    "turning": Outcome(
        "nothing holds the masses where the contact does not see them, as the angles of a drive: those have no period",
        "`simulate` and `sweep` compute such motions; of a contact between masses the file has the `gap`, which may "
        "have a period. A weak spring to the ground, far below all others, holds the masses.",
    ),
    "too_stiff": Outcome(
        "the rates of the oscillator, or of a contact with its stop, are too far apart",
        "Leave out the fastest modes, or give them, or the stop, less damping: see `rates_too_far_apart` above.",
    ),
}

BRANCHES = {  # `Branch.status`, `branch_status`
    "ok": Outcome("followed to both of its ends"),
    "failed": Outcome(
        "it could not be followed to an end, or not at all",
        "The points that are there are valid. Begin again from another orbit of the branch, beyond the place where it "
        "failed, or follow another parameter across it.",
    ),
}

POINTS = {  # `status` of points of branches and curves
    "ok": Outcome("the point is a motion"),
    "inadmissible": Outcome(
        "a solution of the equations that passes a stop, or whose impulse pulls",
        "Curves go on through such points, and pictures draw them dotted. `bifurcation_curve(..., virtual=False)` ends "
        "a curve where its orbit ceases to be a motion.",
    ),
}

REASONS = {  # why a point of a sweep lies in no window; 0: it lies in one
    "in_a_window": Outcome("in a window"),
    "chaos": Outcome("the largest Lyapunov exponent is positive"),
    "quasi_periodic": Outcome(
        "the largest Lyapunov exponent is zero within its error, and the orbit not periodic",
        "If a periodic orbit of long period is expected, lengthen `record` to more than twice that period.",
    ),
    "sticking": Outcome(
        "the mass rests on a stop after infinitely many impacts: such orbits have no finite list of impacts",
        "The sweep's own numbers are valid there. `sticking_onset` finds where such rests begin.",
    ),
    "not_settled": Outcome(
        "neither periodic within the record nor known to be anything else, or not yet where it attracts to",
        "Sweep again with `settle`, or a longer `transient`; with a longer `record` too, to recognise longer periods.",
    ),
    "failed": Outcome(
        "the orbit, or the equations of its impacts, could not be computed",
        "See `status` of the sweep at this point; where it is `ok`, its orbit grazes or is too long to be certified.",
    ),
    "not_computed": Outcome("the file has no orbit there", "Complete the sweep by `--resume`, and search again."),
    "not_isolated": Outcome(
        "one of a family of orbits: of a mass that nothing holds, or of a mode without losses in resonance",
        "Windows need isolated orbits: give the mode some damping, or the mass a weak spring.",
    ),
    "permanent_contact": Outcome(
        "the mass never leaves a compliant stop: its motion is that of a linear oscillator",
        "The sweep's own numbers are valid there. A window of orbits that leave the stop ends where it begins.",
    ),
    "unrelaxed": Outcome(
        "a stop is touched before it has relaxed from the contact before",
        "The sweep's own numbers are valid there; windows need stops that are at rest again at their next touch.",
    ),
    "turning": Outcome(
        "nothing holds the masses where the contact does not see them, as the angles of a drive: those have no period",
        "The sweep's own numbers are valid there; the `gap` may have a period. Windows need masses that something "
        "holds, be it a weak spring.",
    ),
}
ATTRACTORS = ("chaos", "quasi_periodic", "sticking", "permanent_contact")  # reasons that say where an orbit went to

EDGES = {  # of a plane between points of different periods: why; what says most comes first
    "curve": Outcome("a curve passes between the two points on which one of their orbits ends or loses its stability"),
    "no_curve": Outcome(
        "an orbit ends or loses its stability between the points, but no curve was followed from there",
        "Follow the orbit across the edge by `continue_orbit`: its special point says what happens there.",
    ),
    "stable_at_both": Outcome(
        "the periodic orbits are stable at both points; other starts, or a record that has not settled",
        "Both attractors coexist. Use several starts, and compare their shares of the starts.",
    ),
    "not_settled": Outcome(
        "the recorded orbit is not yet the periodic one that it approaches", "Sweep again with `settle`."
    ),
    "failed": Outcome(
        "the orbit could not be followed", "Follow it by hand, with `periodic_orbit` and `continue_orbit`."
    ),
    "open": Outcome("not looked at", "Complete the file by `--resume`."),
}
