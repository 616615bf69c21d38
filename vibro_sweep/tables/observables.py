"""What can be observed of orbits, declared once: the kernels' records, files, scene words and the reference follow.

A variable of a file has the dimensions of the sweep, `start` if there are several, and then its own. Which variables
there are, and how long their dimensions are, follows from the number of masses.
"""

import functools
from functools import partial
from typing import Any

from vibro_sweep.tables.coordinates import coordinates, state
from vibro_sweep.tables.exponents import CERTAIN
from vibro_sweep.tables.outcomes import NOT_COMPUTED, STATUSES, names
from vibro_sweep.tables.quantity import Observable, Quantity

WORDS = {  # of `observe`
    "section": "section points and their period",
    "lyapunov": "Lyapunov spectrum, its standard errors and the residual of its sum rule",
    "multipliers": "Floquet multipliers of periodic orbits",
    "impacts": "counts and speeds of impacts, time at rest on a stop",
    "contacts": "counts, time, peaks and restitution of contacts with compliant stops",
    "attractors": "which starts end on the same attractor",
    "energy": "power that stops take, root mean square and largest size of every coordinate",
    "convergence": "Lyapunov exponents as they converge along the record",
}
ALONG_BRANCHES = ("contacts",)  # words of `observe` that branches have
WITH_TANGENTS = frozenset({"lyapunov", "multipliers", "attractors", "convergence"})  # tangent vectors are carried
WITH_STATES = WITH_TANGENTS | {"section"}  # the section points of the record are kept
SETTLE = "settle"  # the scene's key that asks how long transients were
TRAJECTORY = "trajectory"  # that which asks for the motion after the last section point
GAP = "gap"

_section = partial(Observable, asked_by=("section",), dimensions=("sample",), in_kernel=False)
_period = partial(Observable, asked_by=("section", "multipliers", "attractors"))
_exponent = partial(Observable, asked_by=("lyapunov",), units="s-1")
_multiplier = partial(Observable, asked_by=("multipliers",), dimensions=("multiplier",))
_attractor = partial(Observable, asked_by=("attractors",))
_impacts = partial(Observable, asked_by=("impacts",))
_contacts = partial(Observable, asked_by=("contacts",))
_energy = partial(Observable, asked_by=("energy",), in_kernel=False)

_OF_ANY = (
    _section("phase", "forcing phase", "forcing phase omega t mod 2 pi at the impact", units="rad", at_impacts=True),
    _period("period", "period in T",
        "period of the orbit in forcing periods; 0 if none up to half of `record` is found", dtype="i8"),
    _period("approached_period", "approached period in T",
        "period of the orbit that this one approaches, in forcing periods; 0 where it has arrived, or none is known",
        dtype="i8"),
    _period("approached_distance", "distance to go",
        "largest distance from the orbit that this one approaches, in parts of the sizes of its coordinates; NaN where "
        "none is known"),
    _period("approached_factor", "factor of the approach", "by which this distance shrinks in a forcing period"),
    _exponent("lyapunov", "Lyapunov exponent", "Lyapunov exponents per unit time, natural logarithm", r"\lambda",
        dimensions=("exponent",)),
    _exponent("lyapunov_error", "error of the exponent",
        "standard error of the exponents; of a periodic orbit what rounding and one more period change",
        dimensions=("exponent",), attributes={"significant": CERTAIN}),  # so many errors tell an exponent from zero
    _exponent("lyapunov_residual", "residual of the sum rule", "sum of the exponents minus its exact value"),
    _multiplier("multiplier_re", "multiplier, real part",
        "real part of the Floquet multipliers of the periodic orbit, in the order of falling modulus"),
    _multiplier("multiplier_im", "multiplier, imaginary part",
        "imaginary part of the Floquet multipliers; of a complex pair the positive one comes first"),
    Observable("transient_periods", "transient in T", "forcing periods before the record", asked_by=(SETTLE,),
        dtype="i8"),
    _multiplier("multiplier_error", "error of the multiplier", "error of the multipliers"),
    _attractor("attractor", "attractor",
        "rank of the attractor at this point; 1 = most starts reach it, 0 = not settled", dtype="i8", in_kernel=False),
    _attractor("attractor_id", "number of the attractor",
        "number of the attractor in the whole file, in the order of the sweep; 0 = not settled", dtype="i4",
        in_kernel=False),
    _attractor("share", "share of starts", "share of the starts that reach the attractor of this one",
        in_kernel=False),
    _attractor("average", "average", "averages that orbits of one attractor share", dimensions=("averaged",)),
    _attractor("average_error", "error of the average", "error of the averages", dimensions=("averaged",)),
    Observable("lyapunov_running", "Lyapunov exponent",
        "Lyapunov exponents as they converge along the record, in the order of their vectors", units="s-1",
        asked_by=("convergence",), dimensions=("elapsed", "exponent"), in_kernel=False),
    _impacts("impacts_right", "impacts on the right", "impacts on the right stop in the recorded periods", dtype="i8"),
    _impacts("impacts_left", "impacts on the left", "impacts on the left stop in the recorded periods", dtype="i8"),
    _impacts("min_impact_speed", "smallest impact speed",
        "smallest |v1| before an impact in the recorded periods; 0 where chatter ended in a rest; NaN without impacts",
        units="m s-1"),
    _impacts("contact_error", "contact error", "largest distance from the stop at which an impact was computed",
        units="m"),
    _contacts("contacts_right", "contacts on the right",
        "contacts with the right stop that begin in the recorded periods", dtype="i8"),
    _contacts("contacts_left", "contacts on the left",
        "contacts with the left stop that begin in the recorded periods", dtype="i8"),
    _contacts("contact_time", "share of time in contact", "share of the recorded time in contact"),
    _contacts("contact_force_max", "largest contact force",
        "largest force of a compliant stop in the recorded periods; NaN without contacts", units="N"),
    _contacts("penetration_max", "largest penetration",
        "how far the mass was behind a compliant stop at most; NaN without contacts", units="m"),
    _contacts("restitution_mean", "mean restitution",
        "mean of -v_release/v_touch over the contacts that ended in the recorded periods, without those that the stop "
        "began (v_touch < 0: it comes to the mass while it relaxes); NaN without any; above 1 where slow contacts are "
        "thrown back"),
    _impacts("sticking_time", "sticking time", "time at rest on a stop in the recorded periods", units="s"),
)  # fmt: skip

_STATUS = Observable("status", "status", "outcome of the computation", dtype="i1", flags=names(STATUSES),
    least=NOT_COMPUTED,
)  # fmt: skip


@functools.cache
def variables(masses: int, gap: bool = False) -> tuple[Observable, ...]:
    """All variables of files of oscillators with so many masses, in order.

    gap : whether the gap is something else than x1
    """
    of_masses = (_section(x.name, x.label, f"{x.text} at the section", x.symbol, x.units) for x in coordinates(masses))
    of_gap = [_section(GAP, "gap g", "gap at the section", "g", "m")] if gap else []
    return (*of_masses, *of_gap, *_OF_ANY, *_energies(masses), *_trajectories(masses, gap), _STATUS)


def _energies(masses: int) -> tuple[Observable, ...]:
    """The variables that the designer of a damper looks at."""
    sizes = (("rms", "rms of", "root mean square of the {}"), ("peak", "peak of", "largest size of the {}"))
    return (
        _energy("impact_power", "power that stops take",
            "energy lost in impacts, and the work of the masses on compliant stops, in the recorded periods, per unit "
            "time", units="W"),
        *(
            _energy(f"{size}_{x.name}", f"{label} {x.name}",
                f"{text.format(x.text)} in the recorded periods", units=x.units)
            for size, label, text in sizes
            for x in coordinates(masses)
        ),
    )  # fmt: skip


def _trajectory(name: str, label: str, text: str, *dimensions: str, **more: Any) -> Observable:
    return Observable(
        f"trajectory_{name}", label, text, asked_by=(TRAJECTORY,), dimensions=dimensions, in_kernel=False, **more
    )


def _trajectories(masses: int, gap: bool) -> tuple[Observable, ...]:
    """The continuous motion after the last section point, its sections and its impacts."""
    at_impact = "trajectory_impact"
    known = coordinates(masses) if gap else coordinates(masses)[2:]  # at an impact x1 is at the stop, v1 jumps
    name, label, of = jumping(gap), "gap velocity" if gap else "velocity v1", "of the gap" if gap else "of mass 1"
    return (
        *(
            row
            for x in coordinates(masses)
            for row in (
                _trajectory(x.name, x.label, f"{x.text} along the orbit", "t_over_T", units=x.units),
                _trajectory(f"section_{x.name}", x.label,
                    f"{x.text} at the section t = 0 mod T along the orbit", "trajectory_section", units=x.units),
            )
        ),
        _trajectory("impacts", "impacts", "number of impacts along the orbit; of too many the fastest are stored",
            dtype="i8"),
        _trajectory("impact_t_over_T", "time of impact, t/T",
            "forcing periods from the last section point to an impact", at_impact),
        _trajectory("impact_side", "stop of impact", "stop of an impact: 1 right, -1 left; 0: none", at_impact,
            dtype="i1", missing=0),
        _trajectory(f"impact_{name}", f"{label} before impact", f"velocity {of} before an impact", at_impact,
            units="m s-1"),
        _trajectory(f"impact_{name}_after", f"{label} after impact", f"velocity {of} after an impact", at_impact,
            units="m s-1"),
        *(
            _trajectory(f"impact_{x.name}", f"{x.label} at impact", f"{x.text} at an impact", at_impact,
                units=x.units)
            for x in known
        ),
    )  # fmt: skip


def jumping(gap: bool) -> str:
    """The coordinate that an impact reverses."""
    return "gap_velocity" if gap else "v1"


VARIABLES = variables(2)  # of the paper's oscillator
OF_AN_ORBIT = tuple(observable for observable in VARIABLES if observable.in_kernel)  # whatever the number of masses


def of_an_impact(masses: int, gap: bool = False) -> tuple[str, ...]:
    """The numbers that are stored of an impact along a trajectory, in the order in which kernels keep it."""
    return tuple(
        observable.name for observable in variables(masses, gap) if observable.dimensions == ("trajectory_impact",)
    )


def asked_for(keys: frozenset[str], at_impacts: bool, masses: int = 2, gap: bool = False) -> dict[str, Observable]:
    """The variables of a file, by name, in order.

    keys : words of `observe`, and TRAJECTORY or SETTLE where the scene has these keys
    at_impacts : whether the section is at impacts
    """
    return {
        observable.name: observable
        for observable in variables(masses, gap)
        if (not observable.asked_by or keys.intersection(observable.asked_by))
        and (at_impacts or not observable.at_impacts)
    }


def averaged(masses: int) -> tuple[str, ...]:
    """What all orbits of an attractor have in common."""
    return (*state(masses), "impacts_right", "impacts_left", "lyapunov")


@functools.cache
def dimensions(masses: int) -> dict[str, Quantity]:
    """The dimensions that variables may have beside those of the sweep, for so many masses."""
    rows = (
        Quantity("start", "start", "start of the orbit"),
        Quantity("sample", "section point", "section point, counted from the end of the transient"),
        Quantity("exponent", "exponent", "Lyapunov exponent, counted from the largest", extent=2 * masses),
        Quantity("multiplier", "multiplier", "Floquet multiplier, counted from that of largest modulus",
            extent=2 * masses),
        Quantity("averaged", "average of", "section points, impacts and contacts in a forcing period, lambda_1",
            extent=len(averaged(masses))),
        Quantity("elapsed", "forcing periods recorded", "forcing periods since the end of the transient"),
        Quantity("t_over_T", "time t/T", "forcing periods since the last section point"),
        Quantity("trajectory_section", "time t/T", "forcing periods since the last section point"),
        Quantity("trajectory_impact", "impact", "impact along the orbit, counted from the last section point"),
    )  # fmt: skip
    return {row.name: row for row in rows}


DIMENSIONS = dimensions(2)  # of the paper's oscillator
