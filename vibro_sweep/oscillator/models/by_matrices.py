"""Any linear oscillator with one contact, by its matrices."""

import numpy as np

from vibro_sweep.checks.refusals import ParameterError
from vibro_sweep.oscillator import wording
from vibro_sweep.oscillator.checked_numbers import checked_normal
from vibro_sweep.oscillator.linear import Linear, contact
from vibro_sweep.oscillator.models.declaration import CONTACT, OF_STOPS, UNITS, WHICH_STOPS, Model, Option
from vibro_sweep.oscillator.stacks import vector
from vibro_sweep.tables.quantity import NOT_NEGATIVE, Parameter

ROUNDING = 1e-12  # of a matrix, relative to its largest entry or eigenvalue
KINETIC = (
    "every motion must have kinetic energy; a coordinate without mass, as the charge of a circuit without inductance, "
    "may have a small one"
)
DAMPING = ("C", "modal_damping", "rayleigh")  # ways to give it


def linear(
    *, M, K, C, modal_damping, rayleigh, force, force_cos, constant, force_power, contact_normal, omega, tau,
    **stops,
) -> Linear:  # fmt: skip
    """The oscillator; numbers may be complex, but not the matrices."""
    M, K = np.array(M, float), np.array(K, float)
    constant_amplitude = isinstance(force_power, (int, float)) and force_power == 0
    with np.errstate(all="ignore"):
        power = 1.0 if constant_amplitude else np.asarray(np.power(omega, force_power))[..., None]
    return Linear(
        M=M,
        K=K,
        C=damping(M, K, C, modal_damping, rayleigh),
        constant=vector(constant),
        sine=power * vector(force),
        cosine=power * vector(force_cos),
        omega=omega,
        tau=None if isinstance(tau, str) else tau,
        contacts=[contact(np.array(contact_normal, float), **stops)],
    )


def damping(M, K, C, modal_damping, rayleigh) -> np.ndarray:
    """The damping matrix: as given, from a ratio for each mode, or alpha M + beta K; else none."""
    if rayleigh is not None:
        alpha, beta = (np.asarray(factor)[..., None, None] for factor in rayleigh)
        return alpha * M + beta * K
    if modal_damping is not None:
        from scipy.linalg import eigh  # slow to import

        squares, psi = eigh(K, M)  # psi^T M psi = 1
        carried = M @ psi
        return (carried * (2 * vector(modal_damping) * np.sqrt(np.maximum(squares, 0)))[..., None, :]) @ carried.T
    return np.zeros_like(M) if C is None else np.array(C, float)


def _check(arguments) -> None:
    sizes = {name: len(arguments[name]) for name in ("M", "K", "C", "contact_normal") if arguments[name] is not None}
    masses = sizes["M"]
    for name, size in sizes.items():
        if size != masses:
            what = (
                f"a matrix of {masses} x {masses} numbers"
                if name != "contact_normal"
                else f"a list of {masses} numbers"
            )
            raise ParameterError(name, wording.plain(arguments[name]), f"{what}, as there are {masses} masses in M")
        if name != "contact_normal":
            _check_symmetric(name, np.array(arguments[name]))
    if np.linalg.eigvalsh(arguments["M"]).min() <= 0:
        raise ParameterError("M", wording.plain(arguments["M"]), f"positive definite: {KINETIC}")
    for name in ("K", "C"):
        if arguments[name] is not None:
            values = np.linalg.eigvalsh(arguments[name])
            if values.min() < -ROUNDING * np.abs(values).max():
                raise ParameterError(
                    name, wording.plain(arguments[name]), "positive semidefinite: no motion may gain energy by it"
                )
    checked_normal(arguments["contact_normal"])
    several = [name for name in DAMPING if arguments[name] is not None]
    if len(several) > 1:
        raise ParameterError(several[1], wording.plain(arguments[several[1]]), f"left out where {several[0]} is given")


WITHOUT_SYMMETRY = {"C": "; gyroscopic forces are not computed", "K": "; circulatory forces are not computed"}


def _check_symmetric(name: str, matrix: np.ndarray) -> None:
    apart = np.abs(matrix - matrix.T)
    if apart.max() > ROUNDING * np.abs(matrix).max():
        i, j = (int(index) for index in np.unravel_index(apart.argmax(), apart.shape))
        entries = f"entries {i + 1}, {j + 1} and {j + 1}, {i + 1} differ: {matrix[i, j]:g} and {matrix[j, i]:g}"
        raise ParameterError(name, matrix.tolist(), f"symmetric; {entries}{WITHOUT_SYMMETRY.get(name, '')}")


def _depending(arguments) -> dict[str, str]:
    """The parameters of forces that grow like a power of omega, and alpha and beta of `rayleigh`."""
    power = arguments["force_power"]
    force = f"kg m s{power - 2:.0f}" if power not in (0, 2) else "N" if power == 0 else "kg m"
    if power != int(power):
        force = "1"  # CF has whole powers only
    forces = {f"{name}{i}": force for name in ("force", "force_cos") for i in range(1, len(arguments["M"]) + 1)}
    return forces | {"rayleigh1": "s-1", "rayleigh2": "s"}


def _list(name: str, symbol: str, label: str, text: str, **more) -> Parameter:
    more = {"each": "mass", "default": 0.0} | more
    return Parameter(name, label, text, symbol, free_motion=True, **more)


MODEL = Model(
    name="linear",
    title="any linear oscillator with one contact, by its matrices",
    sketch=r"""
        M, C, K: N masses, joined in any way
        g = n . x    contact_normal: n = (1, 0, ..):  mass 1 and a wall;   (-1, 1, 0, ..): masses 1 and 2
""",
    equations="""
    M x'' + C x' + K x
        = constant + omega^force_power (force sin(omega t + tau) + force_cos cos(omega t + tau))
    offset - b <= n . x <= offset + b
    force_power: 2   unbalance, or a shaken base
""",
    source="docs/how/models.md",
    numbers=(
        _list("force", "F", "force", "amplitude of the force with sin(omega t + tau)", units="N"),
        _list("force_cos", r"\tilde f", "force (cos)", "amplitude of the force with cos(omega t + tau)", units="N"),
        _list("constant", r"\bar f", "constant force", "constant force", units="N"),
        Parameter(
            "force_power",
            "power of omega",
            "the force grows like omega to this power",
            "p",
            default=0.0,
            free_motion=True,
        ),
        _list(
            "modal_damping",
            r"\zeta",
            "damping ratio",
            "damping ratio, in the order of rising frequency",
            range=NOT_NEGATIVE,
            each="mode",
            default=None,
            optional=True,
        ),
        _list(
            "rayleigh",
            "r",
            "Rayleigh damping",
            "alpha and beta of C = alpha M + beta K",
            range=NOT_NEGATIVE,
            each="coefficient",
            default=None,
            optional=True,
        ),
        *CONTACT,
    ),
    options=(
        Option("M", "matrix", "masses: symmetric, positive definite", units="kg"),
        Option("K", "matrix", "stiffnesses: symmetric, positive semidefinite", units="N m-1"),
        Option("C", "matrix", "damping: symmetric, positive semidefinite", optional=True, units="N s m-1"),
        Option("contact_normal", "vector", "n of the gap g = n . x"),
        WHICH_STOPS,
        *OF_STOPS,
        UNITS,
    ),
    masses=lambda arguments: len(arguments["M"]),
    build=linear,
    depending=_depending,
    check=_check,
)
