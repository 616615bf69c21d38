"""A plan of parts: pieces of points and of chains give the same bits, and few large ones are there at a time."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from support import sample
from support.contents import arrays_of, assert_same_bits
from support.scenes import ALL, EVERY, SCENES, run, scene_of

import vibro_sweep as vs
from vibro_sweep.analysis.single.tables import table_of
from vibro_sweep.driver import blocks, compute, memory_needed, sweep
from vibro_sweep.scene.size import MAX_AT_ONCE, numbers_at_once

# chains that begin anew after a point that cannot be computed
FAILING = """
sweep: {omega: {values: [0.5, 0.6, 0.63, 0.7, 0.9, 1.1]}, b: {start: 0.4, stop: 6, num: 11}}
start: {follow: both}
orbit: {transient: 5, record: 10}
observe: [section, lyapunov, impacts]"""
# chains with points whose orbits are still on their way
HASTY = """
sweep: {omega: {values: [0.5, 0.6, 0.63, 0.7, 0.9, 1.1]}, b: {start: 0.4, stop: 6, num: 11}}
start: {follow: both}
orbit: {transient: 0, record: 60}
observe: [section, lyapunov, impacts]"""
MORE = {"failing": (FAILING,), "hasty": (HASTY,)}
AGAIN = "compliant, follow", "compliant, force"


def computed(scene, points, orbits):
    """The scene's arrays by blocks of up to so many points and orbits, chains gone on with, put together."""
    rng = np.random.default_rng(points)
    todo, whole = list(blocks.blocks(scene, lambda: int(rng.integers(1, points + 1)), orbits)), {}
    most = 0
    while todo:
        block = todo.pop()
        box, arrays = compute.compute(block)
        ends = arrays.pop(compute.CHAIN_ENDS, None)
        assert (ends is None) == block.last
        if ends is not None:
            todo.append(blocks.next_part(scene, block, ends))
        most = max(most, arrays["status"].size)
        for name, values in arrays.items():
            extra = values.shape[arrays["status"].ndim :]
            target = whole.setdefault(name, np.full(scene.shape + extra, 99, values.dtype))
            target[box] = values
    return whole, most


@pytest.mark.parametrize(
    "name",
    sample(2, [*(name for name in SCENES if name != "attractors"), *MORE, "compliant", *AGAIN]),
)
def test_parts_of_points_and_chains_give_the_same_bits(name, monkeypatch):
    def too_stiff(*given, **named):
        table, kind, rate = table_of(*given, **named)
        table["cells"][table["omega"] == 0.63 / rate] = 0
        return table, kind, rate

    if name == "failing":
        monkeypatch.setattr("vibro_sweep.driver.compute.table_of", too_stiff)
    scene = scene_of(*(EVERY | MORE)[name])
    whole, _ = computed(scene, 10**6, None)
    if name == "failing":
        assert len(np.unique(whole["status"])) > 1
    for points, orbits in ((1, 1), (3, 2), (10**6, 9), (5, 17)):
        parts, most = computed(scene, points, orbits)
        assert most <= max(orbits, points) or not (scene.start.kind == "follow" or points == 1)
        assert_same_bits(parts, whole)


def test_a_run_in_parts_is_resumed(tmp_path, monkeypatch):
    """Chains in parts of two points: those that are there already are computed again for their ends, and only that."""
    scene, path = scene_of(SCENES["follow"]), tmp_path / "out.h5"
    vs.run(scene, tmp_path / "whole.h5")
    monkeypatch.setattr(sweep, "orbits_per_block", lambda *_: 6)

    class StopError(Exception):
        pass

    def stop(done, total):
        if done >= total // 3:
            raise StopError

    with pytest.raises(StopError):
        vs.run(scene, path, workers=1, progress=stop)
    seen = []
    vs.run(scene, path, workers=1, mode="resume", progress=lambda done, total: seen.append(done))
    assert seen[0] > 0 and seen[-1] == scene.n_points
    assert_same_bits(arrays_of(path), arrays_of(tmp_path / "whole.h5"))


def test_section_alone_computes_no_tangent(tmp_path):
    scene = scene_of(SCENES["random"].replace(ALL, "observe: [section]"))
    plan = blocks.plan_of(scene)
    assert not plan.lyapunov and plan.warm_up == 0
    (block,) = blocks.blocks(scene, lambda: 1000)
    with ThreadPoolExecutor(1) as pool:  # a thread of its own, so that its workspace is new
        _, arrays = pool.submit(compute.compute, block).result()
        touched = pool.submit(lambda: compute._local.workspace.ensemble.tangent.tobytes().strip(b"\0")).result()
    assert not touched and "lyapunov" not in arrays
    assert not {"lyapunov", "impacts_right"} & run(tmp_path, SCENES["random"].replace(ALL, "")).keys()


def test_few_large_blocks_at_a_time():
    text = (
        "sweep: {b: {start: 5, stop: 6, num: 40}}\norbit: {transient: 0, record: RECORD}\nobserve: [section, lyapunov]"
    )
    small, large = (scene_of(text.replace("RECORD", str(record))) for record in (100, 2_400_000))
    assert numbers_at_once(large) <= MAX_AT_ONCE
    assert memory_needed.orbits_per_block(large, 2) == 1
    assert memory_needed.blocks_under_way(large, 1, here=True) == 1
    assert memory_needed.blocks_under_way(small, memory_needed.orbits_per_block(small, 2), here=True) > 8


def test_impacts_alone_need_no_memory_for_their_periods():
    assert numbers_at_once(scene_of("orbit: {transient: 0, record: 1e12}\nobserve: [impacts]")) < 1000
