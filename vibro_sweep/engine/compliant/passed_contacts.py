"""What is recorded of contacts that orbits pass side by side: counted in lanes, and added to those that single orbits
had (law.py) when all have been carried."""

from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.simd.lanes import LANES, select
from vibro_sweep.engine.simd.memory import put, row


@inline
def clear_passed(law):
    """Count contacts from here on."""
    if law is not None:
        passage = law.passage[0]
        for i in range(LANES):
            passage.passed[0, i] = passage.passed[1, i] = 0.0
            passage.pressed_time[i] = passage.restitutions[i] = 0.0
            passage.peak[i] = passage.peak_force[i] = -1.0


@inline
def count_passed(passage, passed, right):
    """Count the contacts that are `passed` with the stop on the `right`, or the left one."""
    time = select(passed, row(passage.time, 0), 0.0)
    put(passage.passed, 0, row(passage.passed, 0) + select(passed & ~right, 1.0, 0.0))
    put(passage.passed, 1, row(passage.passed, 1) + select(passed & right, 1.0, 0.0))
    put(passage.pressed_time, 0, row(passage.pressed_time, 0) + time)
    restitution = -row(passage.speed_after, 0) / row(passage.speed, 0)
    put(passage.restitutions, 0, row(passage.restitutions, 0) + select(passed, restitution, 0.0))
    if passage.watched:
        largest, peak = row(passage.largest, 0), row(passage.peak, 0)
        strongest, peak_force = row(passage.strongest, 0), row(passage.peak_force, 0)
        put(passage.peak, 0, select(passed & (largest > peak), largest, peak))
        put(passage.peak_force, 0, select(passed & (strongest > peak_force), strongest, peak_force))


@inline
def add_passed(law, o):
    """Add the contacts that an orbit has passed."""
    if law is not None:
        add_passed_of(law.orbits[o.lane], law.passage[0], o)


@jit
def add_passed_of(contact, passage, o):
    """`add_passed` where there are compliant stops."""
    i = o.lane
    for n in range(2):
        contact.contacts[n] += int(passage.passed[n, i])
        contact.ended += int(passage.passed[n, i])
    contact.time += passage.pressed_time[i]
    contact.restitutions += passage.restitutions[i]
    if passage.peak[i] > 0.0:
        contact.peak = max(contact.peak, passage.peak[i])
        contact.peak_force = max(contact.peak_force, contact.mass * passage.peak_force[i])
    o.pressed_time += passage.pressed_time[i]
