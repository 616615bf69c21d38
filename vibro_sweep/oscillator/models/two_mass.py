"""The paper's oscillator (eqs. 3, 4): the default."""

from dataclasses import replace

import numpy as np

from vibro_sweep.oscillator.contact_laws import OTHER_STOPS
from vibro_sweep.oscillator.contact_laws.rigid import RESTITUTION, RESTITUTION_LEFT
from vibro_sweep.oscillator.linear import Linear, contact
from vibro_sweep.oscillator.models.declaration import OF_STOPS, UNITS, WHICH_STOPS, Model
from vibro_sweep.oscillator.stacks import matrix, vector
from vibro_sweep.tables.parameters import CLEARANCE, FREQUENCY, OFFSET, PHASE
from vibro_sweep.tables.quantity import FRACTION, NOT_NEGATIVE, POSITIVE, Parameter

PAPER = (  # in the order of the kernels' records and derivatives
    Parameter("mu_m", "mass ratio", "mass ratio M2/M1", r"\mu_m", "1", POSITIVE, "(3)", free_motion=True),
    Parameter("mu_k", "stiffness ratio", "stiffness ratio K2/K1", r"\mu_k", "1", NOT_NEGATIVE, "(3)", free_motion=True),
    Parameter("zeta", "damping ratio", "damping ratio C1/(2 sqrt(K1 M1))", r"\zeta", "1", NOT_NEGATIVE, "(3)",
              free_motion=True),
    Parameter("f2", "share of force on mass 2", "share of the force on the second mass, P2/(P1 + P2)", "f_2", "1",
              FRACTION, "(3)", free_motion=True),
    replace(FREQUENCY, text="forcing frequency Omega sqrt(M1/K1)", equation="(3)"),
    RESTITUTION,
    replace(CLEARANCE, text="clearance on each side, B K1/(P1 + P2)"),
    PHASE,
)  # fmt: skip
PARAMETERS = (
    *PAPER,
    OFFSET,
    RESTITUTION_LEFT,
    Parameter("mu_c", "ratio of dampers", "ratio of the dampers C2/C1; left out: mu_k", r"\mu_c", "1", NOT_NEGATIVE,
              free_motion=True, optional=True, follows="mu_k"),
    *OTHER_STOPS,
)  # fmt: skip
NAMES = tuple(parameter.name for parameter in PAPER)
FREE_MOTION = tuple(parameter.name for parameter in PAPER if parameter.free_motion)


@np.errstate(all="ignore")  # matrices beyond the range of the floats: such an oscillator is too stiff
def two_mass(*, mu_m, mu_k, zeta, f2, omega, tau, mu_c=None, **stops) -> Linear:
    """The oscillator; numbers may be complex."""
    return Linear(
        M=matrix([[1, 0], [0, mu_m]]),
        K=matrix([[1, -1], [-1, 1 + mu_k]]),
        C=2 * np.asarray(zeta)[..., None, None] * matrix([[1, -1], [-1, 1 + (mu_k if mu_c is None else mu_c)]]),
        constant=np.zeros(2),
        sine=vector([1 - f2, f2]),
        cosine=np.zeros(2),
        omega=omega,
        tau=None if isinstance(tau, str) else tau,
        contacts=[contact(np.array([1.0, 0.0]), **stops)],
    )


MODEL = Model(
    name="two_mass",
    title="two masses in a chain, the first between two stops",
    sketch=r"""
    C |<-- b -->.-----.<-- b -->| A            stops at offset - b and offset + b
                |  1  |                .------.
                |     |---/\/\--[--]---| mu_m |---/\/\--[--]---||
                '-----'    1, 2 zeta   '------'   mu_k, 2 zeta mu_c
                  x1                      x2
""",
    equations="""
    x1'' + 2 zeta (x1' - x2') + x1 - x2 = (1 - f2) sin(omega t + tau)
    mu_m x2'' + 2 zeta ((1 + mu_c) x2' - x1') + (1 + mu_k) x2 - x1 = f2 sin(omega t + tau)
    offset - b <= x1 <= offset + b;   mu_c = mu_k unless it is given
""",
    source="the paper that this package follows, eqs. (3), (4): docs/how/models.md",
    numbers=PARAMETERS,
    options=(WHICH_STOPS, *OF_STOPS, UNITS),
    masses=lambda arguments: 2,
    build=two_mass,
)
