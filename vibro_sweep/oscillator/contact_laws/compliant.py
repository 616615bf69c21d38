"""The compliant stop: a spring and a damper side by side, without mass, which a preload may press together."""

from dataclasses import replace
from typing import NamedTuple

from vibro_sweep.oscillator.contact_laws.contact_law import Choice, ContactLaw
from vibro_sweep.tables.quantity import NOT_NEGATIVE, Parameter, Range

MODERATE = Range("a number from 0 to 1e100", {"minimum": 0, "maximum": 1e100})  # its square has to be a number

STIFFNESS = Parameter(
    "k_stop", "stiffness of the stop", "stiffness of a compliant stop, in place of R; 0: a damper alone",
    r"k_{\mathrm{stop}}", "N m-1", NOT_NEGATIVE, optional=True,
    instead="where a machine is softer beyond b, describe the softer side as the machine and the stiffer one as its "
    "stop, mirrored",
)  # fmt: skip
DAMPING = Parameter(
    "c_stop", "damping of the stop", "damping of a compliant stop; left out: 0",
    r"c_{\mathrm{stop}}", "N s m-1", NOT_NEGATIVE, optional=True,
)  # fmt: skip
PRELOAD = Parameter(
    "preload", "preload of the stop",
    "force with which a compliant stop is pressed together before it is touched; left out: 0",
    r"p_{\mathrm{stop}}", "N", MODERATE, optional=True,
)  # fmt: skip
NUMBERS = (STIFFNESS, DAMPING, PRELOAD)


class StopLaw(NamedTuple):
    """The force of a compliant stop, k delta + c delta' + p; delta: how far the mass is behind it. 0 of a rigid one.

    k, c, p : stiffness, damping and preload

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.Oscillator.named("one_mass", zeta=0.05, F=1, omega=0.8, b=0.3, k_stop=50, c_stop=0.1)
    >>> system.linear.contacts[0].law(1)
    StopLaw(k=50.0, c=0.1, p=0.0)
    """

    k: float
    c: float
    p: float


LAW = ContactLaw(
    name="compliant",
    title="the mass presses the stop in, against a spring and a damper",
    equations="F = k_stop delta + c_stop delta' + preload,   delta how far the mass is behind the stop",
    source="Kelvin's and Voigt's element of viscoelasticity; piecewise linear as in S. W. Shaw and P. J. Holmes, "
    "J. Sound Vib. 90 (1983) 129",
    numbers=NUMBERS,
    left=tuple(
        replace(
            number, name=f"{number.name}_left", symbol=number.symbol.replace("stop", "left"),
            label=f"left {number.label.split(' ')[0]}", text=f"{number.name} of the left stop; left out: {number.name}",
            follows=number.name,
        )
        for number in NUMBERS
    ),
    options=(
        Choice(
            "release",
            "where a contact with a compliant stop ends: at zero displacement, or where its force is zero",
            ("displacement", "force"),
        ),
    ),
)  # fmt: skip
