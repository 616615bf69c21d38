"""Branches of doubled and asymmetric orbits beside their births, where rounding decides the sign of the tangent."""

import numpy as np
import pytest
from support.branches import types

import vibro_sweep as vs
from vibro_sweep.analysis.branches.branch_run import BranchRun
from vibro_sweep.analysis.branches.branch_start import start_of_run
from vibro_sweep.analysis.branches.own_birth import halves_apart
from vibro_sweep.analysis.branches.passed_births import passed
from vibro_sweep.analysis.continuation.recorded import Rows
from vibro_sweep.analysis.continuation.solution_curve import branch_through
from vibro_sweep.analysis.windows.stretch import stable_end

TURNED = vs.Oscillator.named(
    "one_mass", zeta=0.009193095240087783, F=1.341737736580175, omega=1.4905, R=0.44, b=0.372790641903939,
    offset=-0.04156552419734383, tau=0.6194168875425987,
)  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("omega", [1.4695, 1.46952])
def test_the_way_to_a_birth_turns_round_at_no_fold(omega):
    """An orbit of 20 impacts: at a fiftieth of the way to its birth the sign of the tangent is rounding."""
    system = TURNED.replace(omega=omega)
    state = vs.simulate(system, [0, 0], 1500).sample([1500 * system.period])[0]
    born = vs.periodic_orbit(system, state=state, periods=8)
    assert len(born.itinerary) == 20
    end = stable_end(born, "omega", (1.27, 1.66), 1.0)
    assert (end.type, end.orbit.period) == ("flip", 4)
    parent = vs.periodic_orbit(TURNED.replace(omega=1.475), state=end.orbit.state, periods=4)
    flips = [value for kind, value in types(vs.continue_orbit(parent, "omega", (1.46, 1.48))) if kind == "flip"]
    assert len(flips) == 1
    assert abs(end.parameters["omega"] - flips[0]) < 1e-12


FREE = vs.Oscillator.named(
    "one_mass", k=0.0, zeta=0.0, F=1.8506852088671144, omega=0.8293795190899775, b=0.9019202943756924, tau=0.3, R=0.6227
)


def test_a_step_that_lands_before_a_birth_by_less_than_rounding():
    """There the sign of its tangent is rounding: no fold lies before it."""
    system = vs.Oscillator(
        M=[[1.1683289858099053]], K=[[2.026691054297847]], C=[[0.17115631105586904]],
        contact_normal=[0.4984838782225783],
        stops="left", force=[0.1005212186126239], force_cos=[0.4048093676312892], constant=[-0.0479180746421895],
        omega=0.5913598511646851, R=0.8636966901455452, b=0.03636840645107031, offset=-0.011280250179775082,
        tau=0.7223421946205266,
    )  # fmt: skip
    u = np.array(
        [
            2.189554639029831,
            3.935983123167149,
            5.140464534060758,
            6.500050253523475,
            12.814599720328157,
            14.560886452822379,
            15.76520150943135,
            17.124345366621142,
            0.15090060952503284,
            0.1935144871391686,
            0.15563550193098952,
            0.0820679376774993,
            0.15085850320587782,
            0.1934704693845098,
            0.15560625198162037,
            0.08208838499363963,
        ]
    )
    guess = [(t, -1, -D / (1 + system.R)) for t, D in zip(u[:8], u[8:], strict=True)]
    born, bounds = vs.periodic_orbit(system, guess=guess, periods=2), (-0.022696426666061177, -0.0008753827954189938)
    a = start_of_run(born._solution, "offset", *bounds)
    here = halves_apart(a.solution, 1)
    low, high = 3e-4, 5e-4  # before and beyond the birth
    apart = [here @ halves_apart(a.curve.step(a, length).solution, 1) for length in (low, high)]
    assert apart[1] < 0 < apart[0]
    birth = np.interp(0, apart[::-1], [high, low])
    ended = 0
    for share in np.geomspace(1e-3, 0.8, 10):
        run, length = BranchRun(a, system), (1 - share) * birth
        if (b := a.curve.step(a, length)) is not None:
            assert run._pass(a, b) == (len(run.special) == 1)
            assert [special.type for special in run.special] in ([], ["flip"])
            ended += len(run.special)
            for special in run.special:
                assert abs(special.parameters["offset"] + 0.0112802354692) < 1e-12
    assert 3 < ended < 10


def mirrored_ball(b: float):
    return vs.Oscillator.named(
        "ball_in_cavity", mass_ratio=0.017271819450076657, zeta=0.016963990878811692, F=0.7886565590720774,
        omega=1.0444602350008463, R=0.32567657306994136, b=b, tau="grazing",
    )  # fmt: skip


def test_where_halves_turn_round_is_counted():
    """Of points that pass a birth, and of those beside it on the parent's branch."""
    orbit = vs.periodic_orbit(mirrored_ball(7.0), itinerary="LR")
    s = orbit._solution.whole()
    curve = branch_through(s, "b", 1.0)
    late = np.array([0.1, 0.02, -0.03, -0.1, 1e-14, -1e-14])
    t = np.tile(s.times, (6, 1)) + late[:, None] * [0, 1]
    nothing = np.zeros((6, 0))
    rows = Rows(np.full(6, 7.0), t, np.tile(s.jumps, (6, 1)), nothing, nothing, nothing, nothing, nothing)
    assert passed(curve, [rows], None) == [2, 4, 5]
    assert passed(curve, [rows.taken(np.s_[:2]), rows.taken(np.s_[2:3])], None) == [2]
