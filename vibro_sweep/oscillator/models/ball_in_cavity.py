"""A free ball in the cavity of a sprung host: the impact damper, or vibro-impact nonlinear energy sink."""

from dataclasses import replace

import numpy as np

from vibro_sweep.oscillator.contact_laws import STOP_NUMBERS
from vibro_sweep.oscillator.linear import Linear, contact
from vibro_sweep.oscillator.models.declaration import OF_STOPS, UNITS, Model
from vibro_sweep.oscillator.stacks import matrix, vector
from vibro_sweep.tables.parameters import CLEARANCE, FREQUENCY, PHASE
from vibro_sweep.tables.quantity import NOT_NEGATIVE, POSITIVE, Parameter


def ball_in_cavity(*, mass_ratio, zeta, F, omega, tau, **stops) -> Linear:
    """The oscillator; numbers may be complex."""
    return Linear(
        M=matrix([[1, 0], [0, mass_ratio]]),
        K=np.diag([1.0, 0.0]),
        C=2 * np.asarray(zeta)[..., None, None] * np.diag([1.0, 0.0]),
        constant=np.zeros(2),
        sine=vector([F, 0]),
        cosine=np.zeros(2),
        omega=omega,
        tau=None if isinstance(tau, str) else tau,
        contacts=[contact(np.array([-1.0, 1.0]), **stops)],
    )


MODEL = Model(
    name="ball_in_cavity",
    title="a free ball in the cavity of a sprung mass: impact damper, vibro-impact energy sink",
    sketch=r"""
    |            .------------------.
    |            |  <-b-> o <-b->   |
    |---/\/\-----|       x2         |
    |---[--]-----|  1               |
    |            '------------------'
                   x1, F sin(omega t + tau)
""",
    equations="""
    x1'' + 2 zeta x1' + x1 = F sin(omega t + tau)
    mass_ratio x2'' = 0
    |x2 - x1| <= b;   the gap is g = x2 - x1
""",
    source="S. F. Masri and T. K. Caughey, J. Appl. Mech. 33 (1966) 586; O. V. Gendelman, J. Sound Vib. 331 (2012) "
    "4599",
    numbers=(
        Parameter(
            "mass_ratio",
            "mass ratio",
            "mass of the ball over that of the host",
            r"\epsilon",
            range=POSITIVE,
            free_motion=True,
        ),
        Parameter("zeta", "damping ratio", "damping ratio of the host", r"\zeta", "1", NOT_NEGATIVE, free_motion=True),
        Parameter("F", "forcing amplitude", "amplitude of the force on the host", "F", "N", free_motion=True),
        FREQUENCY,
        *STOP_NUMBERS,
        replace(CLEARANCE, text="half of the ball's play", range=POSITIVE),
        PHASE,
    ),
    options=(*OF_STOPS, UNITS),
    masses=lambda arguments: 2,
    build=ball_in_cavity,
)
