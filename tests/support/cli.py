"""A small scene for the command line, and commands that are refused."""

import pytest

from support.contents import bytes_in
from support.programs import main

NUMBERS = dict(mu_m="10", mu_k="5", zeta="0.05", f2="0", omega="0.63", R="0.8", b="6.6")


def scene(more="", orbit="{transient: 2, record: 3}", **changes):
    """The text of a good scene with some of the system's numbers changed (None: left out) and lines added."""
    numbers = ", ".join(f"{key}: {value}" for key, value in (NUMBERS | changes).items() if value is not None)
    return f"system: {{{numbers}}}\norbit: {orbit}\n{more}\n"


@pytest.fixture
def scene_folder(tmp_path, monkeypatch):
    """An empty current folder with a good scene in it."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "good.yaml").write_text(scene("sweep: {b: {values: [6.5, 6.6, 6.7]}}"))
    return tmp_path


def assert_refused(capsys, folder, arguments, words):
    before = bytes_in(folder)
    assert main(arguments) == 2
    captured = capsys.readouterr()
    for word in words:
        assert word in captured.err
    assert captured.out == ""
    assert captured.err.lower().count("error:") == 1 and "Traceback" not in captured.err
    assert bytes_in(folder) == before
