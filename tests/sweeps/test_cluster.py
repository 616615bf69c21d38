"""Dask with processes of its own, started by command: the same arrays, whoever dies; and what the user is told."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import pytest
from support import ROOT
from support.clusters import LIMIT, command_of
from support.contents import arrays_of, assert_same_bits
from support.programs import main
from support.scenes import ALL, PAPER, done

import vibro_sweep as vs

pytest.importorskip("distributed")

PACKAGE = Path(vs.__file__).parent
BLOCKER = """
import sys

class Blocker:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] == "vibro_sweep":
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

sys.meta_path.insert(0, Blocker())
"""


@pytest.fixture(scope="module")
def unfit(tmp_path_factory):
    """Where Python finds no package, and where it finds one with other code."""
    lacking, other = tmp_path_factory.mktemp("lacking"), tmp_path_factory.mktemp("other")
    (lacking / "sitecustomize.py").write_text(BLOCKER)
    shutil.copytree(PACKAGE, other / "vibro_sweep", ignore=shutil.ignore_patterns("__pycache__"))
    with (other / "vibro_sweep" / "tables" / "outcomes.py").open("a") as file:
        file.write("# other\n")
    return {"lacking": str(lacking), "other": str(other)}


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    """A scene of some seconds, in several blocks: there is time to stop its run in the middle on a busy machine too."""
    path = tmp_path_factory.mktemp("scene") / "scene.yaml"
    more = f"start: {{random: 2, seed: 5}}\norbit: {{transient: 250000, record: 40}}\n{ALL}\n"
    path.write_text(f"system: {{{PAPER}}}\nsweep: {{b: {{start: 6.5, stop: 6.8, num: 300}}}}\n{more}")
    return path


@pytest.fixture(scope="module")
def whole(scene):
    """Its numbers by threads."""
    path = scene.with_suffix(".h5")
    vs.run(vs.load_scene(scene), path)
    return arrays_of(path)


@pytest.mark.slow
def test_dask_processes_and_threads_agree(tmp_path, cluster, scene, whole):
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        vs.run(vs.load_scene(scene), tmp_path / "processes.h5", executor=pool)
    assert_same_bits(arrays_of(tmp_path / "processes.h5"), whole)
    workers = [cluster.worker(), cluster.worker()]
    cluster.wait_for_workers(2)
    assert main(command_of(scene, tmp_path / "dask.h5", cluster)) == 0
    assert_same_bits(arrays_of(tmp_path / "dask.h5"), whole)
    assert all(worker.poll() is None for worker in workers)
    with vs.open(tmp_path / "dask.h5") as data:
        assert json.loads(data.attrs["provenance"])["executor"] == "ClientExecutor"


@pytest.mark.slow
def test_two_workers_killed_and_one_added(tmp_path, cluster, scene, whole):
    output = tmp_path / "out.h5"
    workers = [cluster.worker(), cluster.worker()]
    cluster.wait_for_workers(2)
    run = subprocess.Popen([sys.executable, "-m", "vibro_sweep", *command_of(scene, output, cluster)])
    cluster.wait(lambda: done(output))
    for worker in workers:
        worker.send_signal(signal.SIGKILL)
        worker.wait()
    assert 0 < done(output) < whole["status"].size and run.poll() is None
    cluster.worker()
    assert run.wait(LIMIT) == 0
    assert_same_bits(arrays_of(output), whole)


def stopped(cluster, path, output, stop):
    """Exit status and the one line of error of a run on one worker that is stopped in the middle by stop(run)."""
    cluster.worker()
    command = [sys.executable, "-m", "vibro_sweep", *command_of(path, output, cluster)]
    run = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    cluster.wait(lambda: done(output))
    stop(run)
    (error,) = run.communicate(timeout=LIMIT)[1].splitlines()
    return run.returncode, error


@pytest.mark.slow
def test_ctrl_c(tmp_path, cluster, scene, whole):
    output = tmp_path / "out.h5"
    status, error = stopped(cluster, scene, output, lambda run: run.send_signal(signal.SIGINT))
    assert status == 130
    assert "--resume" in error and f"--scheduler {cluster.address}" in error
    assert main([*command_of(scene, output, cluster), "--resume"]) == 0
    assert_same_bits(arrays_of(output), whole)


@pytest.mark.slow
def test_the_scheduler_dies(tmp_path, cluster, scene, whole):
    output = tmp_path / "out.h5"
    status, error = stopped(cluster, scene, output, lambda _: cluster.processes[0].kill())
    assert status == 2
    assert "the scheduler has died" in error and "--resume" in error
    vs.run(vs.load_scene(scene), output, mode="resume")
    assert_same_bits(arrays_of(output), whole)


@pytest.mark.slow
def test_a_worker_without_the_package_joins_later(tmp_path, cluster, scene, whole, unfit):
    """It ends at its first block, which others compute."""
    output = tmp_path / "out.h5"
    worker = cluster.worker()
    run = subprocess.Popen([sys.executable, "-m", "vibro_sweep", *command_of(scene, output, cluster)])
    cluster.wait(lambda: done(output))
    worker.send_signal(signal.SIGSTOP)  # so that blocks go to the other
    cluster.worker(PYTHONPATH=unfit["lacking"]).wait(LIMIT)
    worker.send_signal(signal.SIGCONT)
    assert run.wait(LIMIT) == 0
    assert_same_bits(arrays_of(output), whole)
    assert "No module named 'vibro_sweep'" in (cluster.folder / "2.log").read_text()


@pytest.mark.slow
def test_a_worker_with_other_code_joins_later(tmp_path, cluster, scene, unfit):
    output = tmp_path / "out.h5"
    worker = cluster.worker()
    command = [sys.executable, "-m", "vibro_sweep", *command_of(scene, output, cluster)]
    run = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    cluster.wait(lambda: done(output))
    worker.send_signal(signal.SIGSTOP)  # so that blocks go to the other
    cluster.worker(PYTHONPATH=unfit["other"])
    error = run.communicate(timeout=LIMIT)[1]
    assert run.returncode == 2 and len(error.splitlines()) == 1
    assert "has vibro_sweep" in error and "install the same on both" in error and "--resume" in error


@pytest.mark.slow  # three workers
def test_unfit_workers_are_named(tmp_path, cluster, scene, capsys, unfit):
    cluster.worker()
    cluster.worker(PYTHONPATH=unfit["lacking"])
    cluster.worker(PYTHONPATH=unfit["other"])
    cluster.wait_for_workers(3)
    assert main(command_of(scene, tmp_path / "out.h5", cluster)) == 2
    error = capsys.readouterr().err
    assert len(error.splitlines()) == 1 and "No module named 'vibro_sweep'" in error
    assert error.count("worker tcp://127.0.0.1:") == 2 and error.count(", code ") == 2
    assert not list(tmp_path.glob("out.h5*"))


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "host", "post://host:1"])
def test_no_scheduler(tmp_path, scene, capsys, monkeypatch, address):
    monkeypatch.setattr("vibro_sweep.driver.cluster.CONNECT_SECONDS", 0.5)
    output = tmp_path / "out.h5"
    assert main(["run", str(scene), "-o", str(output), "--scheduler", address]) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"vibro-sweep: error: --scheduler {address}: no dask scheduler answers there")
    assert len(error.splitlines()) == 1 and not list(tmp_path.iterdir())


LISTENING = """
ip link set lo up || exit 77
%s
for i in $(seq 60); do sleep 1; [ $(ss -Hltn | wc -l) -ge 8 ] && break; done
ss -Hltn
kill $(jobs -p)
"""


@pytest.mark.slow
def test_the_commands_for_one_machine_listen_on_it_alone(tmp_path):
    """In a network of their own, where every listening socket is theirs: `ss` shows what other machines could reach."""
    lines = re.findall("^dask .* 127.0.0.1 .*&$", (ROOT / "docs/how/many_machines.md").read_text(), re.MULTILINE)
    assert len(lines) == 2
    namespace = shutil.which("unshare"), "--net", *([] if os.geteuid() == 0 else ["--map-root-user"])
    if None in namespace or not shutil.which("ss") or subprocess.run([*namespace, "true"], check=False).returncode:
        pytest.skip("no network namespace here")
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    program = LISTENING % "\n".join(f"{line.removesuffix('&')} >/dev/null 2>&1 &" for line in lines)
    done = subprocess.run(
        [*namespace, "bash", "-c", program],
        cwd=tmp_path,
        env=os.environ | {"PATH": path},
        capture_output=True,
        text=True,
    )
    if done.returncode == 77:
        pytest.skip("no loopback interface here")
    addresses = [line.split()[3] for line in done.stdout.splitlines()]
    assert len(addresses) >= 8  # scheduler, dashboard; two nannies; two workers, each with an HTTP server
    assert all(address.startswith("127.0.0.1:") for address in addresses), addresses


@pytest.mark.parametrize("address", ["tls://127.0.0.1:1"])
def test_tls_without_certificates(tmp_path, scene, capsys, address):
    assert main(["run", str(scene), "-o", str(tmp_path / "out.h5"), "--scheduler", address]) == 2
    error = capsys.readouterr().err
    assert len(error.splitlines()) == 1 and "distributed.comm.tls" in error
