"""What a scene is said to take, by clocks that run as the test says; benchmarks/first_minutes.py compares real ones."""

import logging
import math
from dataclasses import replace

import numpy as np
import pytest
from support.scenes import PAPER, SCENES, scene_of

from vibro_sweep.cli.commands import main
from vibro_sweep.cli.summaries import cost_text
from vibro_sweep.driver import cost
from vibro_sweep.types import Estimate

FEW = "sweep: {b: {start: 5, stop: 6, num: 10}}"
MANY = "sweep: {b: {start: 5, stop: 6, num: 300}, R: {start: 0.5, stop: 0.9, num: 200}}"
STARTS = "sweep: {b: {start: 5, stop: 6, num: 50}}\nstart: {random: 20, seed: 1}"
CHAINS = "sweep: {b: {start: 5, stop: 6, num: 50}, R: {start: 0.5, stop: 0.9, num: 30}}\nstart: {follow: both}"


class Clock:
    """In place of `compute`: each orbit takes `tables` seconds and `period` for each of its periods."""

    def __init__(self, tables: float, period: float):
        self.tables, self.period, self.now, self.places = tables, period, 0.0, set()

    def compute(self, block):
        orbits = math.prod(len(values) for values in block.axes.values()) * (block.part.stop - block.part.start)
        self.now += orbits * (self.tables + self.period * (block.plan.transient + block.plan.record))
        self.places |= {(key, value) for key, values in block.axes.items() for value in values}
        return block.box, {"status": np.zeros(orbits)}

    def measure(self, monkeypatch, scene) -> float:
        monkeypatch.setattr(cost, "compute", self.compute)
        monkeypatch.setattr(cost.time, "thread_time", lambda: self.now)
        return cost.orbit_seconds(scene, 2)


def test_tables_are_not_multiplied_by_the_periods(monkeypatch):
    """120 random clocks; measuring takes two seconds at most, and ten times the first periods of a point's orbits."""
    rng = np.random.default_rng(28)
    for _ in range(120):
        text = str(rng.choice([FEW, MANY, STARTS, CHAINS]))
        transient, record = (int(10 ** rng.uniform(0, 5)) for _ in range(2))
        scene = scene_of(f"{text}\norbit: {{transient: {transient}, record: {record}}}\nobserve: [impacts]")
        clock = Clock(10 ** rng.uniform(-6, 0), 10 ** rng.uniform(-8, -1))
        expected = clock.tables + clock.period * (transient + record)
        assert clock.measure(monkeypatch, scene) == pytest.approx(expected, rel=1e-3)
        assert clock.now < 2.0 + 10 * scene.n_starts * (clock.tables + 4 * clock.period)


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("transient", [0, 7, 10**6])
def test_a_long_transient_is_not_computed(monkeypatch, name, transient):
    """A microsecond in each period: what is measured stands for the whole, and takes no second."""
    scene = replace(scene_of(SCENES[name]), transient=transient)
    clock = Clock(0.0, 1e-6)
    assert clock.measure(monkeypatch, scene) == pytest.approx(1e-6 * (scene.transient + scene.record))
    assert clock.now < 1


@pytest.mark.parametrize("text", [FEW, MANY, STARTS, CHAINS])
def test_orbits_are_spread_over_the_sweep(monkeypatch, text):
    scene = scene_of(f"{text}\norbit: {{transient: 100, record: 10}}\nobserve: [impacts]")
    clock = Clock(0.0, 1e-7)
    clock.measure(monkeypatch, scene)
    values = sorted(value for key, value in clock.places if key == "b")
    assert values[0] < 5.2 and values[-1] > 5.8 and max(np.diff(values)) < 0.25


def test_an_estimate_knows_what_runs_side_by_side(monkeypatch):
    """Starts of a point, and up to eight chains in one direction, are one worker's."""
    monkeypatch.setattr(cost, "orbit_seconds", lambda *_: 1.0)
    monkeypatch.setattr(cost, "available_cores", lambda: 8)
    one = scene_of("orbit: {transient: 0, record: 1}")
    starts = scene_of("orbit: {transient: 0, record: 1}\nstart: {random: 5, seed: 1}")
    chains = scene_of(SCENES["follow"])  # six of nine points, in two directions
    assert (cost.estimate(one).seconds, cost.estimate(starts).seconds) == (1.0 + cost.ALWAYS, 5.0 + cost.ALWAYS)
    assert cost.estimate(chains).seconds == chains.n_points / chains.n_starts + cost.ALWAYS
    assert cost.estimate(chains, workers=1).seconds == chains.n_points + cost.ALWAYS


def test_check_says_that_it_compiles_before_it_does(tmp_path, monkeypatch, capsys):
    said = []

    def compiling(*_):
        said.append(capsys.readouterr())
        logging.getLogger("vibro_sweep").info("compiling kernels, once")
        said.append(capsys.readouterr())
        return 1.0

    monkeypatch.setattr(cost, "orbit_seconds", compiling)
    path = tmp_path / "scene.yaml"
    path.write_text(f"system: {{{PAPER}}}\norbit: {{transient: 0, record: 10}}\nobserve: [impacts]\n")
    assert main(["check", str(path)]) == 0
    before, meanwhile = said
    assert before.out.startswith(str(path)) and meanwhile.err == "vibro-sweep: compiling kernels, once\n"
    assert "  time      about 1.2 s here\n" in capsys.readouterr().out


def test_what_check_says_of_compiling():
    assert cost_text(Estimate(1, 10, 100, 8.0, 8.0, 0.0)).endswith("  time      about 8 s here")
    compiled = cost_text(Estimate(1, 10, 100, 16.0, 16.0, 14.0))
    assert compiled.endswith("  time      about 16 s here\n  compiled  in 14 s just now, once: no run needs it again")


def test_an_estimate_says_what_orbits_may_take_to_settle():
    text = "sweep: {{b: {{start: 6, stop: 6.6, num: 8}}}}\norbit: {{transient: 100, record: 100{}}}\nobserve: [section]"
    plain, more = (cost.estimate(scene_of(text.format(word))) for word in ("", ", settle: 19900"))
    assert plain.most == plain.seconds > 0 and "settle" not in cost_text(plain)
    assert more.most - cost.ALWAYS == pytest.approx(100 * (more.seconds - cost.ALWAYS))
    assert "if all orbits go on as far as `settle`" in cost_text(more)
