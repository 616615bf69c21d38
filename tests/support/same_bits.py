"""Sweeps of machines of any kind, of any observation: the same bits by one worker and three, in blocks of three sizes,
and where they were killed and went on."""

import tempfile
from pathlib import Path

import numpy as np

import vibro_sweep as vs
from support.contents import arrays_of
from support.drawn_oscillators import drawn, drawn_compliant
from support.scene_texts import parsed
from support.searching import Report, new_report
from vibro_sweep.types import Scene

WORDS = ("section", "lyapunov", "multipliers", "attractors", "energy", "convergence")
WAYS = ((1, 10**6), (3, 1), (2, 3))  # workers, points of a block; the last is killed and goes on


class Kill(Exception):  # noqa: N818
    pass


def scene_of(seed: int) -> Scene:
    """A short sweep of its clearance."""
    rng = np.random.default_rng([seed, 76])
    if seed % 3 == 0:
        mu_m, mu_k, omega = rng.uniform(0.3, 3, 3)
        system = vs.System(mu_m=mu_m, mu_k=mu_k, zeta=10 ** rng.uniform(-3, -0.5), f2=0.3, omega=omega, R=0.7, b=1.0)
        system = system.replace(b=float(vs.grazing(system).b * rng.uniform(0.3, 1.1)))
    elif seed % 3 == 1:
        system = drawn(seed, int(rng.integers(1, 4)))[0]
    else:
        system = drawn_compliant(seed)[0]
    touches = ["contacts"] if system.linear.compliant else ["impacts"]
    words = [*rng.permutation([*WORDS, *touches])[: rng.integers(1, 5)].tolist()]
    kinds = {"follow": str(rng.choice(["up", "both"]))}, {"random": int(rng.integers(2, 10)), "seed": seed}, None
    transient = int(rng.choice([0, 30, 300]))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "few.h5")
        axis = {"b": system.b * np.linspace(0.9, 1.1, int(rng.integers(4, 14)))}
        more = {"start": kinds[rng.integers(3)], "transient": transient, "record": int(rng.choice([40, 60]))}
        more |= {"settle": int(rng.choice([400, 2000]))} if rng.random() < 0.7 else {}
        vs.sweep(system, axis, observe=words, output=path, **more)
        return parsed(vs.open(path).attrs["scene"])


def study(seed: int) -> Report:
    """The sweep of this seed by every way."""
    scene, found = scene_of(seed), []
    with tempfile.TemporaryDirectory() as folder:
        for workers, block in WAYS:
            path = Path(folder, f"{workers}.h5")
            killed = computed(scene, path, workers, block, dies=(workers, block) == WAYS[-1])
            found.append({name: values.tobytes() for name, values in arrays_of(path).items() if values.dtype != object})
        longest = arrays_of(path).get("transient_periods", np.zeros(1)).max()
    wrong = [
        f"seed {seed}, {workers} workers, blocks of {block}: {name}"
        for (workers, block), arrays in zip(WAYS[1:], found[1:], strict=True)
        for name in arrays
        if arrays[name] != found[0][name]
    ]
    counted = new_report(scenes=1, killed=int(killed), went_on=int(longest > scene.transient)).counted
    return Report(counted, wrong)


def computed(scene: Scene, path: Path, workers: int, block: int, dies: bool) -> bool:
    """Run it; whether it was killed after its first block, and went on."""

    def progress(done: int, total: int) -> None:
        if dies and 0 < done < total:
            raise Kill

    try:
        vs.run(scene, path, workers=workers, block=block, progress=progress)
    except Kill:
        vs.run(scene, path, workers=workers, block=block, mode="resume")
        return True
    return False
