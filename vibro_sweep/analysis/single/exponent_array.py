"""Lyapunov exponents as an array with their standard errors."""

import numpy as np


class Exponents(np.ndarray):
    """Lyapunov exponents (4,), descending, per unit time; what is computed from them are plain arrays.

    error : (4,) standard errors; of a periodic orbit: what rounding and one more period change
    residual : sum of the exponents minus its exact value; NaN where dimensions are lost
    """

    error: np.ndarray
    residual: float

    def __new__(cls, values: np.ndarray, error: np.ndarray, residual: float) -> "Exponents":
        result = np.array(values, float).view(cls)
        result.error, result.residual = np.array(error, float), float(residual)
        return result

    def __array_finalize__(self, source: object) -> None:
        self.error = getattr(source, "error", np.empty(0))
        self.residual = getattr(source, "residual", np.nan)

    def __array_wrap__(self, array, context=None, return_scalar=False):
        return np.asarray(array)[()]

    def __getitem__(self, key):
        return self.view(np.ndarray)[key]

    def __reduce__(self):
        return Exponents, (np.asarray(self), self.error, self.residual)
