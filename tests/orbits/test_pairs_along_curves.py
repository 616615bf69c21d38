"""Two pairs of multipliers that cross the unit circle within a step of a curve: their test has one sign at its ends."""

import pytest

import vibro_sweep as vs


@pytest.fixture(scope="module")
def graze():
    """Of a chain of five, weakly damped."""
    chain = vs.Oscillator.named(
        "chain", stop_at=1, omega=0.7080516, R=0.9168, b=0.4660973, tau=1.781975,
        m=[2.1657, 1.5235, 2.3139, 1.4191, 1.4858], k=[0.96195, 0.91931, 1.5262, 2.1543, 0.56576, 2.3268],
        c=[0.0030044, 0.0009159, 0.0021932, 0.0025545, 0.0019075, 0.0026846],
        force=[-0.73896, -0.84557, 0.03526, 0.47549, 0.47472],
    )  # fmt: skip
    branch = vs.continue_orbit(vs.periodic_orbit(chain, itinerary="LR"), "b", (0.15, 1.6))
    return next(special for special in branch.special if special.type == "graze")


def followed(graze, factor):
    curve = vs.bifurcation_curve(graze, ("b", "omega"), ((0.112, 0.448), (0.566, 0.885)), step=factor)
    return [(special.type, special.parameters["b"]) for special in curve.special]


@pytest.mark.slow
@pytest.mark.parametrize("factor", [0.5, 1, 2])
def test_points_of_a_curve_do_not_depend_on_steps(graze, factor):
    fine, found = (followed(graze, f) for f in (0.25, factor))
    assert [kind for kind, _ in fine].count("neimark_sacker_graze") > 2
    assert [kind for kind, _ in found] == [kind for kind, _ in fine]
    assert [b for _, b in found] == pytest.approx([b for _, b in fine], rel=1e-9)
