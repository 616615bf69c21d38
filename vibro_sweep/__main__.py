"""``python -m vibro_sweep`` is the program ``vibro-sweep``."""

import gc
import os
import sys

from .cli import interrupt
from .cli.console import INTERRUPTED, prepare_process


def program() -> None:
    """The command line as a process, which it ends."""
    os.environ.pop("MPLBACKEND", None)  # of a notebook that starts this program, say: it shows no window
    interrupt.install()
    prepare_process()
    gc.disable()  # until cli.console.all_is_imported
    from .cli.commands import main  # takes time, in which there may be a Ctrl-C

    status = main()
    if status == INTERRUPTED:  # threads may be in the middle of a block, which may be long: do not wait for them
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)
    gc.freeze()  # else Python looks through all objects at its exit, which takes half a second
    sys.exit(status)


if __name__ == "__main__":
    program()
