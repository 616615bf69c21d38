"""Every command and snippet of the README, in order, twice in a row, in a folder where nobody has run anything."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from support import ROOT

SNIPPETS = re.findall(r"^```(\w+)\n(.*?)^```$", (ROOT / "README.md").read_text(), re.MULTILINE | re.DOTALL)

# What the README takes from other packages, where these are not installed; workers of this machine in their place.
STAND_INS = {
    "dask_jobqueue.py": """
from distributed import LocalCluster

class SLURMCluster(LocalCluster):
    def __init__(self, **_):
        super().__init__(
            n_workers=0, threads_per_worker=1, processes=False, protocol="tcp://", dashboard_address="127.0.0.1:0"
        )

    def scale(self, jobs):
        super().scale(2)

    def wait_for_workers(self, n_workers):
        super().wait_for_workers(2)
""",
    "mpi4py/__init__.py": "",
    "mpi4py/futures.py": """
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

def MPIPoolExecutor():
    return ProcessPoolExecutor(2, get_context("spawn"))
""",
}


def command_of(language, text):
    """A bash script; installing and testing are what whoever runs this test has done and is doing."""
    if language == "python":
        return f"cat > script.py <<'END'\n{text}END\npython script.py\n"
    lines = [re.sub(r"^pip install \S+( && )?", "", line) for line in text.splitlines()]
    lines = [line for line in lines if not line.startswith("pytest")]
    waiting = ["sleep 5"] * any(line.endswith("&") for line in lines)  # for what is in the background to listen
    background = [line for line in lines if line.endswith("&")]
    return "\n".join([*background, *waiting, *(line for line in lines if line not in background)])


@pytest.mark.slow
def test_readme_twice(tmp_path):
    shutil.copytree(ROOT / "configs", tmp_path / "configs")
    for name, text in STAND_INS.items():
        place = tmp_path / "stand_ins" / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(text)
    namespace = ["unshare", "--net", *([] if os.geteuid() == 0 else ["--map-root-user"])]
    if not shutil.which("unshare") or subprocess.run([*namespace, "true"], check=False).returncode:
        namespace = []  # then the ports of the README must be free here
    environment = os.environ | {
        "PATH": os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]]),
        "PYTHONPATH": str(tmp_path / "stand_ins"),
    }
    assert len(SNIPPETS) >= 5
    for _ in "twice":
        for language, text in SNIPPETS:
            lo = "ip link set lo up\n" if namespace else ""
            script = f"set -e\n{lo}trap 'kill $(jobs -p) 2>/dev/null || true' EXIT\n{command_of(language, text)}\n"
            done = subprocess.run(
                [*namespace, "bash", "-c", script],
                cwd=tmp_path,
                env=environment,
                capture_output=True,
                text=True,
                check=False,
            )
            assert done.returncode == 0, f"{text}\n{done.stdout}\n{done.stderr}"
            assert_as_said(text, done.stdout)
    assert (tmp_path / "quickstart.png").exists()


def assert_as_said(text, printed):
    """A line `print(...)  # 6.7...` says how what it prints begins."""
    for number in re.findall(r"^print\(.*\)  # ([\d.]+?)\.\.\.$", text, re.MULTILINE):
        assert any(line.startswith(number) for line in printed.splitlines()), (number, printed)
