"""`vibro-sweep explore`: which scene the page begins with, and the server until Ctrl-C."""

import contextlib
import webbrowser
from pathlib import Path

from . import interrupt
from .console import InputError, all_is_imported, input_errors, messages, say
from .examples import examples

FIRST = "quickstart"


def explore(path: Path | None, port: int, browser: bool) -> None:
    """Serve the page until Ctrl-C. Raises InputError where packages are missing or the port is taken."""
    from vibro_sweep.checks.errors import MissingPackageError
    from vibro_sweep.live.extra import needed

    with input_errors(MissingPackageError), needed():
        from vibro_sweep.live.server import bound, serve
    from vibro_sweep.live.presets import presets_of, scene_to_explore

    presets = presets_of(examples().values())
    if path is not None:
        with input_errors(ValueError):
            presets = {path.stem: scene_to_explore(path)} | presets
    try:
        sock = bound(port)
    except (OSError, OverflowError) as error:
        raise InputError(f"--port {port}: {getattr(error, 'strerror', None) or error}") from None
    all_is_imported()

    def ready(address: str) -> None:
        say(address)
        if browser:
            with contextlib.suppress(webbrowser.Error):
                webbrowser.open(address)

    with interrupt.tidied_up(), messages(quiet=True):
        serve(presets, FIRST if path is None else path.stem, sock, ready)
