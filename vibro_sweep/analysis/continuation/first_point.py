"""The first point of a branch or a curve: an orbit as a guess, null vectors and tangent where there are none yet."""

import numpy as np

from vibro_sweep.analysis.continuation.tracer import Tracer
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.continuation import stepper
from vibro_sweep.engine.continuation.problem import conditions, is_critical, unknowns
from vibro_sweep.engine.continuation.workspace import THETA, Place, new_place


def first_place(tracer: Tracer, row: np.ndarray | None = None) -> Place | None:
    """The point of the curve at `start`, or near it on the plane across `row`; None where it is not isolated."""
    place = guess_of(tracer)
    return place and settle(tracer, place, row)


def guess_of(tracer: Tracer, solution: Solution | None = None, tau: float | None = None) -> Place | None:
    """`start`, or another orbit with the same impacts, as it is; None where the oscillator has no forced motion.

    tau : as of `solution`
    """
    s, place = solution or tracer.start.solution, new_place(tracer.K, tracer.n)
    q = s.family.linear
    place.phases[:], place.jumps[:] = (
        q.omega * s.times + (q.tau if tau is None else tau),
        s.jumps / tracer.units.speed,
    )
    rests = list(s.rests)
    place.jumps[rests] = q.omega * (s.ends - s.times[rests])
    place.p[: len(tracer.names)] = [s.family.numbers[name] for name in tracer.names]
    place.p[THETA] = tracer.start.theta
    if not tracer.go_to(place):
        return None
    states = s.states[: tracer.K, : tracer.n] if tracer.start.state is None else tracer.start.state[None]
    steady = (tracer.planes[0]["Z"] * np.exp(1j * place.phases[:, None])).real
    place.x[:, : tracer.n] = states / tracer.state_units - steady
    if tracer.start.state is not None:
        tracer.do(stepper.FOLLOW, place)
    return place


def settle(tracer: Tracer, place: Place, row: np.ndarray | None = None) -> Place | None:
    """The point of the curve near a guess without a tangent."""
    if not tracer.go_to(place):
        return None
    if is_critical(tracer.problem):
        _take_null_vectors(tracer, place)
    if row is None:
        is_single = conditions(tracer.problem) == unknowns(tracer.problem)
        row = tracer.direction(place) if is_single else first_direction(tracer, place)
    return None if row is None else tracer.correct(place, row)


def _take_null_vectors(tracer: Tracer, place: Place) -> None:
    """v and w of the critical multiplier, at a place that has none."""
    place.v[:], place.w[:] = 0.0, 0.0
    for _ in range(2):  # with any border, then with what that gives
        tracer.do(stepper.ASSEMBLE, place)
        for here, found in ((place.v, tracer.bench.events["v"]), (place.w, tracer.bench.trial)):
            here[:] = found / np.linalg.norm(found)


def first_direction(tracer: Tracer, place: Place) -> np.ndarray | None:
    """The tangent at a place to which the oscillator was moved; it is kept there."""
    if not tracer.do(stepper.ASSEMBLE, place):
        return None
    n, size = tracer.n, tracer.n + unknowns(tracer.problem)
    null = np.linalg.svd(tracer.bench.work[0]["ends"][: size - 1, :size])[2][-1]
    change, events = tracer.taken_apart(place, null[:n], null[n:]), tracer.bench.events
    length = np.linalg.norm(change)
    place.tangent[:] = events["changes"][:, 1]
    place.tangent[:, :n] += events["rate"] * place.tangent[:, n, None]
    place.tangent[:] /= length
    place.tangent_p[:] = change[-3:] / length
    return change / length
