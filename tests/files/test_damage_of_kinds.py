"""What is said of damaged and edited files: the dataset, the attribute, the place, and long texts cut short."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from support import slow_cases
from support.changes import bit_in, with_numbers
from support.file_commands import DAMAGED, REFUSED, opened, plotted_dataset, said
from support.kinds_of_files import KINDS, PERIODIC, RAGGED

import vibro_sweep as vs


@pytest.mark.parametrize("name", ["windows", *slow_cases(*(name for name in KINDS if name != "windows"))])
def test_a_flipped_bit_names_the_file(kinds, tmp_path, monkeypatch, name):
    """In the last dataset; of a sweep the dataset is named as well."""
    monkeypatch.chdir(tmp_path)
    shutil.copy(kinds(name), "x.h5")
    chosen = with_numbers(Path("x.h5"))[-1]
    bit_in(chosen)(Path("x.h5"), np.random.default_rng(1))
    words = "structure" if name in RAGGED else chosen
    for answer in (said(["info", "x.h5"]), opened("x.h5"), plotted_dataset("x.h5")):
        assert answer.outcome in (REFUSED, DAMAGED) and "x.h5" in answer.message and words in answer.message


def test_a_changed_digit_of_a_periodic_orbit(kinds, tmp_path):
    """Each digit of its impacts, one after the other."""
    text, path = kinds(PERIODIC).read_text(), tmp_path / "x.json"
    begin, end = text.index("unknowns"), text.index("residual")
    places = [i for i in range(begin, end) if text[i].isdigit()]
    for i in places[:: len(places) // 20]:
        changed = text[:i] + str((int(text[i]) + 1) % 10) + text[i + 1 :]
        if json.loads(changed) == json.loads(text):  # the last of seventeen digits
            continue
        path.write_text(changed)
        with pytest.raises(ValueError, match=r"x\.json: damaged: its "):
            vs.load(path)
