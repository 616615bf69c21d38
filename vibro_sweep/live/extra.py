"""Packages that the page needs beside those of the program: the extra `explore`."""

import contextlib
from collections.abc import Iterator

from vibro_sweep.checks.errors import MissingPackageError

PACKAGES = ("starlette", "uvicorn", "websockets")


@contextlib.contextmanager
def needed() -> Iterator[None]:
    """Import the server within this. Raises MissingPackageError."""
    try:
        yield
    except ModuleNotFoundError as error:
        if error.name not in PACKAGES:
            raise
        text = f"explore needs the package {error.name}: pip install {' '.join(PACKAGES)}"
        raise MissingPackageError(text) from None
