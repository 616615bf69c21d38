"""Bifurcation curves that are rows of a table: how a row is followed, and what differs from it.

branch : the branch with the first point, as a row of branches.yaml: system, start, parameter, bounds
at : [type, n], the n-th special point of this type on the branch
via : [[type, n, type of start, n of start], ..], points of codimension two, after each of which the curve that begins
    there is followed instead
parameters, bounds : of the curve; `virtual: false` where it is to end with its motion
special : [type, [value, value], error] of its points of codimension two in order; values may differ by the error, and
    a curve that is followed from this start may state no more than five times as much
steps : lengths of steps that give the same list
points : how many points are compared with the reference
starts : from how many points of codimension two it is followed again
in_digits : whether special points are compared with the reference; those where the cubic coefficient of a normal form
    is zero take a minute each: the last of a curve, if `degenerate` says so
"""

import numpy as np
from reference.closed_orbit import ClosedOrbit

import vibro_sweep as vs
from support import branch_rows, cases
from support.curves import chosen, error_at
from support.in_digits import (
    SLOW_IN_SIMULATION,
    closed_of,
    errors_of,
    has_conditions,
    of_point,
    turning_points,
    vanishing,
    without,
)
from support.random_curves import special_at
from support.searching import Report, new_report

STEPS = (0.5, 2)  # of a row that names none
POINTS = 4
STARTS = 2  # at points of codimension two
CLOSE = 1e-12  # relative: of a parameter of a point
CLOSE_OF_CONTACTS = 1e-8  # the same with compliant stops
MARGIN = 1e-8  # relative: of the distance of an orbit from its stops
CRITICAL = {"fold": 1, "flip": -1, "pitchfork": -1}  # over half a period of symmetric orbits
CIRCLE = 1e-6  # of the unit circle: critical multipliers are no nearer to it than that by rounding
NOT_FROM = ("boundary", "closed", "failed", "split", "permanent_contact", "unrelaxed")  # where `switch` gives nothing,
NOT_FROM += ("double_graze",)  # or other curves of the same type


def nth(special, of_type: str, n: int):
    return [one for one in special if one.type == of_type][n]


def first_point(row: dict):
    """The special point where a row begins its curve."""
    branch = row["branch"]
    special = nth(branch_rows.follow(branch, branch_rows.orbit_of(branch)).special, *row["at"])
    for of_type, n, kind, m in row.get("via", ()):
        curve = vs.bifurcation_curve(special, row["parameters"], row["bounds"])
        special = nth(vs.switch(nth(curve.special, of_type, n)), kind, m)
    return special


def follow(row: dict, special, step: float = 1.0):
    return vs.bifurcation_curve(special, row["parameters"], row["bounds"], virtual=row.get("virtual", True), step=step)


def values_of(special) -> list[float]:
    return list(special.parameters.values())


def differences(row: dict, curve) -> list[str]:
    """What a curve has otherwise than its row, in the better of both directions."""
    if curve.closed != row.get("closed", False):
        return [f"closed: {curve.closed}"]
    special = [one for one in curve.special if one.type != "closed"]
    orders = [special, special[::-1]]
    if curve.closed:
        orders = [order[k:] + order[:k] for order in orders for k in range(len(order))]
    return min((in_order(row["special"], order) for order in orders), key=len)


def in_order(expected: list, special: list) -> list[str]:
    if [kind for kind, *_ in expected] != [one.type for one in special]:
        found = [f"{one.type} {values_of(one)}" for one in special]
        return [f"{found} instead of {expected}"] * (1 + len(special))
    return [
        f"{kind} at {values_of(one)}, not {values} +- {error}"
        for (kind, values, error), one in zip(expected, special, strict=True)
        if not np.abs(np.subtract(values_of(one), values)).max() <= error
    ]


def imprecise(row: dict, curve) -> list[str]:
    """Special points whose stated errors say less than is known of them."""
    errors = {(kind, *values): error for kind, values, error in row["special"]}
    return [
        f"{one.type} at {values_of(one)} states the error {one.error:.1e}"
        for one in curve.special
        if one.type not in ("boundary", "closed")
        and not one.error <= 5 * max(error for (kind, *_), error in errors.items() if kind == one.type)
    ]


def starts(row: dict, curve, special):
    """(words, special point) of others from which the same curve is followed: at points of codimension two, between."""
    yield from list(switched(curve, special))[: row.get("starts", STARTS)]
    for k in chosen(curve, 4)[1:-1]:
        crossed = special_at(curve, k, special.orbit)
        if crossed is not None:
            yield f"point {k}", crossed


def with_other_steps(row: dict, special) -> list[str]:
    """What a row's curve has otherwise when it is followed with other steps."""
    return [
        f"step {step}: {words}"
        for step in row.get("steps", STEPS)
        for words in differences(row, follow(row, special, step))
    ]


def from_other_points(row: dict, curve, special) -> tuple[int, list[str]]:
    """(starts, words) of what it has otherwise when it is followed from other points of it."""
    counted, wrong = 0, []
    for start, other in starts(row, curve, special):
        wrong += [f"{start}: {words}" for words in differences(row, follow(row, other))]
        counted += 1
    return counted, wrong


def study(k: int) -> Report:
    """The k-th row of tests/cases/curves.yaml, with all steps, from all starts, and in 30 digits."""
    row = cases.nth("curves", k)
    special = first_point(row)
    curve = follow(row, special)
    report = new_report(curves=1)
    report.wrong.extend(with_other_steps(row, special))
    for name, compare in (("starts", from_other_points), ("points", points_off)):
        counted, wrong = compare(row, curve, special)
        report.counted[name] += counted
        report.wrong.extend(wrong)
    counted, wrong = off_in_digits(row, curve)
    report.counted["in_digits"] += counted
    report.wrong.extend(wrong)
    return report


def switched(curve, special):
    """Those at points of codimension two, of orbits of the same kind."""
    kind = branch_rows.kind(special.orbit)
    for one in curve.special:
        if one.type not in NOT_FROM and one.orbit.ok:
            for k, start in enumerate(vs.switch(one)):
                if start.type == curve.type and branch_rows.kind(start.orbit) == kind:
                    yield f"start {k} of {one.type} at {values_of(one)}", start


def off_in_digits(row: dict, curve) -> tuple[int, list[str]]:
    """(points, words) of points of codimension two that the reference has elsewhere."""
    counted, wrong = 0, []
    compared = [one for one in curve.special if has_conditions(one) and row.get("in_digits", True)]
    degenerate = [one for one in compared if one.type.startswith("degenerate")]
    for one in compared:
        if one not in degenerate or (one is degenerate[-1] and row.get("degenerate")):
            off = np.abs(errors_of(one)).max()
            counted += 1
            if not off < max(one.error, 1e-13):
                wrong.append(f"{one.type} at {values_of(one)} is off by {off:.1e}, and states {one.error:.1e}")
    return counted, wrong


def points_off(row: dict, curve, special) -> tuple[int, list[str]]:
    """(points, words) of a sample of points: their parameters and multipliers by the reference, their motion by the
    engine's simulation, in which a graze would be an impact as fast as the square root of rounding."""
    counted, wrong = 0, []
    count = row.get("points", POINTS)
    close = CLOSE_OF_CONTACTS if special.orbit.system.linear.compliant else CLOSE
    for k in np.unique(chosen(curve, count + 2)[1:-1]).tolist() if count else ():  # at ends multipliers may be double
        counted += 1
        if not error_at(curve, k, special.orbit) < close:
            wrong.append(f"point {k} is off by {error_at(curve, k, special.orbit):.1e}")
        wrong += [f"point {k}: {words}" for words in of_point_wrong(curve, k, special.orbit)]
    return counted, wrong


def of_point_wrong(curve, k: int, orbit) -> list[str]:
    motion, point, wrong = of_point(curve, k, orbit), curve.points.isel(point=k), []
    own = point.multiplier_re.values + 1j * point.multiplier_im.values
    state = motion.sample([0.0])[0]
    away = np.abs(motion.sample([motion.P])[0] * motion.sigma - state).max()
    if curve.type != "graze" and not away < 1e-9 * max(1.0, np.abs(own).max()) * np.abs(state).max():
        wrong.append(f"comes back {away:.1e} away")
    if curve.type == "graze":
        motion = without(motion, vanishing(motion, SLOW_IN_SIMULATION))
    touches = turning_points(motion)[:1] if curve.type == "graze" else ()
    d = closed_of(motion, touches)
    closed = ClosedOrbit(d.machine, *d.of)
    found = d.guess if curve.type == "fold" else closed.solve(*d.guess)  # Newton's method is singular at a fold
    mu = np.array([complex(one) for one in closed.multipliers(*found)])
    if curve.type in CRITICAL and not np.abs(mu - CRITICAL[curve.type]).min() < CIRCLE:
        wrong.append(f"multipliers {mu}")
    outside = int(np.sum(np.abs(mu) > 1 + CIRCLE))
    if np.abs(np.abs(mu) - 1).min() > CIRCLE or curve.type != "graze":
        wrong += [f"{int(point.unstable)} outside, not {outside}"] if int(point.unstable) != outside else []
    sizes = np.sort(np.abs(mu) ** (2 if motion.sigma < 0 else 1))[::-1]
    if not np.abs(np.abs(own[:1]) - sizes[:1]).max() < 1e-5 * sizes[0]:
        wrong.append(f"multipliers {own}, not {mu}")
    return wrong


def margins_off(curve, special) -> tuple[int, list[str]]:
    """(points, words): `stop_distance` of a point is that of its orbit, found anew."""
    counted, wrong = 0, []
    for k in np.unique(chosen(curve, 6)).tolist():
        crossed = special_at(curve, k, special.orbit)
        if crossed is None:
            continue
        expected, found = crossed.orbit.stop_distance, float(curve.points.stop_distance[k])
        counted += 1
        if not (found == expected or abs(found - expected) < MARGIN * abs(expected) + 1e-10):
            wrong.append(f"point {k} is {found!r} from its stop, not {expected!r}")
    return counted, wrong
