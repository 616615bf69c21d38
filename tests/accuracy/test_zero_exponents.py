"""No exponent is told from zero that is zero: idle modes, modes without losses, regular motion; and chaos still is.

Free motion is compared with its roots in 100 digits, regular motion with the exponents 0 that integrable systems have.
"""

import math

import numpy as np
import pytest
from support import slow_cases, zero_exponents
from support.any_oscillators import frame_of_one
from support.oscillators import PAPER

import vibro_sweep as vs
from vibro_sweep.model.exponents import CERTAIN, sign_of
from vibro_sweep.model.outcomes import REASONS

BEYOND = (2.0, 5.0)  # errors


def soak(*values):
    return [
        pytest.param(*(value if isinstance(value, tuple) else (value,)), marks=pytest.mark.soak) for value in values
    ]


@pytest.mark.parametrize(
    "numbers",
    [
        dict(M=[[2, 0], [0, 0.1]], K=[[4020, 0], [0, 0]], C=[[2, 0], [0, 0]], force=[5, 0], omega=50),
        dict(M=[[1, 0], [0, 0.3]], K=[[9000, 0], [0, 0]], C=[[0.05, -0.05], [-0.05, 0.05]], force=[1, 0], omega=10),
        dict(M=[[1, 0], [0, 0.59]], K=[[1, 0], [0, 0]], C=[[0.02, 0], [0, 0]], force=[1, 0], omega=0.9),
    ],
    ids=["no damper", "held by a damper alone", "ball in a cavity"],
)
def test_what_nothing_holds_has_the_exponent_zero(numbers):
    system = vs.Oscillator(**numbers, contact_normal=[-1, 1], R=0.6, b=1e4, tau=0.0)
    for start in (np.zeros(4), np.array([0, 0, 0, 0.01])):
        assert vs.lyapunov(system, start, 300, 100)[0] == 0.0


def test_without_losses_no_exponent_differs_from_zero():
    system = PAPER.replace(zeta=0.0, b=1e3, tau=0.0)
    exponents = vs.lyapunov(system, (0.1, 0.2, 0.3, 0.4), 300, 200)
    assert (exponents == 0.0).all() and np.all(exponents.error < 1e-12)


@pytest.mark.parametrize("count", [*slow_cases(1, 20), *soak(200)])
def test_a_ball_at_rest_in_its_cavity_is_one_of_a_family(count, tmp_path):
    """Whatever is observed: period 1, exponent 0, and no window."""
    rng = np.random.default_rng(5)
    for n in range(count):
        numbers = dict(mass_ratio=10 ** rng.uniform(-1.5, 0), zeta=10 ** rng.uniform(-2.5, 0), F=rng.uniform(0.3, 1.2))
        ball = vs.Oscillator.named("ball_in_cavity", **numbers, omega=0.9, b=1e3, tau=rng.uniform(0, 6), R=0.6)
        for observed in (["section"], ["section", "lyapunov"]):
            file = tmp_path / f"{n}-{len(observed)}.h5"
            values = {"omega": rng.uniform(0.5, 1.5) * np.linspace(1, 1.5, 7)}
            transient = int(7 * values["omega"][-1] / ball.zeta) + 100  # until rounding is all that is left
            with vs.sweep(ball, values, transient=transient, observe=observed, output=file, workers=1) as sweep:
                assert (sweep.period == 1).all() and (sweep.status == 0).all(), (n, observed)
                assert "lyapunov" not in sweep or (sweep.lyapunov[:, 0] == 0).all()
            windows = vs.windows(file)
            assert not windows and {list(REASONS)[code] for code in windows.reason.ravel()} == {"not_isolated"}


def test_a_ball_that_flies_towards_a_stop_is_on_its_way(tmp_path):
    ball = vs.Oscillator.named("ball_in_cavity", mass_ratio=0.59, zeta=0.01, F=1, omega=0.9, b=1e6, tau=0, R=0.6)
    start = dict(x1=0.0, v1=0.0, x2=0.0, v2=0.01)
    vs.sweep(ball, {"omega": [0.5, 0.9]}, start=start, transient=1300, output=tmp_path / "a.h5", workers=1).close()
    assert {list(REASONS)[code] for code in vs.windows(tmp_path / "a.h5").reason.ravel()} == {"not_settled"}


@pytest.mark.parametrize("count", [20, *slow_cases(400), *soak(1000)])
def test_roots_of_frames(count):
    """The roots from which tangent vectors fly, and the error that frames give them, against 100 digits."""
    compared = zeros = 0
    for seed in range(count):
        system = zero_exponents.free(seed)
        found = frame_of_one(system)
        if np.isnan(found.to).any():
            continue
        apart = np.sqrt(np.maximum(-found.square, 0.0))
        fast = found.eta + apart
        slow = np.where(found.square < 0, (found.square + found.eta**2) / np.where(fast > 0, fast, 1.0), found.eta)
        exact, own = zero_exponents.real_parts(system), np.sort(-np.concatenate([slow, fast]))[::-1]
        assert np.abs(own - exact).max() <= found.rounding, (seed, own, exact)
        assert (own[exact == 0] == 0).all(), (seed, own, exact)
        compared, zeros = compared + 1, zeros + np.count_nonzero(exact == 0)
    assert compared >= 0.95 * count and zeros > count


def of_free_motion(seeds, most):
    """(tried, numbers compared, those beyond 2 and 5 errors, zeros, zeros that are not exactly 0)."""
    tried = compared = zeros = wrong = 0
    beyond = np.zeros(2, int)
    for seed in seeds:
        system = zero_exponents.free(seed, most)
        found = vs.lyapunov(system, np.zeros(2 * len(system.linear.M)), 300, 100)
        tried += 1
        if np.isnan(found).any():
            continue
        known, exact = np.isfinite(found), zero_exponents.real_parts(system)
        far = np.abs(found - exact)[known]
        beyond += [np.count_nonzero(far > limit * found.error[known]) for limit in BEYOND]
        compared, zeros = compared + known.sum(), zeros + np.count_nonzero(exact == 0)
        wrong += np.count_nonzero(found[exact == 0])
    return tried, compared, *beyond, zeros, wrong


@pytest.mark.parametrize("count, most", [*slow_cases((30, 2)), *soak((500, 4))])
def test_free_motion(count, most, capsys):
    tried, compared, two, five, zeros, wrong = of_free_motion(range(count), most)
    with capsys.disabled():
        print(f"\nfree motion: {tried} oscillators, {compared} exponents, beyond 2 and 5 errors {two}, {five}")
        print(f"of these {zeros} are 0, found not exactly 0: {wrong}")
    assert compared > 1.5 * count and zeros > count / 2 and five == wrong == 0 and two <= 0.03 * compared


@pytest.mark.parametrize("count", [*slow_cases(12), *soak(500)])
def test_regular_motion_without_losses(count, capsys):
    """One mass: both exponents are 0. Two masses: those of the flow and of the energy are, and all come in pairs."""
    beyond, compared, chaotic, tried = np.zeros(2, int), 0, 0, 0
    for seed in range(count):
        draw = zero_exponents.regular if seed % 2 == 0 else zero_exponents.of_two_masses
        system, start = draw(seed)
        found = vs.lyapunov(system, start, 1300, 200)
        assert not np.isnan(found).any()
        zero = found if len(found) == 2 else np.array([found[1], found[2], found[0] + found[3]])
        error = found.error[: len(zero)]
        beyond += [np.count_nonzero(np.abs(zero) > limit * error) for limit in BEYOND]
        tried, compared = tried + 1, compared + len(zero)
        chaotic += len(found) == 4 and sign_of(found[0], found.error[0]) > 0
    with capsys.disabled():
        print(f"\nwithout losses: {tried} oscillators, {chaotic} of two masses chaotic")
        print(f"{compared} numbers that are 0, beyond 2 and 5 errors {beyond[0]}, {beyond[1]}")
    assert beyond[1] == 0 and beyond[0] <= 0.03 * compared


def scatter(running, T):
    """The standard error of exponents from `lyapunov_running` (periods, n), by parts and their correlation alone."""
    periods = len(running)
    growth = running * np.arange(1, periods + 1)[:, None] * T
    ends = np.arange(1, 21) * (periods // 20) - 1
    rates = np.diff(growth[ends], axis=0, prepend=0) / (periods // 20 * T) - running[-1]
    squares = (rates**2).sum(axis=0)
    c = np.clip((rates[1:] * rates[:-1]).sum(axis=0) / squares + 1 / 20, 0, 0.8)
    return np.sqrt(squares / (20 * 19) * (1 + c) / (1 - c))


@pytest.mark.parametrize("count", [*slow_cases(1, 40), *soak(500)])
def test_chaos_is_told_from_zero_as_well_as_by_the_scatter_alone(count, capsys):
    """Of orbits whose lambda_1 > 0 is certain from a record 100 times as long."""
    certain = before = after = tried = seed = 0
    ratios = []
    while certain < count:
        system, start = zero_exponents.dissipative(seed)
        seed, tried = seed + 1, tried + 1
        told = {"observe": ["section", "lyapunov", "convergence"], "start": start, "transient": 1300}
        short = vs.sweep(system, {"b": [system.b]}, record=200, **told).isel(b=0)
        if not (short.period == 0 and short.status == 0 and np.isfinite(short.lyapunov).all()):
            continue
        long = vs.lyapunov(system, start, 1300, 20_000)
        if not long[0] > 5 * long.error[0]:
            continue
        certain += 1
        alone = scatter(short.lyapunov_running.values, system.period)
        m = int(np.argmax(short.lyapunov_running[-1].values))
        found, error = float(short.lyapunov[0]), float(short.lyapunov_error[0])
        shear = math.log(2) / (200 * system.period)
        assert error == pytest.approx(max(alone[m], shear), rel=1e-6, abs=1e-12)
        before, after = before + (found > CERTAIN * alone[m]), after + (found > CERTAIN * error)
        ratios.append(error / alone[m])
    with capsys.disabled():
        print(f"\nchaos: {tried} oscillators, {certain} certain from the long record; significant by the scatter")
        print(f"alone {before}, as stated {after}; median of the errors' ratio {np.median(ratios):.4f}")
    assert after >= before and np.median(ratios) <= 1.2


def test_an_error_that_is_not_a_number_tells_nothing():
    exponent = np.array([0.1, -0.1, 0.1, np.nan, -np.inf, 0.0])
    assert sign_of(exponent, np.array([0.01, 0.01, 0.06, 0.1, 0.0, 0.0])).tolist() == [1, -1, 0, 0, -1, 0]
