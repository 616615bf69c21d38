"""Commands and options that do not exist: one message, and what was probably meant."""

import difflib
import re
import shlex
from pathlib import Path

import typer

from .console import INTERRUPTED, InputError

# what other programs call it
_COMMANDS = {
    "view": "plot",
    "draw": "plot",
    "show": "info",
    "validate": "check",
    "estimate": "check",
    "start": "run",
    "compute": "run",
    "init": "new",
    "create": "new",
    "version": "--version",
    "help": "--help",
    "resume": "run --resume",
}
_OPTIONS = {
    "-j": "--workers",
    "-n": "--workers",
    "--threads": "--workers",
    "--jobs": "--workers",
    "-f": "--overwrite",
    "--force": "--overwrite",
    "-q": "--quiet",
    "-p": "--plot",
    "--continue": "--resume",
    "--out": "--output",
}
_FILES = {".yaml": "run", ".yml": "run", ".h5": "plot"}


def called(app: typer.Typer, arguments: list[str] | None) -> None:
    """Call the program; ends by SystemExit with its status. Raises InputError for a call that it does not know."""
    try:
        status = app(args=arguments, prog_name="vibro-sweep", standalone_mode=False)
    except typer.Abort:
        raise SystemExit(INTERRUPTED) from None
    except Exception as error:
        if not hasattr(error, "format_message"):  # of click, or of typer's own copy of it
            raise
        raise InputError(_explained(error)) from None
    raise SystemExit(status if isinstance(status, int) else 0)


def _explained(error) -> str:
    """A usage error in one line."""
    context = getattr(error, "ctx", None)
    path = context.command_path if context else "vibro-sweep"
    text = error.format_message().strip().rstrip(".")
    hint = f"`{path} --help` shows what there is"
    if known_form := re.match(r"No such command '([^']*)'", text):
        text, hint = f"there is no command {known_form[1]!r}", _command_meant(known_form[1], context) or hint
    elif known_form := re.match(r"No such option:? '?(-[^\s']*)'?", text):
        text, hint = f"there is no option {known_form[1]}", _option_meant(known_form[1], context) or hint
    elif known_form := re.search(r"[Ff]ile '([^']*)' does not exist", text):
        near = _file_meant(known_form[1])
        hint = f"did you mean {near}?" if near else ""
        if (pieces := Path(known_form[1] + _suffix_of_pieces())).is_dir():
            hint = f"{pieces} beside it is of a run that was interrupted, which --resume continues"
    return f"{text}; {hint}" if hint else text


def _suffix_of_pieces() -> str:
    from vibro_sweep.checks.file_names import SUFFIX  # `--help` must not wait for numpy

    return SUFFIX


def _command_meant(word: str, context) -> str:
    if command := _FILES.get(Path(word).suffix.lower()):
        return f"did you mean `vibro-sweep {command} {shlex.quote(word)}`?"
    known = list(context.command.commands) if context and hasattr(context.command, "commands") else []
    close = [_COMMANDS[word]] if word in _COMMANDS else difflib.get_close_matches(word, known, n=1)
    return f"did you mean `vibro-sweep {close[0]}`?" if close else ""


def _option_meant(word: str, context) -> str:
    known = [option for parameter in context.command.params for option in parameter.opts] if context else []
    if _OPTIONS.get(word) in known:
        return f"did you mean {_OPTIONS[word]}?"
    close = difflib.get_close_matches(word, known, n=1)
    return f"did you mean {close[0]}?" if close else ""


def _file_meant(name: str) -> str | None:
    """A file that exists and is called like it."""
    for ending in (".yaml", ".yml", ".h5"):
        if Path(name + ending).exists():
            return name + ending
    folder = Path(name).parent
    near = [entry.name for entry in folder.iterdir()] if folder.is_dir() else []
    close = difflib.get_close_matches(Path(name).name, near, n=1, cutoff=0.8)
    return str(folder / close[0]) if close else None
