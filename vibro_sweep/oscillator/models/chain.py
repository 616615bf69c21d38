"""A chain of any number of masses between two walls, one of which hits stops."""

import numpy as np

from vibro_sweep.checks.refusals import ParameterError
from vibro_sweep.oscillator.linear import Linear, contact
from vibro_sweep.oscillator.models.declaration import CONTACT, OF_STOPS, UNITS, WHICH_STOPS, Model, Option
from vibro_sweep.oscillator.stacks import vector
from vibro_sweep.tables.quantity import NOT_NEGATIVE, NUMBER, POSITIVE, Parameter


def chain(*, m, k, c, force, constant, stop_at, omega, tau, stop_between=None, **stops) -> Linear:
    """The oscillator; numbers may be complex."""
    n, masses = len(m), vector(m)
    normal = np.eye(n)[stop_at - 1]
    if stop_between is not None:
        first, second = stop_between
        normal = np.eye(n)[second - 1] - np.eye(n)[first - 1]
    return Linear(
        M=masses[..., None] * np.eye(n),
        K=between_walls(k),
        C=between_walls(c),
        constant=vector(constant),
        sine=vector(force),
        cosine=np.zeros(n),
        omega=omega,
        tau=None if isinstance(tau, str) else tau,
        contacts=[contact(normal, **stops)],
    )


def between_walls(springs) -> np.ndarray:
    """The matrix (..., N, N) of N + 1 springs, or dampers, in a row."""
    values = vector(springs)
    n = values.shape[-1] - 1
    result, i = np.zeros((*values.shape[:-1], n, n), values.dtype), np.arange(n)
    result[..., i, i] = values[..., :-1] + values[..., 1:]
    result[..., i[1:], i[:-1]] = result[..., i[:-1], i[1:]] = 0.0 - values[..., 1:-1]
    return result


def _check(arguments) -> None:
    masses = len(arguments["m"])
    if not 1 <= arguments["stop_at"] <= masses:
        allowed = f"a whole number from 1 to {masses}, the number of masses"
        raise ParameterError("stop_at", arguments["stop_at"], allowed)
    pair = arguments["stop_between"]
    if pair is not None and not (1 <= min(pair) and max(pair) <= masses):
        raise ParameterError("stop_between", list(pair), f"two whole numbers from 1 to {masses}, the number of masses")
    if pair is not None and arguments["stop_at"] != 1:
        raise ParameterError("stop_between", list(pair), "left out where stop_at is given")


def _list(name: str, symbol: str, units: str, range_, each: str, label: str, text: str, default=None) -> Parameter:
    return Parameter(name, label, text, symbol, units, range_, default=default, free_motion=True, each=each)


MODEL = Model(
    name="chain",
    title="any number of masses between two walls, stops at one of them",
    sketch=r"""
    |   k1   .----.   k2   .----.   k3         .----.  k(n+1)  |
    |--/\/\--| m1 |--/\/\--| m2 |--/\/\-- ... -| mn |--/\/\----|
    |        '----'        '----'              '----'          |
               x1            x2                  xn
""",
    equations="""
    m_i x_i'' + c_i (x_i' - x_(i-1)') + c_(i+1) (x_i' - x_(i+1)')
              + k_i (x_i - x_(i-1)) + k_(i+1) (x_i - x_(i+1)) = constant_i + force_i sin(omega t + tau)
    x_0 = x_(n+1) = 0, the walls; offset - b <= x_s <= offset + b for the mass s = stop_at
    stop_between: [i, j]   offset - b <= x_j - x_i <= offset + b, between two masses
""",
    source="S. Natsiavas, J. Sound Vib. 165 (1993) 439",
    numbers=(
        _list("m", "m", "kg", POSITIVE, "mass", "mass", "mass"),
        _list("k", "k", "N m-1", NOT_NEGATIVE, "spring", "stiffness", "stiffness, from the left wall on; 0: no spring"),
        _list("c", "c", "N s m-1", NOT_NEGATIVE, "spring", "damper", "damping, from the left wall on", 0.0),
        _list("force", "F", "N", NUMBER, "mass", "force", "amplitude of the force"),
        _list("constant", r"\bar f", "N", NUMBER, "mass", "constant force", "constant force", 0.0),
        *CONTACT,
    ),
    options=(
        Option("stop_at", "whole", "the mass that hits the stops, counted from 1", 1),
        Option(
            "stop_between",
            "pair",
            "[i, j], in place of stop_at: the stops bound the gap x_j - x_i between two masses",
            optional=True,
        ),
        WHICH_STOPS,
        *OF_STOPS,
        UNITS,
    ),
    masses=lambda arguments: len(arguments["m"]),
    build=chain,
    check=_check,
)
