"""How far a number of a system may go, of the bounds within which a branch or a curve is followed."""

from vibro_sweep.oscillator.family import family_of


def in_range(system, name: str, bound: float) -> float:
    """`bound`, or the last value before it that the system accepts."""

    def accepted(value: float) -> bool:
        try:
            system.replace(**{name: value})
        except ValueError:
            return False
        return True

    if accepted(bound):
        return bound
    inside = family_of(system).free[name]
    if bound < 0 < inside and accepted(0.0):
        return 0.0
    outside = bound
    while (middle := (inside + outside) / 2) not in (inside, outside):
        inside, outside = (middle, outside) if accepted(middle) else (inside, middle)
    return inside
