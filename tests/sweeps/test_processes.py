"""The same bits in processes of all kinds: without asserts, with warnings as errors, spawned, forked."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from support import path_with
from support.oscillators import PAPER

import vibro_sweep as vs

CHAOS = PAPER.replace(b=5.8)
STATE = [0.1, 0.2, 0.3, 0.4]

HEAD = """
from test_processes import numbers
if __name__ == "__main__":
"""
HERE = "    print(numbers())"
SPAWNED = """    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context
    with ProcessPoolExecutor(1, get_context("{}")) as pool:
        {}
        print(pool.submit(numbers).result())"""


def numbers() -> str:
    """Of a simulation, exponents and a periodic orbit, in hexadecimal digits."""
    orbit = vs.simulate(CHAOS, STATE, 20)
    periodic = vs.periodic_orbit(PAPER.replace(b=3.0), itinerary="LR")
    values = [orbit.section[-1], vs.lyapunov(CHAOS, STATE, 20, 20), periodic.state]
    return " ".join(float(one).hex() for one in np.concatenate([np.asarray(one) for one in values]))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("options", "code"),
    [
        (["-OO"], HERE),
        (["-W", "error"], HERE),
        ([], SPAWNED.format("spawn", "pass")),
        (["-W", "ignore::DeprecationWarning"], SPAWNED.format("fork", "numbers()")),  # forked after it has computed
    ],
)
def test_the_same_bits(options, code, tmp_path):
    script = tmp_path / "script.py"
    script.write_text(HEAD + code)
    surroundings = os.environ | {"PYTHONPATH": path_with(Path(__file__).parent)}
    expected = numbers()  # compiled with that, or found
    done = subprocess.run(
        [sys.executable, *options, script], capture_output=True, text=True, timeout=300, env=surroundings
    )
    told = [line for line in done.stderr.splitlines() if not line.startswith("vibro-sweep: compil")]
    assert (done.stdout.strip(), told) == (expected, [])
