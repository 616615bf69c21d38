"""Memory is known before it is taken: what does not fit is refused, and checking needs little."""

import subprocess
import sys
import tracemalloc

import pytest
from support.scene_texts import parsed
from support.scenes import PAPER, scene_of

import vibro_sweep as vs

# one number too large for a machine each, and the key that is to be named
TOO_LARGE = {
    "record": ("orbit: {transient: 0, record: 1e9}", "orbit.record = 1000000000: one orbit needs"),
    "samples": (
        "orbit: {transient: 0, record: 1}\ntrajectory: {periods: 1, samples: 1e9}",
        "trajectory.samples = 1000000000: one orbit needs",
    ),
    "exponents": ("orbit: {transient: 0, record: 1e12}\nobserve: [lyapunov]", "orbit.record = 1000000000000: one"),
    "impacts": (
        "orbit: {transient: 0, record: 2e6}\nsection: {kind: impact}",
        "orbit.record = 2000000: one orbit needs 496 MB",
    ),
    "attractors": (
        "orbit: {transient: 0, record: 20}\nstart: {random: 100000}\nobserve: [attractors, section]",
        "start.random = 100000: to find attractors, the 100000 orbits of a point need",
    ),
}


@pytest.mark.parametrize("name", TOO_LARGE)
def test_what_does_not_fit_is_refused_by_name(name):
    text, words = TOO_LARGE[name]
    tracemalloc.start()
    with pytest.raises(vs.SceneError, match=words):
        scene_of(text)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 2e6


@pytest.mark.parametrize("axes", ["zeta: {start: 0, stop: 1, num: 30001}, omega: {start: 2, stop: 4, num: 30001}"])
def test_a_plane_without_damping_is_checked_without_holding_it(axes):
    system = "mu_m: 1, mu_k: 7.875, f2: 0, R: 0.8, b: 1"
    text = f"system: {{{system}}}\nsweep: {{{axes}}}\norbit: {{transient: 0, record: 1}}\n"
    tracemalloc.start()
    scene = parsed(text)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert scene.n_points == 30001**2 and peak < 50e6


PLANES = (
    "zeta: {start: 0, stop: 1, num: 30000}, f2: {start: 0, stop: 1, num: 30000}",
    "mu_m: {start: 1, stop: 2, num: 30000}, mu_k: {start: 0.1, stop: 0.9, num: 30000}",
)


@pytest.mark.slow
def test_check_allocates_little(tmp_path):
    numbers = dict(part.split(": ") for part in PAPER.split(", ")) | {"zeta": "0"}
    system = ", ".join(f"{name}: {value}" for name, value in numbers.items())
    peaks = []
    for n, plane in enumerate(PLANES):
        text = f"system: {{{system}}}\nsweep: {{{plane}}}\norbit: {{transient: 0, record: 1}}\nobserve: [impacts]\n"
        (tmp_path / f"{n}.yaml").write_text(text)
    # the peak of this process alone: `ru_maxrss` would also count the process that started it
    program = (
        "import atexit; from vibro_sweep.__main__ import program;"
        "peak = lambda: next(line.split()[1] for line in open('/proc/self/status') if line.startswith('VmHWM'));"
        "atexit.register(lambda: print(peak()));"
        "program()"
    )
    for n in (0, 0, 1):  # the first compiles, where no other test has, and that takes memory of its own
        command = [sys.executable, "-c", program, "check", tmp_path / f"{n}.yaml"]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        peaks.append(int(done.stdout.splitlines()[-1]))
    assert max(peaks[1:]) < 600_000
