"""Oscillators with names that are simulated: the paper's, balls, a chain."""

from tools.golden.oscillators import PAPER

BALL = dict(type="one_mass", k=0.0, zeta=0.0, constant=-1.0, base=True, F=1.0, omega=1.0, R=0.8, b=0.0, stops="left")
CAVITY = dict(type="ball_in_cavity", mass_ratio=0.05, zeta=0.01, F=0.1, omega=1.0, R=0.7, b=1.0)


def paper() -> list[tuple[dict, list[float]]]:
    """All of them need the kernels of the paper's oscillator."""
    tiny = {"R": 1.0, "b": 1e-7}  # more impacts than are followed
    changes = (
        {}, {"R": 0.0, "b": 0.5}, tiny, {"R": 1.0}, {"R": 1.0, "zeta": 0.0}, {"b": 6.6}, {"b": 0.5},
        {"b": 0.1, "R": 0.3}, {"b": 0.155}, {"stops": "right", "b": 2.0}, {"stops": "left", "b": 1.0, "R": 0.4},
        {"omega": 1.3, "tau": 0.7}, {"b": 7.5}, {"offset": 0.4, "b": 3.0}, {"R": 0.05, "b": 1.2},
        {"R_left": 0.3, "b": 2.5}, {"zeta": 0.9, "b": 1.0},
    )  # fmt: skip
    states = ([0.0, 0.0, 0.0, 0.0], [0.05, 1.0, 0.0, -0.5])
    return [(PAPER | change, list(states[k % 2])) for k, change in enumerate(changes)]


def one_mass_rigid() -> list[tuple[dict, list[float]]]:
    changes = {}, {"R": 0.0, "F": 3.0}, {"R": 1.0}, {"R": 0.4}, {"F": 0.9, "R": 0.5}  # it rests where F < 1
    return [(BALL | change, [0.1, 0.3]) for change in changes]


def two_masses_rigid() -> list[tuple[dict, list[float]]]:
    return [(CAVITY | change, [0.0, 0.2, 0.1, -0.3]) for change in ({}, {"R": 1.0}, {"b": 0.2, "F": 0.5, "R": 0.1})]


def one_mass_compliant() -> list[tuple[dict, list[float]]]:
    dropped = {name: value for name, value in BALL.items() if name != "R"}
    soft = {"k_stop": 50.0, "c_stop": 2.0}
    changes = soft, soft | {"release": "force"}, soft | {"k_stop": 1e8, "c_stop": 1e3}, soft | {"preload": 0.3}
    cases = [(dropped | change, [0.2, 0.0]) for change in changes]
    return [*cases, (dropped | soft, [0.0, 1e300])]  # it leaves the range of floats


def two_masses_compliant() -> list[tuple[dict, list[float]]]:
    soft = {name: value for name, value in PAPER.items() if name != "R"} | {"k_stop": 30.0, "c_stop": 1.0}
    changes = {}, {"release": "force", "preload": 0.2}, {"k_stop": 1e6, "c_stop": 1e2}, {"R_left": 0.5}
    return [(soft | change, [0.0, 0.3, 0.1, 0.0]) for change in changes]


NAMED = {
    "one mass, rigid": one_mass_rigid,
    "two masses, rigid": two_masses_rigid,
    "one mass, compliant": one_mass_compliant,
    "two masses, compliant": two_masses_compliant,
}
