"""What is shown, compared: words are the same, and numbers to six digits."""

import re

import numpy as np

DIGITS = 1e-6
ROUNDING = 1e-9  # smaller numbers, as errors are, are not told apart
NUMBER = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)")
COLOUR = re.compile(r"#[0-9a-f]{8}")


def different(stored, now, place: str = "") -> list[str]:
    """In words what differs between two values of JSON; of a list of numbers in parts of its largest."""
    if _number(stored) and _number(now):
        return _numbers(place, [stored], [now])
    if type(stored) is not type(now):
        return [f"{place}: {stored!r:.80}, now {now!r:.80}"]
    if isinstance(stored, dict):
        if list(stored) != list(now):
            return [f"{place}: {list(stored)}, now {list(now)}"]
        return [line for key in stored for line in different(stored[key], now[key], f"{place} {key}".strip())]
    if isinstance(stored, list):
        if len(stored) != len(now):
            return [f"{place}: {len(stored)} values, now {len(now)}"]
        if _numeric(stored) and _numeric(now):
            return _numbers(place, stored, now)
        return [
            line for i, pair in enumerate(zip(stored, now, strict=True)) for line in different(*pair, f"{place}[{i}]")
        ]
    if isinstance(stored, str):
        return _texts(place, stored, now)
    return [] if stored == now else [f"{place}: {stored!r}, now {now!r}"]


def _number(value) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _numeric(values: list) -> bool:
    """Whether these are numbers; None stands for what is none, as NaN does."""
    return any(map(_number, values)) and all(value is None or _number(value) for value in values)


def _numbers(place: str, stored: list, now: list) -> list[str]:
    a, b = np.array(stored, float), np.array(now, float)
    size = np.abs(a[np.isfinite(a)]).max(initial=0.0)
    near = np.isclose(a, b, rtol=0.0, atol=max(DIGITS * size, ROUNDING), equal_nan=True)
    return [f"{place}: {stored[k]!r}, now {now[k]!r}" for k in np.flatnonzero(~near)[:1]]


def _texts(place: str, stored: str, now: str) -> list[str]:
    """Blanks are not compared, for a number that is longer moves the words behind it. A colour has no numbers."""
    if COLOUR.fullmatch(stored):
        return [] if stored == now else _lines(place, stored, now)
    before, after = (NUMBER.split(" ".join(text.split())) for text in (stored, now))  # words and numbers in turn
    if [part.strip() for part in before[::2]] != [part.strip() for part in after[::2]]:
        return _lines(place, stored, now)
    numbers = zip(before[1::2], after[1::2], strict=True)
    return [line for a, b in numbers if a != b for line in _numbers(place, [float(a)], [float(b)])]


def _lines(place: str, stored: str, now: str) -> list[str]:
    """The first line that differs."""
    pairs = zip([*stored.splitlines(), ""], [*now.splitlines(), ""], strict=False)
    a, b = next((pair for pair in pairs if pair[0] != pair[1]), (stored, now))
    return [f"{place}: {a!r}, now {b!r}"]
