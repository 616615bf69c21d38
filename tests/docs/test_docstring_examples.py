"""Each public name shows an example in its docstring, and each example gives what it shows."""

import doctest
import inspect
import re

import pytest
from support import ROOT, sample

import vibro_sweep as vs
from vibro_sweep import types

PUBLIC = {f"vibro_sweep.{name}": getattr(vs, name) for name in vs.__all__}
PUBLIC |= {f"vibro_sweep.types.{name}": getattr(types, name) for name in types.__all__}


def with_methods():
    """The public names, and methods that have an example."""
    for name, one in PUBLIC.items():
        yield name, one
        if inspect.isclass(one):
            for method, value in vars(one).items():
                function = getattr(value, "__func__", getattr(value, "fget", None) or getattr(value, "func", value))
                if not method.startswith("_") and ">>> " in (inspect.getdoc(function) or ""):
                    yield f"{name}.{method}", function


@pytest.mark.parametrize("name, one", sample(12, [*with_methods()]))
def test_an_example_gives_what_it_shows(name, one, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    examples = doctest.DocTestParser().get_examples(inspect.getdoc(one))
    assert examples, f"{name}: no example"
    shown = []
    test = doctest.DocTest(examples, {}, name, None, None, None)
    result = doctest.DocTestRunner().run(test, out=shown.append)
    assert result.failed == 0 and result.attempted, "".join(shown)


def test_the_reference_lists_every_public_name():
    text = (ROOT / "docs" / "reference" / "api.md").read_text()
    blocks = re.findall(r"currentmodule:: (\S+)\n.*?:nosignatures:\n\n(.*?)```", text, re.DOTALL)
    assert sorted(f"{module}.{name}" for module, names in blocks for name in names.split()) == sorted(PUBLIC)
