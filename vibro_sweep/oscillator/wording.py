"""Oscillators and itineraries in words: in full, or where they are long what fits in a few lines."""

from collections.abc import Mapping

LONGEST = 600  # letters of a text that is written in full
LONGEST_WORD = 24  # impacts of an itinerary that is written in full
FEW = 3  # entries of a list of which only some are written


def sentence(text: str) -> str:
    """A declared text, which begins small and ends without a full stop, as a sentence."""
    return text[:1].upper() + text[1:] + "."


def itinerary_text(word: str) -> str:
    """An itinerary, of a long one its beginning and the numbers of its impacts."""
    if len(word) <= LONGEST_WORD:
        return word or "no impacts"
    return f"{word[: LONGEST_WORD - 3]}... ({word.count('R')} R, {word.count('L')} L)"


def arguments(named: Mapping[str, object]) -> tuple[str, bool]:
    """The arguments as they are given in Python, and whether these are all of them."""
    known = {name: value for name, value in named.items() if value is not None}
    full = ", ".join(f"{name}={plain(value)!r}" for name, value in known.items())
    if len(full) <= LONGEST:
        return full, True
    return ", ".join(f"{name}={_brief(value)}" for name, value in known.items()), False


def numbers(known: Mapping[str, object]) -> str:
    """Numbers by name, those of lists one by one: m1, m2, ..., and options."""
    full = ", ".join(f"{name} = {value}" for name, value in known.items())
    if len(full) <= LONGEST:
        return full
    lists: dict[str, dict[str, object]] = {}
    for name, value in known.items():
        lists.setdefault(name.rstrip("0123456789"), {})[name] = value
    return ", ".join(_entries(entries) for entries in lists.values())


def _entries(entries: dict[str, object]) -> str:
    if len(entries) <= FEW:
        return ", ".join(f"{name} = {_brief(value, str)}" for name, value in entries.items())
    first, *_, last = entries
    return f"{first} .. {last} = {_brief(tuple(entries.values()))}"


def _brief(value: object, text=repr) -> str:
    """A short text: of a matrix its size, of a list of many numbers the first ones."""
    if not isinstance(value, tuple) or len(value) <= FEW:
        return text(plain(value))
    if isinstance(value[0], tuple):
        return f"({len(value)} x {len(value)})"
    if len({*value}) == 1:
        return f"[{value[0]!r}] * {len(value)}"
    return f"[{', '.join(map(repr, value[:FEW]))}, ... of {len(value)}]"


def plain(value: object) -> object:
    """The value as it is given: lists in place of tuples, but of those with a text of their own."""
    return [plain(item) for item in value] if type(value) in (tuple, list) else value


def without_rounding(value: float, spread: float) -> float:
    """The value; 0 where it is that to rounding of values that lie so far apart."""
    return value if abs(value) > 1e-12 * spread else 0.0
