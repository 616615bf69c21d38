"""No exponent is told from zero that is zero: idle modes, modes without losses, regular motion; and chaos still is."""

from functools import partial

import numpy as np
import pytest
from support import slow_cases, zero_exponents
from support.oscillators import PAPER
from support.searching import searched

import vibro_sweep as vs


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


def reasons(windows) -> set[str]:
    """Why points of a sweep are in no window."""
    reason = windows.to_xarray().orbit_reason
    words = dict(zip(reason.flag_values.tolist(), reason.flag_meanings.split(), strict=True))
    return {words[code] for code in reason.values.tolist()}


@pytest.mark.parametrize("count", slow_cases(1, 20))
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
            assert not windows and reasons(windows) == {"not_isolated"}


def test_a_ball_that_flies_towards_a_stop_is_on_its_way(tmp_path):
    ball = vs.Oscillator.named("ball_in_cavity", mass_ratio=0.59, zeta=0.01, F=1, omega=0.9, b=1e6, tau=0, R=0.6)
    start = dict(x1=0.0, v1=0.0, x2=0.0, v2=0.01)
    vs.sweep(ball, {"omega": [0.5, 0.9]}, start=start, transient=1300, output=tmp_path / "a.h5", workers=1).close()
    assert reasons(vs.windows(tmp_path / "a.h5")) == {"not_settled"}


def rare(counted) -> bool:
    """Whether three in a hundred at most are off by more than twice their error."""
    return counted["exponents up to 5"] <= 0.03 * counted["exponents"]


@pytest.mark.slow
def test_free_motion():
    counted, wrong = searched(partial(zero_exponents.study_of_free_motion, most=2), range(30))
    assert wrong == [] and rare(counted)
    assert counted["exponents"] > 45 and counted["zeros"] > 15


@pytest.mark.slow
def test_regular_motion_without_losses():
    counted, wrong = searched(zero_exponents.study_of_regular_motion, range(12))
    assert wrong == [] and rare(counted) and counted["exponents"] == 6 * 2 + 6 * 3


@pytest.mark.parametrize("count, least", slow_cases((20, 1), (150, 20)))
def test_chaos_is_told_from_zero_as_well_as_by_the_scatter_alone(count, least):
    counted, wrong = searched(zero_exponents.study_of_chaos, range(count))
    assert wrong == [] and counted["certain"] >= least
    assert counted["as stated"] >= counted["by the scatter"]
    small = counted["errors over the scatter up to 1"] + counted["errors over the scatter up to 1.2"]
    assert small >= counted["certain"] / 2  # the median is 1.2 at most
