"""How Lyapunov exponents are read off a record: what kernels, attractors, windows, files and pictures must agree on."""

CERTAIN = 2.0  # standard errors by which an exponent must differ from zero to be above or below it
RUNNING = 200  # points at which exponents that converge are stored


def sign_of(exponent, error, certain=CERTAIN):
    """1 where an exponent is above zero by more than so many of its errors, -1 where it is below; else 0."""
    return 1 * (exponent > certain * error) - 1 * (exponent < -certain * error)


def periods_read(m, parts, periods):
    """Forcing periods of a record after which the growth of tangent vectors is read for the m-th of `parts` times."""
    return -(-(m + 1) * periods // parts)
