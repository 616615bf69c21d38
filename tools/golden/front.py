"""Makes the records of what users see: sweeps, files, figures and the live page."""

import math
from pathlib import Path

import numpy as np
import yaml
from golden import answers, datasets, figures, files, records, scenes, shown, sweeps
from support.kinds_of_files import COMPLIANT, KINDS

import vibro_sweep as vs

HERE = Path(__file__).parent
DRAWN_FILES = ("sweep", "windows", "branches", "curves", "search")
RUNS = 4  # of each scene with other rounding
SEARCH = """
system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6}
continue: {from: {itinerary: LR}, parameter: {b: [2, 6.5]}, follow: [pitchfork, graze], depth: 1}
"""
FREQUENCY = """
system: {type: chain, m: [2.4], k: [9500, 0], c: [3, 0], force: [40], k_stop: 180000, c_stop: 45, stop_right: 0.0015,
  units: SI}
sweep: {frequency: {values: [7, 12, 21, 24]}}
orbit: {transient: 600, record: 12}
observe: [section, contacts]
picture: {kind: contacts, units: [mm, Hz]}
"""
PART = """
system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8}
sweep: {R: {values: [0.7, 0.8]}, b: {values: [6.5, 6.6, 6.7]}}
orbit: {transient: 3, record: 4}
observe: [section, lyapunov, impacts]
"""


def named(kind: str) -> list[dict]:
    """The cases of a kind, by hand."""
    return yaml.safe_load((HERE / f"{kind}.yaml").read_text())


def all_sweeps(report) -> list[dict]:
    return [_sweep(case, report) for case in named("scenes")]


def _sweep(case: dict, report) -> dict:
    text = yaml.safe_dump(case["scene"], sort_keys=False)
    beside = [scenes.computed(other) for other in scenes.moved(text, RUNS)]
    result = sweeps.result_of(scenes.computed(text), beside, np.random.default_rng(0))
    kept = sum(len(numbers["at"]) for numbers in result["numbers"].values())
    report(f"{case['name']}: {kept} numbers of {len(result['numbers'])} variables")
    return {"name": case["name"], "scene": text, "result": result}


def all_files(report) -> list[dict]:
    cases = [
        _case(name, f"{name}.h5", "windows" if kind.scene is None else "run", kind.scene, kind.source)
        for name, kind in (KINDS | COMPLIANT).items()
    ]
    cases += [
        _case("search", "search.h5", "run", SEARCH),
        _case("frequency", "frequency.h5", "run", FREQUENCY),
        _case("unfinished", "unfinished.h5.part", "broken off", PART),
    ]
    cases += [_case(name, f"{name}.{'json' if 'orbit' in name else 'h5'}", "saved") for name in files.SAVED]
    records.write("files", cases)  # those that others are made from
    for case in cases:
        case["result"] = files.kept(case)
        report(f"{case['name']}: {case['file']}")
    return cases


def _case(name: str, file: str, made: str, scene: str | None = None, source: str = "") -> dict:
    return {"name": name, "file": file, "made": made, "scene": scene, "source": source}


def all_figure_data(report) -> list[dict]:
    """What is drawn: Datasets of scenes, and of the files of the kind `files`."""
    cases = {case["name"]: scenes.computed(yaml.safe_dump(case["scene"])) for case in named("figure_data")}
    for name, record in records.read("files").items():
        if name in DRAWN_FILES:
            with vs.open(files.file_of(record)) as data:
                cases[f"file {name}"] = data.load()
    report(f"{len(cases)} Datasets")
    return [{"name": name} | datasets.record_of(data) for name, data in cases.items()]


def all_figures(report) -> list[dict]:
    written = named("figures")
    cases = [{"name": call, "call": call} for call in written["of data"] + written["of results"]]
    cases += [{"name": call, "call": call, "arrays": False} for call in written["without arrays"]]
    cases += [{"name": f"plot {case['file']} {case['command']}".strip()} | case for case in written["by command"]]
    report(f"{len(cases)} figures")
    return [case | {"result": figures.result_of(case)} for case in cases]


def all_answers(report) -> list[dict]:
    """Says which answers are decided by rounding: these are no cases."""
    done = [case | {"result": answers.result_of(case)} for case in named("answers")]
    for case in done:
        for line in _by_rounding(case):
            report(f"# {case['name']}: {line}")
    report(f"{len(done)} answers")
    return done


def _by_rounding(case: dict) -> list[str]:
    """What differs with another rounding of the damping."""
    if case["requests"][-1]["type"] not in ("sweep", "orbit", "window"):
        return []
    zeta = 0.05 if case["page"] == "paper" else 0.02
    moved = answers.result_of(case, {"zeta": math.nextafter(zeta, math.inf)})
    return shown.different(case["result"], moved)
