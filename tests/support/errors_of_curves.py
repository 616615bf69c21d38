"""Stated errors of points of codimension two of random systems against 30 digits (tests/reference/conditions.py)."""

import numpy as np

import vibro_sweep as vs
from support.in_digits import errors_of, of_orbit, vanishing
from support.random_branches import attractors, random_system
from support.searching import Report, new_report, size

OF_MONODROMY = (
    "fold_flip", "resonance_1_1", "resonance_1_2", "resonance_1_3", "resonance_1_4", "fold_neimark_sacker",
    "flip_neimark_sacker",
)  # fmt: skip
OF_GRAZES = ("double_graze", "fold_graze", "flip_graze", "pitchfork_graze", "resonant_graze")
MOST_IMPACTS = {OF_MONODROMY: 8, OF_GRAZES: 4}  # of the orbit; with more the reference takes minutes
SHARES = (0.1, 0.5, 1)  # of the error that is stated
BIFURCATIONS = ("fold", "flip", "pitchfork", "neimark_sacker", "graze")


def study(seed: int) -> Report:
    """How many numbers were compared, and those that are off by more than their error."""
    report = new_report(drawn=1)
    for ratio in ratios(seed):
        report.counted.update(["numbers", size("errors", ratio, SHARES)])
        if not ratio < 1:
            report.wrong.append(f"seed {seed}: {ratio:.2f} times the error")
    return report


def points(seed: int, most_curves=3, most_points=8):
    """Points of codimension two on curves in b and another number, of a random system."""
    rng = np.random.default_rng([7, seed])
    system = random_system(rng)
    for state, periods in attractors(system, rng, most=1, tries=4):
        orbit = vs.periodic_orbit(system, state=state, periods=periods)
        if not orbit.ok or not orbit.impacts.size or len(orbit.impacts) > 8:
            continue
        name = str(rng.choice(["omega", "R", "zeta", "mu_k"]))
        value = system.parameters()[name]
        branch = vs.continue_orbit(orbit, "b", (0.5 * system.b, 1.5 * system.b))
        for special in [one for one in branch.special if one.type in BIFURCATIONS][:most_curves]:
            b = special.parameters["b"]
            bounds = ((0.5 * b, 1.8 * b), (0.7 * value, min(1.4 * value, 1.0) if name == "R" else 1.4 * value))
            yield from vs.bifurcation_curve(special, ("b", name), bounds).special[:most_points]


def ratios(seed: int) -> list[float]:
    """Errors over stated errors, of both parameters together or each by itself."""
    result = []
    for special in points(seed):
        motion = of_orbit(special.orbit)
        if special.type == "double_graze" and len(vanishing(motion)) == len(motion.events):  # the free motion's: its
            continue  # own equations are singular there (the row "from an impact to the free motion" of curves.yaml)
        for types, most in MOST_IMPACTS.items():
            if special.type in types and len(special.orbit.impacts) <= most:
                result += [abs(off) / special.error for off in errors_of(special)]
    return result
