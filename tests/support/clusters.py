"""A cluster of Dask as users start it: each part a process of its own, on this machine alone."""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

LIMIT = 60  # seconds after which something hangs


class Cluster:
    """A scheduler and workers, each a process."""

    def __init__(self, folder: Path):
        self.folder, self.processes = folder, []
        self.start("scheduler", "--host", "127.0.0.1", "--port", "0", "--dashboard-address", "127.0.0.1:0")
        told = folder / "scheduler.json"
        self.wait(lambda: told.exists() and told.stat().st_size)
        self.address = json.loads(told.read_text())["address"]

    def start(self, what, *options, **environment):
        files = ["--scheduler-file", str(self.folder / "scheduler.json"), "--no-dashboard"]
        command = [sys.executable, "-m", "distributed.cli.dask_" + what, *files, *options]
        with (self.folder / f"{len(self.processes)}.log").open("w") as log:
            process = subprocess.Popen(command, stdout=log, stderr=log, cwd=self.folder, env=os.environ | environment)
        self.processes.append(process)
        return process

    def worker(self, **environment):
        folder = ["--local-directory", str(self.folder)]
        return self.start("worker", "--nthreads", "1", "--no-nanny", *folder, **environment)

    def wait(self, condition):
        limit = time.monotonic() + LIMIT
        while not condition():
            assert time.monotonic() < limit and all(process.poll() in (None, -9) for process in self.processes)
            time.sleep(0.02)

    def wait_for_workers(self, count):
        from distributed import Client

        with Client(self.address, set_as_default=False) as client:
            client.wait_for_workers(count, timeout=LIMIT)

    def end(self):
        for process in self.processes:
            process.kill()
            process.wait()


def command_of(scene, output, cluster):
    """The words that run a scene on a cluster."""
    return ["run", str(scene), "-o", str(output), "--scheduler", cluster.address, "--quiet"]
