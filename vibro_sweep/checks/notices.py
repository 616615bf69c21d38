"""Notices at a prompt or in a notebook: warnings, and that it compiles, which takes a while.

They are records of the logger `vibro_sweep`, which the command line prints as its own. In Python they go to stderr,
unless the user's logging takes them; `logging.getLogger("vibro_sweep").setLevel(logging.WARNING)` silences the rest,
and the progress bar.
"""

import logging
import sys

NAME = "vibro_sweep"


class _Notices(logging.Handler):
    def emit(self, record: logging.LogRecord) -> None:
        if self.others(record.name) or _is_worker():
            return
        level = "" if record.levelno < logging.WARNING else f"{record.levelname.lower()}: "
        if sys.stderr is not None:  # of a program without a terminal
            print(f"vibro-sweep: {level}{record.getMessage()}", file=sys.stderr, flush=True)

    def others(self, name: str) -> bool:
        """Whether somebody else shows what this logger says."""
        logger: logging.Logger | None = logging.getLogger(name)
        while logger is not None:
            if any(handler is not self for handler in logger.handlers):
                return True
            logger = logger.parent if logger.propagate else None
        return False


def _is_worker() -> bool:
    """Whether another Python started this process; the first one has said it."""
    import multiprocessing  # not needed where nothing is said

    return multiprocessing.parent_process() is not None


def shown() -> bool:
    """Whether what is not a warning goes to stderr: nobody has silenced it, or shows it elsewhere."""
    logger = logging.getLogger(NAME)
    ours = next((handler for handler in logger.handlers if isinstance(handler, _Notices)), None)
    return ours is not None and logger.isEnabledFor(logging.INFO) and not ours.others(NAME) and not _is_worker()


def begin() -> None:
    """Once, when the package is imported."""
    logger = logging.getLogger(NAME)
    if logger.level == logging.NOTSET:
        logger.setLevel(logging.INFO)
    if not any(isinstance(handler, _Notices) for handler in logger.handlers):
        logger.addHandler(_Notices())
