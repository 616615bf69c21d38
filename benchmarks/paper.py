"""The whole paper in one command: every figure, and a table "what the paper says / the map / the exact flow".

    python benchmarks/paper.py [--output FOLDER] [--workers N]

The scenes are those of configs/paper; figures and result files go to FOLDER (./paper). The numbers are those of
tests/support/paper.py.
"""

import argparse
import time
from pathlib import Path

import shared  # noqa: F401
from support import paper

import vibro_sweep as vs
from vibro_sweep import plotting
from vibro_sweep.scene import parse_scene


def draw(run, output) -> None:
    """The paper's figures; figure 6 also as it is when followed up and down, of order 2, and of the flow."""
    for name, kinds in paper.FIGURES.items():
        scene = vs.load_scene(paper.SCENES / f"{name}.yaml")
        vs.run(scene, output / f"{name}.h5", workers=run.workers, mode="overwrite")
        for n, kind in enumerate(kinds):
            plotting.plot(output / f"{name}.h5", output / f"{name}{f'_{kind}' if n else ''}.png", kind)
    sweep = f"sweep: {{b: {{start: 6.5, stop: 6.9, step: {paper.STEP}}}}}\n"
    follow = f"{sweep}start: {{follow: both}}\norbit: {paper.HASTY}\n"
    for name, model in (
        ("map", "dynamics: map"),
        ("map_order_2", "dynamics: map\norder: 2"),
        ("flow", "dynamics: flow"),
    ):
        text = f"system: {{{paper.SYSTEM}}}\n{model}\n{follow}{paper.OBSERVE}"
        path = output / f"figure_06_follow_{name}.h5"
        vs.run(parse_scene(text, path.stem), path, workers=run.workers, mode="overwrite")
        plotting.plot(path, path.with_suffix(".png"))


def show(t: paper.Table) -> None:
    def line(what, *parts):
        print(f"{what:<30}" + "".join(f"{part:<30}" for part in parts).rstrip())

    print("\nThe double grazing (Theorem 1)")
    line("", "the paper", "exact", "the paper's error")
    for name, (value, off) in (("b*", t.b), ("tau*", t.tau)):
        printed = paper.PAPER[name]
        line(name, f"{printed}", f"{value:.14g} +- {off:.0e}", f"{100 * (printed / value - 1):+.4f} %")
    for b, models in t.states.items():
        print(f"\nb = {b}; {paper.STARTS} random starts, in brackets how many end there")
        line("the paper", paper.PAPER[b])
        for name, found in models.items():
            for n, attractor in enumerate(found):
                line("" if n else name, str(attractor))
    print("\nThe band of impacting motion ends at b =")
    line("", "from X*", "for half of random starts", "for all (at least)")
    line("the paper", f"{paper.PAPER['b*']}")
    for name, end in t.from_elsewhere.items():
        start = "{:.9f} +- {:.0e}".format(*t.from_graze[name]) if name in t.from_graze else ""
        line(name, start, f"{end.most:.4f} +- {paper.STEP:.0e}", f"{end.last:.6f} +- {end.off:.0e}")
    end = t.from_elsewhere["exact flow"]
    print("\nThe non-impacting orbit, stable from b* on, coexists with impacting attractors of the flow for b =")
    line("the paper", "nowhere")
    line("exact flow", f"{t.b[0]:.12f} +- {t.b[1]:.0e} .. {end.last:.6f} +- {end.off:.0e}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--output", type=Path, default=Path("paper"), help="folder of the figures")
    parser.add_argument("--workers", type=int, default=None, help="threads; by default one for each core")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    run = paper.Runner(options.workers)
    run("dynamics: flow", "{transient: 1, record: 1}", "{x1: 0}", 6.7)
    began = time.perf_counter()  # after compiling
    draw(run, options.output)
    show(paper.table(run))
    print(f"\n{time.perf_counter() - began:.0f} s; figures in {options.output}")


if __name__ == "__main__":
    main()
