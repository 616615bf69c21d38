"""The gallery: short scripts, and every kind of picture and every model among them. The build of the site runs them."""

import ast
import json
import re

import pytest
from support import ROOT
from support.programs import ended

SCRIPTS = sorted((ROOT / "docs" / "gallery").rglob("plot_*.py"))
MOST_LINES = 30
BY_DEFAULT = {  # kinds that a script need not name, for they are those of what it sweeps
    "bifurcation": '"b": {',
    "plane": '"omega": {"start": 0.5, "stop": 1.1',
    "basins": '"v1": {',
}


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_a_title_what_is_seen_and_short_code(path):
    text = path.read_text()
    title, underline, empty, *seen = ast.get_docstring(ast.parse(text)).splitlines()
    assert title and underline == "=" * len(title) and not empty and seen
    code = text.split('"""', 2)[2].strip().splitlines()
    assert 0 < len([line for line in code if line.strip()]) <= MOST_LINES
    assert "plot" in code[-1] or code[-1] == "plt.show()"


def test_each_kind_of_picture_and_each_model():
    schema = json.loads(ended("schema").out)
    kinds, models = words(schema, "picture"), words(schema, "type")
    assert len(kinds) > 10 and len(models) > 4
    text = "".join(path.read_text() for path in SCRIPTS)
    assert [kind for kind in kinds if f'"{kind}"' not in text and BY_DEFAULT.get(kind, "\0") not in text] == []
    assert [model for model in models - {"two_mass", "linear", "build"} if f'"{model}"' not in text] == []
    assert "vs.System(" in text and re.search(r"vs\.Oscillator\(\s*M=", text)
    assert len(SCRIPTS) >= 25


def words(schema, key: str) -> set[str]:
    """All that a key may be, wherever it stands in the schema."""
    if isinstance(schema, list):
        return set().union(*(words(inner, key) for inner in schema))
    if not isinstance(schema, dict):
        return set()
    there = schema.get("properties", {}).get(key, {})
    options = there.get("anyOf", there.get("oneOf", [there]))
    here = {word for option in options for word in (*option.get("enum", []), option.get("const")) if word}
    return here.union(*(words(inner, key) for inner in schema.values()))
