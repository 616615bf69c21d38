"""The problem that every method solves: the paper's oscillator at three clearances, and the truth about it.

At three more its motion is chaotic: orbits that a block computes together part there.

The truth is the first 40 impacts of three orbits at each clearance, computed with 40 digits by
tests/reference/naive.py and kept in data/impacts.json (`python benchmarks/problem.py --write` makes it anew, in
minutes). An error is the largest error of those 40 impact times over the three orbits: early times mean something, the
end of a chaotic orbit does not.
"""

import json
import sys
from concurrent.futures import ProcessPoolExecutor
from decimal import Decimal
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

HERE = Path(__file__).parent
REFERENCE = HERE / "data" / "impacts.json"
CLEARANCES = (6.69, 3.0, 1.0)
CHAOTIC = (5.8, 4.6, 0.5)
CYCLE = dict.fromkeys((*CLEARANCES, *CHAOTIC), 1) | {6.69: 29}  # forcing periods after which a periodic orbit repeats
COUNT = 40
TRANSIENT = 3000  # forcing periods from rest to the attractor, on which everything is timed
NEAR = 1e-2  # an impact further than this from the true one is another impact


class Truth(NamedTuple):
    """One orbit of the reference."""

    params: dict[str, float]
    state: tuple[float, ...]  # at t = 0
    times: list[Decimal]
    sides: np.ndarray
    effect: float  # on any of the times, of moving every input by one part in 2^53


class Error(NamedTuple):
    """How a method did on one clearance: the worst of its orbits."""

    matched: int  # impacts before the first one that is missed, invented or elsewhere
    largest: float  # error of their times


@cache
def truths(b: float) -> tuple[Truth, ...]:
    """The reference orbits at clearance b."""
    rows = [row for row in json.loads(REFERENCE.read_text()) if row["params"]["b"] == b]
    return tuple(
        Truth(
            row["params"],
            tuple(row["state"]),
            [Decimal(t) for t in row["impacts"]["t"]],
            np.array(row["side"]),
            max(row["effect"]["t"]),
        )
        for row in rows
    )


def compare(truth: Truth, times, sides) -> Error:
    """Hold impact times and sides (+1, -1) against the truth."""
    largest, matched = 0.0, 0
    for t, side, true_t, true_side in zip(times, sides, truth.times, truth.sides, strict=False):
        error = abs(float(Decimal(float(t)) - true_t))
        if side != true_side or not error < NEAR:
            break
        matched, largest = matched + 1, max(largest, error)
    return Error(matched, largest)


def error(b: float, impacts) -> Error:
    """The worst over the orbits at b; impacts(params, state, count) -> times, sides."""
    found = [compare(truth, *impacts(truth.params, truth.state, len(truth.times))) for truth in truths(b)]
    return Error(min(e.matched for e in found), max(e.largest for e in found))


def rounding(b: float) -> float:
    """What the rounding of the inputs alone does to the times: no double precision method can be asked for less."""
    return max(truth.effect for truth in truths(b))


def period(params) -> float:
    return 2 * np.pi / params["omega"]


@cache
def on_attractor(b: float) -> tuple[dict[str, float], np.ndarray]:
    """(params, states): eight section points, spread over the attractor that is reached from rest."""
    import vibro_sweep as vs

    params = truths(CLEARANCES[0])[0].params | {"b": b}
    section = vs.simulate(vs.System(**params), (0.0,) * 4, TRANSIENT).section
    return params, section[-29::4]


def write_reference() -> None:
    import shared  # noqa: F401
    from reference import naive

    jobs = [(b, tuple(b * x for x in start), COUNT) for b in (*CLEARANCES, *CHAOTIC) for start in naive.STARTS]
    with ProcessPoolExecutor() as pool:
        orbits = list(pool.map(naive.reference, *zip(*jobs, strict=True)))
    REFERENCE.parent.mkdir(exist_ok=True)
    REFERENCE.write_text("[\n" + ",\n".join(json.dumps(orbit) for orbit in orbits) + "\n]\n")


if __name__ == "__main__":
    if sys.argv[1:] != ["--write"]:
        sys.exit(f"usage: python {sys.argv[0]} --write")
    write_reference()
