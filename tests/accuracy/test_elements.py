"""Several contacts and friction, one orbit from phase to phase: against many digits, closed forms and identities."""

import math

import numpy as np
import pytest
from accuracy.test_reference import TIES, machine_of_case, one_mass
from mpmath import mp, mpf
from reference.event_check import moved
from reference.events import simulate
from reference.machine import Contact, Friction, Harmonic, Machine, Stop
from support.drawn_elements import drawn_machine
from support.element_orbits import engine_machine, machine_of_system, orbit_of

import vibro_sweep as vs

CLOSE = 4e-15
BEYOND_STOP = 5  # as `status` of results
CHAOS = 1e-10  # nothing is compared from where rounding moves a number by more
STEPS = 150  # of the reference, after which it gives up
ALLOWED = 10.0  # times what rounding of the inputs does
MANY = 200  # events: a mass that drops on a preloaded stop bounces ever lower, and comes to rest in the limit alone
ENDS = 1e-9  # of the time: events so near to the end may lie on either side of it


@pytest.mark.parametrize("case", TIES, ids=[case["name"].split(":")[0][:60] for case in TIES])
def test_several_things_at_one_instant(case):
    orbit = orbit_of(engine_machine(machine_of_case(case["system"])), case["start"], case["duration"])
    wanted = [(e["kind"], e["element"], int(e["side"])) for e in case["events"]]
    assert wanted == [event[:3] for event in orbit.events] and orbit.status == 0
    for event, one in zip(orbit.events, case["events"], strict=True):
        assert abs(event.t - one["t"]) <= CLOSE and abs(event.v - one.get("v", event.v)) <= CLOSE
    assert np.abs(orbit.end - case["end"]).max() <= CLOSE


def numbers_of(orbit):
    return [event[:3] for event in orbit.events], [(event.t, event.v) for event in orbit.events]


def largest_error(seed: int, most: int = 15) -> tuple[float, int]:
    """Of the first events of a drawn machine, in units of what rounding of all its numbers does; how many there were.

    AssertionError where one is missed or invented before rounding decides.
    """
    rng = np.random.default_rng(seed)
    machine, state = drawn_machine(rng)
    until = 4 * 2 * math.pi / machine.omega
    with mp.workdps(50):
        limits = {"events": most, "until": until, "digits": 30, "steps": STEPS}
        exact = simulate(machine, state, **limits)
        reached = len(exact.events) < most and not exact.given_up
        end = until if reached or not exact.events else float(exact.events[-1].t) * (1 + ENDS)
        others = [numbers_of(simulate(*moved(machine, state, rng), **limits)) for _ in range(3)]
        kinds, numbers = numbers_of(exact)
        found, worst = orbit_of(engine_machine(machine), state, min(end, until)), 0.0
        for i, (kind, exactly) in enumerate(zip(kinds, numbers, strict=True)):
            if any(len(them) <= i or them[i] != kind for them, _ in others):
                return worst, i
            effects = [[abs(there[i][n] - exactly[n]) for _, there in others] for n in (0, 1)]
            if max(map(max, effects)) > CHAOS or (i >= len(found.events) and exactly[0] > end * (1 - ENDS)):
                return worst, i
            event = found.events[i]
            assert event[:3] == kind, (seed, i, kind, event)
            for n, floor in ((0, max(1.0, float(exactly[0]))), (1, 1.0)):
                unit = sum(effects[n]) + mpf(2) ** -53 * floor
                worst = max(worst, float(abs(event[3 + n] - exactly[n]) / unit))
    return worst, len(kinds)


@pytest.mark.parametrize("seed", [1, 3, 5, 7, 8, 12])
def test_drawn_machines_in_many_digits(seed):
    error, events = largest_error(seed)
    assert error <= ALLOWED and events > 3


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(15, 20))
def test_more_drawn_machines_in_many_digits(seed):
    error, _ = largest_error(seed)
    assert error <= ALLOWED


@pytest.mark.parametrize("R", [0.8, 0.5, 0.0])
def test_ball_that_is_dropped(R):
    """From the height 1 with gravity 1: bounces at t_1 (1 + 2 (R - R^n)/(1 - R)), then rest."""
    orbit = orbit_of(engine_machine(one_mass(constant=-1, stops=[Stop(-1, 0, R=R)])), [1, 0], 20)
    hits, first = [event for event in orbit.events if event.kind == "impact"], math.sqrt(2)
    for n, hit in enumerate(hits, 1):
        assert abs(hit.t - first * (1 + 2 * (R - R**n) / (1 - R))) <= CLOSE * 4
    assert [event.kind for event in orbit.events[len(hits) :]] == ["rest"] and len(hits) >= (20 if R else 1)
    assert abs(orbit.events[-1].t - first * (1 + R) / (1 - R)) <= 4 * CLOSE and orbit.end.tolist() == [0, 0]


@pytest.mark.parametrize("r", [0.6, 1.5])
def test_den_hartog(r):
    """Symmetric slipping of a mass with Coulomb friction: x_max = F sqrt(V^2 - (f U)^2), turns half a period apart."""
    f, V, U = 0.2, 1 / (1 - r**2), math.sin(math.pi / r) / (r * (1 + math.cos(math.pi / r)))
    largest, phase = math.sqrt(V**2 - (f * U) ** 2), math.asin(-f * U / V)
    phase = phase if V > 0 else math.pi - phase  # of the force, at a turn on the right
    machine = one_mass(stiffness=1, force=1, omega=r, tau=phase, friction=[Friction([1], f, f)])
    orbit = orbit_of(engine_machine(machine), [largest, 0], 40)
    assert [event.side for event in orbit.events[:7]] == [1, -1] * 3 + [1]
    for n, event in enumerate(orbit.events, 1):
        assert abs(event.t - n * math.pi / r) <= 1e-13 and abs(event.y[0] - (-1) ** n * largest) <= 1e-14


def test_stick_slip_on_a_belt():
    """Sticks last 2 (static - kinetic)/speed, slips are arcs of circles about kinetic/k."""
    kinetic, static, speed = 0.3, 0.5, 0.1
    machine = one_mass(stiffness=1, friction=[Friction([1], kinetic, static, speed)])
    orbit = orbit_of(engine_machine(machine), [0, speed], 60)
    a = static - kinetic
    slip, stick = 2 * math.pi - 2 * math.atan(a / speed), 2 * a / speed
    assert [event.kind for event in orbit.events[:8]] == ["stick", "slip"] * 4
    t = 0.0
    for n, event in enumerate(orbit.events[1:]):
        t += (static / speed if n == 0 else stick) if event.kind == "slip" else slip
        assert abs(event.t - t) <= 1e-13
        assert abs(event.y[0] - (static if event.kind == "slip" else kinetic - a)) <= CLOSE


def test_rest_on_a_preloaded_stop():
    """Pressed on with less than the preload a mass rests; where the force has grown to it, the mass enters."""
    machine = one_mass(force=1.25, tau=-math.pi / 2, stops=[Stop(1, 0, k=4, p=1)])  # 1.25 sin(t)
    orbit = orbit_of(engine_machine(machine), [0, 0], 1.5)
    assert [event.kind for event in orbit.events] == ["rest", "touch", "leave"]
    assert abs(orbit.events[1].t - math.asin(0.8)) <= CLOSE


def test_a_start_behind_a_stop_has_a_status():
    machine = one_mass(stops=[Stop(-1, -1, R=0.5)])
    assert orbit_of(engine_machine(machine), [-2, 0], 1).status == BEYOND_STOP


def test_more_elements_than_phases_can_name_are_refused():
    machine = one_mass(friction=[Friction([1], 0.1 * n, 0.1 * n, float(n)) for n in range(25)])
    with pytest.raises(ValueError, match="there are 25; 24 at most"):
        engine_machine(machine)


def test_several_contacts_of_an_oscillator_move_as_the_reference_has_them():
    """The list of an oscillator's contacts, rigid and compliant ones, is that of the machine."""
    contacts = [
        vs.Contact([1, 0], b=0.3, R=0.8, R_left=0.9),
        vs.Contact([-1, 1], b=0.2, offset=0.05, stops="right", k_stop=50.0, c_stop=0.5, preload=0.1),
    ]
    system = vs.Oscillator([[1, 0], [0, 2]], [[2, -1], [-1, 1]], force=[1, 0], omega=0.8, tau=0.3, contacts=contacts)
    same = Machine(
        [[1, 0], [0, 2]], [[2, -1], [-1, 1]], [[0, 0], [0, 0]], [0, 0], (Harmonic(1, [1, 0], [0, 0]),), 0.8, 0.3,
        (
            Contact([1.0, 0.0], (Stop(1, 0.3, R=0.8), Stop(-1, -0.3, R=0.9))),
            Contact([-1.0, 1.0], (Stop(1, 0.25, k=50.0, c=0.5, p=0.1),)),
        ),
    )  # fmt: skip
    for one, other in zip(machine_of_system(system)[0], engine_machine(same)[0], strict=True):
        np.testing.assert_array_equal(one, other)
    assert len(orbit_of(machine_of_system(system), [0.0, 0, 0, 0], 20.0).events) > 10


@pytest.mark.parametrize(
    "law",
    [{"R": 0.8}, {"k_stop": 1e4}, {"k_stop": 1e4, "c_stop": 5, "release": "force"}, {"k_stop": 50, "preload": 0.2}],
)
def test_one_contact_moves_as_simulate_has_it(law):
    system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, b=3, **law)
    known = vs.simulate(system, [0, 0, 0, 0], periods=20)
    made = machine_of_system(system)
    orbit = orbit_of(made, [0, 0, 0, 0], 20 * system.period * (1 + 1e-12), periods=20)
    kind, times = ("impact", known.impacts["t"]) if "R" in law else ("touch", known.contacts["t_touch"])
    found = [event.t for event in orbit.events if event.kind == kind]
    assert len(found) == len(times) > 20 and np.abs(np.array(found) - times).max() <= 2e-12
    N, sections = 2, known.section[1:].reshape(20, -1)
    x, v = (orbit.section[:, part] @ made[0].back.T for part in (slice(N), slice(N, 2 * N)))
    assert np.abs(np.stack([x, v], -1).reshape(20, 4) - sections).max() <= 1e-11


def jacobian(machine, state, until):
    """Tangent vectors and central differences after the time `until`; None where events differ. By (y, y', s)."""
    made, N, h = engine_machine(machine), machine.masses, 1e-6
    V = np.eye(2 * N + int((made[0].relaxing >= 0).sum()))[:, : 2 * N]
    events = [event[:3] for event in orbit_of(made, state, until, vectors=V).events]
    if len(events) > MANY:
        return None
    differences = np.zeros_like(V)
    for j in range(2 * N):
        step = np.zeros(2 * N)
        step[j // N :: 2] = made[0].back[:, j % N] * h
        ends = [orbit_of(made, np.array(state) + sign * step, until) for sign in (1, -1)]
        if any([event[:3] for event in end.events] != events for end in ends):
            return None
        differences[:, j] = (ends[0].z - ends[1].z) / (2 * h)
    return V, differences, len(events)


def test_tangent_vectors_are_derivatives():
    compared = 0
    for seed in range(40):
        machine, state = drawn_machine(np.random.default_rng(seed))
        found = jacobian(machine, state, 1.3 * 2 * math.pi / machine.omega)
        if found is not None:
            V, differences, events = found
            assert np.abs(V - differences).max() <= 1e-6 * max(1.0, np.abs(differences).max()), seed
            compared += events
    assert compared > 200


def test_volumes_are_known():
    """Each impact on a stop with R multiplies volumes by R^2, and dampers by e^(-tr(M^-1 C) t)."""
    machine = Machine(
        [[1.0, 0.1], [0.1, 2.0]], [[2.0, -1.0], [-1.0, 3.0]], [[0.1, 0.0], [0.0, 0.05]], [0.0, 0.1],
        (Harmonic(1, [1.0, 0.5], [0.0, 0.3]),), 0.8, 0.2,
        (
            Contact([1.0, 0.0], (Stop(1, 0.3, R=0.8), Stop(-1, -0.4, R=0.9))),
            Contact([-1.0, 1.0], (Stop(1, 0.2, R=0.7),)),
        ),
    )  # fmt: skip
    V, until = np.eye(4), 8.0
    orbit = orbit_of(engine_machine(machine), [0, 0.5, 0, 0.2], until, vectors=V)
    R = {(1, 1): 0.8, (1, -1): 0.9, (2, 1): 0.7}
    hits = [R[event.element, event.side] for event in orbit.events if event.kind == "impact"]
    known = 2 * np.log(hits).sum() - np.trace(np.linalg.solve(machine.M, machine.C)) * until
    assert len(hits) > 8 and len({*hits}) == 3 and abs(np.linalg.slogdet(V)[1] - known) <= 1e-11
