"""The base of all errors that the package raises; each is also the error of Python that it is a case of."""


class VibroSweepError(Exception):
    """A request cannot be met: an argument, a scene or a file is wrong, or a run cannot go on.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> try:
    ...     vs.System(mu_m=-1, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    ... except vs.VibroSweepError as error:
    ...     print(error)
    mu_m: -1 is not allowed; it must be a finite number > 0
    """


class ArgumentError(VibroSweepError, ValueError):
    """A value that is not allowed."""


class ArgumentTypeError(VibroSweepError, TypeError):
    """A value of a kind that is not allowed."""


class MissingPackageError(VibroSweepError, ImportError):
    """A package that is needed is not installed."""


class MachineError(VibroSweepError, OSError):
    """The machine, or how it is set up, cannot do what is needed."""
