"""Help texts of the program and of its commands, in 80 columns and without colour, and what differs from a record."""

import difflib
import os
import re
from unittest import mock

from support.programs import ended

PLAIN = {"COLUMNS": "80", "NO_COLOR": "1", "TERM": "dumb"}


def commands() -> list[str]:
    """Of the program, in the order of its help; the first one is '', the program itself."""
    section = help_of("").partition("\nCommands:\n")[2].partition("\n\n")[0]
    return ["", *re.findall(r"^  (\w+)", section, re.MULTILINE)]


def help_of(command: str) -> str:
    with mock.patch.dict(os.environ, PLAIN):
        status, out, err = ended(*command.split(), "--help")
    if status or err:
        raise LookupError(f"{command} --help ended with {status}: {err}")
    return "".join(f"{line.rstrip()}\n" for line in out.splitlines())


def record_of(command: str) -> dict:
    return {"name": command, "commands": commands() if command == "" else [], "text": help_of(command)}


def differences_from(record: dict) -> list[str]:
    """Between a record and what is printed now."""
    now = record_of(record["name"])
    lines = [f"commands {now['commands']}"] if now["commands"] != record["commands"] else []
    pair = (record["text"].splitlines(), now["text"].splitlines())
    return lines + [line for line in difflib.unified_diff(*pair, "record", "now", lineterm="", n=0)]
