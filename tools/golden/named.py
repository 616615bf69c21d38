"""Cases by their names: what the paper has, and what random draws meet seldom."""

import numpy as np
from golden.motions import start_of, system_record
from support.models import GIVEN
from support.random_branches import attractors, random_system

import vibro_sweep as vs

PAPER = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=2.0)
ROOM = (0.3, 6.8)


def _case(name: str, system, start: dict, parameter: str, bounds) -> dict:
    return {
        "name": name, "system": system_record(system), "start": start, "parameter": parameter, "bounds": list(bounds)
    }  # fmt: skip


def _word(itinerary: str, periods: int = 1) -> dict:
    return {"itinerary": itinerary, "periods": periods}


def _settled(system) -> dict:
    """A state on the attractor that the motion from rest comes to."""
    section = vs.simulate(system, [0.0] * 2 * system.masses, 2000).section
    apart = np.abs(section[-1] - section[-2:-100:-1]).max(axis=1)
    return {"state": section[-1].tolist(), "periods": int(np.argmax(apart < 1e-8) + 1)}


def branches() -> list[dict]:
    four = PAPER.replace(b=4.0)
    cases = [
        _case("paper, symmetric, in b", PAPER, _word("LR"), "b", ROOM),
        _case("paper, one side, in b", four, _word("R"), "b", ROOM),
        _case("paper, other side, in b", four, _word("L"), "b", ROOM),
        _case("paper, free motion, in b", PAPER.replace(b=7.0), _word(""), "b", (6, 8)),
        _case("paper, free motion, in omega", PAPER.replace(b=7.0), _word(""), "omega", (0.3, 1.2)),
    ]
    for name, bounds in {
        "omega": (0.4, 1.0), "R": (0.0, 1.0), "zeta": (0.0, 0.3), "mu_m": (2, 20), "mu_k": (1, 10), "f2": (0, 1),
        "offset": (-1, 1), "tau": (0, 3),
    }.items():  # fmt: skip
        system = PAPER.replace(tau=1.0) if name == "tau" else PAPER
        cases.append(_case(f"paper, symmetric, in {name}", system, _word("LR"), name, bounds))
    cases += [
        _case(f"paper, one side, in {name}", four, _word("R"), name, bounds)
        for name, bounds in (("omega", (0.5, 0.8)), ("R", (0.2, 1.0)), ("zeta", (0.01, 0.2)))
    ]
    cases.append(_case("paper, RRRR of period 13", PAPER.replace(b=6.6), _word("RRRR", 13), "b", ROOM))
    cases += [
        _case(f"paper, attractor at {b}", PAPER.replace(b=b), _settled(PAPER.replace(b=b)), "b", ROOM)
        for b in (5.2, 5.33, 6.0, 6.596, 6.664)
    ]
    cases += [
        _case(f"paper, chatter at {b}", PAPER.replace(b=b), _settled(PAPER.replace(b=b)), "b", (0.05, 0.6))
        for b in (0.5, 0.35, 0.155, 0.1, 0.08)
    ]
    return [*cases, *_rests(), *_elastic(), *_mirrors(), *_other_models()]


def _rests() -> list[dict]:
    """R = 0: the mass rests after an impact."""
    cases = []
    for b, name, bounds in (
        (0.5, "b", (0.3, 3)), (0.5, "omega", (0.58, 0.68)), (1.2, "b", (0.3, 3)), (0.05, "b", (0.04, 0.07)),
        (1.2, "zeta", (0.01, 0.2)), (0.5, "f2", (0.0, 0.5)),
    ):  # fmt: skip
        system = PAPER.replace(R=0.0, b=b)
        cases.append(_case(f"rests, b = {b}, in {name}", system, _settled(system), name, bounds))
    one = vs.Oscillator.named("one_mass", zeta=0.05, F=1.0, omega=0.8, R=0.0, b=0.2, stops="right")
    cases.append(_case("rests, one mass", one, _settled(one), "b", (0.05, 2)))
    return cases


def _elastic() -> list[dict]:
    """R = 1, and no losses at all."""
    elastic, none = PAPER.replace(R=1.0), PAPER.replace(R=1.0, zeta=0.0)
    return [
        _case("R = 1, symmetric", elastic, _word("LR"), "b", ROOM),
        _case("R = 1, one side", elastic.replace(b=4.0), _word("R"), "b", ROOM),
        _case("no losses, symmetric", none, _word("LR"), "b", ROOM),
        _case("nearly no restitution", PAPER.replace(R=0.05), _word("LR"), "b", ROOM),
    ]


def _mirrors() -> list[dict]:
    """Both orbits that begin at the pitchfork."""
    orbit = vs.periodic_orbit(PAPER, itinerary="LR")
    special = next(one for one in vs.continue_orbit(orbit, "b", ROOM).special if one.type == "pitchfork")
    pair = vs.switch(special)
    return [
        _case(f"mirror image {k}", orbit.system, start_of(orbit), "b", ROOM) for k, orbit in enumerate(pair)
    ]  # fmt: skip


def _other_models() -> list[dict]:
    ball = vs.Oscillator.named(
        "one_mass", k=0.0, zeta=0.0, constant=-1.0, base=True, F=1.0, omega=1.0, R=0.8, b=0.0, stops="left"
    )
    cases = [
        _case(f"bouncing ball, {word} of period {n}, in {name}", ball, _word(word, n), name, bounds)
        for word, n, name, bounds in (
            ("L", 1, "F", (0.3, 2)), ("L", 2, "F", (0.3, 3)), ("L", 1, "R", (0.5, 1)),
        )
    ]  # fmt: skip
    cavity = vs.Oscillator.named("ball_in_cavity", **GIVEN["ball_in_cavity"])
    cases += [
        _case(f"cavity, in {name}", cavity, _word("LR"), name, b) for name, b in (("b", (0.1, 3)), ("R", (0.3, 1)))
    ]
    for masses in (5, 6, 7, 8):
        for word, omega, stops in (("LR", 0.3, "both"), ("LLRR", 0.8, "both"), ("R", 0.6, "right")):
            cases.append(_case(f"chain of {masses}, {word}", *_chain(masses, word, omega, stops)))
    return cases


def _chain(masses: int, word: str, omega: float, stops: str):
    """Masses between walls, forced at the first, with as much room as an orbit of this word needs."""
    system = vs.Oscillator.named(
        "chain", m=[1 + 0.1 * i for i in range(masses)], k=[1.0] * (masses + 1), c=[0.05] * (masses + 1),
        force=[10.0] + [0.0] * (masses - 1), stop_at=(masses + 1) // 2, omega=omega, R=0.7, b=1.0, stops=stops,
    )  # fmt: skip
    systems = (system.replace(b=part * vs.grazing(system).b_right) for part in (0.84, 0.63, 0.42, 0.21, 0.74, 0.95))
    found = next(one for one in systems if vs.periodic_orbit(one, itinerary=word).ok)
    return found, _word(word), "b", (0.2 * found.b, 1.5 * found.b)


def _curve(name: str, case: dict, special: dict, names, boxes, then=()) -> dict:
    start = {key: case[key] for key in ("system", "start", "parameter", "bounds")}
    box, inner = ([list(one) for one in both] for both in boxes)
    return {
        "name": name, **start, "special": special, "then": list(then), "names": list(names), "box": box, "inner": inner
    }  # fmt: skip


PLANE, BOX = ("b", "omega"), [[0.3, 9.0], [0.5, 0.8]]


def _around(values, share: float) -> list[list[float]]:
    return [[x - share * abs(x), x + share * abs(x)] for x in values]


def curves() -> list[dict]:
    """Those of the paper's symmetric and one-sided orbits, and what begins at their points of codimension two."""
    cases = [_sticking(), _closed()]
    for title, system, word in (("symmetric", PAPER, "LR"), ("one side", PAPER.replace(b=4.0), "R")):
        case = _case("", system, _word(word), "b", ROOM)
        branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary=word), "b", ROOM)
        for k, one in enumerate(branch.special):
            special = {"type": one.type, "parameters": dict(one.parameters)}
            inner = _around((one.parameters["b"], system.omega), 0.05)
            name = f"paper, {title}, {one.type} {k}"
            cases.append(_curve(name, case, special, PLANE, (BOX, inner)))
            cases += _from_codimension_two(name, case, one, special)
    return cases


def _from_codimension_two(name: str, case: dict, one, special: dict) -> list[dict]:
    cases = []
    for j, two in enumerate(vs.bifurcation_curve(one, PLANE, BOX).special):
        if two.type in ("closed", "boundary", "failed"):
            continue
        at = {"type": two.type, "parameters": dict(two.parameters)}
        boxes = [_around(two.parameters.values(), share) for share in (0.1, 0.05)]
        for i, start in enumerate(vs.switch(two)):
            if (start.type, len(start.orbit.impacts)) == (one.type, len(one.orbit.impacts)):  # the same curve
                continue
            then = {"names": list(PLANE), "box": BOX, "special": at, "switch": i}
            own = f"{name}, {two.type} {j}, {start.type} {i}"
            cases.append(_curve(own, case, special, PLANE, boxes, [then]))
    return cases


def _sticking() -> dict:
    system = PAPER.replace(b=0.08)
    onset = _case("", system, _settled(system), "b", (0.06, 0.1))
    at = {"type": "sticking", "parameters": {"b": 0.064639143358}}
    return _curve("paper, sticking", onset, at, PLANE, ([[0.05, 0.08], [0.6, 0.66]], [[0.06, 0.07], [0.62, 0.64]]))


def _closed() -> dict:
    """Folds in (b, R) which come back to where they began."""
    rng = np.random.default_rng(52)
    system = random_system(rng)
    ((state, periods),) = attractors(system, rng, most=1, tries=4)
    orbit, bounds = vs.periodic_orbit(system, state=state, periods=periods), (0.3 * system.b, 2 * system.b)
    fold = next(one for one in vs.continue_orbit(orbit, "b", bounds).special if one.type == "fold")
    b = fold.parameters["b"]
    boxes = [[0.1 * b, 10 * b], [0.05, 1.0]], [*_around([b], 0.01), [system.R - 0.05, system.R + 0.05]]
    special = {"type": "fold", "parameters": dict(fold.parameters)}
    return _curve("closed curve of folds", _case("", system, start_of(orbit), "b", bounds), special, ("b", "R"), boxes)


def searches() -> list[dict]:
    both = {"follow": ["graze", "pitchfork", "flip"], "depth": 2}
    return [
        _case("paper, symmetric", PAPER, _word("LR"), "b", ROOM) | both | {"depth": 3},
        _case("paper, one side", PAPER.replace(b=4.0), _word("R"), "b", ROOM) | both,
        _case("paper, free motion", PAPER.replace(b=7.0), _word(""), "b", (6.5, 8)) | both,
        _case("paper, towards sticking", PAPER.replace(b=0.3), _settled(PAPER.replace(b=0.3)), "b", (0.06, 0.3))
        | both
        | {"depth": 8},
        _case("paper, over grazes alone", PAPER, _word("LR"), "omega", (0.5, 0.8)) | both | {"follow": ["graze"]},
    ]
