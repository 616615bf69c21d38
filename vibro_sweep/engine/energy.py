"""What the designer of a damper looks at: the energy that stops take, root mean squares and peaks of all coordinates.

A room of its own, which nothing enters that does not ask for it: orbits are carried over their record once more, one by
one and cell by cell, and each piece of their motion is added up (motion/energy_sums.py).
"""

from vibro_sweep.engine.compliant.law import clear_contacts
from vibro_sweep.engine.motion.ensemble import carry
from vibro_sweep.engine.motion.orbits import Records, set_state
from vibro_sweep.engine.motion.together import Ensemble, Readings
from vibro_sweep.engine.orbit_block import prepare
from vibro_sweep.engine.simd.jit import exported, inline
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.trajectory import hold
from vibro_sweep.tables import outcomes as status


@inline
def begin_contacts(law):
    """Watch contacts from here on."""
    if law is not None:
        clear_contacts(law.orbits[0], True)


@inline
def work_on(law):
    """The work of a unit mass on compliant stops."""
    if law is not None:
        return law.orbits[0].work
    return 0.0


@exported
def run_energy(points, begins, resting, relaxed, periods, w, plan, sums, loss, squares, peaks, outcome):
    """Carry each orbit over its record. n = orbits.

    points: (n,). begins: (n, 2 N) in contact coordinates, `resting` (n,) the stops that they rest on, and `relaxed`
    (n, 2) where stops are that relax. sums: (n,) `sums_of`, of which each orbit's has what leads from contact
    coordinates to its masses; the first one is scratch. loss: (n,), of a unit mass. outcome: (n,), NOT_COMPUTED where
    an orbit is wanted; then its status.
    """
    e, o = w.ensemble, w.ensemble.orbits[0]
    e.tangent[0].wanted = e.strike[0].measured = False
    for i in range(1, LANES):
        e.orbits[i].status = status.NOT_COMPUTED
    for n in range(len(points)):
        if outcome[n] != status.NOT_COMPUTED:
            continue
        one = sums[n : n + 1]
        records = Records(e.records.impacts, e.records.rests, e.records.times, e.records.samples, one)
        stops = prepare(points[n], 0, w, plan)
        set_state(o, e.flights.nodes[o.table], stops, 0, 0.0, begins[n])
        o.resting, o.periods, o.log_side = resting[n], periods, 0.0
        begin_contacts(e.law)
        hold(e.law, o, relaxed[n])
        carry(
            Ensemble(e.flights, e.orbits, e.strike, e.tangent, records, e.halt, e.law),
            None,
            Readings(w.section, False, w.growth, 0),
        )
        outcome[n] = o.status
        loss[n] = one[0].loss + work_on(e.law)
        for j in range(len(begins[n])):
            squares[n, j], peaks[n, j] = one[0].squares[j], one[0].peaks[j]
