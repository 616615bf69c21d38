"""What can be observed of orbits, declared once: the kernels' records, files, scene words and the reference follow.

A variable of a file has the dimensions of the sweep, `start` if there are several, and then its own. Which variables
there are, and how long their dimensions are, follows from the number of masses.
"""

import functools
from typing import Any, NamedTuple

import numpy as np

from vibro_sweep.model.state import coordinates
from vibro_sweep.model.trajectory_variables import of_a_trajectory
from vibro_sweep.model.variable import Variable
from vibro_sweep.tables.exponents import CERTAIN
from vibro_sweep.tables.outcomes import NOT_COMPUTED, STATUSES


class Word(NamedTuple):
    """A word of `observe`, and what must be done for it while an orbit is computed."""

    text: str
    states: bool = True  # keep the section points of the record
    tangents: bool = False  # carry tangent vectors


WORDS = {
    "section": Word("section points and their period"),
    "lyapunov": Word("Lyapunov spectrum, its standard errors and the residual of its sum rule", tangents=True),
    "multipliers": Word("Floquet multipliers of periodic orbits", tangents=True),
    "impacts": Word("counts and speeds of impacts, time at rest on a stop", states=False),
    "contacts": Word("counts, time, peaks and restitution of contacts with compliant stops", states=False),
    "attractors": Word("which starts end on the same attractor", tangents=True),
    "energy": Word(
        "power that stops take, root mean square and largest size of every coordinate", states=False,
    ),
    "convergence": Word("Lyapunov exponents as they converge along the record", tangents=True),
}  # fmt: skip


def _section(name: str, label: str, text: str, **more: Any) -> Variable:
    return Variable(name, ("section",), label, text, ("sample",), in_kernel=False, **more)


def _attractor(name: str, label: str, text: str, dtype: str = "f8") -> Variable:
    return Variable(name, ("attractors",), label, text, (), dtype, in_kernel=False)


_EXPONENTS, _MULTIPLIERS, _IMPACTS, _ENERGY = ("lyapunov",), ("multipliers",), ("impacts",), ("energy",)
_CONTACTS, _PERIODS = ("contacts",), ("section", "multipliers", "attractors")
SETTLE = "settle"  # the scene's key that asks how long transients were
GAP = "gap"


@functools.cache
def variables(masses: int, gap: bool = False) -> tuple[Variable, ...]:
    """All variables of files of oscillators with so many masses, in order.

    gap : whether the gap is something else than x1
    """
    named = coordinates(masses)
    return (
        *(
            _section(one.name, one.label, f"{one.text} at the section", symbol=one.symbol, units=one.units)
            for one in named
        ),
        *([_section(GAP, "gap g", "gap at the section", symbol="g", units="m")] if gap else []),
        *_OF_ANY,
        *_energies(masses),
        *of_a_trajectory(masses, gap),
        _STATUS,
    )


_OF_ANY = (
    _section("phase", "forcing phase", "forcing phase omega t mod 2 pi at the impact", units="rad", at_impacts=True),
    Variable(
        "period", _PERIODS, "period in T",
        "period of the orbit in forcing periods; 0 if none up to half of `record` is found", dtype="i8",
    ),
    Variable(
        "approached_period", _PERIODS, "approached period in T",
        "period of the orbit that this one approaches, in forcing periods; 0 where it has arrived, or none is known",
        dtype="i8",
    ),
    Variable(
        "approached_distance", _PERIODS, "distance to go",
        "largest distance from the orbit that this one approaches, in parts of the sizes of its coordinates; NaN where "
        "none is known",
    ),
    Variable(
        "approached_factor", _PERIODS, "factor of the approach", "by which this distance shrinks in a forcing period",
    ),
    Variable(
        "lyapunov", _EXPONENTS, "Lyapunov exponent", "Lyapunov exponents per unit time, natural logarithm",
        ("exponent",), symbol=r"\lambda", units="s-1",
    ),
    Variable(
        "lyapunov_error", _EXPONENTS, "error of the exponent",
        "standard error of the exponents; of a periodic orbit what rounding and one more period change", ("exponent",),
        units="s-1",
        attributes={"significant": CERTAIN},  # so many of these errors tell an exponent from zero
    ),
    Variable(
        "lyapunov_residual", _EXPONENTS, "residual of the sum rule", "sum of the exponents minus its exact value",
        units="s-1",
    ),
    Variable(
        "multiplier_re", _MULTIPLIERS, "multiplier, real part",
        "real part of the Floquet multipliers of the periodic orbit, in the order of falling modulus", ("multiplier",),
    ),
    Variable(
        "multiplier_im", _MULTIPLIERS, "multiplier, imaginary part",
        "imaginary part of the Floquet multipliers; of a complex pair the positive one comes first", ("multiplier",),
    ),
    Variable(
        "transient_periods", (SETTLE,), "transient in T", "forcing periods before the record", dtype="i8",
    ),
    Variable("multiplier_error", _MULTIPLIERS, "error of the multiplier", "error of the multipliers", ("multiplier",)),
    _attractor(
        "attractor", "attractor",
        "rank of the attractor at this point; 1 = most starts reach it, 0 = not settled", "i8",
    ),
    _attractor(
        "attractor_id", "number of the attractor",
        "number of the attractor in the whole file, in the order of the sweep; 0 = not settled", "i4",
    ),
    _attractor("share", "share of starts", "share of the starts that reach the attractor of this one"),
    Variable(
        "average", ("attractors",), "average", "averages that orbits of one attractor share", ("averaged",),
    ),
    Variable(
        "average_error", ("attractors",), "error of the average", "error of the averages", ("averaged",),
    ),
    Variable(
        "lyapunov_running", ("convergence",), "Lyapunov exponent",
        "Lyapunov exponents as they converge along the record, in the order of their vectors", ("elapsed", "exponent"),
        units="s-1", in_kernel=False,
    ),
    Variable(
        "impacts_right", _IMPACTS, "impacts on the right", "impacts on the right stop in the recorded periods",
        dtype="i8",
    ),
    Variable(
        "impacts_left", _IMPACTS, "impacts on the left", "impacts on the left stop in the recorded periods", dtype="i8",
    ),
    Variable(
        "min_impact_speed", _IMPACTS, "smallest impact speed",
        "smallest |v1| before an impact in the recorded periods; 0 where chatter ended in a rest; NaN without impacts",
        units="m s-1",
    ),
    Variable(
        "contact_error", _IMPACTS, "contact error", "largest distance from the stop at which an impact was computed",
        units="m",
    ),
    Variable(
        "contacts_right", _CONTACTS, "contacts on the right",
        "contacts with the right stop that begin in the recorded periods", dtype="i8",
    ),
    Variable(
        "contacts_left", _CONTACTS, "contacts on the left",
        "contacts with the left stop that begin in the recorded periods", dtype="i8",
    ),
    Variable("contact_time", _CONTACTS, "share of time in contact", "share of the recorded time in contact"),
    Variable(
        "contact_force_max", _CONTACTS, "largest contact force",
        "largest force of a compliant stop in the recorded periods; NaN without contacts", units="N",
    ),
    Variable(
        "penetration_max", _CONTACTS, "largest penetration",
        "how far the mass was behind a compliant stop at most; NaN without contacts", units="m",
    ),
    Variable(
        "restitution_mean", _CONTACTS, "mean restitution",
        "mean of -v_release/v_touch over the contacts that ended in the recorded periods, without those that the stop "
        "began (v_touch < 0: it comes to the mass while it relaxes); NaN without any; above 1 where slow contacts are "
        "thrown back",
    ),
    Variable("sticking_time", _IMPACTS, "sticking time", "time at rest on a stop in the recorded periods", units="s"),
)  # fmt: skip

_STATUS = Variable(
    "status", (), "status", "outcome of the computation", dtype="i1", missing=NOT_COMPUTED,
    attributes={
        "flag_values": np.arange(len(STATUSES), dtype=np.int8) + NOT_COMPUTED,  # as CF has them
        "flag_meanings": " ".join(status.name for status in STATUSES),
    },
)  # fmt: skip


_TOO_LONG = "NaN where contacts take more than a million steps in a period"


def _energies(masses: int) -> tuple[Variable, ...]:
    """The variables that the designer of a damper looks at."""
    sizes = (("rms", "rms of", "root mean square of the {}"), ("peak", "peak of", "largest size of the {}"))
    return (
        Variable(
            "impact_power", _ENERGY, "power that stops take",
            "energy lost in impacts, and the work of the masses on compliant stops, in the recorded periods, per unit "
            f"time; {_TOO_LONG}", units="W", in_kernel=False,
        ),
        *(
            Variable(
                f"{name}_{of}", _ENERGY, f"{label} {of}",
                f"{text.format(what)} in the recorded periods; {_TOO_LONG}", units=units, in_kernel=False,
            )
            for name, label, text in sizes
            for of, _, _, what, units in coordinates(masses)
        ),
    )  # fmt: skip


VARIABLES = variables(2)  # of the paper's oscillator
OF_AN_ORBIT = tuple(variable for variable in VARIABLES if variable.in_kernel)  # whatever the number of masses


def of_an_impact(masses: int, gap: bool = False) -> tuple[str, ...]:
    """The numbers that are stored of an impact along a trajectory, in the order in which kernels keep it."""
    return tuple(one.name for one in variables(masses, gap) if one.dimensions == ("trajectory_impact",))


def asked_for(keys: frozenset[str], at_impacts: bool, masses: int = 2, gap: bool = False) -> dict[str, Variable]:
    """The variables of a file, by name, in order.

    keys : words of `observe`, and TRAJECTORY or SETTLE where the scene has these keys
    at_impacts : whether the section is at impacts
    """
    return {
        variable.name: variable
        for variable in variables(masses, gap)
        if (not variable.asked_by or keys.intersection(variable.asked_by)) and (at_impacts or not variable.at_impacts)
    }
