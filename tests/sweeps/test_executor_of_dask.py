"""What the executor of Dask does inside: chains in parts, and what a scheduler that has died says."""

import signal
import threading

import pytest
from support.clusters import LIMIT, command_of
from support.contents import arrays_of, assert_same_bits
from support.programs import main
from support.scenes import COMPLIANT, run

import vibro_sweep as vs
from vibro_sweep.driver import sweep
from vibro_sweep.driver.executors import completed, worker_count

driver_cluster = pytest.importorskip("vibro_sweep.driver.cluster")


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in COMPLIANT if "rigid" not in name])
def test_dask_and_threads_agree_on_compliant_stops(tmp_path, cluster, name, monkeypatch):
    """Chains in parts of three points, each by any worker."""
    text, system = COMPLIANT[name]
    own = run(tmp_path, text, system)
    scene = tmp_path / "scene.yaml"
    scene.write_text(f"system: {{{system}}}\n{text}")
    monkeypatch.setattr(sweep, "orbits_per_block", lambda *_: 9)
    cluster.worker(), cluster.worker()
    cluster.wait_for_workers(2)
    assert main(command_of(scene, tmp_path / "dask.h5", cluster)) == 0
    assert_same_bits(arrays_of(tmp_path / "dask.h5"), own)


class DeadClient:
    """Of a scheduler that was killed while a block was sent; found by kills at random moments."""

    status = "closed"

    def nthreads(self):
        raise RuntimeError("ConnectionPool is closed")


class ExecutorOfTheDead:
    _client = DeadClient()

    def submit(self, *_):
        raise RuntimeError("Client is closed. Can't send update-graph message.")


def test_a_closed_client_is_a_scheduler_that_has_died():
    pool = ExecutorOfTheDead()
    assert worker_count(pool, 3) == 3
    with pytest.raises(vs.RunError, match="the scheduler has died"):
        next(completed(pool, print, lambda: 1, lambda: worker_count(pool)))


@pytest.mark.slow
def test_a_worker_dies_while_it_is_asked_for_its_version(cluster):
    """The other one computes."""
    for _ in range(2):
        cluster.worker()
    cluster.wait_for_workers(2)
    one = cluster.processes[-1]
    one.send_signal(signal.SIGSTOP)  # it does not answer, until it is dead
    threading.Timer(2.0, one.kill).start()
    with driver_cluster.cluster(cluster.address) as executor:
        assert executor.submit(driver_cluster.version).result(LIMIT) == driver_cluster.version()
