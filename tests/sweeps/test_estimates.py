"""What a scene is said to take, by clocks that run as the test says; benchmarks/first_minutes.py compares real ones."""

import errno
import logging
import math
import threading
from dataclasses import replace

import numpy as np
import pytest
from support.scenes import PAPER, SCENES, scene_of

from vibro_sweep.cli.commands import main
from vibro_sweep.cli.summaries import cost_text
from vibro_sweep.driver import cost, measuring
from vibro_sweep.driver.blocks import blocks
from vibro_sweep.driver.measuring import OrbitCost
from vibro_sweep.types import Estimate

FEW = "sweep: {b: {start: 5, stop: 6, num: 10}}"
MANY = "sweep: {b: {start: 5, stop: 6, num: 300}, R: {start: 0.5, stop: 0.9, num: 200}}"
STARTS = "sweep: {b: {start: 5, stop: 6, num: 50}}\nstart: {random: 20, seed: 1}"
CHAINS = "sweep: {b: {start: 5, stop: 6, num: 50}, R: {start: 0.5, stop: 0.9, num: 30}}\nstart: {follow: both}"


class Clock:
    """In place of `compute`: a call takes `call` seconds, each orbit `tables` and `period` for each of its periods.

    Every fortieth call takes `hiccup` seconds more, the third one first.
    """

    def __init__(self, tables: float, period: float, call: float = 2e-4, hiccup: float = 0.0):
        self.tables, self.period, self.call, self.hiccup = tables, period, call, hiccup
        self.now, self.calls = 0.0, 0

    def compute(self, block):
        orbits = math.prod(len(values) for values in block.axes.values()) * (block.part.stop - block.part.start)
        periods = block.plan.transient + block.plan.record
        self.calls += 1
        self.now += self.call + orbits * (self.tables + self.period * periods)
        self.now += self.hiccup if self.calls % 40 == 3 else 0.0
        return block.box, {"status": np.zeros(orbits)}

    def measure(self, monkeypatch, scene, workers: int = 2) -> OrbitCost:
        monkeypatch.setattr(measuring, "compute", self.compute)
        monkeypatch.setattr(measuring.time, "thread_time", lambda: self.now)
        return cost.orbit_cost(scene, workers)


def test_tables_and_hiccups_are_not_multiplied_by_the_periods(monkeypatch):
    """120 random clocks: the estimate is right to a quarter, and measuring takes no more than some first periods."""
    rng, counted = np.random.default_rng(28), 0
    for _ in range(120):
        text = str(rng.choice([FEW, MANY, STARTS, CHAINS]))
        transient, record = (int(10 ** rng.uniform(0, 5)) for _ in range(2))
        scene = scene_of(f"{text}\norbit: {{transient: {transient}, record: {record}}}\nobserve: [impacts]")
        clock = Clock(10 ** rng.uniform(-6, 0), 10 ** rng.uniform(-8, -1), hiccup=float(rng.choice([0, 0.05])))
        found = clock.measure(monkeypatch, scene)
        expected = clock.tables + clock.period * (transient + record)
        if expected * scene.n_points > 0.1:  # else calls themselves count
            counted += 1
            assert 0.8 < found.seconds / expected < 1.25, (text, transient, record, vars(clock), found.seconds)
            assert clock.now < 2.0 + 30 * (clock.tables + 4 * clock.period) + 0.05 * clock.calls
    assert counted > 75


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("transient", [0, 7, 10**6])
def test_a_long_transient_is_not_computed(monkeypatch, name, transient):
    """A microsecond in each period: what is measured stands for the whole, and takes no second."""
    scene = replace(scene_of(SCENES[name]), transient=transient)
    clock = Clock(0.0, 1e-6, call=0.0)
    found = clock.measure(monkeypatch, scene)
    assert found.seconds == pytest.approx(1e-6 * (scene.transient + scene.record))
    assert clock.now < 1


def test_a_stiff_orbit_is_measured_in_a_few_periods(monkeypatch):
    """Two seconds a period and three for the tables: what it will take is known after some of them."""
    scene = scene_of("orbit: {transient: 10, record: 70}\nsweep: {b: {start: 5, stop: 6, num: 10}}")
    clock = Clock(3.0, 2.0)
    assert clock.measure(monkeypatch, scene).seconds == pytest.approx(3 + 2.0 * 80, rel=1e-3)
    assert clock.now < 80  # of 1630


def test_orbits_are_measured_in_blocks_like_those_of_the_run(monkeypatch):
    """Of few points each worker gets a part, and lanes stay empty: so they do in the measurement."""
    few = scene_of(f"{FEW}\norbit: {{transient: 100, record: 10}}\nobserve: [impacts]")
    many = scene_of(f"{MANY}\norbit: {{transient: 100, record: 10}}\nobserve: [impacts]")
    sizes = {}
    for name, scene in {"few": few, "many": many}.items():
        sample = Clock(0.0, 1e-5).measure(monkeypatch, scene).sample
        sizes[name] = [math.prod(len(values) for values in block.axes.values()) for block in sample]
    size = cost.points_per_block(few, 1e-5 * 110, 2, cost.BLOCK_SECONDS)
    assert size == 1 and set(sizes["few"]) == {1}
    (together,) = sizes["many"]
    assert together % 8 == 0
    run = [math.prod(len(values) for values in block.axes.values()) for block in blocks(few, size)]
    assert set(run) == {1}


def test_a_pause_of_the_processor_does_not_count(monkeypatch):
    """The first measurement of an orbit is twice as long as it should be; those that follow are right."""
    clock = Clock(1e-3, 1e-6, call=0.0)
    found = clock.measure(monkeypatch, scene_of(f"{FEW}\norbit: {{transient: 0, record: 10}}\nobserve: [impacts]"))
    slow = found._replace(seconds=2 * found.seconds, sample_seconds=2 * found.sample_seconds)
    right = measuring.repeated(slow)
    assert right.seconds == pytest.approx(found.seconds)
    assert right.sample_seconds == pytest.approx(found.sample_seconds)


@pytest.mark.parametrize(("extent", "places", "beside"), [(100, 8, 1), (100, 8, 8), (1000, 3, 8), (5, 8, 8), (1, 1, 1)])
def test_places_are_spread_over_an_axis(extent, places, beside):
    """As many on either side of the middle: no end counts for more than the parts between."""
    found = measuring._spread(extent, places, beside)
    assert found[0] >= 0 and found[-1] < extent and len(found) <= places * beside
    assert abs(found.mean() - (extent - 1) / 2) <= 0.5 + extent / 100
    if places * beside < extent:
        assert found[0] <= extent / places and found[-1] >= extent - 1 - extent / places


@pytest.mark.parametrize("factor", [1.0, 2.5])
@pytest.mark.parametrize("threads", [1, 3])
def test_the_load_of_the_machine(monkeypatch, factor, threads):
    """By a clock that runs `factor` times as long as orbits take of a thread alone."""
    (block, *_) = blocks(scene_of(SCENES["plane"]), 10**9)
    now, lock, seconds = [0.0], threading.Lock(), 0.02

    def compute(_):
        with lock:
            now[0] += factor * seconds / threads

    monkeypatch.setattr(cost, "compute", compute)
    monkeypatch.setattr(cost.time, "perf_counter", lambda: now[0])
    assert cost.crowding(OrbitCost(1.0, [block], seconds), threads) == pytest.approx(factor)


@pytest.mark.parametrize(("size", "expected"), [(10**5, 0.0), (10**7, 0.25), (10**9, 0.25 * 10**9 / 16e6)])
def test_the_time_of_writing_is_that_of_the_disk(monkeypatch, tmp_path, size, expected):
    """By a disk on which whatever is written takes a quarter of a second; and one that is full."""
    monkeypatch.chdir(tmp_path)
    now = [0.0]
    monkeypatch.setattr(cost.time, "perf_counter", lambda: now[0])
    monkeypatch.setattr(cost.os, "fsync", lambda _: now.__setitem__(0, now[0] + 0.25))
    assert cost.writing_seconds(size) == pytest.approx(expected)
    assert not list(tmp_path.iterdir())

    def full(_):
        raise OSError(errno.ENOSPC, "no space")

    monkeypatch.setattr(cost.os, "fsync", full)
    assert cost.writing_seconds(size) == 0.0


def test_check_says_that_it_compiles_before_it_does(tmp_path, monkeypatch, capsys):
    said = []

    def compiling(*_):
        said.append(capsys.readouterr())
        logging.getLogger("vibro_sweep").info("compiling kernels, once")
        said.append(capsys.readouterr())
        return OrbitCost(1.0, [], 1.0)

    monkeypatch.setattr(cost, "orbit_cost", compiling)
    monkeypatch.setattr(cost, "crowding", lambda *_: 1.0)
    path = tmp_path / "scene.yaml"
    path.write_text(f"system: {{{PAPER}}}\norbit: {{transient: 0, record: 10}}\nobserve: [impacts]\n")
    assert main(["check", str(path)]) == 0
    before, meanwhile = said
    assert before.out.startswith(str(path)) and meanwhile.err == "vibro-sweep: compiling kernels, once\n"
    assert "  time      about 1 s here\n" in capsys.readouterr().out


def test_what_check_says_of_load_and_compiling():
    quiet = cost_text(Estimate(1, 1, 10, 100, 8.0, 7.9, 8.0, 0.0))
    assert quiet.endswith("  time      about 8 s here")
    busy = cost_text(Estimate(1, 1, 10, 100, 16.0, 8.0, 16.0, 14.0))
    assert "  time      about 16 s here beside what else runs now, 8 s alone\n  compiled  in 14 s just now" in busy


def test_an_estimate_says_what_orbits_may_take_to_settle():
    text = "sweep: {{b: {{start: 6, stop: 6.6, num: 8}}}}\norbit: {{transient: 100, record: 100{}}}\nobserve: [section]"
    plain, more = (scene_of(text.format(word)).estimate() for word in ("", ", settle: 19900"))
    assert plain.most == plain.seconds and "settle" not in cost_text(plain)
    assert more.most > more.seconds > 0 and "if all orbits go on as far as `settle`" in cost_text(more)
    assert cost.longest(scene_of(text.format(", settle: 19900"))) == 100
