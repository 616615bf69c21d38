"""The base of all errors that the package raises; each is also the error of Python that it is a case of."""


class VibroSweepError(Exception):
    """A request cannot be met: an argument, a scene or a file is wrong, or a run cannot go on."""


class ArgumentError(VibroSweepError, ValueError):
    """A value that is not allowed."""


class ArgumentTypeError(VibroSweepError, TypeError):
    """A value of a kind that is not allowed."""


class MissingPackageError(VibroSweepError, ImportError):
    """A package that is needed is not installed."""
