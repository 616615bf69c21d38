"""Write report.md and its picture: python benchmarks/report.py [--quick] [-o FOLDER] [--data FILE]

Each script runs in a process of its own, one after the other; the text follows from their figures. `--data` keeps the
figures in a file, or, where it exists, writes the report from it without measuring.
"""

import argparse
import json
import sys
import textwrap
import time
from pathlib import Path

import branches_and_curves
import first_minutes
import hard_cases
import scaling
import speed
from bench import ROOT, child, machine

SCRIPTS = (speed, hard_cases, branches_and_curves, scaling, first_minutes)


def measured(quick: bool) -> dict:
    """The figures of all scripts by their names; `about`: the machine and the time."""
    began, found = time.perf_counter(), {"about": machine()}
    for script in SCRIPTS:
        print(f"{script.__name__} after {time.perf_counter() - began:.0f} s", file=sys.stderr, flush=True)
        path = ROOT / "benchmarks" / f"{script.__name__}.py"
        found[script.__name__] = json.loads(child(path, "--json", *["--quick"] * quick).printed)
    found["about"] += f"; {time.perf_counter() - began:.0f} s, by `python benchmarks/report.py{' --quick' * quick}`"
    return found


def span(values, unit: str = "", count: int = 2) -> str:
    """The least and the largest of some values."""
    values = sorted(values)
    ends = dict.fromkeys(f"{float(f'{value:.{count}g}'):,.10g}" for value in (values[0], values[-1]))
    return " to ".join(ends) + unit


def filled(text: str) -> str:
    """Paragraphs in lines of 120 characters."""
    return "\n\n".join(textwrap.fill(part, 120, break_on_hyphens=False) for part in text.split("\n\n"))


def speeds(data: dict) -> str:
    points = data["points"]
    mine = {b: {row["method"]: row["us"] for row in rows} for b, rows in points.items()}
    orbit = [found[speed.OURS] for found in mine.values()]
    costs = [found[speed.EXPONENTS] / found[speed.OURS] - 1 for found in mine.values()]
    text = (
        f"A forcing period of an orbit takes {span(orbit)} microseconds in a sweep on one core, and the four Lyapunov "
        f"exponents add {span(costs)} times as much. Errors are those of rounding: the last line says what moving each "
        "input by one part in 2^53 does to the same impact times."
    )
    times, tangents = speed.ratios(data), speed.ratios(data, True)
    if times:
        bare = [found[speed.BARE] / found[speed.OURS] for found in mine.values()]
        text += (
            f" heyoka is the fastest of the other programs; in its best mode with the same error it takes "
            f"{span(times.values())} times as long, and with exponents {span(tangents.values())} times. Most of its "
            f"time goes into its events and their callbacks in Python: without events, where it flies through the "
            f"stops, it takes {span(bare)} times as long as this package with them."
        )
    slow = [
        row["us"] / mine[b][speed.OURS]
        for b, rows in points.items()
        for row in rows
        if row["method"].startswith("SciPy")
    ]
    steps = [
        row["us"] / mine[b][speed.OURS] for b, rows in points.items() for row in rows if row["method"] == speed.RK4
    ]
    if slow:
        text += (
            f" Fixed steps of Runge-Kutta take {span(steps)} times as long, by the number of steps, and DOP853 "
            f"{span(slow)} times. DOP853 passes brief contacts where the length of its steps is not limited: such "
            "points, and those of too few steps, stand in the grey strip of the picture."
        )
    return text


def others(data: dict) -> str:
    rows = [row for row in data["others"] if "peer" in row]
    found = []
    for what, chosen in (
        ("compliant stops", [r for r in rows if "chain" not in r["what"] and "force" not in r["what"]]),
        ("stops that release by force", [r for r in rows if "force" in r["what"]]),
        ("chains of masses between rigid stops", [r for r in rows if "chain" in r["what"]]),
    ):
        if chosen:
            found.append(f"{span([r['peer_us'] / r['us'] for r in chosen])} times as long with {what}")
    return (
        f"In its faster mode heyoka takes {', '.join(found)}, with and without exponents. The error is that of the "
        f"first {speed.COUNT} touches or impacts. The stops of chains are at a fifth of the free swing."
    )


def hard(data: dict) -> str:
    ours = data["grazes"][hard_cases.OURS]
    missed, invented = (sum(column) for column in zip(*ours["cells"], strict=True))
    worst = [max(row["parts"][k] for row in data["calibration"]) for k in (0, 1)]
    return (
        f"Of {ours['flights'] * len(ours['cells'])} impacts that go 10^-2 to 10^-14 of the clearance beyond a stop, "
        f"this package misses {missed}, and where as many flights turn as little before it, it invents {invented}.\n\n"
        f"Of the exponents of a sweep at most {100 * worst[0]:.1f} % are off by more than 2 of the errors in its file, "
        f"and at most {100 * worst[1]:.2f} % by more than 5; independent parts of a record would put 6.0 % beyond 2."
    )


def continued(data: dict) -> str:
    def rates(kind: str, which: str) -> str:
        found = [
            (name, 1e6 / us) for name, us in data["rows"].items() if kind in name and "short" in name and which in name
        ]
        return span([rate for _, rate in found], count=2) if found else ""

    text = (
        f"A second of processor time gives {rates('branch', 'impacts')} points of a branch of orbits with 28 to 1 "
        f"impacts, {rates('branch', 'contacts')} with 8 to 1 contacts, and {rates('curve', '')} points of a curve."
    )
    return text + (
        " Each point has all tests and the certificate. A whole call takes more for each, since it has few points, and "
        "finds the ends and special points to rounding. From a state near it a single orbit is found faster by "
        "shooting with heyoka, which gives neither certificate nor multipliers."
    )


def scaled(data: dict) -> str:
    exponents = [curve["exponent"] for curves in data["curves"].values() for curve in curves.values()]
    memory = [value for name, value in data["rows"].items() if "memory" in name]
    return (
        f"Cost grows at most like the power {max(exponents):.2f} of periods and points. Where it is less, what each "
        f"call takes still counts. A run of {scaling.POINTS[0]:,} to {scaling.POINTS[-1]:,} points has "
        f"{span(memory, count=3)} MB in memory. "
        "Two processes that know nothing of each other show what the machine had to give to two workers."
    )


def minutes(data: dict) -> str:
    rows = data["rows"]
    page = data["page"]
    text = (
        f"The first run compiles: with an empty cache a sweep and then an orbit take {rows[first_minutes.FIRST]:.0f} s."
        f" Later a single orbit is there after {rows['a single orbit: s']:.2f} s, and "
        f"`run` of the quickstart takes {rows['`run` of the quickstart: s']:.1f} s, both with the start of Python. "
        f"What `check` says of a scene is within a factor of {first_minutes.worst(data):.1f} of its run."
    )
    return text + ("" if page else " The live page was not measured: it needs chromium and playwright.")


def report(found: dict) -> str:
    s, name = found["speed"], "figures/error_against_time.png"
    return f"""# Error against time

{speed.head(s)}
![Time of a forcing period against the error of impact times]({name})

{filled(speeds(s))}

{filled(found["about"] + ". Everything here comes from this run.")}

**How it is measured.** The machine is the paper's oscillator. b = 6.69, 3 and 1 have periodic orbits with 0.28, 2 and 2
impacts a forcing period, b = 5.8, 4.6 and 0.5 chaos with 0.5, 0.9 and 4.4. Times are CPU times of one core, medians of
rounds in which the methods take turns. Those of this package are of sweeps by `vs.sweep`, less a sweep of fewer
periods, so that the start of a sweep, which takes some hundredths of a second, does not count. The error is the largest
one of the first 40 impact times of three orbits, in units of time, against 30 digits. A method that misses an impact,
or invents one, has no error but the number of impacts up to there. heyoka runs with `fast_math`, one orbit alone or
eight side by side in the vector unit; its best mode is the fastest one whose error is at most three times ours, or
three times that of rounding the inputs. "Short steps" limit each step of DOP853 to a 400th of a forcing period.
Right-hand sides of SciPy and Runge-Kutta are compiled by numba. The end of a chaotic orbit is compared nowhere.

In version 0.1 a period took 2.4 to 3.0 times what its sums and products alone cost on such a machine.

## Compliant stops, chains of masses, and other sweeps

{filled(others(s))}

{speed.rest(s)}
## Hard cases

{filled(hard(found["hard_cases"]))}

{hard_cases.text(found["hard_cases"])}
## Branches and curves

{filled(continued(found["branches_and_curves"]))}

{branches_and_curves.text(found["branches_and_curves"])}
## Scaling

{filled(scaled(found["scaling"]))}

{scaling.text(found["scaling"])}
## The first minutes

{filled(minutes(found["first_minutes"]))}

{first_minutes.text(found["first_minutes"])}"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition(":")[0])
    parser.add_argument("--quick", action="store_true", help="in reduced form: shows that it works")
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "benchmarks", metavar="FOLDER")
    parser.add_argument(
        "--data", type=Path, metavar="FILE", help="keep the figures here, or write the report from them"
    )
    chosen = parser.parse_args()
    if chosen.data and chosen.data.exists():
        found = json.loads(chosen.data.read_text())
    else:
        found = measured(chosen.quick)
        if chosen.data:
            chosen.data.write_text(json.dumps(found))
    (chosen.output / "figures").mkdir(parents=True, exist_ok=True)
    speed.figure(found["speed"]).savefig(chosen.output / "figures" / "error_against_time.png")
    (chosen.output / "report.md").write_text(report(found))


if __name__ == "__main__":
    main()
