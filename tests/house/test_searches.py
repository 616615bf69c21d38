"""`tools.search`: every kind has its study, what is wrong of a seed is printed, and counts are those of all seeds."""

from collections import Counter
from importlib.util import module_from_spec, spec_from_file_location

import pytest
from support import ROOT
from support.searching import searched, size

SPEC = spec_from_file_location("search", ROOT / "tools" / "search.py")  # tools/ is not where tests are imported from
search = module_from_spec(SPEC)
SPEC.loader.exec_module(search)


@pytest.mark.parametrize("kind", search.KINDS)
def test_every_kind_has_its_study(kind):
    assert callable(search.study_of(kind))


def planted(seed):
    if seed == 4:
        raise ValueError("no orbit")
    return Counter(drawn=1, compared=seed), [f"seed {seed} is off"] * (seed == 2)


def test_what_is_wrong_is_printed_and_is_the_exit_status(monkeypatch, capsys):
    monkeypatch.setattr(search, "study_of", lambda kind: planted)
    assert search.main(["births", "0", "6"]) == 1
    assert capsys.readouterr().out.splitlines() == [
        "seed 2 is off",
        "seed 4 raises ValueError: no orbit",
        "births, seeds 0 to 5: 2 wrong; drawn 5, compared 11, raised 1",
    ]
    assert search.main(["births", "0", "2"]) == 0
    assert capsys.readouterr().out == "births, seeds 0 to 1: 0 wrong; drawn 2, compared 1\n"


def test_a_sample_counts_all_seeds_and_keeps_what_is_wrong():
    assert searched(planted, [1, 2, 2]) == (Counter(drawn=3, compared=5), ["seed 2 is off"] * 2)


@pytest.mark.parametrize(
    "value, name", [(0, "off up to 1"), (1.5, "off up to 2"), (10, "off up to 10"), (11, "off beyond 10")]
)
def test_sizes_are_counted_by_their_bounds(value, name):
    assert size("off", value) == name
