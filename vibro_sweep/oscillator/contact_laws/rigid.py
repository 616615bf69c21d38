"""The rigid stop, which the paper has (eq. 4)."""

from vibro_sweep.oscillator.contact_laws.contact_law import ContactLaw
from vibro_sweep.tables.quantity import FRACTION, Parameter

RESTITUTION = Parameter(
    "R", "coefficient of restitution", "coefficient of restitution of a rigid stop", "R", "1", FRACTION, "(4)",
    optional=True,
)  # fmt: skip
RESTITUTION_LEFT = Parameter(
    "R_left", "restitution on the left", "coefficient of restitution of the left stop; left out: R",
    r"R_{\mathrm{left}}", "1", FRACTION, optional=True, follows="R",
)  # fmt: skip

LAW = ContactLaw(
    name="rigid",
    title="the mass leaves the stop at once, with R times its speed",
    equations="v -> -R v",
    source="the paper that this package follows, eq. (4)",
    numbers=(RESTITUTION,),
    left=(RESTITUTION_LEFT,),
)
