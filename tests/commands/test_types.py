"""Every class of the package that stands in an annotation of a public function, or of what it returns, has a place."""

import functools
import inspect
import typing

import matplotlib.animation
import matplotlib.axes
import matplotlib.figure
import numpy as np
import pandas
import xarray

import vibro_sweep as vs

KNOWN = {"pandas": pandas, "xarray": xarray, "np": np, "Axes": matplotlib.axes.Axes, "Figure": matplotlib.figure.Figure}
KNOWN["FuncAnimation"] = matplotlib.animation.FuncAnimation
DESCRIBED = {"Model", "Option", "Parameter", "Range"}  # how models describe themselves: nothing that functions take


def classes_in(annotation) -> set[type]:
    own = isinstance(annotation, type) and annotation.__module__.startswith("vibro_sweep")
    found = {annotation} if own else set()
    return found.union(*(classes_in(one) for one in typing.get_args(annotation)))


def annotated(function) -> set[type]:
    known = KNOWN | {name: getattr(vs.types, name) for name in vs.types.__all__}
    hints = typing.get_type_hints(function, known | vars(inspect.getmodule(function)))
    return set().union(*(classes_in(one) for one in hints.values()))


def members(kind: type) -> list:
    """The functions behind public methods and properties."""
    found = [one for name, one in vars(kind).items() if not name.startswith("_")]
    plain = [one.fget if isinstance(one, property) else one for one in found]
    plain = [one.func if isinstance(one, functools.cached_property) else one for one in plain]
    return [one for one in plain if inspect.isfunction(one)]


def test_every_class_in_an_annotation_has_a_place():
    functions = [one for one in (getattr(vs, name) for name in vs.__all__) if not isinstance(one, type)]
    assert len(functions) > 15
    todo, seen = set().union(*map(annotated, functions)), set()
    while todo:
        kind = todo.pop()
        seen.add(kind)
        todo |= set().union(*map(annotated, members(kind))) - seen
    places = {getattr(vs, name) for name in vs.__all__} | {getattr(vs.types, name) for name in vs.types.__all__}
    assert {kind.__name__ for kind in seen - places} <= DESCRIBED
    assert {"Branch", "PeriodicOrbit", "Windows", "Scene", "RunReport"} <= {kind.__name__ for kind in seen}


def test_names_are_sorted_and_there():
    assert vs.types.__all__ == sorted(vs.types.__all__)
    assert all(isinstance(getattr(vs.types, name), type) for name in vs.types.__all__)
