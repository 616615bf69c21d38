"""Writes the messages of tests/cases/messages.yaml as the program gives them now; the rows are written by hand.

    PYTHONPATH=tests python -m tools.messages

A new row has `message: ""`. Read what changed (`git diff`) before you commit it.
"""

import contextlib
import json
import tempfile
from collections.abc import Callable

import yaml
from support import cases, refusals

PATH = cases.FOLDER / "messages.yaml"


def rewritten(text: str, message_of: Callable[[dict], str]) -> str:
    """The table with new messages, and else as it is."""
    places = [place for entry in yaml.compose(text).value for place in _messages(entry)]
    rows = [row for row in cases.read(text) if "message" in row]
    for (begin, end), row in reversed(list(zip(places, rows, strict=True))):
        text = text[:begin] + _scalar(message_of(row)) + text[end:]
    return text


def _messages(node: yaml.Node) -> list[tuple[int, int]]:
    """Where in the text the messages of an entry stand."""
    if isinstance(node, yaml.ScalarNode):
        return []
    if isinstance(node, yaml.SequenceNode):
        return [place for item in node.value for place in _messages(item)]
    found = []
    for key, value in node.value:
        found += [(value.start_mark.index, value.end_mark.index)] if key.value == "message" else _messages(value)
    return found


def _scalar(text: str) -> str:
    """A text in quotes: single ones, in which nothing is written as an escape, if there are double ones in it."""
    plain = '"' in text and text.isprintable()
    return "'" + text.replace("'", "''") + "'" if plain else json.dumps(text, ensure_ascii=False)


def message_now(row: dict) -> str:
    """What the program says. Raises LookupError where it refuses nothing."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        message = refusals.answer(row).message
    if message is None:
        raise LookupError(f"{row['id']}: this is accepted")
    return message


if __name__ == "__main__":
    PATH.write_text(rewritten(PATH.read_text(), message_now))
