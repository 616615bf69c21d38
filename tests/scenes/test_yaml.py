"""Values of a scene are read as the core schema of YAML 1.2 says: numbers, and what is refused as none."""

import pytest
from support.oscillators import PAPER_NUMBERS
from support.scene_texts import parsed
from support.yaml_core import read

import vibro_sweep as vs

NUMBERS = {
    "1e-9": 1e-9,
    "1E5": 1e5,
    "-.5": -0.5,
    "6.": 6.0,
    "+12e03": 12000.0,
    "010": 10,
    "0x1F": 31,
    "0o17": 15,
    "-3": -3,
}
NONE = {  # its text in the message
    ".inf": ".inf",
    "true": "true",
    "False": "false",
    "~": "null",
    "": "null",
    "no": '"no"',
    "1_000": '"1_000"',
    "12:30": '"12:30"',
    "2020-01-01": '"2020-01-01"',
    "'1e-9'": '"1e-9"',
    "1e": '"1e"',
    "tRue": '"tRue"',
}


def offset(text: str) -> float:
    """What a scene reads this value as."""
    return parsed(
        f"system: {{{PAPER_NUMBERS}, b: 6.6, offset: {text}}}\norbit: {{transient: 3, record: 4}}"
    ).system.offset


@pytest.mark.parametrize("text, value", NUMBERS.items())
def test_numbers(text, value):
    assert offset(text) == value == read(text)


@pytest.mark.parametrize("text, words", NONE.items())
def test_what_is_no_number(text, words):
    with pytest.raises(vs.SceneError) as caught:
        offset(text)
    (problem,) = caught.value.problems
    assert problem.startswith(f"system.offset = {words}: must be a ")


@pytest.mark.parametrize("text", [*NUMBERS, *NONE])
def test_types_are_those_of_the_core_schema(text):
    """As the loader of the tests reads it, with which random scenes are held against the schema."""
    value = read(f"a: {text}")["a"]
    if text in NUMBERS:
        assert type(value) is (int if text in ("010", "0x1F", "0o17", "-3") else float)
    else:
        shown = {float: ".inf", bool: str(value).lower(), type(None): "null"}.get(type(value), f'"{value}"')
        assert shown == NONE[text]
