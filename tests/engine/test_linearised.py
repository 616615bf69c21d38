"""How orbits move with a number, and what a critical multiplier moves: beside differences and plain products."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigvals, expm
from support import slow_cases
from support.oscillators import CAVITY, CHAIN, ONE_MASS, PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.periodic.linearised import Linearised
from vibro_sweep.oscillator.family import family_of

ORBITS = {
    "paper": (family_of(PAPER), "LR", 1),
    "paper, tau": (family_of(PAPER).replace(tau=0.3), "LR", 1),
    "chain": (CHAIN.replace(b=0.2), "LR", 1),
    "one mass": (ONE_MASS, "R", 2),
    "a free mode": (CAVITY, "LR", 1),
    "rests": (family_of(PAPER.replace(R=0, b=0.3)), "LR", 1),
    "rests, tau": (family_of(PAPER.replace(R=0, b=0.3, tau=0.3)), "LR", 1),
}
CASES = [(one, name) for one, (family, *_) in ORBITS.items() for name, x in family.numbers.items() if type(x) is float]
CASES = [case for case in CASES if "rests" not in case[0] or case[1] != "R"]  # another R leads to no rest at once
SLOW = [case for case in CASES if case[0] in ("chain", "rests", "rests, tau")]  # whose kernels no other fast test needs
FAST = [case for case in CASES if case not in SLOW]


@pytest.mark.parametrize(("one", "name"), [*FAST, *slow_cases(*SLOW)])
def test_slopes_are_those_of_differences(one, name):
    family, itinerary, periods = ORBITS[one]
    s = vs.periodic_orbit(family, itinerary=itinerary, periods=periods)._solution
    value, h = family.numbers[name], 1e-5
    if name == "R" and value + h > 1:
        value -= h
        s = replace(s, family=family.replace(R=value)).corrected()
    sides = [replace(s, family=family.replace(**{name: value + d})).corrected() for d in (h, -h)]
    found = Linearised(s, s.family.derivative(name)).slopes()
    assert len(found) == 2 * s.K + len(s.rests) and bool(s.rests) == ("rests" in one)
    difference = ((sides[0].u - sides[1].u) / (2 * h))[: len(found)]
    assert found == pytest.approx(difference, rel=1e-5, abs=1e-7 * max(1, np.abs(difference).max()))


def test_critical_direction_of_a_pitchfork():
    """It is where the born orbit leaves: the halves of the orbits beside it differ by it."""
    b = 3.892819435563419
    s = vs.periodic_orbit(PAPER.replace(b=b), itinerary="LR")._solution
    assert np.linalg.svd(Linearised(s).closure(-1), compute_uv=False)[-1] < 1e-12
    moved = Linearised(s).critical_direction(-1) * 1e-3
    whole = s.whole()
    guess = replace(whole, u=whole.u + np.concatenate([moved[:1], -moved[:1], moved[1:], moved[1:]]))
    beside = [
        one for d in (-2e-6, 2e-6) if (one := replace(guess, family=family_of(PAPER.replace(b=b + d))).corrected())
    ]
    apart = [one.times - one.times.mean() for one in beside]
    assert any(abs(np.ptp(t) - whole.P / 2) > 1e-5 for t in apart)


@pytest.mark.parametrize("count", [1, 40])
@pytest.mark.parametrize("system", [PAPER, *slow_cases(CHAIN.replace(b=0.2))])
def test_closure_has_the_multipliers(system, count):
    solution = vs.periodic_orbit(system, itinerary="LR")._solution.whole().repeated(count)
    linearised, n = Linearised(solution), 2 * solution.family.linear.masses
    one, other = linearised.closure(1), linearised.closure(-1)
    values = eigvals(one + other, other - one)
    largest = max(solution.multipliers, key=abs)
    assert min(abs(values - largest)) < 1e-9 * abs(largest) and len(values) == n


@pytest.mark.parametrize("R", [1e-12, 1.2777006663019564e-09, 1e-4])
def test_multipliers_at_a_small_restitution(R):
    """Rows were multiplied by 1 - (1 + R): of the digits of a small R few were left, and of the multipliers seven."""
    guess = [(t, side, v) for t, side, v, *_ in vs.periodic_orbit(PAPER.replace(R=0.1), itinerary="LR").impacts]
    s = vs.periodic_orbit(PAPER.replace(R=R), guess=guess)._solution
    q, v, a = s.family.linear, *s.motion[0, :2]
    inverse, zero = np.linalg.inv(q.M), np.zeros(2)
    A = np.block([[np.zeros((2, 2)), np.eye(2)], [-inverse @ q.K, -inverse @ q.C]])
    e_g, e_s = np.append(q.contact.normal, zero), np.append(zero, q.contact.normal)
    e_v = np.append(zero, inverse @ q.contact.normal / (q.contact.normal @ inverse @ q.contact.normal))
    S = np.eye(4) - (1 + R) * (np.outer(e_v, e_s) + np.outer(A @ e_v, e_g) - a / v * np.outer(e_v, e_g))
    expected = np.linalg.eigvals(s.sigma * expm(A * s.P) @ S)
    expected = expected[np.lexsort((-expected.imag, -np.abs(expected)))]
    assert s.multipliers[:3] == pytest.approx(expected[:3], abs=1e-13)
