"""Random searches: what is computed for each of many seeds, against another way to compute it.

    PYTHONPATH=tests python -m tools.search KIND FROM TO [--workers N]

prints what is wrong of the seeds FROM ... TO - 1, and what was counted. What such searches have found is in
docs/evidence.md; a sample of each is a slow test.
"""

import argparse
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from importlib import import_module
from multiprocessing import get_context

from support.searching import Report, Study, new_report

KINDS = {  # its study, in tests/support
    "events": "first_events.study",
    "events-of-any": "first_events.study_of_any",
    "events-stiff": "stiff_contacts.study",
    "events-compliant": "first_events.study_of_compliant",
    "events-of-sweeps": "first_events.study_of_sections",
    "grazes": "near_grazes.study",
    "grazes-compliant": "compliant_grazes.study",
    "exponents": "rounded_orbits.study",
    "exponents-compliant": "compliant_exponents.study",
    "exponents-relaxing": "compliant_exponents.study_of_relaxing",
    "sums": "compliant_sums.study",
    "sums-relaxing": "compliant_sums.study_of_relaxing",
    "zeros-of-free-motion": "zero_exponents.study_of_free_motion",
    "zeros-of-regular-motion": "zero_exponents.study_of_regular_motion",
    "zeros-and-chaos": "zero_exponents.study_of_chaos",
    "branches": "branch_search.study",
    "branches-of-table": "branch_rows.study",
    "branches-of-systems": "random_branches.study_of_systems",
    "branches-of-oscillators": "random_branches.study_of_oscillators",
    "branches-compliant": "compliant_branches.study",
    "branches-beside-grazes": "beside_grazes.study_of_rigid",
    "branches-beside-touches": "beside_grazes.study_of_compliant",
    "branches-without-impacts": "free_peaks.study",
    "curves": "random_curves.study",
    "curves-of-table": "curve_rows.study",
    "curves-compliant": "compliant_curves.study",
    "curves-compliant-far": "compliant_curves.study_far",
    "curves-errors": "errors_of_curves.study",
    "switches": "random_switching.study",
    "windows": "window_search.study",
    "windows-compliant": "window_search.study_of_compliant",
    "births": "births.study",
    "arguments": "any_arguments.study",
    "scenes": "any_scenes.study",
    "runs-of-scenes": "any_scenes.study_of_runs",
    "extreme-numbers": "any_scenes.study_of_extremes",
    "same-bits": "same_bits.study",
    "arrivals": "arrivals.study",
    "settling": "arrivals.study_of_settle",
    "files": "fuzz_files.study",
    "kills": "kills.study",
    "units": "units.study",
}
EVERY = 100  # seeds after which counts are printed


def study_of(kind: str) -> Study:
    module, name = KINDS[kind].split(".")
    return getattr(import_module(f"support.{module}"), name)


def studied(kind: str, seed: int) -> Report:
    """The report on a seed; of one whose study raises an error, that it does."""
    try:
        return Report(*study_of(kind)(seed))
    except Exception as error:
        return Report(new_report(raised=1).counted, [f"seed {seed} raises {type(error).__name__}: {error}"])


def reports(kind: str, seeds: range, workers: int) -> Iterator[Report]:
    if workers == 1:
        yield from map(partial(studied, kind), seeds)
        return
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        yield from pool.map(partial(studied, kind), seeds)


def main(words: list[str] | None = None) -> int:
    """Exit status 1 where something is wrong."""
    parser = argparse.ArgumentParser(prog="python -m tools.search", description=__doc__.partition("\n")[0])
    parser.add_argument("kind", choices=KINDS)
    parser.add_argument("first", type=int)
    parser.add_argument("last", type=int)
    parser.add_argument("--workers", type=int, default=1)
    options = parser.parse_args(words)
    seeds, total = range(options.first, options.last), new_report()
    for seed, report in zip(seeds, reports(options.kind, seeds, options.workers), strict=True):
        total.counted.update(report.counted)
        total.wrong.extend(report.wrong)
        print(*report.wrong, sep="\n", end="\n" * bool(report.wrong), flush=True)
        if (seed + 1) % EVERY == 0 or seed == seeds[-1]:
            counts = ", ".join(f"{name} {count}" for name, count in total.counted.items())
            print(f"{options.kind}, seeds {options.first} to {seed}: {len(total.wrong)} wrong; {counts}", flush=True)
    return 1 if total.wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
