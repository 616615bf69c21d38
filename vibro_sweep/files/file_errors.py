"""What is wrong with a file, in one message that names it."""

from vibro_sweep.checks.errors import VibroSweepError
from vibro_sweep.checks.file_names import MissingFileError


class StoreError(VibroSweepError, ValueError):
    """A file that is in the way, is not one of ours, is damaged or does not fit the scene; or a disk that fails.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> try:
    ...     vs.open("nothing.h5")
    ... except vs.StoreError as error:
    ...     print(error)
    nothing.h5: there is no such file
    """


class MissingError(StoreError, MissingFileError):
    """A file does not exist."""
