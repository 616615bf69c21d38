"""How large a scene may be: points, numbers in the file, and what must be in memory at once for one orbit."""

from typing import TYPE_CHECKING

from vibro_sweep.model.observables import OF_AN_IMPACT, WORDS
from vibro_sweep.model.state import STATE

from .problems import problem

if TYPE_CHECKING:
    from .scene import Scene

MAX_POINTS = 10**9
MAX_NUMBERS = 10**11  # doubles in the file, about a terabyte
MAX_AT_ONCE = 5 * 10**7  # doubles in memory that cannot be split: 400 MB

POINT = len(STATE)  # doubles of a section point,
IMPACT, SAMPLE = POINT + 3, POINT + 2  # a logged impact, a sample's time and state,
TRAJECTORY = POINT + len(OF_AN_IMPACT)  # a stored sample, and an impact beside it
FIXED = 300  # of an orbit, whatever is observed
COPIES = 4  # of what goes into the file: by dataset and as it is written


def scratch_numbers(scene: "Scene") -> int:
    """Doubles that an orbit needs while it is computed, and that the next one uses again."""
    sought = any(WORDS[word].states for word in scene.observe)
    logged = "section" in scene.observe and scene.section.kind == "impact"
    return scene.record * (POINT * sought + IMPACT * logged)


def written_numbers(scene: "Scene") -> int:
    """Doubles that an orbit leaves for the file, but for those of `FIXED`."""
    recorded = POINT + (scene.section.kind == "impact") if "section" in scene.observe else 0
    return recorded * scene.record + sum(_trajectory_numbers(scene).values())


def _trajectory_numbers(scene: "Scene") -> dict[str, int]:
    """Doubles of a trajectory by the key that they are due to: states and at most as many impacts; section points."""
    if not scene.trajectory:
        return {"trajectory.samples": 0, "trajectory.periods": 0}
    return {
        "trajectory.samples": TRAJECTORY * scene.trajectory.samples,
        "trajectory.periods": POINT * scene.trajectory.periods,
    }


def numbers_at_once(scene: "Scene") -> int:
    """Doubles in memory for the least part of a scene: an orbit, or all that start at a point to find attractors."""
    together = scene.n_starts if "attractors" in scene.observe else 1
    samples = SAMPLE * scene.trajectory.samples if scene.trajectory else 0
    return scratch_numbers(scene) + samples + together * (FIXED + COPIES * written_numbers(scene))


def size_problems(scene: "Scene") -> list[str]:
    """What is too large, by the key that makes it so; nothing of that size is allocated to find out."""
    if scene.n_points > MAX_POINTS:
        size = " x ".join(str(length) for length in scene.shape)
        text = f"{size} = {scene.n_points:.6g} points; at most {MAX_POINTS:.0e} are allowed"
        return [problem("sweep", list(scene.sweep), text)]
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


def _largest(scene: "Scene") -> tuple[str, int]:
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
