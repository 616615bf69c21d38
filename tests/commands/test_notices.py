"""What a prompt says by itself: that kernels compile, and warnings; unless logging takes it, or silences it."""

import re
import subprocess
import sys
from types import SimpleNamespace

import pytest
from support import slow_cases
from support.oscillators import PAPER_NUMBERS
from support.programs import on_a_terminal

from vibro_sweep.driver import notebook_bar, progress

COMPILE = "from vibro_sweep.engine.simd import jit; jit._announce('FOLDER')"
MESSAGE = "compiling kernels, once: they are kept in FOLDER\n"
WARN = "logging.getLogger('vibro_sweep').warning('beware')"
WORKER = f"""
import multiprocessing
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
        ("", f"vibro_sweep: {MESSAGE}vibro_sweep: warning: beware\n"),
        *slow_cases(
            ("logging.basicConfig(format='of mine: %(message)s')", f"of mine: {MESSAGE}of mine: beware\n"),
            ("logging.getLogger('vibro_sweep').setLevel(logging.WARNING)", "vibro_sweep: warning: beware\n"),
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
    assert (b"50/50" in shown) == bar == (b"points" in shown), shown


class Shown:
    """What a notebook shows, as IPython.display changes it."""

    def __init__(self):
        self.texts = []
        self.HTML = str

    def display(self, text, display_id):
        assert display_id
        self.texts.append(text)
        return SimpleNamespace(update=self.texts.append)


def in_a_shell(monkeypatch, name):
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=type(name, (), {})))
    monkeypatch.setitem(sys.modules, "IPython.display", shown := Shown())
    return shown.texts


@pytest.mark.parametrize("slow", [True, False])
def test_a_bar_in_notebooks_of_what_takes_long(monkeypatch, slow):
    texts, times = in_a_shell(monkeypatch, "ZMQInteractiveShell"), iter(range(0, 100, 10 if slow else 1))
    monkeypatch.setattr(notebook_bar.time, "monotonic", lambda: next(times) / (1 if slow else 10))
    with progress.progress_bar(4, quiet=False) as show:
        for done in range(5):
            show(done, 4)
    lengths = [int(re.search(r'value="(\d+)" max="400"', text)[1]) for text in texts[:-1]]
    assert lengths == ([100, 200, 300, 400] if slow else [])
    assert texts[-1:] == ([""] if slow else [])
    assert not slow or "2 of 4 points, 0:30 left" in texts[1]


def test_no_bar_where_nobody_looks(monkeypatch):
    in_a_shell(monkeypatch, "TerminalInteractiveShell")
    with progress.progress_bar(4, quiet=False) as show:
        assert show is None
    in_a_shell(monkeypatch, "ZMQInteractiveShell")
    with progress.progress_bar(4, quiet=True) as show:
        assert show is None
