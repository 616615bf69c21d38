"""Published machines in their own units: a drive, a float with a damper at its end, cantilevers, a resonator in ns."""

import numpy as np
import pytest
from support.programs import ended

import vibro_sweep as vs

DRIVE = dict(
    M=[[1, 0], [0, 2]], K=[[0, 0], [0, 0]], C=[[0.1, 0], [0, 0.3]], force=[3, 0], omega=2, tau=0.0,
    contact_normal=[1, -1], k_stop=50, c_stop=2, b=0.2, offset=0.3,
)  # fmt: skip
TAPPING = dict(
    m=[1.1257909293593089e-11], k=[40, 0], c=[5.3051647697298445e-8, 0], force=[2e-9], k_stop=160, stops="right",
    omega=1884955.5921538759, units="SI",
)  # fmt: skip


def nanoseconds(**changes):
    """x'' + 0.04 x' + x = sin(0.8 t), x <= 1, in nanoseconds."""
    numbers = dict(m=[1], k=[1e18, 0], c=[4e7, 0], force=[1e18], omega=8e8, R=0.8, b=1, stops="right", tau=0.0)
    return vs.Oscillator.named("chain", **(numbers | changes))


@pytest.mark.parametrize("k_stop", [0, 1e-12])
def test_a_stop_that_is_a_damper_alone(k_stop):
    """WEC-Sim, issue 1086: a float of 100 t; times and speeds from the closed form of the two pieces in 30 digits."""
    system = vs.Oscillator.named(
        "chain", m=[1e5], k=[1e5, 0], c=[2e4, 0], force=[3e5], omega=0.9, k_stop=k_stop, c_stop=1e9, b=2, tau=0.0
    )
    contacts = vs.simulate(system, [0, 0], 1).contacts
    touches, speeds = [1.9005169542646398, 5.7131596880527958], [2.3045662002721761, 4.179777799637314]
    assert np.abs(contacts["t_touch"][:2] - touches).max() < 1e-13
    assert np.abs(np.abs(contacts["v_touch"][:2]) - speeds).max() < 1e-12
    assert abs(contacts["t_release"][0] - 4.1782845071689156) < 1e-12
    assert abs(abs(contacts["v_release"][0]) - 0.00037400345021798278) < 1e-12


def test_a_drive_turns():
    """Modelica, issue 44, with a constant torque: its angles have no period; what says that is not a resonance."""
    system = vs.Oscillator(**DRIVE, constant=[0.5, 0])
    axis = {"b": np.linspace(0.2, 0.25, 6)}
    observe, start = ["section", "lyapunov", "energy", "contacts"], {"x1": 0.3}
    data = vs.sweep(system, axis, start=start, transient=800, record=60, observe=observe)
    assert (data.period == 0).all() and np.ptp(data.gap.values, axis=-1).max() < 1e-9
    first = vs.sweep(system, {"b": [0.2]}, start=start, transient=0, record=3, observe=observe[2:])
    assert abs(first.impact_power.item() - 0.238971816847) < 1e-11
    assert abs(first.contact_time.item() - 0.513148732114) < 1e-11
    reasons = vs.windows(data).to_xarray().orbit_reason
    assert {reasons.attrs["flag_meanings"].split()[k] for k in reasons.values.ravel()} == {"turning"}
    orbit = vs.periodic_orbit(system, itinerary="LR")
    assert orbit.status == "turning"
    assert vs.periodic_orbit(vs.Oscillator(**DRIVE), itinerary="LR").status != "turning"  # it comes back to its place


def test_info_says_of_a_drive_why_it_has_no_period(tmp_path):
    path = tmp_path / "drive.h5"
    vs.sweep(vs.Oscillator(**DRIVE, constant=[0.5, 0]), {"b": [0.2, 0.21]}, transient=300, record=60, output=path)
    assert "turning      2 orbits: nothing holds the masses" in ended("info", path).out


def test_info_of_drives_that_a_function_makes(tmp_path):
    """No text says what the function does: `info` says nothing of their turning, and nothing is called damaged."""
    path = tmp_path / "made.h5"
    made = lambda b: vs.Oscillator(**DRIVE | {"b": b}, constant=[0.5, 0])  # noqa: E731
    vs.sweep(made, {"b": [0.2, 0.21]}, transient=300, record=60, output=path)
    end = ended("info", path)
    assert end.status == 0 and "turning" not in end.out and "damaged" not in end.out


def test_a_tapping_cantilever():
    """300 kHz, Q = 400, in SI: its orbit with one contact, and, at 22 nm, the motion that touches nothing."""
    near = vs.Oscillator.named("chain", **TAPPING, b=1e-8, tau=0.0)
    data = vs.sweep(near, {"b": [1e-8]}, transient=1000, settle=100_000, record=60, observe=["section"])
    orbit = vs.periodic_orbit(near, [data.x1.values[0, -1], data.v1.values[0, -1]], 1)
    assert (orbit.status, data.status.item(), data.period.item()) == ("ok", 0, 1)
    assert abs(orbit.contacts["t_touch"][0] - 1.0259251432676641e-6) < 1e-17
    assert abs(orbit.contacts["t_release"][0] - 1.2051666350865813e-6) < 1e-17
    assert np.abs(orbit.multipliers[0] - (0.983945941833203 + 0.127534885037068j)) < 1e-12
    assert abs(vs.grazing(near).b - 2e-8) < 1e-21
    far = near.replace(b=2.2e-8)
    found = vs.sweep(far, {"b": [2.2e-8]}, transient=9000, record=60, observe=["section"])
    assert (found.status.item(), found.period.item()) == (0, 1)


def test_a_resonator_in_nanoseconds():
    orbit = vs.periodic_orbit(nanoseconds(), itinerary="R")
    assert orbit.status == "ok" and abs(orbit.state[0] + 1.2548043859418076605) < 1e-14
    assert abs(orbit.state[1] / 1e9 - 0.11714990611708998438) < 1e-14
    assert np.abs(orbit.multipliers[0] - (-0.00332562568799896021 + 0.683700711192343658j)) < 1e-13
    special = {one.type: one.parameters["b"] for one in vs.continue_orbit(orbit, "b", (0.9, 2.9)).special}
    assert abs(special["flip"] - 1.9064629830466182789) < 1e-12
    assert abs(special["graze"] - 2.7668684463685735733) < 1e-11
    axis = {"b": np.linspace(0.3, 2.9, 53)}
    data = vs.sweep(nanoseconds(), axis, start={"follow": "both"}, transient=600, record=60)
    assert len(vs.windows(data)) == 5


def test_windows_end_at_the_same_places_in_any_unit_of_time():
    found = []
    for unit in (1.0, 1e-6, 1e9):
        system = nanoseconds(k=[unit**-2, 0], c=[0.04 / unit, 0], force=[unit**-2], omega=0.8 / unit)
        axis = {"b": np.linspace(0.3, 2.9, 53)}
        data = vs.sweep(system, axis, start={"follow": "both"}, transient=600, record=60)
        found.append([(one.period, one.lower.type, one.upper.type, one.lo, one.hi) for one in vs.windows(data)])
    for other in found[1:]:
        assert [one[:3] for one in other] == [one[:3] for one in found[0]] and len(other) == 5
        assert np.abs(np.array([one[3:] for one in other]) - [one[3:] for one in found[0]]).max() < 1e-9
