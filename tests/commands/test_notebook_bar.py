"""The bar of a run in a notebook, by a shell and a clock that the test makes."""

import re
import sys
from types import SimpleNamespace

import pytest

from vibro_sweep.driver import notebook_bar, progress


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


def test_a_line_a_minute_where_no_bar_can_be_drawn(monkeypatch, caplog):
    in_a_shell(monkeypatch, "TerminalInteractiveShell")
    times = iter((0.0, 50.0, 70.0, 70.0, 90.0, 150.0))
    monkeypatch.setattr(progress.time, "monotonic", lambda: next(times))
    with caplog.at_level("INFO", "vibro_sweep"), progress.progress_bar(4000, quiet=False) as show:
        for done in (1000, 2000, 3000, 4000):
            show(done, 4000)
    assert caplog.messages == ["2,000 of 4,000"]


def test_no_bar_where_it_is_not_wanted(monkeypatch):
    in_a_shell(monkeypatch, "ZMQInteractiveShell")
    with progress.progress_bar(4, quiet=True) as show:
        assert show is None
