"""The phase of the force from event to event: sin and cos, each as a sum of two floats.

What presses the mass on a stop may be a small difference of large terms. So that it goes on smoothly over many short
flights and series of contacts, the phase is carried on by each of them and not rounded anew.
"""

import math

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.tables.twofold import add


@jit
def set_phase(o, sin, cos):
    """Take the phase of a node."""
    o.phase[0], o.phase[1] = sin, cos
    o.phase_low[0] = o.phase_low[1] = 0.0


@jit
def turn_phase(o, omega, u):
    """Carry the phase of an orbit on by the time u."""
    phase, low = o.phase, o.phase_low
    swing, half = math.sin(omega * u), math.sin(0.5 * omega * u)
    sin, cos, fall = phase[0], phase[1], -2.0 * half * half
    phase[0], low[0] = add(sin, low[0], sin * fall + cos * swing, 0.0)
    phase[1], low[1] = add(cos, low[1], cos * fall - sin * swing, 0.0)
