"""Oscillators that have no tables or no isolated orbits, and multipliers of what is not an orbit."""

import math

import numpy as np
import pytest
from support.oscillators import PAPER

import vibro_sweep as vs
from vibro_sweep.analysis.periodic.event_equations import EventEquations
from vibro_sweep.analysis.periodic.orbit_multipliers import contacts_of, multipliers_of
from vibro_sweep.engine.impulses.flow import flow
from vibro_sweep.engine.impulses.free_modes import MOST_CELLS, ResonanceError, TooStiffError
from vibro_sweep.oscillator.family import family_of

PAPER_FAMILY = family_of(PAPER)


def test_undamped_mode_that_repeats_itself_is_named():
    family = PAPER_FAMILY.replace(zeta=0.0, tau=0.0)
    omega = math.sqrt(PAPER.modes.omega_squared[0])
    with pytest.raises(ResonanceError):
        EventEquations(family.replace(omega=omega).linear, 1, 2, (1,))
    assert np.isfinite(EventEquations(family.linear, 1, 2, (1,)).planes["closing"]).all()


def test_rates_too_far_apart_are_named():
    with pytest.raises(TooStiffError, match=str(MOST_CELLS)):
        EventEquations(PAPER_FAMILY.replace(mu_m=1e-12, tau=0.0).linear, 1, 2, (1,))


def test_impacts_out_of_order_have_no_multipliers():
    """Their flights are longer than the period, in which there is room for the factors."""
    orbit = vs.periodic_orbit(vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=5.3), itinerary="LR")
    s = orbit._solution.whole()
    moved = s.u.copy()
    moved[0] += 100 * s.P
    q = s.family.linear
    given = flow(q), s.sigma, s.P, contacts_of(q, s.sides)
    assert np.isnan(multipliers_of(*given, moved, s.motion)).all()
    assert np.isfinite(multipliers_of(*given, s.u, s.motion)).all()
