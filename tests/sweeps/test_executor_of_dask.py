"""What the executor of Dask does inside: chains in parts, what a scheduler that has died says, and of whom it warns."""

import signal
import threading
from concurrent.futures import CancelledError, Future
from types import SimpleNamespace

import pytest
from support.clusters import LIMIT, command_of
from support.contents import arrays_of, assert_same_bits
from support.programs import main
from support.scenes import COMPLIANT, run

import vibro_sweep as vs
from vibro_sweep.driver import sweep

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


@pytest.mark.parametrize(
    "address, warned",
    [("tcp://10.1.2.3:8786", True), ("tcp://127.0.0.1:8786", False), ("tcp://localhost:8786", False)],
)
def test_a_scheduler_within_reach_of_others_is_warned_of(caplog, monkeypatch, address, warned):
    def no_client(*_, **__):
        return SimpleNamespace(wait_for_workers=lambda *_, **__: None, close=lambda: None, nthreads=dict)

    monkeypatch.setattr(driver_cluster, "Client", no_client)
    monkeypatch.setattr(driver_cluster, "_check", lambda _: None)
    monkeypatch.setattr(driver_cluster, "ClusterExecutor", lambda client: client)
    with caplog.at_level("WARNING"), driver_cluster.cluster(address):
        pass
    assert ("without TLS" in caplog.text) == warned


def test_a_client_whose_scheduler_is_gone_is_no_bug():
    """RuntimeError and OSError by turns are what a client raises then."""

    def gone():
        raise RuntimeError("ConnectionPool is closed")

    executor = driver_cluster.ClusterExecutor.__new__(driver_cluster.ClusterExecutor)
    executor._threads, executor._last = gone, 3
    assert executor.num_workers == 3


def test_a_closed_client_is_a_scheduler_that_has_died(monkeypatch):
    """Of a scheduler killed while a block is sent; found by kills at random moments."""

    def closed(*_, **__):
        raise driver_cluster.GONE[-1]("Client is closed. Can't send update-graph message.")

    monkeypatch.setattr(driver_cluster.ClientExecutor, "submit", closed)
    executor = driver_cluster.ClusterExecutor.__new__(driver_cluster.ClusterExecutor)
    with pytest.raises(vs.RunError, match="the scheduler has died"):
        executor.submit(print)


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


@pytest.mark.parametrize(
    "error, told",
    [(driver_cluster.GONE[-1]("closed"), False), (CancelledError("a block"), False), (ValueError("a bug"), True)],
)
def test_blocks_that_a_dead_scheduler_had_cannot_be_cancelled(caplog, error, told):
    def cannot_cancel(_):
        raise error

    driver_cluster._filter_callbacks()
    future = Future()
    future.add_done_callback(cannot_cancel)
    future.cancel()
    assert ("exception calling callback" in caplog.text) == told
