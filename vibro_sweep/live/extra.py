"""Packages that the page needs beside those of the program: the extra `explore`."""

import contextlib
from collections.abc import Iterator

from vibro_sweep.checks.errors import MissingPackageError

PACKAGES = ("starlette", "uvicorn", "websockets")
NEEDS = "needs the packages starlette, uvicorn and websockets: pip install 'vibro_sweep[explore]'"


@contextlib.contextmanager
def needed() -> Iterator[None]:
    """Import the server within this. Raises MissingPackageError."""
    try:
        yield
    except ModuleNotFoundError as error:
        if error.name not in PACKAGES:
            raise
        raise MissingPackageError(f"explore {NEEDS} ({error.name} is not there)") from None
