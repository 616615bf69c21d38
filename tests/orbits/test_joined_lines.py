"""What lines of branches join: one multiplier, and one turning point, of one branch."""

from types import SimpleNamespace

import numpy as np
import pytest

import vibro_sweep as vs
from vibro_sweep.analysis.branches.branch_arrays import arrays_of, sections_of
from vibro_sweep.plotting import multiplier_lines


class Points(SimpleNamespace):
    """Arrays of a file of branches over the parameter b, and one state x1."""

    parameters = ("b",)

    def __getitem__(self, name):
        return getattr(self, name)


def stored(mu) -> dict:
    """Multipliers (points, 2N) as files have them: by falling modulus, of a pair the positive imaginary part first."""
    order = np.lexsort((-mu.imag, -np.abs(mu).round(12)))
    mu = np.take_along_axis(mu, order, axis=1)
    return {"multiplier_re": mu.real, "multiplier_im": mu.imag}


def test_each_line_is_one_multiplier():
    """Two branches, each with a real multiplier that passes a pair, and a small one: known as functions of b."""
    b = np.linspace(0, 1, 23)
    real, size, small = 0.3 + 0.9 * b, 0.72 + 0.02 * b, 1e-3 * np.exp(-20 * b)
    pair = size * np.exp(1j * (1 + 0.3 * b))
    one = np.stack([real, pair, pair.conj(), small], axis=1)
    both = np.concatenate([one, one[::-1]])
    found = multiplier_lines.multipliers(Points(branch_row_size=np.array([23, 23]), **stored(both)))
    for part, falls in ((found[:23], False), (found[23:], True)):
        columns = part[:: -1 if falls else 1].T
        for expected in (real, size, size, small):
            assert min(np.abs(column - expected).max() for column in columns) < 1e-12
    largest = np.abs(both).max(axis=1)  # one line of these would change from the pair to the real one
    assert not any(np.allclose(column, largest[:23]) for column in found[:23].T)


def test_two_real_multipliers_become_a_pair():
    b = np.linspace(-1, 1, 41)
    root = 0.2 * np.sqrt(b + 0j)
    found = multiplier_lines.multipliers(
        Points(branch_row_size=np.array([41]), **stored(np.stack([0.6 + 1j * root, 0.6 - 1j * root], 1)))
    )
    assert np.all(np.abs(np.diff(found, axis=0)) < 0.06)
    assert found[-1, 0] == found[-1, 1] and abs(found[0, 0] - found[0, 1]) > 0.3


def test_a_mark_is_where_a_multiplier_is_on_the_circle():
    moduli = np.array([1.7, 1.0000001, 0.2])
    assert multiplier_lines.at_circle(moduli, True) == 1.0000001 and multiplier_lines.at_circle(moduli, False) == 1.7


@pytest.mark.parametrize("at", [1, 10, 30])
def test_another_turning_point_begins_another_line(at):
    """One turning point is the nearest up to a point of the branch, then there is none such, and it is another."""
    b = np.sort(np.random.default_rng(3).uniform(0, 1, 40))
    stop_distance = np.where(np.arange(40) < at, 0.2 + 0.3 * b, 1.5 - 0.4 * b)
    points = Points(
        branch_row_size=np.array([40]), b=b, x1=np.sin(b), stop_distance=stop_distance,
        special_point=np.zeros(0, int), special_impact=np.zeros(0, int),
    )  # fmt: skip
    expected = np.ones(40, bool)
    expected[[at - 1, 39]] = False
    assert multiplier_lines.margins(points, ["x1"]).tolist() == expected.tolist()
    points.stop_distance = 0.2 + 0.3 * b + 2 * b**3
    assert multiplier_lines.margins(points, ["x1"])[:-1].all()
    points.stop_distance[20] = np.inf
    assert np.flatnonzero(~multiplier_lines.margins(points, ["x1"])).tolist() == [19, 20, 39]


def test_an_impact_that_vanishes_is_no_turning_point():
    """At its graze the stop_distance is 0, that of the impact; where a turning point grazes it goes to 0."""
    b = np.linspace(0, 1, 20)
    points = Points(
        branch_row_size=np.array([20]), b=b, x1=b, stop_distance=0.04 * b, special_point=np.array([0, 19]),
        special_impact=np.array([1, -1]),
    )  # fmt: skip
    assert np.flatnonzero(~multiplier_lines.margins(points, ["x1"])).tolist() == [0, 19]


def test_section_states_are_continuous_along_a_branch():
    """Near b = 5.68 another of the four impacts has the earliest phase, with which an orbit alone begins."""
    system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=5.6)
    settled = vs.simulate(system, (0, 0, 0, 0), 2000).section[-1]
    branch = vs.continue_orbit(vs.periodic_orbit(system, settled, periods=8), "b", (5.55, 5.78))
    b, drawn = branch.points.b.values, sections_of(arrays_of(branch, 5.6), "b", system)
    assert drawn.shape[1] == 16 and len(b) > 10 and b[0] < 5.6 < 5.75 < b[-1]
    slopes = np.abs(np.diff(drawn[..., 0], axis=0) / np.diff(b)[:, None])
    assert slopes.max() < 15  # lines that changed places would have jumped by 1 in a step of 0.02
