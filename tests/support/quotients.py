"""Derivatives by difference quotients in many digits."""

from mpmath import mpf

DIGITS = 30
STEP = mpf(10) ** -15  # what quotients leave is its square, times third derivatives


def quotient(function, x):
    """Derivative of a function of one number, which returns 4, by central differences."""
    return [float((p - q) / (2 * STEP)) for p, q in zip(function(x + STEP), function(x - STEP), strict=True)]
