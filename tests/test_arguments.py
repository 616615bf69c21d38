"""What Python functions are given: a result, or a ValueError that names the argument and what is allowed."""

import math

import numpy as np
import pytest

import vibro_sweep as vs
from vibro_sweep.model.parameters import ParameterError
from vibro_sweep.scene import parse_scene

SYSTEM = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.6)
REST = (0.0, 0.0, 0.0, 0.0)
STATES = [
    (0, 0, 0, math.nan),
    (0, 0, 0, math.inf),
    ("0", "0", "0", "0"),
    "rest",
    None,
    (0, 0, 0),
    (0, (1, 2), 0, 0),
    (True, False, True, True),
    (0, 0, 0, 1j),
    (0, 0, 0, 10**400),
]


@pytest.mark.parametrize("state", STATES, ids=repr)
@pytest.mark.parametrize(
    "call",
    [
        lambda state: vs.simulate(SYSTEM, state, periods=1),
        lambda state: vs.lyapunov(SYSTEM, state, transient=0, periods=1),
        lambda state: vs.discontinuity_map(SYSTEM)(state),
        lambda state: vs.discontinuity_map(SYSTEM).jacobian(state),
    ],
    ids=["simulate", "lyapunov", "map", "jacobian"],
)
def test_states(call, state):
    with pytest.raises(ValueError, match=r"state: .* is not allowed; it must be four finite numbers"):
        call(state)


@pytest.mark.parametrize("value", [-1, 0.5, math.nan, math.inf, "3", None, True, 1e300, 10**400, [1], 1j])
def test_counts(value):
    for call in (
        lambda: vs.simulate(SYSTEM, REST, periods=value),
        lambda: vs.lyapunov(SYSTEM, REST, transient=value, periods=1),
        lambda: vs.lyapunov(SYSTEM, REST, transient=0, periods=value),
    ):
        with pytest.raises(ValueError, match=r"(periods|transient): .* is not allowed; it must be a whole number"):
            call()


def test_numbers_of_any_kind_are_numbers():
    for one in (1, 1.0, np.int8(1), np.float32(1), np.longdouble(1), np.array(1)):
        assert len(vs.simulate(SYSTEM, np.zeros(4, np.int8), periods=one, start_time=one).section) == 2


@pytest.mark.parametrize("value", [1e300, 1e17, -1e11, math.nan, math.inf, "0", None, True])
def test_start_times(value):
    with pytest.raises(ValueError, match=r"start_time: .* is not allowed; it must be a number of at most"):
        vs.simulate(SYSTEM, REST, periods=1, start_time=value)


def test_more_exponents_than_memory_is_to_be_taken_for():
    with pytest.raises(ValueError, match=r"periods: 1000000000 is not allowed; .* <= 12500000"):
        vs.lyapunov(SYSTEM, REST, transient=0, periods=10**9)


@pytest.mark.parametrize(
    "argument, value",
    [("order", True), ("order", 3), ("order", "1"), ("order", None)]
    + [("expand_at", value) for value in (math.nan, math.inf, 0, -1.0, "6.7", True, [6.7])],
)
def test_maps(argument, value):
    with pytest.raises(ValueError, match=f"{argument}: .* is not allowed; it must be"):
        vs.discontinuity_map(SYSTEM, **{argument: value})


@pytest.mark.parametrize("name", ["mu_m", "mu_k", "zeta", "omega", "b", "tau"])
@pytest.mark.parametrize("value", [np.longdouble("1e4000"), 10**400], ids=["longdouble", "integer"])
def test_numbers_beyond_the_floats(name, value):
    with pytest.raises(ParameterError) as caught:
        SYSTEM.replace(**{name: value})
    assert caught.value.key == name


@pytest.mark.parametrize("workers", [0, -1, 1.5, True, "2", 10**20, math.nan])
def test_workers(tmp_path, workers):
    text = (
        "system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6.6}\norbit: {transient: 0, record: 1}"
    )
    with pytest.raises(ValueError, match=r"workers: .* is not allowed; it must be a whole number from 1 to 1024"):
        vs.run(parse_scene(text), tmp_path / "out.h5", workers=workers)
    assert not list(tmp_path.iterdir())


@pytest.fixture(scope="module")
def orbit():
    return vs.periodic_orbit(SYSTEM.replace(b=3.0), itinerary="LR")


@pytest.mark.parametrize(
    "times", [None, "0", [None], [True], [[0.0]], [[0.0], [1.0, 2.0]], {}, 1j, math.nan, [math.inf], 1e300, -(10**400)]
)
def test_sampled_times(orbit, times):
    for one in (orbit, vs.simulate(SYSTEM, REST, periods=1)):
        with pytest.raises(ValueError, match=r"times: .* is not allowed; it must be"):
            one.sample(times)
        assert one.sample([]).shape == (0, 4) and one.sample(0).shape == (1, 4)


def test_branches(orbit):
    for bounds in (("1", "4"), (True, 4), (1,), 4, None, (1, math.nan), {1: 2, 4: 5}):
        with pytest.raises(ValueError, match=r"bounds: .* is not allowed; it must be \(lo, hi\)"):
            vs.continue_orbit(orbit, "b", bounds)
    for depth in (True, -1, 1.5, "1", None):
        with pytest.raises(ValueError, match=r"depth: .* is not allowed; it must be a whole number"):
            vs.follow_branches(orbit, "b", (1, 4), depth=depth)
    for follow in ("flip", 5, None, ["fold"], [5]):
        with pytest.raises(ValueError, match=r"follow: .* is not allowed; it must be a list of"):
            vs.follow_branches(orbit, "b", (1, 4), follow=follow)


@pytest.mark.parametrize("guess", [5, "abc", [(0, 1)], [("0", 1, 1)], [(0, True, 1)], [(0, 1, None)], [(0, 1, 1j)]])
def test_guesses(guess):
    with pytest.raises(ValueError, match=r"guess: must be \(t, side, v\)"):
        vs.periodic_orbit(SYSTEM, guess=guess)
