"""What a prompt says by itself: that kernels compile, and warnings; unless logging takes it, or silences it."""

import subprocess
import sys

import pytest
from support import slow_cases
from support.oscillators import PAPER_NUMBERS
from support.programs import on_a_terminal

MESSAGE = "compiling kernels, once: they are kept in FOLDER\n"
COMPILE = f"logging.getLogger('vibro_sweep').info({MESSAGE.strip()!r})"  # as the compiler says it
WARN = "logging.getLogger('vibro_sweep').warning('beware')"
WORKER = f"""
import logging, multiprocessing
def work():
    import vibro_sweep
    {COMPILE}
if __name__ == "__main__":
    one = multiprocessing.get_context("spawn").Process(target=work)
    one.start(), one.join()
"""


def told(tmp_path, program: str) -> str:
    file = tmp_path / "program.py"
    file.write_text(program)
    done = subprocess.run([sys.executable, file], capture_output=True, text=True, check=True, timeout=120)
    assert not done.stdout
    return done.stderr


@pytest.mark.slow
@pytest.mark.parametrize(
    "before, expected",
    [
        ("", f"vibro-sweep: {MESSAGE}vibro-sweep: warning: beware\n"),
        *slow_cases(
            ("logging.basicConfig(format='of mine: %(message)s')", f"of mine: {MESSAGE}of mine: beware\n"),
            ("logging.getLogger('vibro_sweep').setLevel(logging.WARNING)", "vibro-sweep: warning: beware\n"),
            ("logging.getLogger('vibro_sweep').setLevel(logging.CRITICAL)", ""),
            ("logging.getLogger('vibro_sweep').addHandler(logging.NullHandler())", ""),
        ),
    ],
)
def test_it_is_said_once_and_can_be_silenced(tmp_path, before, expected):
    for first, second in (("import vibro_sweep", before), (before, "import vibro_sweep")):
        assert told(tmp_path, f"import logging\n{first}\n{second}\n{COMPILE}\n{WARN}\n") == expected


def test_processes_that_python_starts_say_nothing(tmp_path):
    assert told(tmp_path, WORKER) == ""


SWEEP = f"""
import numpy as np, vibro_sweep as vs
system = vs.System({PAPER_NUMBERS.replace(": ", "=")}, b=6.6)
vs.sweep(system, dict(b=np.linspace(6, 7, 50)), observe=["section"], transient=5, record=5, PROGRESS)
"""
SILENT = "import logging; logging.getLogger('vibro_sweep').setLevel(logging.WARNING)"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("before", "progress", "bar"),
    [("", "", True), (SILENT, "", False), ("", "progress=lambda done, total: None", False)],
)
def test_a_bar_on_a_terminal(tmp_path, before, progress, bar):
    file = tmp_path / "program.py"
    file.write_text(before + SWEEP.replace("PROGRESS", progress))
    shown = on_a_terminal(file)
    assert (b"50/50" in shown) == bar == (b"orbits/s" in shown), shown
