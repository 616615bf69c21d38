"""Files of version 0.1: they are read, drawn and checked; a run that it began is not continued."""

import gzip
from pathlib import Path

import numpy as np
import pytest
import xarray

import vibro_sweep as vs
from vibro_sweep.cli.commands import main
from vibro_sweep.store import StoreError

SCENE = """
system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6.6}
sweep: {b: {start: 6.5, stop: 6.9, num: 4}}
orbit: {transient: 5, record: 4}
start: {follow: both}
observe: [section, lyapunov, impacts]
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    data = Path(__file__).parent / "data"
    for name in ("version_0_1.h5", "version_0_1.h5.part"):
        Path(name).write_bytes(gzip.decompress((data / f"{name}.gz").read_bytes()))
    Path("old.yaml").write_text(SCENE)
    return tmp_path


def test_a_complete_file(folder, capsys):
    with vs.open("version_0_1.h5") as own, xarray.open_dataset("version_0_1.h5", engine="h5netcdf") as data:
        assert own.identical(data)
        assert own["start"].values.tolist() == ["up", "down"] and np.all(own["status"] == 0)
    assert main(["info", "version_0_1.h5"]) == 0
    told = capsys.readouterr().out
    assert "8 of 8" in told and "checksums    all hold" in told and "begun by vibro_sweep 0.1.0" in told
    assert main(["plot", "version_0_1.h5"]) == 0


def test_an_interrupted_run(folder, capsys):
    with vs.open("version_0_1.h5.part") as data:
        assert np.count_nonzero(data["status"] == 0) == 4
    assert main(["info", "version_0_1.h5.part"]) == 0 and main(["plot", "version_0_1.h5.part"]) == 0
    before = Path("version_0_1.h5.part").read_bytes()
    Path("version_0_1.h5").unlink()
    capsys.readouterr()
    assert main(["run", "old.yaml", "-o", "version_0_1.h5", "--resume"]) == 2
    told = capsys.readouterr().err
    assert "version_0_1.h5.part was begun by vibro_sweep 0.1.0 with the format 1" in told and "or overwrite it" in told
    assert Path("version_0_1.h5.part").read_bytes() == before
    assert main(["run", "old.yaml", "-o", "version_0_1.h5", "--overwrite", "--quiet"]) == 0


def test_a_heap_that_hdf5_cannot_walk_through(folder):
    whole = Path("version_0_1.h5").read_bytes()
    first = whole.index(b"GCOL")
    for place in range(first + 16, first + 80, 8):
        Path("version_0_1.h5").write_bytes(whole[:place] + bytes(32) + whole[place + 32 :])
        with pytest.raises(StoreError, match="damaged"):
            vs.open("version_0_1.h5")
