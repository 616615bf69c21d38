"""The command line: each command with its arguments and options."""

import inspect
from collections.abc import Iterator

import typer

from ..commands import app
from ..console import EXIT_STATUSES
from .markdown import head, table


def page() -> Iterator[str]:
    program = typer.main.get_command(app)
    yield from head(
        "Commands",
        "What the program `vibro-sweep` can be asked for. `vibro-sweep --help` and `vibro-sweep COMMAND --help` print\n"
        "the same; `python -m vibro_sweep` is the same program.",
    )
    rows = ((f"[`{name}`](#vibro-sweep-{name})", _first(one.help)) for name, one in program.commands.items())
    yield from table(("command", "what it does"), rows)
    for name, command in program.commands.items():
        yield f"## `vibro-sweep {name}`\n"
        usage = " ".join(one.metavar for one in command.params if one.param_type_name == "argument")
        yield f"```text\nvibro-sweep {name} [OPTIONS] {usage}".rstrip() + "\n```\n"
        yield inspect.cleandoc(command.help) + "\n"
        rows = [(_named(one), one.help) for one in command.params if one.param_type_name == "option"]
        yield from table(("option", "meaning"), rows) if rows else ()
    yield "## Exit status\n\n[Troubleshooting](statuses.md#exit-status-of-the-program) says what to do.\n"
    yield from table(("status", "meaning"), ((code, one.text) for code, one in EXIT_STATUSES.items()))


def _first(text: str) -> str:
    """The first paragraph."""
    return " ".join(inspect.cleandoc(text).partition("\n\n")[0].split())


def _named(option) -> str:
    value = "" if option.is_flag else f" {option.metavar}"
    return ", ".join(f"`{name}{value}`" for name in option.opts)
