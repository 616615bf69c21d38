"""The reference itself against closed forms, and against the values of ties: several things at one instant."""

import copy

import pytest
import yaml
from mpmath import mp, mpf
from reference.events import simulate
from reference.machine import Contact, Friction, Harmonic, Machine, Stop
from support import ROOT

TIES = yaml.safe_load((ROOT / "tests" / "cases" / "ties.yaml").read_text())
DOUBLES = mpf(2) ** -50  # the numbers of the ties are rounded
CLOSE = mpf("1e-28")


@pytest.fixture(autouse=True)
def precision():
    with mp.workdps(50):
        yield


def one_mass(stiffness=0, damping=0, constant=0, force=None, omega=1, tau=0, stops=(), friction=()):
    """M = 1; `force`: amplitude of cos(omega t + tau)."""
    return Machine(
        M=[[1]], K=[[stiffness]], C=[[damping]], constant=[constant], omega=omega, tau=tau,
        harmonics=() if force is None else (Harmonic(1, [0], [force]),),
        contacts=(Contact([1], tuple(stops)),) if stops else (), friction=tuple(friction),
    )  # fmt: skip


def machine_of_case(system):
    """The machine of a `system:` with lists of contacts and friction."""
    none, contacts = [0] * len(system["M"]), []
    for keys in system.get("contacts", []):
        names = ("k_stop", "c_stop", "preload")
        law = {"R": keys["R"]} if "R" in keys else dict(zip("kcp", (keys.get(name, 0) for name in names), strict=True))
        sides = {"both": (1, -1), "right": (1,), "left": (-1,)}[keys["stops"]]
        contacts.append(Contact(keys["contact_normal"], tuple(Stop(side, side * keys["b"], **law) for side in sides)))
    friction = [Friction(**{"static_force": keys["friction_force"]} | keys) for keys in system.get("friction", [])]
    return Machine(
        system["M"], system["K"], [none for _ in none], system.get("constant", none),
        (Harmonic(1, system["force"], none),) if "force" in system else (),
        system.get("omega", 1), system.get("tau", 0), tuple(contacts), tuple(friction),
    )  # fmt: skip


def differences(orbit, case):
    """What an orbit does otherwise than the case says."""
    wanted = [(e["kind"], e["element"], int(e["side"]), e["t"], e.get("v")) for e in case["events"]]
    if [event[:3] for event in wanted] != [(e.kind, e.element, e.side) for e in orbit.events]:
        return ["events"]
    pairs = [(e.t, t) for e, (*_, t, _) in zip(orbit.events, wanted, strict=True)]
    pairs += [(e.v, v) for e, (*_, v) in zip(orbit.events, wanted, strict=True) if v is not None]
    pairs += zip(orbit.end, case["end"], strict=True)
    return [(float(a), b) for a, b in pairs if abs(a - b) > 8 * DOUBLES]


@pytest.mark.parametrize("case", TIES, ids=[case["name"].split(":")[0][:60] for case in TIES])
def test_several_things_at_one_instant(case):
    orbit = simulate(machine_of_case(case["system"]), case["start"], until=case["duration"], resolution=DOUBLES)
    assert case["events"] and not differences(orbit, case)


def test_the_comparison_sees_each_change():
    """A time, a speed, an end or a kind that is changed, and an event too many or too few."""
    case = TIES[1]
    orbit = simulate(machine_of_case(case["system"]), case["start"], until=case["duration"], resolution=DOUBLES)
    changed = [copy.deepcopy(case) for _ in range(6)]
    changed[0]["events"][1]["t"] += 1e-12
    changed[1]["events"][2]["v"] += 1e-12
    changed[2]["end"][2] -= 1e-12
    changed[3]["events"][0]["kind"] = "stick"
    changed[4]["events"].append(case["events"][-1])
    del changed[5]["events"][0]
    assert [len(differences(orbit, each)) for each in changed] == [1] * 6 and not differences(orbit, case)


@pytest.mark.parametrize("R", [0.8, 0.5, 0])
def test_ball_that_is_dropped(R):
    """From the height 1 with gravity 1: bounces at t_1 (1 + 2 (R - R^n)/(1 - R)), then rest."""
    orbit = simulate(one_mass(constant=-1, stops=[Stop(-1, 0, R=R)]), [1, 0], until=20)
    R, first = mpf(R), mp.sqrt(2)
    assert len(orbit.impacts) >= (1 if R == 0 else 40)
    for n, hit in enumerate(orbit.impacts, 1):
        assert abs(hit.t - first * (1 + 2 * (R - R**n) / (1 - R))) < CLOSE
        assert abs(hit.v / (first * R ** (n - 1)) - 1) < mpf("1e-15")
    assert [(rest.side, rest.t_off) for rest in orbit.rests] == [(-1, 20)]
    assert abs(orbit.rests[0].t_on - first * (1 + R) / (1 - R)) < CLOSE


def test_ball_between_walls():
    """Speeds fall by R of each wall."""
    orbit = simulate(one_mass(stops=[Stop(1, 1, R=0.5), Stop(-1, -1, R=0.75)]), [0, 1], impacts=12)
    t, v = mpf(1), mpf(1)
    assert [hit.side for hit in orbit.impacts] == [1, -1] * 6
    for hit in orbit.impacts:
        assert abs(hit.t - t) < CLOSE * t and abs(hit.v - v) < CLOSE
        v *= mpf(0.5) if hit.side > 0 else mpf(0.75)
        t += 2 / v


@pytest.mark.parametrize("z, by_force", [(0, False), (0.25, False), (0.25, True), (1.5, True)])
def test_restitution_of_a_compliant_stop(z, by_force):
    """delta'' + 2 z delta' + delta = 0 from the speed 1 until delta, or the force, is zero."""
    stop = Stop(1, 0.5, k=1, c=2 * z, by_force=by_force)
    contact = simulate(one_mass(stops=[stop]), [0, 1], contacts=1, until=20).contacts[0]
    z = mpf(z)
    root = mp.sqrt(mp.mpc(z * z - 1))
    delta = lambda t: (mp.exp(-z * t) * mp.sinh(root * t) / root).real  # noqa: E731
    slope = lambda t: (mp.exp(-z * t) * mp.cosh(root * t)).real - z * delta(t)  # noqa: E731
    t = contact.t_release - contact.t_touch
    assert abs(contact.t_touch - 0.5) < CLOSE and abs(slope(t) - contact.v_release) < CLOSE
    if by_force:
        assert abs(delta(t) + 2 * z * slope(t)) < CLOSE
    else:
        assert abs(t - mp.pi / root.imag) < CLOSE
    deepest = (mp.atanh(root / z) / root).real if z else mp.pi / 2
    assert abs(contact.max_penetration - delta(deepest)) < CLOSE


def test_free_decay_by_friction():
    """Each half swing is 2 friction_force/k shorter, until a turn is within static_force/k."""
    friction = Friction([1], mpf("0.11"), mpf("0.15"))
    orbit = simulate(one_mass(stiffness=1, friction=[friction]), [1, 0], until=40)
    turns = [event.y[0] for event in orbit.events]
    assert [(event.kind, event.side) for event in orbit.events] == [
        ("slip", 1),
        ("slip", -1),
        ("slip", 1),
        ("stick", 0),
    ]
    for n, (event, x) in enumerate(zip(orbit.events, turns, strict=True), 1):
        assert abs(event.t - n * mp.pi) < CLOSE and abs(x - (-1) ** n * (1 - mpf("0.22") * n)) < CLOSE


@pytest.mark.parametrize("r", [0.6, 1.5])
def test_den_hartog(r):
    """Symmetric slipping of a mass with Coulomb friction: x_max = F sqrt(V^2 - (f U)^2), turns half a period apart."""
    r, F, f = mpf(r), mpf(1), mpf("0.2")
    V, U = 1 / (1 - r**2), mp.sin(mp.pi / r) / (r * (1 + mp.cos(mp.pi / r)))
    largest, phase = F * mp.sqrt(V**2 - (f * U) ** 2), mp.asin(-f * U / V)
    phase = phase if V > 0 else mp.pi - phase  # of the force, at a turn on the right
    machine = one_mass(stiffness=1, force=F, omega=r, tau=phase, friction=[Friction([1], f * F, f * F)])
    orbit = simulate(machine, [largest, 0], periods=4)
    assert [event.side for event in orbit.events[:7]] == [1, -1] * 3 + [1]
    for n, event in enumerate(orbit.events[:7], 1):
        assert abs(event.t - n * mp.pi / r) < CLOSE and abs(event.y[0] - (-1) ** n * largest) < CLOSE
    assert all(abs(x - largest) < CLOSE and abs(v) < CLOSE for x, v in orbit.section)


def test_stick_slip_on_a_belt():
    """Sticks last 2 (static - kinetic)/speed, slips are arcs of circles about kinetic/k."""
    kinetic, static, speed = mpf("0.3"), mpf("0.5"), mpf("0.1")
    machine = one_mass(stiffness=1, friction=[Friction([1], kinetic, static, speed)])
    orbit = simulate(machine, [0, speed], events=8)
    a = static - kinetic
    slip, stick = 2 * mp.pi - 2 * mp.atan(a / speed), 2 * a / speed
    t = mpf(0)
    assert [event.kind for event in orbit.events] == ["stick", "slip"] * 4
    for n, event in enumerate(orbit.events[1:]):
        t += (static / speed if n == 0 else stick) if event.kind == "slip" else slip
        assert abs(event.t - t) < CLOSE and event.side == (-1 if event.kind == "slip" else 0)
        assert abs(event.y[0] - (static if event.kind == "slip" else kinetic - a)) < CLOSE


def test_harmonics():
    """x'' = 8 sin(2 phi) + 9 cos(3 phi), phi = t + tau."""
    tau = mpf("0.3")
    machine = one_mass(tau=tau)._replace(harmonics=(Harmonic(2, [8], [0]), Harmonic(3, [0], [9])))
    x = lambda t: -2 * mp.sin(2 * (t + tau)) - mp.cos(3 * (t + tau))  # noqa: E731
    orbit = simulate(machine, [x(mpf(0)), mp.diff(x, 0)], until=5)
    assert abs(orbit.end[0] - x(mpf(5))) < CLOSE and abs(orbit.end[1] - mp.diff(x, 5)) < CLOSE


def test_rest_on_a_preloaded_stop():
    """Pressed on with less than the preload a mass rests; where the force has grown to it, the mass enters."""
    stop = Stop(1, 0, k=4, p=1)
    machine = one_mass(force=mpf("1.25"), tau=-mp.pi / 2, stops=[stop])  # 1.25 sin(t)
    orbit = simulate(machine, [0, 0], events=3)
    assert [event.kind for event in orbit.events] == ["rest", "touch", "leave"]
    assert abs(orbit.events[1].t - mp.asin(mpf("0.8"))) < CLOSE
    leaves = simulate(machine._replace(tau=mp.pi / 2 - mpf("0.5")), [0, 0], events=2)  # 1.25 sin(t + pi - 0.5)
    assert [event.kind for event in leaves.events] == ["rest", "leave"] and abs(leaves.events[1].t - 0.5) < CLOSE


def test_starts():
    right = one_mass(constant=1, stops=[Stop(1, 0, k=1, p=2), Stop(-1, -1, R=0.5)])
    with pytest.raises(ValueError, match="behind a stop"):
        simulate(right, [-2, 0], until=1)
    with pytest.raises(ValueError, match="when to stop"):
        simulate(right, [0, 0])
    inside = simulate(right, [0.5, 0], contacts=1)
    assert inside.contacts[0].t_touch == 0 and inside.contacts[0].max_penetration == 0.5
