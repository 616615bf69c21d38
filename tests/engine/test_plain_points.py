"""Points that a kernel sets up, from modes, are those that follow from the matrices with NumPy."""

import numpy as np
import pytest
from support import slow_cases

import vibro_sweep as vs
from vibro_sweep.engine.points import any_points
from vibro_sweep.engine.points.contact import ContactCoordinates, contact_coordinates, flight_matrix
from vibro_sweep.engine.points.coupled_points import set_coupled_point
from vibro_sweep.engine.points.exact import exact_motion
from vibro_sweep.engine.points.plain_modes import COUPLED, UNKNOWN, set_modes
from vibro_sweep.engine.points.plain_points import machine_of, modes_of
from vibro_sweep.engine.points.refined_equations import refine_equations
from vibro_sweep.engine.records import point_of
from vibro_sweep.engine.simd.jit import exported
from vibro_sweep.oscillator.linear import selected, stacked

BITS_LOST = 2.0**-40  # what a detuning of 1e-3 of the frequency of the force, the least one drawn, may take of 2^-53
FIELDS = (
    "stiffness", "damping", "force", "constrained", "push", "P", "back", "steady", "middle", "swing", "confining",
    "rate", "divergence",
)  # fmt: skip
FIELDS_OF_FREE = tuple(name for name in FIELDS if name != "swing")
SAME = ("omega", "tau", "turned", "origin", "cells", "apart")


def drawn(rng: np.random.Generator, slow: bool = False) -> vs.Oscillator:
    """Masses in a row, some without walls, some with inertia in common, whose dampers are in proportion to their
    springs, or to the masses; any of them strikes, or some combination of them. slow: the force is."""
    n = int(rng.integers(1, 7))
    k, m, normal = rng.uniform(0.2, 2, n + 1), rng.uniform(0.5, 2, n), rng.normal(size=n)
    M = np.diag(m) + (np.outer(normal, normal) if rng.random() < 0.3 else 0)
    if rng.random() < 0.5:
        normal = np.eye(n)[rng.integers(n)]
    if rng.random() < 0.3:
        k[[0, n]] = 0.0  # one mode is free
    speeds = (-1.5, -0.5) if slow else (-0.5, 0.3)
    stops = dict(R=0.8) if rng.random() < 0.6 else dict(k_stop=50.0)
    return vs.Oscillator(
        M, np.diag(k[:n] + k[1:]) - np.diag(k[1:n], 1) - np.diag(k[1:n], -1),
        rayleigh=[rng.choice([0, 0.05, 3.0]), rng.choice([0, 0.02, 1.0])], force=rng.normal(size=n),
        force_cos=rng.normal(size=n), constant=0.1 * rng.normal(size=n) * (rng.random() < 0.5), contact_normal=normal,
        omega=10 ** rng.uniform(*speeds), tau=rng.uniform(0, 6), b=rng.uniform(0.2, 3), **stops,
    )  # fmt: skip


def both(system: vs.Oscillator, monkeypatch) -> tuple[np.void, np.void] | None:
    """The point from the kernel, and the one from NumPy; None where the oscillator is not plain."""
    q, asked = stacked([system.linear]), []
    kind, other_points = any_points.kind_of(q), any_points._other_points

    def counted(*given):
        asked.append(given)
        return other_points(*given)

    monkeypatch.setattr(any_points, "_other_points", counted)
    point = any_points.any_points(q, kind)
    monkeypatch.undo()
    return None if asked else (point[0], other_points(q, kind, True)[0])


def in_the_frame(point: np.void) -> np.ndarray:
    """What is left of `to` A `from` beside rotations and decay, over the largest terms of that product."""
    A = flight_matrix(point["stiffness"], point["damping"])
    left = point["to_frame"] @ A @ point["from_frame"]
    terms = np.abs(point["to_frame"]) @ np.abs(A) @ np.abs(point["from_frame"])
    planes = zip(point["frame_eta"], point["frame_square"], point["frame_scale"], strict=True)
    for j, (eta, square, scale) in enumerate(planes):
        left[2 * j : 2 * j + 2, 2 * j : 2 * j + 2] -= [[-eta, scale], [-square / scale, -eta]]
    return np.abs(left).max() / terms.max()


@pytest.mark.parametrize("slow, share", [(False, 0.8), (True, 0.15)])  # others have rates that lie apart, or no modes
@pytest.mark.parametrize("count", [40, *slow_cases(500)])
def test_a_plain_point_is_that_of_any_oscillator(count, slow, share, monkeypatch):
    rng, plain = np.random.default_rng(13), 0
    for _ in range(count):
        system = drawn(rng, slow)
        squares = np.linalg.eigvals(np.linalg.solve(system.linear.M, system.linear.K)).real
        points = both(system, monkeypatch)
        if points is None or np.abs(squares / system.omega**2 - 1).min() < 1e-3:
            continue
        plain += 1
        for name in SAME:
            assert np.array_equal(points[0][name], points[1][name]), (system, name)
        free = np.isinf(points[1]["swing"])
        assert np.isinf(points[0]["swing"]) == free
        if free:
            assert points[0]["rounding"] <= max(5 * points[1]["rounding"], 2.0**-24)  # of residuals that are rounding
        else:
            exact = np.count_nonzero(system.linear.M) == system.masses  # else it is a bound of the other one
            most = 1 + BITS_LOST if exact else 20.0
            least, error = (1 - BITS_LOST) * points[1]["rounding"], points[0]["rounding"]
            assert least <= error <= most * points[1]["rounding"], system
        for name in FIELDS if not free else FIELDS_OF_FREE:
            one, other = (np.asarray(point[name]) for point in points)
            assert np.abs(one - other).max() <= BITS_LOST * np.abs(other).max(), (system, name)
        assert points[0]["constrained_rate"] >= points[1]["constrained_rate"] * (1 - BITS_LOST)
        assert in_the_frame(points[0]) <= 2.0**-48, system
    assert plain > share * count


@pytest.mark.parametrize(
    "changes",
    [
        dict(k=[1, 1e5, 1]), dict(c=[0.3, 0.1, 0]), dict(offset=2),
        dict(omega=1e-3), dict(omega=1.0, c=[0, 0, 0]),
    ],
    ids=["far rates", "damping", "stops on one side", "slow force", "resonance"],
)  # fmt: skip
def test_what_is_not_plain_is_left_to_numpy(changes, monkeypatch):
    numbers = dict(m=[1, 1], k=[1, 1, 1], c=[0.1, 0.1, 0.1], force=[1, 0], omega=0.7, b=1, R=0.8)
    assert both(vs.Oscillator.named("chain", **numbers), monkeypatch) is not None
    assert both(vs.Oscillator.named("chain", **numbers | changes), monkeypatch) is None


@exported
def set_any_point(machine, point, modes):
    """As a page does, which takes points without frames as well."""
    return set_modes(machine[0], modes[0]) == COUPLED and set_coupled_point(machine[0], point[0], modes[0])


def test_points_of_coupled_modes_have_all_but_frames():
    """Such a point, for pages, says no exponents and confines no motion; its rates are bounds."""
    rng = np.random.default_rng(4)
    for _ in range(40):
        n = int(rng.integers(2, 6))
        k, c, m = (rng.uniform(low, 2, size) for low, size in ((0.2, n + 1), (0.0, n + 1), (0.5, n)))
        system = vs.Oscillator.named("chain", m=m, k=k, c=0.3 * c, force=rng.normal(size=n), omega=1.0, b=1, R=0.8)
        q = stacked([system.linear])
        wanted = any_points._other_points(q, any_points.kind_of(q), True)
        machine, point = np.zeros(1, machine_of(n)), np.zeros(1, wanted.dtype)
        for name in machine.dtype.names:
            machine[name] = getattr(q.contact if name == "normal" else q, name)
        assert set_any_point(machine, point, np.empty(1, modes_of(n)))
        assert np.isnan(point["to_frame"]).all() and np.isinf(point["swing"][0])
        for name in ("stiffness", "damping", "force", "constrained", "push", "P", "back", "divergence"):
            assert np.abs(point[name] - wanted[name]).max() <= BITS_LOST * np.abs(wanted[name]).max(), name
        for name in ("rate", "constrained_rate"):
            assert wanted[name][0] <= point[name][0] * (1 + BITS_LOST) <= 4 * wanted[name][0], name


@exported
def refine_any_point(machine, point, modes):
    """As a page does."""
    known = set_modes(machine[0], modes[0]) != UNKNOWN and set_coupled_point(machine[0], point[0], modes[0])
    refine_equations(machine[0], point[0], modes[0])
    return known


def test_equations_of_rates_apart_are_those_in_fractions():
    """Their second floats too: together they have nearly twice the digits of the largest terms."""
    rng = np.random.default_rng(6)
    for _ in range(40):
        n = int(rng.integers(2, 6))
        k, c, m = 10 ** rng.uniform(-2, 5, n + 1), 10 ** rng.uniform(-3, 2, n + 1), rng.uniform(0.5, 2, n)
        chain = vs.Oscillator.named("chain", m=m, k=k, c=c, force=rng.normal(size=n), omega=1.0, b=1, R=0.8).linear
        normal = rng.normal(size=n)
        M = chain.M + (rng.random() < 0.5) * np.outer(normal, normal)
        q = stacked([chain._replace(M=M).with_contact(normal=normal)])
        contact = ContactCoordinates(*(one[0] for one in contact_coordinates(q)))
        rounded, left = exact_motion(selected(q, 0), contact)
        machine, point = np.zeros(1, machine_of(n)), np.zeros(1, point_of(any_points.kind_of(q)))
        for name in machine.dtype.names:
            machine[name] = getattr(q.contact if name == "normal" else q, name)
        assert refine_any_point(machine, point, np.empty(1, modes_of(n)))
        assert point["apart"][0] == (point["rate"][0] > 8.0)
        high = np.hstack([-point["stiffness"][0], -point["damping"][0], point["force"][0]])
        P, back, compliance = (np.abs(one) for one in (contact.P, contact.back, np.linalg.inv(q.M[0])))
        terms = P @ compliance @ (np.abs(q.K[0]) + np.abs(q.C[0])) @ back
        apart = (high - rounded) + (point["low"][0] - left)
        assert np.abs(apart).max() <= 2.0**-92 * terms.max()
        assert np.abs(point["low"][0]).max() > 2.0**-60 * terms.max()
