"""Lyapunov exponents as an array with their standard errors."""

import numpy as np


class Exponents(np.ndarray):
    """Lyapunov exponents (2N,), descending, per unit time; what is computed from them are plain arrays.

    error : (2N,) standard errors; of a periodic orbit: what rounding and one more period change
    residual : sum of the exponents minus its exact value; NaN where dimensions are lost

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> exponents = vs.lyapunov(system, (0, 0, 0, 0), transient=200, record=400)
    >>> exponents.shape, exponents.error.shape, round(float(exponents[0]), 6)
    ((4,), (4,), -0.010194)
    """

    error: np.ndarray
    residual: float

    def __new__(cls, values: np.ndarray, error: np.ndarray, residual: float) -> "Exponents":
        result = np.array(values, float).view(cls)
        result.error, result.residual = np.array(error, float), float(residual)
        return result

    def __repr__(self) -> str:
        """The exponents with their standard errors."""
        if self.ndim != 1 or self.error.shape != self.shape:
            return repr(np.asarray(self))
        pairs = zip(np.asarray(self).tolist(), self.error.tolist(), strict=True)
        return f"Exponents([{', '.join(f'{value:.10g} +- {error:.1g}' for value, error in pairs)}])"

    __str__ = __repr__

    def __array_finalize__(self, source: object) -> None:
        self.error = getattr(source, "error", np.empty(0))
        self.residual = getattr(source, "residual", np.nan)

    def __array_wrap__(self, array, context=None, return_scalar=False):
        return np.asarray(array)[()]

    def __getitem__(self, key):
        return self.view(np.ndarray)[key]

    def __reduce__(self):
        return Exponents, (np.asarray(self), self.error, self.residual)
