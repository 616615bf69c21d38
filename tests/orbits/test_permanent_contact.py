"""Where the contact with a compliant stop never ends: ends of branches, orbits and windows."""

import numpy as np
import pytest
from scipy.optimize import brentq
from support import slow_cases
from support.compliant_bifurcations import one_mass

import vibro_sweep as vs

PRESSED = dict(k=1, zeta=0.05, F=0.3, omega=5.5, k_stop=29, c_stop=0.5, b=1, tau=0, constant=1.5, stops="right")


def least_on_the_stop(value, system, parameter):
    """The least displacement into its stop of one mass that never leaves it."""
    there = system.replace(**{parameter: value})
    k, c = 1 + there.k_stop, 2 * there.zeta + there.c_stop
    static = (abs(there.constant) + there.k_stop * there.b) / k
    return static - there.b - there.F / abs(k - there.omega**2 + 1j * there.omega * c)


@pytest.mark.slow
@pytest.mark.parametrize("numbers, parameter, bounds", [
    (PRESSED, "F", (0.01, 5)),
    *slow_cases(
        (PRESSED | dict(omega=4.5), "F", (0.01, 5)),  # by way of two folds
        (PRESSED | dict(stops="left", constant=-1.5), "F", (0.01, 5)),
        (PRESSED, "omega", (4, 9)),
        (PRESSED, "k_stop", (1, 100)),
        (PRESSED, "constant", (1, 4)),
    ),
])  # fmt: skip
def test_a_contact_that_never_ends(numbers, parameter, bounds, tmp_path):
    """The branch ends where the motion of the mass on its stop, of a linear oscillator, comes to the stop's place."""
    system = one_mass(**numbers)
    orbit = vs.periodic_orbit(system, vs.simulate(system, (0, 0), 600).section[-1])
    branch = vs.continue_orbit(orbit, parameter, bounds)
    (end,) = [one for one in branch.special if one.type == "permanent_contact"]
    at = end.parameters[parameter]
    assert abs(brentq(least_on_the_stop, at - 1e-6, at + 1e-6, (system, parameter), 1e-16, 1e-15) - at) < 2 * end.error
    there = system.replace(**end.parameters)
    k, c = 1 + there.k_stop, 2 * there.zeta + there.c_stop
    exact = np.sort_complex(np.exp(np.roots([1, c, k]) * there.period))[::-1]
    assert end.multipliers == pytest.approx(exact, abs=1e-12)
    (contact,) = end.orbit.contacts
    assert contact["t_release"] - contact["t_touch"] == pytest.approx(there.period, rel=1e-14)
    assert end.orbit.sample([0.3 * there.period]) == pytest.approx(end.orbit.sample([1.3 * there.period]), abs=1e-12)
    read = vs.load(branch.save(tmp_path / "branch.h5"))
    assert [one.type for one in read.special] == [one.type for one in branch.special]


def test_a_mass_that_never_leaves_its_stop():
    system = one_mass(**PRESSED | dict(F=0.03))
    held = vs.periodic_orbit(system, vs.simulate(system, (0, 0), 300).section[-1])
    assert held.status == "permanent_contact"
    with pytest.raises(ValueError, match="never leaves a compliant stop"):
        held.sample([0.0])
    data = vs.sweep(
        system, {"F": np.linspace(0.02, 0.2, 10)}, transient=300, record=20, observe=["section", "lyapunov"]
    )
    (window,) = vs.windows(data)
    assert window.lower.type == "permanent_contact" and window.lower.parameters["F"] == pytest.approx(0.055157602477909)
