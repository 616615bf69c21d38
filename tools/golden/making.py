"""Makes the record: cases one after the other, until there are enough of each kind."""

import collections
import time

import numpy as np
from golden import branches, curves, searches
from support.drawn_branches import MODELS

import vibro_sweep as vs
from tools.golden import drawing, named

PER_MODEL = {"branches": 24, "curves": 13, "searches": 8}  # of those drawn
LONGEST = 4.0  # seconds of one case, of its own time: a busy machine changes nothing
MOST_REACHED = 25  # branches of a search
OTHERS = {"branches": 0, "curves": 1, "searches": 2}  # of seeds


def timed(function, *given):
    """What a function returns; None where it takes long also when all is compiled."""
    for _ in range(2):
        begun = time.process_time()
        result = function(*given)
        if time.process_time() - begun < LONGEST:
            return result
    return None


def tried(make, record: dict, told) -> dict | None:
    """The record with its result, or None: it takes long, or is refused."""
    try:
        return timed(make, record)
    except (ValueError, LookupError) as error:
        told(f"# {record['name']}: {type(error).__name__}: {error!s:.150}")
        return None


def branch_record(record: dict) -> dict | None:
    branch = branches.followed(record)
    if not branch.ok:
        raise LookupError("failed")
    rng = np.random.default_rng(0)
    return record | {"result": branches.result_of(branch, rng), "switch": branches.switched(branch)}


def curve_record(record: dict) -> dict | None:
    made = curves.traced(record)
    if any(end.type == "failed" for one in made for end in (one.begins, one.ends)):
        raise LookupError("failed")
    return record | {"result": curves.result_of(made)}


def search_record(record: dict) -> dict | None:
    def progress(count, *_):
        if count > MOST_REACHED:
            raise LookupError("too many branches")

    found = searches.searched(record, progress)
    return record | {"result": searches.result_of(found, np.random.default_rng(0))}


def all_branches(told) -> list[dict]:
    done = [tried(branch_record, case, told) for case in named.branches()]
    return [one for one in done if one] + _drawn("branches", branch_record, drawing.cases, told)


def all_curves(known: list[dict], told) -> list[dict]:
    """Those that are named, and from special points of the branches `known`."""
    done = [tried(curve_record, case, told) for case in named.curves()]
    rng, counted = np.random.default_rng(drawing.SEED), collections.Counter()
    for model in MODELS:
        own = [one for one in known if one["system"]["type"] == model]
        done += _curves_of(own, counted, rng, told)
    return [one for one in done if one]


def _curves_of(known: list[dict], counted: collections.Counter, rng, told) -> list[dict]:
    """From special points of these branches, those types first that are met seldom."""
    points = [(one, *point) for one in known for point in enumerate(one["result"]["special"])]
    points = [points[i] for i in rng.permutation(len(points)) if points[i][2]["type"] in drawing.CURVES]
    result = []
    while points and len(result) < PER_MODEL["curves"]:
        points.sort(key=lambda point: counted[point[2]["type"]])
        branch, k, special = points.pop(0)
        case = drawing.one_curve(branch, special, rng, f"{branch['name']}, {special['type']} {k}")
        if case and (found := tried(curve_record, case, told)):
            told(found["name"])
            result.append(found)
            counted[special["type"]] += 1
    return result


def all_searches(told) -> list[dict]:
    def cases(seed):
        for case in drawing.cases(seed):
            rng = np.random.default_rng([drawing.SEED, seed])
            yield case | {"follow": ["graze", "pitchfork", "flip"], "depth": int(rng.integers(1, 3))}
            return

    done = [tried(search_record, case, told) for case in named.searches()]
    return [one for one in done if one] + _drawn("searches", search_record, cases, told)


def _drawn(kind: str, make, cases, told) -> list[dict]:
    result, counted, seed = [], collections.Counter(), 100_000 * OTHERS[kind]
    while any(counted[model] < PER_MODEL[kind] for model in MODELS):
        model = MODELS[seed % len(MODELS)]
        if counted[model] < PER_MODEL[kind]:
            try:
                for case in cases(seed):
                    found = tried(make, case, told)
                    if found and counted[model] < PER_MODEL[kind]:
                        result.append(found)
                        counted[model] += 1
                        told(found["name"])
            except (ValueError, vs.RunError) as error:
                told(f"# seed {seed}: {error!s:.150}")
        seed += 1
    return result
