"""Each public name shows an example in its docstring, and each example gives what it shows."""

import doctest
import inspect
import re

import pytest
from support import ROOT

import vibro_sweep as vs
from vibro_sweep import types

PUBLIC = {f"vibro_sweep.{name}": getattr(vs, name) for name in vs.__all__}
PUBLIC |= {f"vibro_sweep.types.{name}": getattr(types, name) for name in types.__all__}


def with_methods():
    """The public names, and methods that have an example."""
    for name, public in PUBLIC.items():
        yield name, public
        if inspect.isclass(public):
            for method, value in vars(public).items():
                function = getattr(value, "__func__", getattr(value, "fget", None) or getattr(value, "func", value))
                if not method.startswith("_") and ">>> " in (inspect.getdoc(function) or ""):
                    yield f"{name}.{method}", function


def examples_of(value):
    return doctest.DocTestParser().get_examples(inspect.getdoc(value))


def test_each_public_name_has_an_example():
    named = dict(with_methods())
    assert len(named) > 50 and [name for name, value in named.items() if not examples_of(value)] == []


@pytest.mark.slow  # their kernels are compiled once, for all of them
def test_the_examples_give_what_they_show(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shown, tried = [], 0
    for name, value in with_methods():
        test = doctest.DocTest(examples_of(value), {}, name, None, None, None)
        tried += doctest.DocTestRunner(verbose=False).run(test, out=shown.append).attempted
    assert shown == [] and tried > 150


def test_the_reference_lists_every_public_name():
    text = (ROOT / "docs" / "reference" / "api.md").read_text()
    blocks = re.findall(r"currentmodule:: (\S+)\n.*?:nosignatures:\n\n(.*?)```", text, re.DOTALL)
    assert sorted(f"{module}.{name}" for module, names in blocks for name in names.split()) == sorted(PUBLIC)
