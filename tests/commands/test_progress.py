"""How a run says how far it is: a bar where somebody looks, a line a minute elsewhere."""

import io
import sys
from types import SimpleNamespace

import pytest

from vibro_sweep.driver import progress


class Terminal(io.StringIO):
    def isatty(self):
        return True


def in_a_shell(monkeypatch, name):
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=type(name, (), {})))


SHELLS = [("ZMQInteractiveShell", io.StringIO()), ("TerminalInteractiveShell", Terminal())]


@pytest.mark.parametrize("shell, stream", SHELLS)
def test_a_bar_where_somebody_looks(monkeypatch, shell, stream):
    in_a_shell(monkeypatch, shell)
    monkeypatch.setattr(sys, "stderr", stream)
    monkeypatch.setattr(progress, "DELAY", 0.0)
    with progress.progress_bar(quiet=False) as show:
        for done in (1000, 2000, 4000):
            show(done, 4000)
    assert "4000/4000" in stream.getvalue() and "orbits/s" in stream.getvalue()


@pytest.mark.parametrize("stream", [io.StringIO(), None])
def test_a_line_a_minute_elsewhere(monkeypatch, caplog, stream):
    """Also in a window without a standard error."""
    in_a_shell(monkeypatch, "TerminalInteractiveShell")
    monkeypatch.setattr(sys, "stderr", stream)
    times = iter((0.0, 50.0, 70.0, 70.0, 90.0, 150.0))
    monkeypatch.setattr(progress.time, "monotonic", lambda: next(times))
    with caplog.at_level("INFO", "vibro_sweep"), progress.progress_bar(quiet=False) as show:
        for done in (1000, 2000, 3000, 4000):
            show(done, 4000)
    assert caplog.messages == ["2,000 of 4,000"]


def test_nothing_where_it_is_not_wanted(monkeypatch):
    in_a_shell(monkeypatch, "ZMQInteractiveShell")
    with progress.progress_bar(quiet=True) as show:
        assert show is None
