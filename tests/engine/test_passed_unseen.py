"""What lies between two points of a branch although their tests do not tell: bifurcations and births."""

import numpy as np
import pytest
from support import sample, slow_cases
from support.branches import exact, same_points, types
from support.drawn_branches import Case
from support.same_branch import follow, rows

import vibro_sweep as vs
from vibro_sweep.analysis.branches.crossings import explained, stands_alone
from vibro_sweep.analysis.branches.looking import extremum
from vibro_sweep.engine.continuation.between_points import FARTHER, dips
from vibro_sweep.engine.simd.jit import exported

BESIDE = vs.Oscillator(
    M=[[1.013195585878699, -0.55204056781175], [-0.55204056781175, 2.637855657462587]],
    K=[[0.6186294619195736, -0.43531312017067053], [-0.43531312017067053, 0.7490062589269704]],
    C=[[0.017931341976962122, -0.016782229109168982], [-0.016782229109168982, 0.05128108826042008]],
    contact_normal=[-0.9584651407408522, 1.2063082654617954], force=[0.5414602008133512, -0.4247086091937014],
    force_cos=[0.21265631867212226, 0.4614742868969503], omega=1.5001755162828383, R=0.669, b=0.2140312390626448,
    tau=3.8085663752458316,
)  # fmt: skip
TURNED = vs.Oscillator.named(
    "one_mass", zeta=0.009193095240087783, F=1.341737736580175, omega=1.4905, R=0.44, b=0.372790641903939,
    offset=-0.04156552419734383, tau=0.6194168875425987,
)  # fmt: skip


@pytest.fixture(scope="module")
def beside_fold():
    """A Neimark-Sacker point beside a fold: the branch entered from both its ends, from the fold, in other steps."""
    bounds = (0.0856, 0.3425)
    state = vs.simulate(BESIDE, np.zeros(4), 600).sample([600 * BESIDE.period])[0]
    short = vs.continue_orbit(vs.periodic_orbit(BESIDE, state=state, periods=5), "b", bounds)
    orbits = [orbit for end in (short.begins, short.ends) for orbit in vs.switch(end)]
    branches = [vs.continue_orbit(orbit, "b", bounds) for orbit in orbits]
    fold = next(special for special in branches[0].special if special.type == "fold")
    return [*branches, vs.continue_orbit(fold.orbit, "b", bounds)]


@pytest.mark.slow
def test_a_pair_goes_out_where_a_fold_takes_one_in(beside_fold):
    """As many multipliers lie outside before both points as behind them."""
    kinds = ["graze", "flip", "neimark_sacker", "fold", "graze"]
    upwards = [types(branch) if branch.special[1].type == "flip" else types(branch)[::-1] for branch in beside_fold]
    assert [[kind for kind, _ in one] for one in upwards] == [kinds] * 3
    values = np.array([[value for _, value in one] for one in upwards])
    assert np.ptp(values, axis=0).max() < 1e-12
    torus = next(special for special in beside_fold[0].special if special.type == "neimark_sacker")
    assert abs(exact(torus, "b") - torus.parameters["b"]) < 1e-13


@pytest.mark.slow
@pytest.mark.parametrize("factor", [0.5, 2])
def test_they_do_not_depend_on_the_step(beside_fold, factor):
    for branch in beside_fold[:2]:
        begun = next(special.orbit for special in branch.special if special.type == "fold")
        same_points(vs.continue_orbit(begun, "b", (0.0856, 0.3425), step=factor), types(beside_fold[2]), 1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("bounds", [(1.2, 1.8), *slow_cases(((0.3, 2.1),), ((1.0, 1.52),))])
def test_a_step_that_lands_on_the_birth(bounds):
    """With the first bounds a point lies where a multiplier is 1.00000003 and the tangent's sign is rounding."""
    state = vs.simulate(TURNED, [0, 0], 1500).sample([1500 * TURNED.period])[0]
    branch = vs.continue_orbit(vs.periodic_orbit(TURNED, state=state, periods=4), "omega", bounds)
    assert [special.type for special in branch.special] == ["graze", "flip", "flip"]
    assert branch.ends.orbit.period == 2  # the parent's
    parent = vs.continue_orbit(branch.ends.orbit, "omega", (1.5, 1.52))
    flips = [special.parameters["omega"] for special in parent.special if special.type == "flip"]
    assert branch.ends.parameters["omega"] == pytest.approx(min(flips, key=lambda value: abs(value - 1.508)), abs=1e-12)
    assert np.all(np.diff(branch.points.omega.values) > 0)


class Stand:
    """A point with multipliers only."""

    def __init__(self, multipliers):
        self.solution, self.torus = self, np.nan
        self.multipliers = multipliers


def crossings(matrices):
    """Which bifurcations lie between neighbouring matrices of a path, from their eigenvalues alone."""
    mu = np.array([np.sort_complex(np.linalg.eigvals(matrix)) for matrix in matrices])
    fold, flip = (np.sign(np.prod(1 - sign * mu, axis=1).real) for sign in (1, -1))
    outside = np.sum(np.abs(mu) > 1, axis=1)
    result = []
    for k in np.flatnonzero((np.diff(fold) != 0) | (np.diff(flip) != 0) | (np.diff(outside) != 0)):
        one = [kind for kind, sign in (("fold", fold), ("flip", flip)) if sign[k] != sign[k + 1]]
        result.append((k, one if one else ["neimark_sacker"]))
    return mu, result


@pytest.mark.parametrize("paths", [20, *slow_cases(400)])
def test_counts_tell_what_is_missing(paths):
    """On random paths of 4 x 4 matrices: a bifurcation explains the change that it makes, no other one does, nor
    none; what is not explained although nothing was left out are multipliers that meet near the circle, seldom."""
    rng, counted, refused, s = np.random.default_rng(4), 0, 0, np.linspace(0, 1, 2001)
    for _ in range(paths):
        parts = rng.normal(size=(3, 4, 4)) * [[[0.7]], [[1.0]], [[0.5]]]
        path = parts[0] + s[:, None, None] * parts[1] + (s**2)[:, None, None] * parts[2]
        mu, events = crossings(path)
        places = [0, *(k for k, _ in events), 2000]
        for before, (k, kinds), behind in zip(places, events, places[2:], strict=False):
            if len(kinds) != 1 or behind - before < 8:
                continue
            a, b = Stand(mu[max(k - 3, before + 1)]), Stand(mu[min(k + 4, behind)])
            if any(np.any(np.abs(np.abs(point.multipliers) ** 2 - 1) < 1e-6) for point in (a, b)):
                continue
            counted += 1
            refused += not explained(a, b, kinds)
            assert not explained(a, b, [])
            for other in {"fold", "flip", "neimark_sacker"} - set(kinds):
                assert not explained(a, b, [other])
    assert counted > 0.75 * paths
    assert refused < 0.02 * counted


@exported
def dips_at(x, y, z, before, behind):
    return dips(x, y, z, before, behind)


def test_an_extremum_is_looked_for_where_a_parabola_comes_nearer_to_zero():
    """Of 4000 parabolas at three points those with two zeros near the middle one, or between it and the last, and few
    others but those of which the middle point is much nearer to zero."""
    rng, looked, hidden = np.random.default_rng(3), 0, [0, 0]
    for _ in range(4000):
        before, behind = rng.uniform(0.5, 1.5, 2)
        at, least, curve = rng.uniform(-0.4, 1.0) * behind, rng.uniform(-0.2, 2.0), rng.uniform(0.2, 5.0)
        x, y, z = (least + curve * (place - at) ** 2 for place in (-before, 0.0, behind))
        if not (0 < y <= x and z > 0):
            continue
        found = extremum(before, behind, x, y, z)
        assert dips_at(x, y, z, before, behind) == (found is not None)
        assert dips_at(-x, -y, -z, before, behind) == (found is not None)
        looked += found is not None and min(x, z) <= FARTHER * y
        if least < 0:
            hidden[int(z < y)] += 1
            assert found == pytest.approx(at, abs=1e-9)
    assert min(hidden) > 20
    assert looked < 0.3 * 4000


def loaded_ball(b: float):
    return vs.Oscillator.named(
        "ball_in_cavity", mass_ratio=0.12107258245090825, zeta=0.028718477932176745, F=0.2882207938717394,
        omega=1.973330563076163, R=0.8257742338315457, b=b, tau="grazing",
    )  # fmt: skip


@pytest.fixture(scope="module")
def loaded():
    """A branch that is born at a pitchfork; then a pair goes out, becomes two real ones, and one comes in."""
    bounds = (0.01, 0.109)
    parent = vs.continue_orbit(vs.periodic_orbit(loaded_ball(0.035), itinerary="LLRR"), "b", bounds)
    (birth,) = (special for special in parent.special if special.type == "pitchfork")
    return Case(vs.switch(birth)[0], "b", bounds)


@pytest.mark.parametrize("factor", sample(1, [1, 2, 3]))
def test_a_pair_that_becomes_two_of_which_a_flip_takes_one_back(loaded, factor):
    """All that within one long step: its ends differ by what a flip does, and a neutral saddle hides the torus."""
    kinds = [kind for kind, _ in types(follow(loaded, factor))]
    assert kinds == ["graze", "flip", "neimark_sacker", "pitchfork"]


@pytest.mark.slow
def test_a_graze_does_not_depend_on_the_start(loaded):
    """Of a doubled orbit with a free mode: rounding of its stop_distance is larger than that of the graze."""
    parent = follow(loaded)
    (flip,) = (special for special in parent.special if special.type == "flip")
    case = loaded._replace(orbit=vs.switch(flip)[0])
    branch = follow(case)
    orbits = [case.orbit, *(rows(branch, case, k) for k in range(12, len(branch.points.point) - 4, 4))]
    orbits = [orbit for orbit in orbits if orbit.ok and orbit.period == 2]
    ends = [end for orbit in orbits for end in follow(case._replace(orbit=orbit)).special if end.type == "graze"]
    (beyond,) = [orbit for orbit in vs.switch(ends[0]) if len(orbit.impacts) == 9]
    ends += [end for end in vs.continue_orbit(beyond, "b", loaded.bounds).special if end.impact is not None][:1]
    values, errors = (np.array(one) for one in zip(*((end.parameters["b"], end.error) for end in ends), strict=True))
    assert len(ends) > 6
    assert np.ptp(values) < 2 * errors.min()


@pytest.mark.slow
def test_a_pair_that_goes_out_and_comes_back_within_a_step():
    """A chain of four; another pair is as near to the circle, and all the tests have one sign at both ends of the step.
    From each point of the branch."""
    chain = vs.Oscillator.named(
        "chain", stop_at=1, omega=1.694763070173401, R=0.9302849928693322, b=0.15423415238272734,
        m=[2.1704838438148224, 2.016397624402721, 2.8848289012369, 2.142958785062927],
        k=[2.443472720324935, 1.118099785501611, 1.9695940019590559, 2.558174347419574, 0.30503480295263985],
        c=[0.14450005552956577, 0.061569680138501726, 0.06696202112173676, 0.030983872336523267, 0.04770137064485006],
        force=[-1.0547386729927153, -0.4508916632719665, 0.625012635140836, -2.0385347528666182],
    )  # fmt: skip
    orbit = vs.periodic_orbit(chain, itinerary="LLRR")
    case = Case(orbit, "b", (0.1111128572130296, 1.2222414293433257))
    branch = follow(case)
    kinds = [kind for kind, _ in types(branch)]
    assert kinds.count("neimark_sacker") == 5
    for k in range(2, len(branch.points.point) - 2, 2):
        orbit = rows(branch, case, k)
        if orbit.ok:
            found = [kind for kind, _ in types(follow(case._replace(orbit=orbit)))]
            assert found in (kinds, kinds[::-1]), k


def test_counts_do_not_tell_of_a_pair_that_goes_out_and_one_that_comes_in():
    here = np.array([1.01 * np.exp(2.7j), 0.99 * np.exp(2.3j), 0.5])
    ends = [Stand(np.array([*mu, *mu.conj()])) for mu in (here, here * [0.98, 1.02, 1], here * [1.001, 0.999, 1])]
    assert not explained(ends[0], ends[1], []) and not explained(ends[1], ends[0], [])
    assert explained(ends[0], ends[2], [])


def test_the_pair_on_the_circle_is_on_different_sides_before_and_behind():
    """Else another one has crossed it too: of two outside one is left, and a third one has gone out and come in."""
    at = np.array([1.05 * np.exp(2.6j), 0.99 * np.exp(2.1j), np.exp(1.7j)])
    paths = (at, at * [1, 1.02, 0.99], at * [1, 1, 0.99], at * [1, 1, 1.01])
    point, before, behind, other = (Stand(np.array([*mu, *mu.conj()])) for mu in paths)
    assert not stands_alone(before, behind, point, "neimark_sacker")
    assert stands_alone(other, behind, point, "neimark_sacker")


@pytest.mark.slow
def test_a_pair_that_goes_out_where_another_one_comes_in():
    """Within one step of twice the usual length: as many lie outside before it and behind it."""
    system = vs.Oscillator(
        M=[[1.953, -0.0039, 0.3153, 0.0741], [-0.0039, 4.1814, 0.7996, -0.9339],
           [0.3153, 0.7996, 1.803, 0.2458], [0.0741, -0.9339, 0.2458, 2.0221]],
        K=[[1.329, 0.0617, -0.0626, -0.9331], [0.0617, 0.626, 0.7021, -0.0803],
           [-0.0626, 0.7021, 1.8622, -0.0633], [-0.9331, -0.0803, -0.0633, 1.5369]],
        C=[[0.0010838, 0.0001287, -0.0002303, 0.0018514], [0.0001287, 0.0024827, -0.0011777, 0.0020326],
           [-0.0002303, -0.0011777, 0.0069247, -0.002277], [0.0018514, 0.0020326, -0.002277, 0.0072971]],
        contact_normal=[-0.09619, -0.55797, 0.45701, -1.33235], force=[-0.77858, 0.98543, -0.08759, 1.04249],
        force_cos=[0.51296, -0.63732, 1.01827, 1.11931], omega=0.4514226, R=0.9942246, b=9.3101, tau=0.6098279,
    )  # fmt: skip
    case = Case(vs.periodic_orbit(system, itinerary="LR"), "b", (0.98, 10.7))
    usual, longer = (types(follow(case, factor)) for factor in (1.0, 2.0))
    assert [kind for kind, _ in longer] == ["graze", "neimark_sacker", "neimark_sacker", "graze"]
    same_points(follow(case, 2.0), usual, 1e-12)
