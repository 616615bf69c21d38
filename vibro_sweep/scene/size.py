"""How large a scene may be: points, numbers in the file, and what must be in memory at once for one orbit."""

import math
from collections.abc import Collection, Mapping, Sized
from typing import Any, Protocol

from vibro_sweep.tables.observables import WITH_STATES, of_an_impact

from .problems import problem

MAX_POINTS = 10**9
MAX_NUMBERS = 10**11  # doubles in the file, about a terabyte
MAX_TOGETHER = 5 * 10**6  # orbits among which attractors are sought
MAX_AT_ONCE = 5 * 10**7  # doubles in memory that cannot be split: 400 MB

FIXED = 300  # of an orbit of two masses, whatever is observed
COPIES = 4  # of what goes into the file: by dataset and as it is written


class Asked(Protocol):
    """What a `Scene` says of its size."""

    system: Any
    sweep: Mapping[str, Sized]
    section: Any
    observe: Collection[str]
    trajectory: Any
    record: int
    n_points: int
    n_starts: int
    shape: tuple[int, ...]


def fixed_numbers(masses: int) -> int:
    """Doubles of an orbit that it takes in any case."""
    return FIXED * max(2, masses) ** 2 // 4


def point_numbers(masses: int) -> int:
    """Doubles of a section point."""
    return 2 * masses


def impact_numbers(masses: int) -> int:
    """Doubles of an impact that is logged."""
    return 2 * masses + 3


def sample_numbers(masses: int) -> int:
    """Doubles of a sample: its time and its state."""
    return 2 * masses + 2


def scratch_numbers(scene: Asked) -> int:
    """Doubles that an orbit needs while it is computed, and that the next one uses again."""
    sought = not WITH_STATES.isdisjoint(scene.observe)
    logged = "section" in scene.observe and scene.section.kind == "impact"
    masses = scene.system.masses
    return scene.record * (point_numbers(masses) * sought + impact_numbers(masses) * logged)


def written_numbers(scene: Asked) -> int:
    """Doubles that an orbit leaves for the file, but for those of `fixed_numbers`."""
    each = point_numbers(scene.system.masses) + (not scene.system.gap_is_x1) + (scene.section.kind == "impact")
    recorded = each if "section" in scene.observe else 0
    return recorded * scene.record + sum(_trajectory_numbers(scene).values())


def _trajectory_numbers(scene: Asked) -> dict[str, int]:
    """Doubles of a trajectory by the key that they are due to: states and at most as many impacts; section points."""
    if not scene.trajectory:
        return {"trajectory.samples": 0, "trajectory.periods": 0}
    point = point_numbers(scene.system.masses)
    impact = len(of_an_impact(scene.system.masses, not scene.system.gap_is_x1))
    return {
        "trajectory.samples": (point + impact) * scene.trajectory.samples,
        "trajectory.periods": point * scene.trajectory.periods,
    }


def numbers_at_once(scene: Asked) -> int:
    """Doubles in memory for the least part of a scene: an orbit, or all that start at a point to find attractors."""
    together = scene.n_starts if "attractors" in scene.observe else 1
    masses = scene.system.masses
    samples = sample_numbers(masses) * scene.trajectory.samples if scene.trajectory else 0
    return scratch_numbers(scene) + samples + together * (fixed_numbers(masses) + COPIES * written_numbers(scene))


def size_problems(scene: Asked) -> list[str]:
    """The problems of what is too large, by the key that makes it so; nothing of that size is allocated to find out."""
    if scene.n_points > MAX_POINTS:
        size = " x ".join(str(length) for length in scene.shape)
        text = f"{size} = {scene.n_points:.6g} points; at most {MAX_POINTS:.0e} are allowed"
        return [problem("sweep", list(scene.sweep), text)]
    together = scene.n_points // math.prod(len(scene.sweep[key]) for key in scene.sweep if not key.startswith("start_"))
    if "attractors" in scene.observe and together > MAX_TOGETHER:
        text = f"attractors are sought among {together:,} orbits of one system; at most {MAX_TOGETHER:,} are allowed"
        return [problem("observe", sorted(scene.observe), text)]
    numbers = scene.n_points * written_numbers(scene)
    if numbers > MAX_NUMBERS:
        text = f"the file would hold {numbers:.6g} numbers; at most {MAX_NUMBERS:.0e} are allowed"
        return [problem(*_largest(scene), text)]
    numbers = numbers_at_once(scene)
    if numbers > MAX_AT_ONCE:
        what = "one orbit needs"
        if "attractors" in scene.observe and scene.n_starts > 1:
            what = f"to find attractors, the {scene.n_starts} orbits of a point need"
        most = MAX_AT_ONCE * 8 // 10**6
        text = f"{what} {8e-6 * numbers:,.0f} MB of memory at once; at most {most} MB are allowed"
        return [problem(*_largest(scene), text)]
    return []


def _largest(scene: Asked) -> tuple[str, int]:
    """The key, and its value, that most of the memory is due to."""
    together = scene.n_starts if "attractors" in scene.observe else 1
    trajectory = _trajectory_numbers(scene)
    recorded = scratch_numbers(scene) + together * (written_numbers(scene) - sum(trajectory.values()))
    path = max(trajectory, key=trajectory.get)
    if trajectory[path] * together > recorded:
        return path, getattr(scene.trajectory, path.removeprefix("trajectory."))
    if together > max(scene.record, 1000):
        return "start.random", together
    return "orbit.record", scene.record
