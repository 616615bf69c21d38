"""One mass on a spring, with one stop or two; without the spring a bouncing ball, or the rattle of gears."""

import numpy as np

from vibro_sweep.oscillator.linear import Linear, contact
from vibro_sweep.oscillator.models.declaration import CONTACT, OF_STOPS, UNITS, WHICH_STOPS, Model, Option
from vibro_sweep.oscillator.stacks import matrix, vector
from vibro_sweep.tables.quantity import NOT_NEGATIVE, POSITIVE, Parameter

STOP = "stop"  # that moves alone, of `base`


def one_mass(*, k, zeta, F, constant, base, omega, tau, m=1.0, **stops) -> Linear:
    """The oscillator; numbers may be complex."""
    sine, cosine = F, np.zeros(1)
    if base:  # of x, which is counted from what moves by F sin(omega t + tau)
        sine = m * F * omega * omega
    if base == STOP:
        sine, cosine = sine - k * F, vector([-2 * zeta * omega * F])
    return Linear(
        M=matrix([[m]]),
        K=matrix([[k]]),
        C=matrix([[2 * zeta]]),
        constant=vector([constant]),
        sine=vector([sine]),
        cosine=cosine,
        omega=omega,
        tau=None if isinstance(tau, str) else tau,
        contacts=[contact(np.ones(1), **stops)],
    )


MODEL = Model(
    name="one_mass",
    title="one mass, one stop or two; k = 0: bouncing ball, rattling gears",
    sketch=r"""
           L |<-- b -->.-----.<-- b -->| R      stops at offset - b and offset + b
                       |  1  |
    ||---/\/\--[--]----'-----'                  spring k and damper 2 zeta
                         x1
""",
    equations="""
    m x1'' + 2 zeta x1' + k x1 = constant + F sin(omega t + tau)
    base: true   wall and stops move by F sin(omega t + tau), x1 is counted from them: m F omega^2 for F
    base: stop   the stops move alone, x1 is counted from them: (m omega^2 - k) F for F, and
                 - 2 zeta omega F cos(omega t + tau)
    bouncing ball on a table A sin(omega t), gravity G: k = 0, zeta = 0, constant = -G, base: true, F = A,
    stops: left, b = 0
""",
    source="S. W. Shaw and P. J. Holmes, J. Sound Vib. 90 (1983) 129; bouncing ball: P. J. Holmes, J. Sound Vib. 84 "
    "(1982) 173; orbits to compare with: arXiv 2510.16218",
    numbers=(
        Parameter("m", "mass", "mass", "m", "kg", POSITIVE, default=1.0, free_motion=True),
        Parameter(
            "k", "stiffness", "stiffness of the spring", "k", "N m-1", NOT_NEGATIVE, default=1.0, free_motion=True
        ),
        Parameter(
            "zeta", "damping ratio", "half the damping coefficient", r"\zeta", "N s m-1", NOT_NEGATIVE, free_motion=True
        ),
        Parameter(
            "F", "forcing amplitude", "amplitude of the force, or of the wall's motion", "F", "N", free_motion=True
        ),
        Parameter("constant", "constant force", "constant force", r"\bar f", "N", default=0.0, free_motion=True),
        *CONTACT,
    ),
    options=(
        Option(
            "base",
            "choice",
            "what moves by F sin(omega t + tau), in place of a force: true, wall and stops; stop, the stops alone",
            False,
            (False, True, STOP),
        ),
        WHICH_STOPS,
        *OF_STOPS,
        UNITS,
    ),
    masses=lambda arguments: 1,
    build=one_mass,
    depending=lambda arguments: {"F": "m"} if arguments["base"] else {},  # the wall's motion
)
