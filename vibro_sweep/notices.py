"""What the package has to say at a prompt or in a notebook: warnings, and that it compiles, which takes a while.

They are records of the logger `vibro_sweep`, which the command line prints as its own. In Python they go to stderr,
unless the user's logging takes them; `logging.getLogger("vibro_sweep").setLevel(logging.WARNING)` silences the rest.
"""

import logging
import sys


class _Notices(logging.Handler):
    def emit(self, record: logging.LogRecord) -> None:
        if self._others(record.name) or _is_worker():
            return
        level = "" if record.levelno < logging.WARNING else f"{record.levelname.lower()}: "
        print(f"vibro_sweep: {level}{record.getMessage()}", file=sys.stderr, flush=True)

    def _others(self, name: str) -> bool:
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


def begin() -> None:
    """Once, when the package is imported."""
    logger = logging.getLogger("vibro_sweep")
    if logger.level == logging.NOTSET:
        logger.setLevel(logging.INFO)
    if not any(isinstance(handler, _Notices) for handler in logger.handlers):
        logger.addHandler(_Notices())
