"""Oscillators in a stack have the bits that each has alone, whatever else is in the stack."""

from operator import attrgetter

import numpy as np
import pytest
from support import slow_cases
from support.drawn_oscillators import positive

import vibro_sweep as vs
from vibro_sweep.analysis.single.tables import table_of
from vibro_sweep.engine.points.any_points import kind_of
from vibro_sweep.oscillator.grid import linears
from vibro_sweep.types import Linear, LinearContact

FIELDS = [name for name in Linear._fields if name != "contacts"]
FIELDS += [f"contact.{name}" for name in LinearContact._fields]
SWEPT = {
    "one_mass": ("k", "zeta", "F", "constant", "omega", "b", "offset", "R", "tau"),
    "chain": ("m1", "k1", "k2", "c1", "force2", "constant1", "omega", "b", "offset", "R_left", "tau"),
    "linear": ("force1", "force_cos2", "constant1", "force_power", "omega", "b", "offset", "modal_damping1"),
    "ball_in_cavity": ("mass_ratio", "zeta", "F", "omega", "b"),
    "two_mass": ("mu_m", "mu_k", "zeta", "f2", "omega", "b", "offset", "mu_c"),
}


def drawn(rng: np.random.Generator) -> tuple[vs.Oscillator, str]:
    """An oscillator of any model and one of its numbers. Springs and dampers may be missing, or differ by 10^6."""
    name = rng.choice([*SWEPT])
    stops = dict(omega=rng.uniform(0.1, 2), b=rng.uniform(0.2, 2))
    stops |= dict(R=0.8) if rng.random() < 0.7 else dict(k_stop=rng.uniform(5, 50), c_stop=0.2)
    n = int(rng.integers(2, 5))
    if name == "one_mass":
        own = dict(k=rng.choice([0.0, 1.0]), zeta=rng.choice([0.0, 0.05, 2.0]), F=1.0, constant=rng.choice([0.0, -0.4]))
    elif name == "chain":
        k, c = rng.uniform(0.2, 2, n + 1) * rng.choice([0, 1, 1, 1, 1e3], n + 1), rng.choice([0, 0.1, 3], n + 1)
        own = dict(m=rng.uniform(0.5, 2, n), k=k, c=c, force=rng.normal(size=n), stop_at=int(rng.integers(1, n + 1)))
    elif name == "linear":
        own = dict(
            M=positive(rng, n, 1.0), K=positive(rng, n, 0.2), modal_damping=rng.uniform(0, 0.2, n),
            force=rng.normal(size=n), force_cos=rng.normal(size=n), force_power=1, contact_normal=rng.normal(size=n),
        )  # fmt: skip
    elif name == "ball_in_cavity":
        own = dict(mass_ratio=0.05, zeta=0.01, F=0.02)
    else:
        own = dict(mu_m=rng.uniform(0.1, 10), mu_k=rng.uniform(0, 5), zeta=0.05, f2=0.3, mu_c=rng.uniform(0, 5))
    of_all = set(SWEPT[name]) - ({"R", "R_left"} if "R" not in stops else set())
    return vs.Oscillator.named(name, **own, **stops), rng.choice(sorted(of_all))


@pytest.mark.parametrize("count", [40, *slow_cases(300)])
def test_points_of_a_stack_are_those_of_its_oscillators(count):
    rng, different = np.random.default_rng(3), 0
    for _ in range(count):
        system, name = drawn(rng)
        size = 3 if name == "offset" else 1.0
        values = size * np.sort(rng.uniform(0.01, 1, int(rng.integers(2, 12))))
        table, kind, _ = table_of(system, {name: values}, frames=True)
        for i, value in enumerate(values):
            alone, own, _ = table_of(system, {name: values[i : i + 1]}, frames=True)
            if own == kind:  # else the oscillators together need other kernels
                assert alone.tobytes() == table[i : i + 1].tobytes(), (system, name, value)
        different += len({one.tobytes() for one in table})
    assert different > 3 * count


@pytest.mark.parametrize("count", [40, *slow_cases(300)])
def test_a_stack_is_built_as_each_oscillator_is(count):
    rng = np.random.default_rng(4)
    for _ in range(count):
        system, name = drawn(rng)
        values = np.sort(rng.uniform(0.01, 1, 5))
        q = linears(system, {name: values})
        for i, value in enumerate(values):
            one = system.replace(**{name: value}).linear
            for field, stack, alone in zip(FIELDS, *map(attrgetter(*FIELDS), (q, one)), strict=True):
                assert np.array_equal(stack[i], alone, equal_nan=True), (system, name, field)


def test_where_a_state_is_measured_from_does_not_depend_on_other_points():
    """Stops at 2 and 4 lie on one side of 0, those at -2 and 8 do not."""
    ball = vs.Oscillator.named("one_mass", k=1, zeta=0.05, F=1, omega=0.8, R=0.7, b=1, offset=3)
    table, *_ = table_of(ball, {"b": np.array([1.0, 5.0])}, frames=False)
    assert table["origin"][:, 0].tolist() == [3.0, 0.0]
    assert table["stops"][:, :2].tolist() == [[-1.0, 1.0], [-2.0, 8.0]]


def test_which_oscillators_share_kernels():
    """Those with as many masses, wherever the contact is, unless a stop is compliant."""
    numbers = dict(M=np.eye(2), K=np.eye(2), C=0.1 * np.eye(2), contact_normal=[1, 0], omega=0.8, b=1)
    stops = dict(R=0.8), dict(R=0.8, contact_normal=[1, -1]), dict(R=0.8, M=[[2, 0.1], [0.1, 3]]), dict(k_stop=29)
    wall, between, coupled, compliant = (kind_of(vs.Oscillator(**numbers | stop).linear) for stop in stops)
    assert wall == between == coupled != compliant


def test_a_constant_force_on_one_mass_needs_no_kernels_of_its_own():
    kinds = [
        kind_of(vs.Oscillator.named("one_mass", k=1, zeta=0, F=1, constant=constant, omega=0.8, b=1, R=0.8).linear)
        for constant in (0.0, -0.4)
    ]
    assert kinds[0] == kinds[1]
