"""Values of every kind that a caller may give for an argument, by name; each is made anew when it is asked for."""

import array
import collections
import datetime
import decimal
import enum
import fractions
import functools
import itertools
import pathlib
import types
from collections.abc import Callable

import numpy as np
import pandas as pd
import xarray as xr

NAN, INF = float("nan"), float("inf")


class Word(str):
    """A word, but not of Python's own type."""


class Colour(enum.Enum):
    RED = 1


def _odd(**methods) -> object:
    return type("Odd", (), {name: staticmethod(method) for name, method in methods.items()})()


def _raising(error: type[Exception]) -> Callable:
    def method(*_, **__):
        raise error("odd")

    return method


class Everything:
    """Has every attribute, and each is itself."""

    def __getattr__(self, name):
        return self


class Unequal:
    def __eq__(self, other):
        raise RuntimeError("odd")

    def __hash__(self):
        raise RuntimeError("odd")


class Elementwise:
    def __eq__(self, other):
        return np.array([True, False])

    __hash__ = None


def _in_itself(kind: type) -> object:
    one = kind()
    if kind is dict:
        one["b"] = one
    else:
        one.append(one)
    return one


def _array_in_itself() -> np.ndarray:
    one = np.empty(2, object)
    one[:] = [one, one]
    return one


def _number_in_itself() -> np.ndarray:
    one = np.empty((), object)
    one[()] = one
    return one


def _deep(levels: int) -> list:
    one: list = []
    for _ in range(levels):
        one = [one]
    return one


def _frozen() -> np.ndarray:
    one = np.arange(4.0)
    one.flags.writeable = False
    return one


PLAIN = [
    None, True, False, 0, 1, 2, 3, -1, 10**13, 10**400, -(10**400), 10**5000, 0.0, -0.0, 0.5, 1.5, -1.0, 6.6, 1e300,
    -1e300, 1e-300, 5e-324, NAN, INF, -INF, 1j, 1 + 0j, "", "x", "b", "both", "grazing", "new", "section", "LR", "1",
    "nan", "a b", "é", "x\n", "..", ".", "/", "none.h5", "nodir/x.h5", "x" * 5000, "x/" * 3000, "a\0b", "\ud800",
    "LR" * 4, b"", b"x", b"LR", b"1234", Ellipsis, NotImplemented, np.int8(1), np.uint64(2**64 - 1), np.float16(0.5),
    np.float32(6.6), np.longdouble(1), np.longdouble("1e4000"), np.bool_(True), np.complex128(1), np.str_("b"),
    np.bytes_(b"b"), np.datetime64("2026-01-01"), np.timedelta64(1, "s"), decimal.Decimal("6.6"),
    decimal.Decimal("NaN"),
    fractions.Fraction(1, 2), datetime.timedelta(1), Colour.RED, Word("b"), Word("new"), Word("x" * 5000),
    pathlib.Path("none.h5"), pathlib.Path("."), pathlib.Path("a\0b"), pathlib.Path("x" * 300), (), (0,) * 4, (1, 2),
    ("b", "R"), (0, (1, 2), 0, 0), (6.5, 6.7), ((6, 7), (0.6, 0.7)), range(4), range(10**9), range(10**30),
    np.ma.masked,
    pd.NA, pd.Timestamp("2026-01-01"), object, type, int, list, xr.Dataset, np.ndarray, len, types, Word,
]  # fmt: skip

MADE: dict[str, Callable[[], object]] = {
    "empty list": list,
    "one number": lambda: [0.0],
    "four numbers": lambda: [0.0, 0, np.float32(0), np.int8(0)],
    "four truth values": lambda: [True] * 4,
    "four nan": lambda: [NAN] * 4,
    "huge integers": lambda: [10**400] * 4,
    "numbers as words": lambda: ["0", "0", "0", "0"],
    "two words": lambda: ["b", "R"],
    "word in a list": lambda: ["section"],
    "long words": lambda: ["x" * 5000] * 100,
    "million words": lambda: {"b": ["x"] * 10**6},
    "nothing in a list": lambda: [None],
    "empty rows": lambda: [[], []],
    "rows": lambda: [[1.0, 0.0], [0.0, 1.0]],
    "impacts": lambda: [(0.0, 1, 1.0)],
    "ragged": lambda: [[0.0], [0.0, 1.0]],
    "ragged deeper": lambda: [[[0.0], 1.0], [2.0]],
    "list in itself": lambda: _in_itself(list),
    "dict in itself": lambda: _in_itself(dict),
    "array in itself": _array_in_itself,
    "array without dimension in itself": _number_in_itself,
    "odd signature": lambda: type("Odd", (), {"__signature__": 3, "__call__": lambda *_, **__: None})(),
    "deque in itself": lambda: _in_itself(collections.deque),
    "deep": lambda: _deep(20_000),
    "long list": lambda: [0.0] * 100_000,
    "list of arrays": lambda: [np.zeros(2), np.ones(2)],
    "list of masked": lambda: [np.ma.masked] * 4,
    "list of ranges": lambda: [range(10**9)] * 4,
    "list of odd": lambda: [Unequal()] * 4,
    "bytearray": lambda: bytearray(4),
    "memoryview": lambda: memoryview(b"1234"),
    "view of floats": lambda: memoryview(array.array("d", [0, 0, 0, 0])),
    "array.array": lambda: array.array("d", [0, 0, 0, 0]),
    "deque": lambda: collections.deque([0.0, 0, 0, 0]),
    "UserList": lambda: collections.UserList([0.0, 0, 0, 0]),
    "UserString": lambda: collections.UserString("b"),
    "generator": lambda: (float(i) for i in range(4)),
    "endless": itertools.count,
    "endless words": lambda: itertools.repeat("section"),
    "zip": lambda: zip((1, 2), (3, 4), strict=True),
    "set": lambda: {6.5, 6.6},
    "set of words": lambda: {"section"},
    "frozenset": lambda: frozenset({"b"}),
    "empty dict": dict,
    "dict of a number": lambda: {"b": 6.6},
    "dict of values": lambda: {"b": [6.5, 6.6]},
    "dict of numbers": lambda: {1: 2, (3, 4): 5},
    "dict of an array": lambda: {"b": np.array([6.5, NAN])},
    "dict of words": lambda: {"b": "x" * 5000},
    "dict with a long name": lambda: {"x" * 5000: 1.0},
    "dict with odd names": lambda: {"\ud800": 1.0, "a\0b": 2.0},
    "dict of what is in itself": lambda: {"b": _in_itself(list)},
    "dict of masked": lambda: {"b": np.ma.masked_greater([6.5, 6.6], 6.55)},
    "dict of kind": lambda: {"kind": np.array(["phase", "impact"])},
    "mapping proxy": lambda: types.MappingProxyType({"b": [6.5]}),
    "counter": lambda: collections.Counter("bbR"),
    "array of nothing": lambda: np.zeros(0),
    "array of one": lambda: np.zeros(1),
    "array of two": lambda: np.array([6.5, 6.7]),
    "array of four": lambda: np.zeros(4),
    "square": lambda: np.eye(2),
    "row of four": lambda: np.zeros((1, 4)),
    "no rows of four": lambda: np.zeros((0, 4)),
    "cube": lambda: np.zeros((4, 4, 4)),
    "small integers": lambda: np.ones(4, np.int8),
    "halves": lambda: np.zeros(4, np.float16),
    "complex array": lambda: np.zeros(4, complex),
    "truth array": lambda: np.ones(4, bool),
    "objects": lambda: np.array([0.0, 1, None, "x"], object),
    "object numbers": lambda: np.array([0.0, 0.0, 0.0, 0.0], object),
    "words": lambda: np.array(["both", "right"]),
    "one word in an array": lambda: np.array(["b"]),
    "word without dimension": lambda: np.array("b"),
    "number without dimension": lambda: np.array(1.0),
    "nan without dimension": lambda: np.array(NAN),
    "nothing without dimension": lambda: np.array(None),
    "byte words": lambda: np.array([b"both", b"right"]),
    "structured": lambda: np.zeros(4, [("t", float), ("side", np.int8)]),
    "dates": lambda: np.array(["2026-01-01"], "datetime64[D]"),
    "million": lambda: np.zeros(10**6),
    "every other": lambda: np.zeros(8)[::2],
    "backwards": lambda: np.arange(4.0)[::-1],
    "frozen": _frozen,
    "nan array": lambda: np.full(4, NAN),
    "infinite array": lambda: np.full(4, INF),
    "matrix": lambda: np.eye(2).view(np.matrix),
    "masked": lambda: np.ma.masked_equal([0.0, 1.0, 2.0, 3.0], 1.0),
    "masked, nothing masked": lambda: np.ma.array([0.0, 0.0, 0.0, 0.0]),
    "masked square": lambda: np.ma.masked_equal(np.eye(2), 0.0),
    "masked number": lambda: np.ma.array(1.0, mask=True),
    "DataArray": lambda: xr.DataArray([6.5, 6.6], dims="b"),
    "DataArray of four": lambda: xr.DataArray(np.zeros(4)),
    "DataArray of one number": lambda: xr.DataArray(6.6),
    "DataArray of words": lambda: xr.DataArray(["b", "R"]),
    "Dataset": xr.Dataset,
    "Dataset of another": lambda: xr.Dataset({"status": ("x", [1, 2])}),
    "Series": lambda: pd.Series([6.5, 6.6]),
    "Series with a hole": lambda: pd.Series([6.5, None], dtype="Float64"),
    "DataFrame": lambda: pd.DataFrame({"b": [6.5, 6.6]}),
    "Index": lambda: pd.Index([6.5, 6.6]),
    "object": object,
    "lambda": lambda: lambda: None,
    "function of one": lambda: lambda x: x,
    "function of anything": lambda: lambda *_, **__: None,
    "partial": lambda: functools.partial(lambda x: x, 1),
    "error": lambda: ValueError("x"),
    "namespace": types.SimpleNamespace,
    "has everything": Everything,
    "odd __eq__": Unequal,
    "elementwise __eq__": Elementwise,
    "odd __repr__": lambda: _odd(__repr__=_raising(RuntimeError)),
    "no text as __repr__": lambda: _odd(__repr__=lambda: 3),
    "long __repr__": lambda: _odd(__repr__=lambda: "x" * 10**6),
    "odd __str__": lambda: _odd(__str__=_raising(RuntimeError)),
    "odd __len__": lambda: _odd(__len__=_raising(RuntimeError), __getitem__=_raising(RuntimeError)),
    "negative __len__": lambda: _odd(__len__=lambda: -1, __getitem__=lambda i: i),
    "endless by __getitem__": lambda: _odd(__getitem__=lambda i: 0.0),
    "odd __iter__": lambda: _odd(__iter__=_raising(RuntimeError)),
    "odd __bool__": lambda: _odd(__bool__=_raising(RuntimeError)),
    "odd __hash__": lambda: _odd(__hash__=_raising(RuntimeError)),
    "odd __float__": lambda: _odd(__float__=lambda: 1.0, __index__=lambda: 1),
    "odd __array__": lambda: _odd(__array__=_raising(RuntimeError)),
    "__array__ of no array": lambda: _odd(__array__=lambda *_, **__: "x"),
    "__array__ of words": lambda: _odd(__array__=lambda *_, **__: np.array(["b"])),
    "__array__ of masked": lambda: _odd(__array__=lambda *_, **__: np.ma.masked_equal([0.0, 1, 2, 3], 1)),
    "__array__ of four": lambda: _odd(__array__=lambda *_, **__: np.zeros(4)),
    "__fspath__": lambda: _odd(__fspath__=lambda: "none.h5"),
    "odd __fspath__": lambda: _odd(__fspath__=_raising(RuntimeError)),
    "class of numbers": lambda: np.float64,
    "method": lambda: [].append,
}


def _named(value: object, place: int) -> str:
    return f"{place}: {type(value).__name__}"


VALUES: dict[str, Callable[[], object]] = {
    **{_named(value, place): functools.partial(lambda value: value, value) for place, value in enumerate(PLAIN)},
    **MADE,
}
