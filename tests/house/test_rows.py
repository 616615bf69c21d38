"""Tables of cases are read as they are written: groups, ids, and which rows are slow."""

import pytest
from support import cases, sample

TABLE = """
- {id: first, value: 1}
- why: two of a kind
  value: 2
  rows:
  - {id: second}
  - {value: 3, slow: true}
- {id: last, value: 4}
"""


@pytest.fixture
def rows(tmp_path):
    (tmp_path / "table.yaml").write_text(TABLE)
    return lambda sample=None: cases.rows("table", sample, tmp_path)


def slow(params):
    return [param.id for param in params if param.marks]


def test_a_group_gives_its_rows_what_they_do_not_have(rows):
    found = [param.values for param in rows()]
    assert found == [
        ({"id": "first", "value": 1},),
        ({"id": "second", "value": 2, "why": "two of a kind"},),
        ({"id": "3", "value": 3, "why": "two of a kind", "slow": True},),
        ({"id": "last", "value": 4},),
    ]
    assert [param.id for param in rows()] == ["first", "second", "3", "last"]


def test_slow_are_rows_that_say_so_and_those_out_of_the_sample(rows):
    assert slow(rows()) == ["3"]
    assert slow(rows(2)) == ["second", "3", "last"]
    assert slow(rows(4)) == slow(rows(9)) == ["3"]
    assert {mark.name for param in rows(1) for mark in param.marks} == {"slow"}


def test_an_id_that_is_given_twice_is_an_error():
    with pytest.raises(ValueError, match="'first'"):
        cases.read(TABLE.replace("last", "first"))


@pytest.mark.parametrize("n, fast", [(0, []), (1, [0]), (2, [0, 2]), (3, [0, 1, 3]), (5, [0, 1, 2, 3, 4])])
def test_a_sample_is_spread_over_all_cases(n, fast):
    params = sample(n, [1, (2, 3), "four", {}, None])
    assert [param.values for param in params] == [(1,), (2, 3), ("four",), ({},), (None,)]
    assert [k for k, param in enumerate(params) if not param.marks] == fast
