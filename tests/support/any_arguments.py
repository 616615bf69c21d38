"""Any value for any argument of any public function: a result, or one message that says what is wrong.

All calls, in an order without order, are dealt to PARTS seeds; a quarter of them have valid values.
"""

import contextlib
import functools
import os
import random
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import matplotlib.pyplot as plt

import vibro_sweep as vs
from support.any_calls import BRANCHES, COMPUTING, SLOW, TEXT, Call, calls, inside, objects
from support.any_values import VALUES
from support.searching import Report, new_report, size

PARTS = 150
SECONDS = 5.0  # of processor time, in which a value is refused
LONGEST = 600  # letters of a line: it has the value shortened, and what is allowed


@functools.cache
def workshop() -> tuple[tempfile.TemporaryDirectory, dict]:
    """A folder with files of all kinds, and objects of all kinds."""
    folder = tempfile.TemporaryDirectory()
    with contextlib.chdir(folder.name):
        Path("scene.yaml").write_text(TEXT)
        Path("branches.yaml").write_text(BRANCHES)
        vs.run(vs.load_scene("scene.yaml"), "sweep.h5")
        made = objects()
        made["PeriodicOrbit"].save("orbit.json")
    return folder, made


def draws(made: dict, part: int) -> Iterator[tuple[str, str, str, dict, Call]]:
    """(function, argument, kind of value, arguments, call)"""
    choose, table = random.Random("arguments"), calls(made)
    values = VALUES | {f"our {name}": (lambda one=one: one) for name, one in made.items()}
    bad = [
        (name, argument, kind, place)
        for name, call in table.items()
        for argument in call.valid
        for kind in values
        for place in range(-1, len(inside(argument, None)))
        if argument not in ("changes", "options")
    ]
    choose.shuffle(bad)
    for name, argument, kind, place in bad[part::PARTS]:
        value = values[kind]()
        value = value if place < 0 else inside(argument, value)[place]
        changed = {"F": value} if argument == "arguments" else {argument: value}
        yield name, argument, kind, table[name].given(changed), table[name]
    choose, weights = random.Random(f"valid {part}"), [1 if name in COMPUTING else SLOW for name in table]
    for name in choose.choices(list(table), weights, k=len(bad) // PARTS // 3):
        call = table[name]
        argument = choose.choice([*call.valid, "nothing"])
        yield name, argument, "valid", call.given(choose.choice(call.valid.get(argument, [{}]))), call


def study(seed: int) -> Report:
    """What became of the calls of one part, by the kind of error; and which were not refused as they should be."""
    folder, made = workshop()
    report = new_report()
    with contextlib.chdir(folder.name):
        files = sorted(os.listdir())
        for name, argument, kind, given, call in draws(made, seed % PARTS):
            what, began = f"{name}({argument} = {kind})", time.process_time()
            report.counted["calls"] += 1
            try:
                call(given)
            except Exception as error:
                seconds = time.process_time() - began
                report.counted.update(
                    [type(error).__name__, size("seconds of a refusal", seconds, (0.1, 0.5, SECONDS))]
                )
                wrong = ["it is valid"] * (kind == "valid") + said_wrong(error, argument)
                wrong += [f"it took {seconds:.1f} s"] * (seconds > SECONDS)
                wrong += ["files are left"] * (sorted(os.listdir()) != files)
                report.wrong.extend(f"{what}: {words}: {error!r}" for words in wrong)
            else:
                report.counted["valid" if kind == "valid" else "accepted"] += 1
            for left in {*os.listdir()}.difference(files):
                os.unlink(left)
            plt.close("all")
    return report


def said_wrong(error: Exception, argument: str) -> list[str]:
    """What is wrong with an error: it is the package's, or names argument, value and what is allowed; of one size."""
    text = str(error)
    wrong = ["a line is too long"] * any(len(line) >= LONGEST for line in text.splitlines())
    if not isinstance(error, vs.VibroSweepError):
        return [*wrong, "not the package's error"]
    if type(error).__name__ in ("ArgumentError", "ArgumentTypeError") and not (argument in text and "must be" in text):
        wrong.append("argument, or what is allowed, is not named")
    return wrong
