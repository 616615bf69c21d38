"""Frames of a sweep (`live/frames.py`): put together they are what `vibro_sweep.sweep` computes, bit for bit."""

import numpy as np
import pytest
from support import slow_cases
from support.models import PAPER, oscillator

import vibro_sweep as vs
from vibro_sweep.driver.block_columns import columns_of, draft_of, whole_block
from vibro_sweep.driver.compute import compute
from vibro_sweep.live.frames import Preview, frames
from vibro_sweep.live.pace import Pace
from vibro_sweep.scene import scene_of as scene_of_data
from vibro_sweep.scene.written import changed

SYSTEM = vs.System(**PAPER)
B = {"b": np.linspace(6.2, 6.8, 96)}


def scene_of(system=SYSTEM, sweep=B, **changes):
    base = {"transient": 60, "record": 20, "observe": ["section", "lyapunov", "impacts"]}
    return scene_of_data(changed({}, base | {"system": system, "sweep": sweep} | changes), "sweep")


def swept(scene):
    """The same by the driver and its file."""
    start = scene.start if scene.start.kind != "state" else None
    return vs.sweep(
        scene.system, scene.sweep, observe=scene.observe, start=start, transient=scene.transient, record=scene.record
    )


def put_together(scene, found):
    data = swept(scene)
    result = {name: np.full(data[name].shape, -99, data[name].dtype) for name in found[-1].arrays}
    for frame in found:
        if frame.kind == "piece":
            for name, values in frame.arrays.items():
                result[name][frame.box] = values
    return result, data


@pytest.mark.parametrize(
    "changes",
    [
        {},
        *slow_cases(
            {"start": {"random": 3, "seed": 5}},
            {"start": {"follow": "both"}},
            {"sweep": {"R": np.linspace(0.5, 0.9, 40)}},
            {"start": {"follow": "up"}},
            {"start": {"follow": "down"}},
            {"system": oscillator("one_mass"), "sweep": {"F": np.linspace(0.3, 0.6, 33)}, "start": {"random": 2}},
        ),
    ],
    ids=["b", "random", "both", "R", "up", "down", "one_mass"],
)
def test_pieces_have_the_bits_of_the_sweep(changes):
    scene = scene_of(**changes)
    pace = Pace()
    for seconds in (0.01, 1e-4):  # the second time in other pieces
        found = [*frames(scene, pace=pace, seconds=seconds)]
        assert [frame.kind for frame in found] == ["preview"] + ["piece"] * (len(found) - 1)
        assert [frame.last for frame in found] == [False] * (len(found) - 1) + [True]
        result, data = put_together(scene, found)
        for name, values in result.items():
            assert np.array_equal(values, data[name], equal_nan=values.dtype.kind == "f"), name
        assert {"x1", "lyapunov", "status", "period", "impacts_right"} <= result.keys()


def test_pieces_are_interlaced_and_complete():
    boxes = [frame.box[0] for frame in frames(scene_of(), preview=None)]
    assert [box.start for box in boxes] == [0, 2, 1, 3] and {box.step for box in boxes} == {4}
    every = np.concatenate([np.arange(96)[box] for box in boxes])
    assert np.array_equal(np.sort(every), np.arange(96))


def test_a_preview_has_values_of_the_sweep_and_shorter_orbits():
    scene = scene_of()
    first = next(frames(scene, variables=["v1", "lyapunov"], preview=Preview(columns=24, transient=60, record=10)))
    assert first.kind == "preview" and first.exact is False and first.box == (slice(0, 96, 4),)
    assert first.arrays.keys() == {"v1", "status"} and first.arrays["v1"].shape == (24, 10)
    alone = vs.sweep(SYSTEM, {"b": B["b"][::4]}, observe=["section"], transient=60, record=10)
    assert np.array_equal(first.arrays["v1"], alone["v1"])


def test_a_preview_is_reduced_to_its_time():
    pace, scene = Pace(), scene_of(sweep={"b": np.linspace(6.2, 6.8, 1000)})
    block = whole_block(scene, ["x1"])
    pace.measured(block, 100, 0.101)
    assert pace.step(block, 250, 0.126) == 8 and pace.step(block, 250, 1.0) == 4
    assert pace.step(block, 250, 0.002) == 16  # never fewer than 64 columns
    assert pace.pieces(block, 0.25) == 4 and pace.pieces(block, 1e-9) == 32
    other = whole_block(scene_of(transient=61), ["x1"])
    assert pace.step(other, 250, 0.002) == 1


def test_parts_of_parts_and_drafts():
    block = whole_block(scene_of(start={"random": 2, "seed": 3}), ["x1", "v2", "status"])
    box, whole = compute(block)
    assert box == (slice(0, 96),)
    part = columns_of(columns_of(block, slice(1, None, 3)), slice(2, 9, 2))
    box, arrays = compute(part)
    assert np.array_equal(np.arange(96)[box], np.arange(96)[1::3][2:9:2])
    for name, values in arrays.items():
        assert np.array_equal(values, whole[name][box], equal_nan=True)
    _, draft = compute(draft_of(block, 60, 20, ["x1"]))
    assert np.array_equal(draft["x1"], whole["x1"])  # exponents change no orbit


@pytest.mark.parametrize(
    "scene, more, words",
    [
        (scene_of(sweep={"b": np.array([6.2, 6.3]), "R": np.array([0.5, 0.6])}), {}, "scene.sweep"),
        (scene_of(observe=["attractors"], start={"random": 2}), {}, "scene.observe"),
        (scene_of(), {"variables": ["x3"]}, "variables"),
    ],
)
def test_what_has_no_frames_is_refused_at_once(scene, more, words):
    with pytest.raises(ValueError, match=words):
        frames(scene, **more)
