"""Oscillators with names and any linear one: their matrices, their free motion, where it grazes, how they start."""

import math
import pickle
import re

import numpy as np
import pytest
from mpmath import mp, mpf
from support import ROOT, slow_cases
from support.models import GIVEN, PAPER, oscillator
from support.programs import ended
from support.scene_texts import parsed

import vibro_sweep as vs

ROWS = re.compile(r"^  (\w+)  +\S.*?  +(\S.*)$", re.MULTILINE)  # name, what it may be, text


def printed(name: str) -> str:
    """What the command says of a model or a law of contact."""
    end = ended("models", name)
    assert end.status == 0 and not end.err
    return end.out.rstrip("\n")


def response(q):
    """Complex amplitudes of the steady motion, in 40 digits."""
    with mp.workdps(40):
        w = mpf(q.omega)
        Z = mp.matrix(q.K) - w**2 * mp.matrix(q.M) + 1j * w * mp.matrix(q.C)
        return mp.lu_solve(Z, mp.matrix(q.cosine) - 1j * mp.matrix(q.sine))


@pytest.mark.parametrize("name", GIVEN)
class TestEveryModel:
    def test_it_says_what_it_is(self, name):
        """A title, a sketch, equations, each of its numbers and options, and where it is from."""
        text, one = printed(name), oscillator(name)
        title, sketch, *equations, rows, source = text.split("\n\n")
        assert title.startswith(f"{name}: ") and "\n" not in title and sketch.strip()
        assert any("= " in line for line in equations) and source.startswith("source: ") and len(source) > 12
        assert all(len(line) <= 110 for part in (sketch, *equations) for line in part.splitlines())
        described = dict(ROWS.findall(rows))
        keys = {re.sub(r"(?<=[a-z])\d+$", "", key) if key not in described else key for key in one.numbers}
        assert keys | set(one.options) <= described.keys() and all(described.values())

    def test_grazing_touches_in_forty_digits(self, name):
        """|n . X| from the middle of the steady gap, whatever the number of masses."""
        one = oscillator(name)
        q, touch = one.linear, vs.grazing(one)
        with mp.workdps(40):
            X = response(q)
            gap_response = sum(mpf(n) * x for n, x in zip(q.contact.normal, X, strict=True))
            middle = mpf(0)
            if np.any(q.constant):
                rest = mp.lu_solve(mp.matrix(q.K), mp.matrix(q.constant))
                middle = sum(mpf(n) * x for n, x in zip(q.contact.normal, rest, strict=True))
            offset = mpf(getattr(one, "offset", 0.0))
            expected = abs(gap_response) + middle - offset, abs(gap_response) - middle + offset
        assert touch.b_right == pytest.approx(float(expected[0]), rel=1e-13)
        assert touch.b_left == pytest.approx(float(expected[1]), rel=1e-13)
        assert (touch.b == touch.b_right) if expected[0] == expected[1] else math.isnan(touch.b)
        assert abs(math.remainder(touch.tau + float(mp.arg(gap_response)), 2 * math.pi)) < 1e-13
        state = np.array(touch.state)
        assert q.contact.normal @ state[0::2] == pytest.approx(float(abs(gap_response) + middle), rel=1e-13)
        assert abs(q.contact.normal @ state[1::2]) < 1e-13 * np.abs(state).max()
        assert one.phase == pytest.approx(touch.tau, abs=1e-14)

    def test_copies_are_equal(self, name):
        one = oscillator(name)
        assert pickle.loads(pickle.dumps(one)) == one == oscillator(name)
        assert hash(one) == hash(oscillator(name)) and one != one.replace(omega=1.1) and repr(one)
        for key, value in one.numbers.items():
            if isinstance(value, float):
                changed = one.replace(**{key: 0.4 * value + 0.1})
                assert changed.numbers[key] == 0.4 * value + 0.1 and one.numbers[key] == value
                both = map(numbers_of, (changed.linear, one.linear))
                assert any(map(np.any, map(np.not_equal, *both))), key  # each number matters

    def test_derivatives_by_every_number(self, name):
        """The complex step against differences of the matrices."""
        one = oscillator(name, tau=0.3)
        family = one.family
        for key, value in one.numbers.items():
            if not isinstance(value, float):
                continue
            step = 1e-6 * max(1.0, abs(value))
            high, low = (family.replace(**{key: value + sign * step}).linear for sign in (1, -1))
            slope = family.derivative(key)
            for numbers in zip(*map(numbers_of, (high, low, slope)), strict=True):
                up, down, found = (np.asarray(each, float) for each in numbers)
                finite = np.isfinite(up)
                difference = (up[finite] - down[finite]) / (2 * step)
                np.testing.assert_allclose(found[finite], difference, atol=2e-9, rtol=1e-8)

    def test_a_scene_of_it_and_back(self, name):
        one = oscillator(name)
        first = next(key for key, value in one.numbers.items() if isinstance(value, float) and value > 0)
        value = one.numbers[first]
        scene = parsed(
            f"system: {_yaml(one)}\nsweep: {{{first}: {{values: [{value}, {2 * value}]}}}}\n"
            "orbit: {transient: 1, record: 2}\n"
        )
        assert scene.system == one
        again = parsed(scene.to_yaml())
        assert again.system == one and list(again.sweep) == [first]
        assert scene.parameters()[first].tolist() == [value, 2 * value]


def numbers_of(q):
    """All numbers of a `vs.types.Linear` with one contact."""
    *numbers, (contact,) = q
    return [*numbers, *contact]


def _yaml(one):
    kind = {} if one.model.name == "two_mass" else {"type": one.model.name}
    given = {} if one.model.name == "two_mass" else {k: v for k, v in one.arguments.items() if v is not None}
    given = given or {name: value for name, value in PAPER.items()}
    text = ", ".join(
        f"{key}: {str(value).lower() if isinstance(value, bool) else value}" for key, value in (kind | given).items()
    )
    return "{" + text.replace("(", "[").replace(",)", "]").replace(")", "]") + "}"


def test_the_paper_as_a_chain_and_by_its_matrices():
    """Three ways to the same matrices."""
    paper = vs.System(**PAPER).linear
    chain = vs.Oscillator.named(
        "chain", m=[1, 10], k=[0, 1, 5], c=[0, 0.1, 0.5], force=[0.75, 0.25], omega=0.63, R=0.8, b=6.6
    ).linear
    plain = vs.Oscillator(
        paper.M, paper.K, rayleigh=[0, 0.1], force=[0.75, 0.25], contact_normal=[1, 0], omega=0.63, R=0.8, b=6.6
    ).linear
    for other in (chain, plain):
        for found, wanted in zip(*map(numbers_of, (other, paper)), strict=True):
            np.testing.assert_allclose(found, wanted, rtol=1e-14, atol=1e-15)


def test_damping_that_is_not_proportional():
    system = vs.System(**PAPER, mu_c=2.0)
    np.testing.assert_array_equal(system.linear.C, 0.1 * np.array([[1, -1], [-1, 3]]))
    assert vs.System(**PAPER, mu_c=5.0).linear.C.tolist() == vs.System(**PAPER).linear.C.tolist()
    assert system.divergence == pytest.approx(-np.trace(np.linalg.solve(system.linear.M, system.linear.C)), rel=1e-15)
    assert vs.grazing(system).b == pytest.approx(float(abs(response(system.linear)[0])), rel=1e-14)
    physical = dict(M1=2, M2=6, K1=8, K2=12, C1=0.4, C2=1.0, P1=3, P2=1, Omega=1.5, R=0.7, B=2)
    assert vs.System.physical(**physical).mu_c == pytest.approx(2.5)


def test_ratios_of_the_modes():
    """Each mode decays with its own: x = psi_j e^(lambda t), lambda^2 + 2 zeta_j omega_j lambda + omega_j^2 = 0."""
    M, K = np.array([[2, 0.3], [0.3, 1]]), np.array([[3, -1], [-1, 2.0]])
    q = vs.Oscillator(M, K, modal_damping=[0.1, 0.3], contact_normal=[1, 0], omega=1, R=1, b=1).linear
    squares, psi = np.linalg.eig(np.linalg.solve(M, K))
    for j, ratio in zip(np.argsort(squares), (0.1, 0.3), strict=True):
        root = np.sqrt(squares[j])
        rate = root * (-ratio + 1j * math.sqrt(1 - ratio**2))
        assert np.abs((rate**2 * M + rate * q.C + K) @ psi[:, j]).max() < 1e-14


def test_unequal_stops():
    system = vs.System(**PAPER, offset=0.5, R_left=0.6)
    q = system.linear
    assert (q.contact.low, q.contact.high, q.contact.R_low, q.contact.R_high) == (0.5 - 6.6, 0.5 + 6.6, 0.6, 0.8)
    alone = vs.System(**(PAPER | dict(b=-1.5)), stops="right").linear
    assert (alone.contact.low, alone.contact.high) == (-math.inf, -1.5)
    assert vs.System(**PAPER, stops="left", R_left=0.3).linear.contact.R_low == 0.3
    touch = vs.grazing(system)
    middle = vs.grazing(vs.System(**PAPER)).b
    assert (touch.b_right, touch.b_left) == (middle - 0.5, middle + 0.5) and math.isnan(touch.b)


def test_no_steady_motion():
    """A ball that falls on a table has none; neither has an undamped mode in resonance."""
    ball = vs.Oscillator.named(
        "one_mass", k=0, zeta=0, constant=-1, base=True, F=0.2, omega=1, R=0.8, b=0, stops="left"
    )
    assert ball.phase == 0 and math.isnan(vs.grazing(ball).b_left) and not vs.grazing(ball).satisfied
    assert ball.linear.sine.tolist() == [0.2]
    resonant = oscillator("one_mass", zeta=0, omega=1.0)
    assert resonant.phase == 0 and not vs.grazing(resonant).satisfied


def test_stops_about_the_static_equilibrium():
    """Both stops are grazed at the same clearance, whatever the rounding of the static state."""
    K = np.array([[3, -1.1, 0.3], [-1.1, 2.3, -0.7], [0.3, -0.7, 1.9]])
    rest, along = np.array([0.3, 0.1, -0.2]), np.array([1.0, 0, 0])
    given = dict(M=np.eye(3), K=K, C=K / 30, force=[1, 0, 0.2], contact_normal=along, omega=1.1, b=1, R=0.8)
    touch = vs.grazing(vs.Oscillator(**given, constant=K @ rest, offset=along @ rest))
    amplitude = abs(np.linalg.solve(K - 1.1**2 * np.eye(3) + 1.1j * K / 30, [1, 0, 0.2])[0])
    assert touch.satisfied and touch.b == touch.b_right == touch.b_left
    assert touch.b == pytest.approx(amplitude, rel=1e-14, abs=0)
    apart = vs.grazing(vs.Oscillator(**given, constant=K @ rest, offset=0.3 + 1e-9))
    assert math.isnan(apart.b) and apart.b_left - apart.b_right == pytest.approx(2e-9, rel=1e-5, abs=0)


def test_condition_of_motions_that_are_not_the_only_ones():
    """A free mode; an undamped mode in resonance that no force excites: the determinant is 0, and (19) fails."""
    free = vs.System(**(PAPER | dict(mu_k=0)))
    chain = oscillator("chain", k=[0, 1, 1, 0], c=[0, 0.1, 0.1, 0])
    resonant = vs.Oscillator(
        np.eye(2), [[2, -1], [-1, 2]], 0, force=[1, 1], contact_normal=[1, 0], omega=math.sqrt(3), b=1, R=0.8
    )
    for system in (free, chain, resonant):
        touch = vs.grazing(system)
        assert (touch.determinant, touch.satisfied) == (0.0, False) and touch.b > 0
    assert vs.grazing(resonant).b == pytest.approx(0.5, rel=1e-13, abs=0)


def test_numbers_of_a_list_that_is_not_given():
    """They are none of the oscillator's; a damping matrix of 0 is none."""
    given = dict(M=np.eye(2), K=np.eye(2), contact_normal=[1, 0], omega=0.7, b=1, R=0.8)
    plain, damped = vs.Oscillator(**given, C=0), vs.Oscillator(**given, C=0, rayleigh=[0.1, 0])
    assert not plain.linear.C.any() and not hasattr(plain, "rayleigh1")
    assert damped.rayleigh1 == 0.1 and np.array_equal(damped.linear.C, 0.1 * np.eye(2))


@pytest.mark.parametrize(
    "one, rest",
    [
        (oscillator("linear", constant=[0, 0], offset=0), [0, 0]),
        (oscillator("linear", constant=[0, 0], offset=5.0), None),
        (vs.Oscillator.named("one_mass", k=1e9, zeta=0.01, F=1, omega=3e4, R=0.8, b=1, offset=3), [2.0]),
        *slow_cases(
            (oscillator("chain"), [0, 0, 0]),
            (oscillator("chain", offset=5.0, constant=[0.3, 0, -0.2]), None),
            (oscillator("one_mass", k=0.0, offset=2.0, stops="left", b=-1), [3.0]),
        ),
    ],
)
def test_a_motion_begins_at_rest(tmp_path, one, rest):
    """Zero between the stops; else the gap at the nearer stop, and no force but that of the stop: K x = f + n F."""
    q = one.linear
    if rest is None:
        *rest, force = np.linalg.solve(
            np.block([[q.K, -q.contact.normal[:, None]], [q.contact.normal[None], 0]]), [*q.constant, q.contact.low]
        )
        assert force > 0  # the left stop pushes to the right
    scene = parsed(f"system: {_yaml(one)}\norbit: {{transient: 0, record: 1}}")
    vs.run(scene, tmp_path / "x.h5")
    start = np.column_stack([rest, np.zeros(len(rest))]).ravel()
    with vs.open(tmp_path / "x.h5") as data:
        later = [float(data[f"{kind}{k}"][0]) for k in range(1, len(rest) + 1) for kind in "xv"]
    np.testing.assert_allclose(later, vs.simulate(one, start, 1).section[-1], rtol=1e-12, atol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("stop_at", [1, 2])
def test_the_mass_at_the_stops_is_the_one_that_stays_between_them(stop_at):
    """Coordinates that are only exchanged are their own inverse, and not the same for that."""
    one = vs.Oscillator.named(
        "chain", m=[1, 2], k=[1, 1, 1], c=[0.1, 0.1, 0.1], force=[1, 0], stop_at=stop_at, omega=0.9, R=0.6, b=0.3
    )
    orbit = vs.simulate(one, (0, 0, 0, 0), 40)
    assert len(orbit.impacts) > 20
    largest = np.abs(orbit.sample(np.linspace(0, 40 * one.period, 4001))[:, 0::2]).max(axis=0)
    assert largest[stop_at - 1] <= 0.3 * (1 + 1e-12) and largest[2 - stop_at] > 0.35
    assert np.abs(orbit.impacts["x"][:, stop_at - 1] - 0.3 * orbit.impacts["side"]).max() < 1e-15


def test_docs_show_every_model():
    page = (ROOT / "docs" / "how" / "models.md").read_text()
    for name in GIVEN:
        assert f"## `{name}`\n" in page and f"\nvibro-sweep models {name}\n" in page


def test_the_command_lists_them():
    models, _, laws = ended("models").out.rstrip("\n").partition("\n\nstops, of every model:\n")
    assert [line.split()[0] for line in models.splitlines()] == list(GIVEN)
    assert [line.split()[0] for line in laws.splitlines()] == ["rigid", "compliant"]
    for line in laws.splitlines():
        text, numbers = printed(line.split()[0]), line.rpartition(": ")[2].split(", ")
        assert re.search(r"^    \S.* (?:=|->) ", text, re.MULTILINE) and {*numbers} <= dict(ROWS.findall(text)).keys()


@pytest.mark.slow
@pytest.mark.parametrize("stiffness", [0.0, 1.0])
def test_attractors_of_one_mass(stiffness):
    """Random starts, which are grouped and numbered for any number of masses."""
    one = oscillator("one_mass", F=0.6, k=stiffness, stops="both", zeta=0.1)
    data = vs.sweep(
        one, {"b": [0.8, 1.0]}, start={"random": 6}, observe=("attractors", "section"), transient=300, record=60
    )
    assert (data["status"] == 0).all() and (data["attractor_id"] >= 1).all()
    assert data.sizes["averaged"] == 5
    first = data.isel(b=0)
    for i in range(6):
        same = first["attractor"] == first["attractor"][i]
        assert first["share"][i] == same.mean()


def test_no_spring_to_the_ground():
    """mu_k = 0: the centre of mass drifts freely, x1 + mu_m x2 as the force pushes it."""
    system = vs.System(**(PAPER | dict(mu_k=0.0, b=1e6, zeta=0.0, tau=0.4)))
    orbit = vs.simulate(system, (0, 0.2, 0, 0.1), 10)
    t, (x1, v1, x2, v2) = orbit.section_times, orbit.section.T
    w, momentum = 0.63, 0.2 + 10 * 0.1
    push = (math.cos(0.4) - np.cos(w * t + 0.4)) / w
    way = (momentum + math.cos(0.4) / w) * t - (np.sin(w * t + 0.4) - math.sin(0.4)) / w**2
    np.testing.assert_allclose(v1 + 10 * v2, momentum + push, rtol=0, atol=1e-11)
    np.testing.assert_allclose(x1 + 10 * x2, way, rtol=1e-12, atol=1e-11)
