"""The numbers of an oscillator's contact as kernels have them, in units in which all are of size 1."""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.continuation.lasting import PER_TIME_CONSTANT
from vibro_sweep.engine.continuation.lasting_map import MOST_HALVINGS
from vibro_sweep.engine.continuation.moving_flow import NUMBERS
from vibro_sweep.engine.impulses.flow import contact_coordinates
from vibro_sweep.oscillator.linear import STEP, Linear, forcing_period, stepped


class EventUnits(NamedTuple):
    """EventUnits in which kernels compute, so that all numbers are of size 1."""

    length: float  # the gap's size
    rate: float  # omega of the start

    @property
    def speed(self) -> float:
        """The unit of velocities."""
        return self.length * self.rate


def numbers_of(q: Linear, units: EventUnits) -> list[float]:
    """Where a stop is compliant k_stop, c_stop, preload over m_e of the left and of the right one; then stops, 1 + R at
    each, and omega."""
    length, rate = units
    laws = []
    one, sides = q.contact, (-1, 1)
    if any(np.real(one.law(side).k) > 0 for side in sides):
        push = contact_coordinates(q).by_force[0] @ one.normal  # 1/m_e
        for law in map(one.law, sides):
            laws += [law.k * push / rate**2, law.c * push / rate, law.p * push / (rate**2 * length)]
    R_low, R_high = (0.0 if np.real(k) > 0 else R for k, R in ((one.k_low, one.R_low), (one.k_high, one.R_high)))
    return [*laws, one.low / length, one.high / length, 1 + R_low, 1 + R_high, q.omega / rate]


def number_slopes(q: Linear, slope: Linear, units: EventUnits) -> np.ndarray:
    """Derivatives of `numbers_of` where q changes by `slope`, and these units stay."""
    there = q.with_contact(**{name: 0.0 for name in ("low", "high") if np.isinf(getattr(q.contact, name))})
    return np.imag(numbers_of(stepped(there, slope), units)) / STEP


def one_plus_R(q: Linear, sides) -> np.ndarray:
    """-D/v of events on these sides: 1 + R, and 1 of a contact, whose D stands for its speed as that of a rest does."""
    return 1 + np.where(q.contact.is_compliant(sides), 0.0, q.contact.restitution(sides))


def compliant_stops(q: Linear) -> np.ndarray | None:
    """(2,) whether the left and the right stop are compliant; None where no event lasts: both are rigid, R > 0."""
    lasting = q.compliant or min(q.contact.restitution((-1, 1))) == 0
    return q.contact.is_compliant((-1, 1)) if lasting else None


def presses_too_long(q: Linear) -> bool:
    """Whether a contact with a stop that lasts for a forcing period takes more parts than are computed."""
    laws = np.array(numbers_of(q, EventUnits(1.0, 1.0))[:-NUMBERS]).reshape(-1, 3)
    rates = PER_TIME_CONSTANT * (np.sqrt(laws[:, 0]) + laws[:, 1])
    return bool(np.any(rates * forcing_period(q) > 1 << MOST_HALVINGS))


def is_smooth(q: Linear, side: int) -> bool:
    """Whether a contact with this stop begins like the square root of what passes the stop: orbits go on through its
    graze, or turn back where it ends by force."""
    return bool(q.contact.is_compliant(side)) and q.contact.law(side).p == 0


def has_corner(q: Linear, side: int) -> bool:
    """Whether multipliers jump at the graze of a contact with this stop, by its damper."""
    return q.contact.by_force and is_smooth(q, side) and q.contact.law(side).c > 0


def preload(q: Linear, side: int) -> float:
    """The acceleration with which the preload of a compliant stop takes the gap back; 0 of other stops."""
    force = q.contact.law(side).p if q.contact.is_compliant(side) else 0.0
    return float(force * (contact_coordinates(q).by_force[0] @ q.contact.normal))


def impulse_by_speed(q: Linear, side: int) -> float:
    """The impulse, as a change of the gap velocity, over the speed of a weak touch that does not begin smoothly."""
    return 2.0 if q.contact.is_compliant(side) else 1.0 + float(q.contact.restitution(side))
