"""The monodromy matrix of a periodic orbit in 40 digits, from the times of its impacts alone.

Between impacts the flow is exp(A u); an impact multiplies by DG + (F+ - DG F-) n^T/(n . F-), with the vector field F
just before and after it, formed from eq. (3) in full.
"""

from mpmath import mp, mpf

from reference.gmp import expm


def matrices(params):
    """A of z' = A z for z = (x1, v1, x2, v2, sin, cos), from eq. (3)."""
    mu_m, mu_k, zeta, f2, omega = (mpf(params[name]) for name in ("mu_m", "mu_k", "zeta", "f2", "omega"))
    A = mp.zeros(6)
    A[0, 1] = A[2, 3] = 1
    A[1, 0], A[1, 1], A[1, 2], A[1, 3], A[1, 4] = -1, -2 * zeta, 1, 2 * zeta, 1 - f2
    A[3, 0], A[3, 1] = 1 / mu_m, 2 * zeta / mu_m
    A[3, 2], A[3, 3], A[3, 4] = -(1 + mu_k) / mu_m, -2 * zeta * (1 + mu_k) / mu_m, f2 / mu_m
    A[4, 5], A[5, 4] = omega, -omega
    return A


def saltation(A, R, before, after):
    """The jump of a perturbation of (x1, v1, x2, v2) at an impact with these states (6 numbers) before and after."""
    DG = mp.diag([1, -R, 1, 1])
    F_before, F_after = (A * before)[:4], (A * after)[:4]
    n = mp.matrix([[1, 0, 0, 0]])
    return DG + (mp.matrix(F_after) - DG * mp.matrix(F_before)) * n / before[1]


def multipliers(params, impacts, periods):
    """Eigenvalues by falling modulus. impacts: t from 0 on, side, v1 (before), x2, v2; the orbit begins at t = 0."""
    with mp.workdps(40):
        A, R = matrices(params), mpf(params["R"])
        omega, tau, b = mpf(params["omega"]), mpf(params["tau"]), mpf(params["b"])
        total, now = mp.eye(4), mpf(0)
        for hit in impacts:
            t, v1 = mpf(float(hit["t"])), mpf(float(hit["v1"]))
            rest = [mpf(float(hit["x2"])), mpf(float(hit["v2"])), mp.sin(omega * t + tau), mp.cos(omega * t + tau)]
            before = mp.matrix([int(hit["side"]) * b, v1, *rest])
            after = mp.matrix([int(hit["side"]) * b, -R * v1, *rest])
            total = saltation(A, R, before, after) * expm(A[:4, :4] * (t - now)) * total
            now = t
        total = expm(A[:4, :4] * (periods * 2 * mp.pi / omega - now)) * total
        values = mp.eig(total, left=False, right=False)
        return [complex(value) for value in sorted(values, key=lambda value: -abs(value))]
