"""Arguments of the Python functions, checked: what is wrong is named before anything is computed or opened."""

import functools
import inspect
from collections.abc import Callable, Collection
from typing import Any, TypeVar, overload

import numpy as np

from vibro_sweep.checks.errors import ArgumentError, ArgumentTypeError
from vibro_sweep.checks.meant import did_you_mean, meant
from vibro_sweep.checks.not_computed import why_not_computed
from vibro_sweep.checks.real import array_of, number_of
from vibro_sweep.checks.refusals import cut, not_allowed

MAX_COUNT = 10**12  # periods
F = TypeVar("F", bound=Callable)
LATEST = 10**9  # forcing periods from t = 0; a time then resolves a millionth of one


def is_number(value) -> bool:
    """Whether this is one real number, of Python's or NumPy's."""
    return number_of(value) is not None


def checked_times(times, first: float, last: float, allowed: str) -> np.ndarray:
    """Times (m,) from first to last, of one number or of a sequence of them. ValueError; `allowed` says so in words."""
    values = array_of(times, 1)
    if values is None and is_number(times):
        values = np.array([number_of(times)])
    if values is None:
        raise ArgumentError(not_allowed("times", times, "a number or a sequence of numbers"))
    outside = ~((values >= first) & (values <= last))
    if outside.any():
        raise ArgumentError(not_allowed("times", float(values[outside][0]), allowed))
    return values


def checked_interval(name: str, bounds, value: float) -> tuple[float, float]:
    """(lo, hi) around a value. Raises ValueError."""
    ends = array_of(bounds, 1)
    if ends is None or ends.shape != (2,) or not (np.isfinite(ends).all() and ends[0] < ends[1]):
        raise ArgumentError(not_allowed(name, bounds, f"(lo, hi), lo < hi, around {value!r}"))
    lo, hi = ends.tolist()
    if not lo <= value <= hi:
        raise ArgumentError(not_allowed(name, bounds, f"(lo, hi), lo < hi, around {value!r}"))
    return lo, hi


def checked_count(name: str, value, least: int, most: int = MAX_COUNT) -> int:
    """A whole number of at least and at most so many. Raises ValueError."""
    number = number_of(value)
    if number is None or not (least <= number <= most and number == int(number)):
        raise ArgumentError(not_allowed(name, value, f"a whole number >= {least} and <= {most}"))
    return int(number)


@overload
def checked_word(name: str, value, words: Collection[str]) -> str: ...


@overload
def checked_word(name: str, value, words: Collection[str], optional: bool) -> str | None: ...


def checked_word(name, value, words, optional=False):
    """One of these words, or None where that is allowed too. Raises ValueError."""
    if value is None and optional:
        return None
    if not (isinstance(value, str) and value in words):
        likely = meant(value, words) if isinstance(value, str) else None
        hint = f"; did you mean `{likely}`?" if likely else ""
        raise ArgumentError(not_allowed(name, value, f"{'one of ' if len(words) > 1 else ''}{', '.join(words)}{hint}"))
    return str(value)


def checked_flag(name: str, value) -> bool:
    """Raises ValueError for what is neither True nor False."""
    if not isinstance(value, (bool, np.bool_)):
        raise ArgumentError(not_allowed(name, value, "True or False"))
    return bool(value)


def check_call(name: str, value: object, example: str, *arguments: Any) -> None:
    """Raise TypeError unless `value` is None, or can be called as in the example, with as many arguments as `given`.

    Nor is it a class, of which each call would only make another object.
    """
    if value is not None and (isinstance(value, type) or not accepts(value, *arguments)):
        raise ArgumentTypeError(not_allowed(name, value, f"callable as {example}"))


def accepts(function: object, *arguments: Any, **named: Any) -> bool:
    """Whether this can be called so, as far as it says."""
    if not callable(function):
        return False
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):  # written in C, mostly: it does not say
        return not isinstance(function, type)
    try:
        signature.bind(*arguments, **named)
    except TypeError:
        return False
    return True


def names_its_arguments(function: F) -> F:
    """The function, which says what its arguments are where it is called with others: TypeError."""
    signature, name = inspect.signature(function), function.__qualname__.removesuffix(".__init__")

    @functools.wraps(function)
    def called(*arguments, **named):
        bound(name, signature, *arguments, **named)
        return function(*arguments, **named)

    return called  # type: ignore[return-value]


def bound(name: str, signature: inspect.Signature, /, *arguments: Any, **named: Any) -> inspect.BoundArguments:
    """The arguments of a call by their names. Raises TypeError where they are not those of the signature."""
    try:
        return signature.bind(*arguments, **named)
    except TypeError as error:
        kinds = {name: parameter.kind for name, parameter in signature.parameters.items() if name != "self"}
        any_name = inspect.Parameter.VAR_KEYWORD in kinds.values()
        unknown = [] if any_name else [cut(word) for word in named if word not in kinds]
        wrong = f"{', '.join(unknown)}: no such argument" if unknown else str(error)
        why = why_not_computed(unknown[0]) if unknown else None
        known = (did_you_mean(unknown[0], kinds) if unknown else "") + f"it takes {', '.join(kinds)}"
        raise ArgumentTypeError(f"{name}: {wrong}; {why or known}") from None


def check_type(name: str, value: object, kinds: type | tuple[type, ...], allowed: str) -> None:
    """Raise TypeError unless `value` is one of these kinds; `allowed` says so in words."""
    if not isinstance(value, kinds):
        raise ArgumentTypeError(not_allowed(name, value, allowed))
