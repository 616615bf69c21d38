"""The program as a process: closed and full streams, Ctrl-C twice, bugs, and what it says before it takes time."""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import h5py
import pytest
from support import slow_cases
from support.oscillators import PAPER_NUMBERS
from support.programs import main

SCENE = f"system: {{{PAPER_NUMBERS}, b: 6.6}}\n"
SHORT = SCENE + "sweep: {b: {values: [6.5, 6.6, 6.7]}}\norbit: {transient: 2, record: 3}\n"
PROGRAM = [sys.executable, "-m", "vibro_sweep"]
LIMIT = 60


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "good.yaml").write_text(SHORT)
    return tmp_path


def shell(command):
    text = command.replace("vibro-sweep", f"{sys.executable} -m vibro_sweep")
    return subprocess.run(["bash", "-c", text], capture_output=True, text=True, timeout=LIMIT, check=False)


@pytest.mark.parametrize("closed", slow_cases(">&- 2>&- <&-", "2>&-", ">&-", "<&-"))
def test_closed_streams(folder, closed):
    """And no message of a library can reach the data file by the number of a closed stream."""
    done = shell(f"vibro-sweep run good.yaml {closed}")
    assert done.returncode == 0
    with h5py.File("good.h5") as file:
        assert (file["status"][()] == 0).all()


@pytest.mark.parametrize(
    "command", ["--help", *slow_cases("run good.yaml", "check good.yaml", "grazing good.yaml", "schema", "--version")]
)
def test_a_full_disk_at_stdout(folder, command):
    done = shell(f"vibro-sweep {command} > /dev/full")
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1 and "No space left on device" in done.stderr
    assert (folder / "good.h5").exists() == command.startswith("run")


def test_a_reader_that_has_read_enough(folder):
    done = shell("vibro-sweep schema | head -1; echo ${PIPESTATUS[0]}")
    assert done.stdout.splitlines() == ["{", "0"] and done.stderr == ""


@pytest.mark.slow
def test_ctrl_c_twice(folder):
    (folder / "long.yaml").write_text(SCENE + "orbit: {transient: 1.0e+9, record: 1}\n")
    process = subprocess.Popen([*PROGRAM, "run", "long.yaml"], stderr=subprocess.PIPE, text=True)
    limit = time.monotonic() + LIMIT
    while not (folder / "long.h5").exists():
        assert process.poll() is None and time.monotonic() < limit
        time.sleep(0.02)
    time.sleep(1.0)
    for _ in range(20):
        process.send_signal(signal.SIGINT)
        time.sleep(0.002)
    error = process.communicate(timeout=LIMIT)[1]
    assert process.returncode == 130
    assert "interrupted; to continue: " in error.splitlines()[-1] and "Traceback" not in error


INTERRUPTING = """
import os, signal, sys, time

where = sys.argv.pop(1)

def interrupt():
    os.kill(os.getpid(), signal.SIGINT)

class AtTheImport:
    def find_spec(self, name, path=None, target=None):
        if name == where:
            interrupt()

class Destroyed:
    def __del__(self):
        interrupt()

def run_that_loses_it(*_):
    if where == "a destructor":
        Destroyed()
    else:
        try:
            interrupt()
        except BaseException:
            pass
    time.sleep(60)

sys.meta_path.insert(0, AtTheImport())
from vibro_sweep.cli import interrupt as package
from vibro_sweep.__main__ import program
if " " in where:
    from vibro_sweep.driver import run
    package.TIDYING, run.run = 0.5, run_that_loses_it
program()
"""
ADVICE = "; to continue: vibro-sweep run good.yaml -o good.h5 --resume"


@pytest.mark.parametrize(
    "where, advice",
    [
        ("typer", ""),
        ("numba", ADVICE),
        *slow_cases(
            ("a destructor", ADVICE),
            ("yaml", ADVICE),
            ("h5py", ADVICE),
            ("vibro_sweep.driver.progress", ADVICE),
            ("a handler", ADVICE),
        ),
    ],
)
def test_ctrl_c_is_never_lost(folder, where, advice):
    """Whatever the program is doing: it ends, with one message."""
    command = [sys.executable, "-c", INTERRUPTING, where, "run", "good.yaml"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT, check=False)
    assert (done.returncode, done.stderr) == (130, f"vibro-sweep: interrupted{advice}\n")
    assert not (folder / "good.h5").exists()


@pytest.mark.parametrize(
    "options, advice", [("--overwrite", "--overwrite"), *slow_cases(("--plot", "--plot --resume"))]
)
def test_after_ctrl_c_the_advice_leads_to_what_was_asked_for(folder, options, advice):
    """Before a run has begun, `--resume` would take the file that is to be overwritten for its result."""
    command = [sys.executable, "-c", INTERRUPTING, "vibro_sweep.driver.progress", "run", "good.yaml", options]
    done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT, check=False)
    assert done.stderr == f"vibro-sweep: interrupted; to continue: vibro-sweep run good.yaml -o good.h5 {advice}\n"


BEGINNING = """
import signal, sys
signal.signal(signal.SIGINT, signal.SIG_IGN)
from vibro_sweep.cli import interrupt
from vibro_sweep.__main__ import program
signal.signal(signal.SIGINT, signal.default_int_handler)
interrupt.install()
print(flush=True)
program()
"""


@pytest.mark.slow
@pytest.mark.parametrize("compiled", [True, False])
def test_ctrl_c_at_any_moment_of_the_beginning(folder, compiled):
    """While it imports, compiles and computes its first blocks."""
    (folder / "long.yaml").write_text(SCENE + "orbit: {transient: 1.0e+9, record: 1}\n")
    output = folder / "long.h5"
    count = 6 if compiled else 3
    for k in range(count):
        cache = {} if compiled else {"NUMBA_CACHE_DIR": str(folder / f"cache{k}")}
        command = [sys.executable, "-c", BEGINNING, "run", "long.yaml", "--resume"]
        process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=os.environ | cache
        )
        process.stdout.readline()
        time.sleep((4 if compiled else 12) * k / count)
        process.send_signal(signal.SIGINT)
        error = process.communicate(timeout=LIMIT)[1].splitlines()
        assert process.returncode == 130, (k, error)
        *before, last = error
        assert last.startswith("vibro-sweep: interrupted"), (k, error)
        # a quick machine has said by then that it compiles, and how long that took; other tests may compile as well
        expected = r"vibro-sweep: (compiling .*|compiled \w+ in \d+ s|another process compiles them: waiting for it)"
        assert len(set(before)) == len(before) and all(re.fullmatch(expected, line) for line in before), (k, error)
        assert not Path(f"{output}.lock").exists()


def test_a_bug_is_called_a_bug(folder, capsys, monkeypatch):
    """Status 1 says that some points are bad; a bug says that it is one, and where."""
    monkeypatch.setattr("vibro_sweep.scene.load_scene", lambda _: 1 / 0)
    assert main(["check", "good.yaml"]) == 70
    error = capsys.readouterr().err.splitlines()
    assert error[0].startswith(
        "vibro-sweep: internal error, a bug of this program; please report it: ZeroDivisionError"
    )
    assert error[1].startswith("Traceback")


def test_a_bug_in_a_block_does_not_advise_to_resume(folder, capsys, monkeypatch):
    monkeypatch.setattr("vibro_sweep.driver.compute.table_of", lambda *_, **__: 1 / 0)
    assert main(["run", "good.yaml"]) == 70
    error = capsys.readouterr().err
    assert "ZeroDivisionError" in error and "--resume" not in error


def test_memory_that_is_not_there_is_no_bug(folder, capsys, monkeypatch):
    def too_little(*_, **__):
        raise MemoryError

    monkeypatch.setattr("vibro_sweep.driver.compute.table_of", too_little)
    assert main(["run", "good.yaml"]) == 2
    assert "MemoryError" in capsys.readouterr().err


def test_help_names_every_exit_status(capsys):
    assert main(["--help"]) == 0
    text = " ".join(capsys.readouterr().out.split())
    assert all(
        status in text for status in ("0 done", "1 done, but", "2 the input", "70 an internal", "130 interrupted")
    )


def begun(folder, *options) -> subprocess.Popen:
    """A run that takes for ever."""
    (folder / "long.yaml").write_text(SHORT.replace("transient: 2", "transient: 1.0e+9"))
    command = [*PROGRAM, "run", "long.yaml", "--workers", "2", *options]
    return subprocess.Popen(command, stderr=subprocess.PIPE, text=True)


@pytest.mark.slow
def test_a_quiet_run_is_not_announced(folder):
    process = begun(folder, "--quiet")
    limit = time.monotonic() + LIMIT
    while not (folder / "long.h5").exists():
        assert process.poll() is None and time.monotonic() < limit
        time.sleep(0.02)
    time.sleep(3.0)
    process.send_signal(signal.SIGINT)
    (line,) = process.communicate(timeout=LIMIT)[1].splitlines()
    assert line.startswith("vibro-sweep: interrupted")


@pytest.mark.slow
def test_a_scene_whose_name_is_no_text(folder):
    os.rename(b"good.yaml", b"\xff\xfe.yaml")
    done = subprocess.run([*PROGRAM, "run", os.fsdecode(b"\xff\xfe.yaml")], capture_output=True, check=False)
    assert done.returncode == 0 and done.stderr == b""
    assert b"3 points" in done.stdout and os.path.exists(b"\xff\xfe.h5")
    done = subprocess.run([*PROGRAM, "info", os.fsdecode(b"\xff\xfe.h5")], capture_output=True, check=False)
    assert done.returncode == 0


@pytest.mark.parametrize("command", ["run", "check", "grazing"])
@pytest.mark.parametrize("name", ["pipe.yaml", "/dev/zero", "/dev/null"])
def test_a_scene_that_is_no_file(folder, capsys, name, command):
    os.mkfifo(folder / "pipe.yaml")
    assert main([command, name]) == 2
    assert "is not a regular file" in capsys.readouterr().err
