"""Ctrl-C in Python: long kernels end soon, the compiler does not lose it, and garbage of others is found."""

import gc
import os
import signal
import subprocess
import sys
import textwrap
import threading
from pathlib import Path

import numpy as np
import pytest
from support import path_with
from support.oscillators import PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.single import orbit
from vibro_sweep.engine import halting, orbit_block, simd
from vibro_sweep.engine.motion.ensemble import Mapping
from vibro_sweep.engine.one_system import Engine, plan_of
from vibro_sweep.engine.points.any_points import grazing_points
from vibro_sweep.engine.records import new_results, starts_at
from vibro_sweep.engine.simd import jit
from vibro_sweep.tables import outcomes as status

CHAOS = PAPER.replace(b=5.8)
STATE = [0.1, 0.2, 0.3, 0.4]
AGES = 10**11  # forcing periods, which would take hours

BEGUN = """
import signal, threading
from test_halting import AGES, CHAOS, STATE
import vibro_sweep as vs

{0}  # compiled before, or found
threading.Timer(1.0, signal.raise_signal, [signal.SIGINT]).start()
try:
    {1}
except KeyboardInterrupt:
    print("answered", flush=True)
"""


def slow(call):
    return pytest.param(call, marks=pytest.mark.slow)


@pytest.mark.parametrize(
    "call",
    [
        "vs.lyapunov(CHAOS, STATE, transient=AGES)",
        slow("vs.simulate(CHAOS.replace(b=0.5), STATE, 9_000_000)"),
        slow("vs.sweep(CHAOS, {'b': [5.0, 5.8]}, transient=AGES, record=10, workers=2)"),
        slow("vs.sweep(CHAOS, {'b': [5.0, 5.8]}, transient=AGES, record=10, observe=['energy'], workers=1)"),
    ],
)
def test_a_process_that_computes_for_hours_ends_with_ctrl_c(call):
    """Also the process: threads that went on would keep it from ending."""
    code = textwrap.dedent(BEGUN).format(call.replace("AGES", "10").replace("9_000_000", "10"), call)
    surroundings = os.environ | {"PYTHONPATH": path_with(Path(__file__).parent)}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=150, env=surroundings)
    assert (done.returncode, done.stdout) == (0, "answered\n"), done.stderr


def halted(plan, mapping=None):
    """Results of eight orbits whose kernels are told to end while they are on their way."""
    halt = halting.new_halt()
    halting.heed(halt)
    try:
        engine = Engine(CHAOS)
        if plan.order:
            engine.point["graze"] = grazing_points(CHAOS.linear, None)
        nothing, starts = np.empty((1, 8, 0)), starts_at(np.tile(STATE, (2, 8, 1)))
        workspace = orbit_block.new_workspace(plan, engine.cells, 0, engine.kind)
        steps = np.ascontiguousarray(np.broadcast_to(engine.point, (1, 8)))
        kept = nothing[..., None], nothing, nothing[..., None]
        for periods in (1, AGES):  # compiled before that takes long
            results, begun = new_results((1, 8), 2), plan._replace(transient=periods)
            orbit_block.run_points(steps, starts, results, *kept, workspace, begun, mapping)
            threading.Timer(0.3, halt.__setitem__, (0, 1)).start()
        return results
    finally:
        del halting._thread.halt


def test_what_was_halted_is_not_computed():
    results = halted(plan_of(0, 100, lyapunov=True))
    assert (results["status"] == status.NOT_COMPUTED).all() and np.isnan(results["lyapunov"]).all()


@pytest.mark.slow
def test_the_mapping_is_halted():
    assert (halted(plan_of(0, 100)._replace(order=1), Mapping(1))["status"] == status.NOT_COMPUTED).all()


def test_the_same_bits_in_a_thread_of_its_own(monkeypatch):
    here = vs.simulate(CHAOS, STATE, 300), vs.lyapunov(CHAOS, STATE, 100, 100)
    monkeypatch.setattr(halting, "LONG", 0)
    there = vs.simulate(CHAOS, STATE, 300), vs.lyapunov(CHAOS, STATE, 100, 100)
    assert np.array_equal(here[0].section, there[0].section) and np.array_equal(here[0].impacts, there[0].impacts)
    assert np.array_equal(here[1], there[1]) and here[0].status == there[0].status == "ok"


def test_errors_come_out_of_the_thread(monkeypatch):
    monkeypatch.setattr(halting, "LONG", 0)
    monkeypatch.setattr(orbit.orbit_block, "run_points", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        vs.lyapunov(CHAOS, STATE, 10, 10)


def test_an_interrupt_that_is_lost_comes_at_the_end():
    """As LLVM loses one, and within kernels that are compiled for another kernel."""
    with pytest.raises(KeyboardInterrupt), halting.heard():
        try:
            with halting.heard():
                try:
                    signal.raise_signal(signal.SIGINT)
                except KeyboardInterrupt:
                    pass
        except KeyboardInterrupt:
            pass
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_a_handler_of_somebody_else_stays():
    before = signal.signal(signal.SIGINT, lambda *_: None)
    try:
        mine = signal.getsignal(signal.SIGINT)
        with halting.heard():
            assert signal.getsignal(signal.SIGINT) is mine
        assert signal.getsignal(signal.SIGINT) is mine
    finally:
        signal.signal(signal.SIGINT, before)


def test_the_compiler_halts_with_its_thread():
    def double(x):
        return 2.0 * x

    came = []

    def compiled():
        halting.heed(np.ones(1, np.int64))
        try:
            jit.kernel_of(double, jit.WholeCompiler)(1.0)
        except KeyboardInterrupt:
            came.append(True)

    thread = threading.Thread(target=compiled)
    thread.start()
    thread.join()
    assert came
    assert jit.kernel_of(double, jit.WholeCompiler)(1.0) == 2.0


@pytest.mark.skipif(not jit.AS_ONE, reason="numba compiles as it does by itself")
def test_garbage_of_others_is_still_found(monkeypatch):
    """What was frozen was never looked at again. Where somebody froze objects, these stay frozen."""

    def double(x):
        return 2.0 * x

    monkeypatch.setattr(simd, "OWN_PROCESS", False)
    gc.unfreeze()
    assert jit.kernel_of(double, jit.WholeCompiler)(1.0) == 2.0
    assert gc.get_freeze_count() == 0 and gc.isenabled()
    gc.freeze()
    try:
        many = gc.get_freeze_count()
        assert jit.kernel_of(lambda x: x + 1.0, jit.WholeCompiler)(1.0) == 2.0
        assert 0 < gc.get_freeze_count() <= many
    finally:
        gc.unfreeze()
