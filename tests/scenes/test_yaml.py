"""Values of a scene are read as the core schema of YAML 1.2 says."""

import pytest

from vibro_sweep.scene.yaml_text import read_yaml


@pytest.mark.parametrize(
    "text, value",
    [
        ("1e-9", 1e-9),
        ("1E5", 1e5),
        ("-.5", -0.5),
        ("6.", 6.0),
        ("+12e03", 12000.0),
        (".inf", float("inf")),
        ("010", 10),
        ("0x1F", 31),
        ("0o17", 15),
        ("-3", -3),
        ("true", True),
        ("False", False),
        ("~", None),
        ("", None),
        ("no", "no"),
        ("1_000", "1_000"),
        ("12:30", "12:30"),
        ("2020-01-01", "2020-01-01"),
        ("'1e-9'", "1e-9"),
        ("1e", "1e"),
        ("tRue", "tRue"),
    ],
)
def test_core_schema_of_yaml_1_2(text, value):
    read = read_yaml(f"a: {text}")["a"]
    assert read == value and type(read) is type(value)
