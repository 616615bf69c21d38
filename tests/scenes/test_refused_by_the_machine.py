"""What a machine does not have or does not allow is refused in one message, too."""

import subprocess
import sys

import pytest
from support.contents import bytes_in
from support.programs import ended

SCHEDULER = ["run", "good.yaml", "--scheduler", "tcp://host:8786"]
WITHOUT_DISTRIBUTED = """
import sys
sys.modules["distributed"] = None  # to import it fails
from vibro_sweep.__main__ import program
program()
"""


def test_a_folder_that_is_read_only(scene_folder, monkeypatch):
    """Made up, since a superuser may write into any folder."""

    def refuse(**_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("tempfile.TemporaryFile", refuse)
    before = bytes_in(scene_folder)
    status, out, err = ended("run", "good.yaml")
    assert (status, out) == (2, "") and bytes_in(scene_folder) == before
    assert err == "vibro-sweep: error: --output good.h5: cannot write into .: Permission denied\n"


@pytest.mark.slow
def test_a_scheduler_without_its_package(scene_folder):
    before = bytes_in(scene_folder)
    command = [sys.executable, "-c", WITHOUT_DISTRIBUTED, *SCHEDULER]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (2, "") and bytes_in(scene_folder) == before
    message = "--scheduler tcp://host:8786 needs the package dask.distributed: pip install distributed"
    assert done.stderr == f"vibro-sweep: error: {message}\n"
