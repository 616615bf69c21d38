"""The same oscillators with all lengths in another unit, 2^k times as small: every result is the same, to rounding.

Lengths and forces are then multiplied by 2^k, which rounds nothing; but the equations, which are lengths, stand beside
a row that is none, so that eliminations may take another order.
"""

from numbers import Real

import numpy as np

import vibro_sweep as vs
from support.drawn_branches import drawn_orbit, drawn_oscillator
from support.searching import Report, new_report

LENGTHS = ("b", "offset", "F", "constant", "force", "force_cos")
MODELS = ("one_mass", "ball_in_cavity", "chain", "linear")
EXPONENTS = (-40, 40)
CURVES = ("fold", "flip", "pitchfork", "neimark_sacker", "graze", "sticking")
SWITCHED = ("flip", "pitchfork", "graze")
ENDS = ("closed", "boundary", "failed")
CLOSE = 1e-13  # relative difference of special points, beyond their errors
BORN = 1e-6  # the same, of what begins at them, at a small amplitude or beside a graze


def unit_of(name: str, k: int) -> float:
    """What a number of this name is multiplied by."""
    return 2.0**k if name.rstrip("0123456789") in LENGTHS else 1.0


def scaled(system, k: int):
    """The same oscillator, lengths and forces times 2^k."""
    numbers = {name: value for name, value in system.numbers.items() if isinstance(value, Real)}
    return system.replace(**{name: value * unit_of(name, k) for name, value in numbers.items()})


def orbit_in(orbit, k: int):
    """By Newton's method from the impacts of `orbit`."""
    system = scaled(orbit.system, k)
    whole = orbit._solution.whole()
    guess = list(zip(whole.times, whole.sides, whole.motion[:, 0] * 2.0**k, strict=True)) if whole.K else None
    return vs.periodic_orbit(system, periods=orbit.period, **({"guess": guess} if guess else {"itinerary": ""}))


def words_of(one, mirrored: bool):
    """What must be equal: of a special point, or an orbit; mirrored: or of its mirror image."""
    if hasattr(one, "system"):
        itinerary = len(one.itinerary or "") if mirrored else one.itinerary
        return "orbit", one.status, itinerary, one.period, one.symmetric
    sides = () if mirrored else (one.stop, one.impact)
    return one.type, *sides, one.kind, one.direction, one.criticality


def apart(one, other, k: int, switched: bool, mirrored: bool) -> bool:
    """Whether numbers differ by more than rounding does: of special points by more than the errors stated.

    switched : what `switch` gives, which lies beside a special point. A doubled orbit may begin with either half, and
        either of two mirror images may be the first: only speeds of impacts are compared
    """
    if not hasattr(one, "system"):
        error = 0.0 if switched else np.nan_to_num(one.error)
        values = [(value, other.parameters[name] / unit_of(name, k)) for name, value in one.parameters.items()]
        values = [(abs(x), abs(y)) for x, y in values] if mirrored else values
        sizes = [max(abs(x), one.orbit.system.b if name == "offset" else 0.0) for name, x in one.parameters.items()]
        close = BORN if switched else CLOSE
        return any(abs(x - y) > 2 * error + close * size for (x, y), size in zip(values, sizes, strict=True))
    numbers = other.system.numbers
    pairs = [
        (value, numbers[name] / unit_of(name, k))
        for name, value in one.system.numbers.items()
        if isinstance(value, Real)
    ]
    speeds = [np.sort(np.abs(orbit.impacts["v1"])) / unit for orbit, unit in ((one, 1.0), (other, 2.0**k))]
    size = speeds[0].max(initial=0.0)
    pairs += [(x / size, y / size) for x, y in zip(*speeds, strict=True)]
    pairs = [(abs(x), abs(y)) for x, y in pairs] if mirrored else pairs
    return any(abs(x - y) > BORN * max(abs(x), 1.0) for x, y in pairs)


class Pair:
    """Calls of a function in both units, from what the calls before gave."""

    def __init__(self, report: Report, where: str, k: int, mirrored: bool):
        """mirrored : whether orbits have mirror images, of which either may be the first"""
        self.report, self.where, self.k, self.mirrored = report, where, k, mirrored

    def alike(self, what: str, one, other) -> bool:
        """Whether two lists of special points or orbits say the same; two at the same place may change their order."""
        self.report.counted[what.split()[0]] += 1
        one, other = (sorted(found, key=lambda x: repr(words_of(x, self.mirrored))) for found in (one, other))
        words = [[words_of(x, self.mirrored) for x in found] for found in (one, other)]
        if words[0] != words[1]:
            self.report.wrong.append(f"{self.where}, 2^{self.k}, {what}: {words[0]} and {words[1]}")
            return False
        for x, y in zip(one, other, strict=True):
            if (not hasattr(x, "system") or x.ok) and apart(x, y, self.k, what.startswith("switch"), self.mirrored):
                self.report.wrong.append(f"{self.where}, 2^{self.k}, {what}: {words_of(x, False)}, {x} and {y}")
        return True

    def branch(self, orbits, name: str, bounds):
        """`continue_orbit`, and `switch` from its special points; the pairs of these, empty where they differ."""
        unit = unit_of(name, self.k)
        found = [
            vs.continue_orbit(orbit, name, tuple(bound * factor for bound in bounds))
            for orbit, factor in zip(orbits, (1.0, unit), strict=True)
        ]
        if not self.alike("continue_orbit", *(one.special for one in found)):
            return []
        pairs = list(zip(*(one.special for one in found), strict=True))
        for pair in pairs:
            if pair[0].type in SWITCHED:
                self.switch(pair)
        return pairs

    def switch(self, pair):
        self.report.counted[f"from {pair[0].type}"] += 1
        found = [vs.switch(special) for special in pair]
        return list(zip(*found, strict=True)) if self.alike(f"switch from {pair[0].type}", *found) else []

    def curve(self, pair, names, bounds):
        """`bifurcation_curve`, and `switch` from its points of codimension two."""
        self.report.counted[f"curve of {pair[0].type}"] += 1
        units = np.array([unit_of(name, self.k) for name in names])
        found = []
        for special, factors in zip(pair, (np.ones(2), units), strict=True):
            try:
                found.append(vs.bifurcation_curve(special, names, (np.array(bounds).T * factors).T.tolist()).special)
            except ValueError as error:
                found.append(str(error).split(";")[0])
        if str in map(type, found):
            self.alike("bifurcation_curve", *([] if isinstance(one, str) else one for one in found))
            return
        if self.alike("bifurcation_curve", *found):
            for one in zip(*found, strict=True):
                if one[0].type not in ENDS:
                    self.switch(one)

    def followed(self, orbits, name: str, bounds):
        unit = unit_of(name, self.k)
        found = [
            vs.follow_branches(orbit, name, tuple(bound * factor for bound in bounds))
            for orbit, factor in zip(orbits, (1.0, unit), strict=True)
        ]
        self.alike("follow_branches", *([s for one in each for s in one.branch.special] for each in found))


def study(seed: int, most_curves=2) -> Report:
    report, rng = new_report(drawn=1), np.random.default_rng([11, seed])
    model = str(rng.choice(MODELS))
    system = drawn_oscillator(model, rng)
    orbit = drawn_orbit(system, rng)
    if orbit is None:
        return report
    name = str(rng.choice([name for name in ("b", "b", "offset", "F", "omega", "R") if name in system.numbers]))
    value, reach = float(system.numbers[name]), {"offset": 0.3 * system.b}.get(name)
    reach = 0.3 * value if reach is None else reach
    bounds = value - reach, min(value + reach, 1.0) if name == "R" else value + reach
    other = str(rng.choice([x for x in ("b", "omega", "R", "zeta", "offset") if x in system.numbers and x != name]))
    around = float(system.numbers[other])
    width = 0.2 * system.b if other == "offset" else 0.3 * around
    limits = around - width, min(around + width, 1.0) if other == "R" else around + width
    for k in EXPONENTS:
        pair = Pair(report, f"{seed} {model}, {orbit.itinerary!r} in {name}, {other}", k, system.linear.symmetric)
        orbits = [orbit_in(orbit, j) for j in (0, k)]
        if not pair.alike("periodic_orbit", *([one] for one in orbits)) or not orbits[0].ok:
            continue
        found = pair.branch(orbits, name, bounds)
        for points in [one for one in found if one[0].type in CURVES][:most_curves]:
            pair.curve(points, (name, other), (bounds, limits))
        pair.followed(orbits, name, bounds)
    return report
