"""Any value for any argument of any public function: a result, or one message that says what is wrong.

`pytest -m soak -s tests/scenes/test_any_arguments.py` has all of them: tests/data/arguments.log.
"""

import os
import random
import time
from collections import Counter, defaultdict
from pathlib import Path

import matplotlib.pyplot as plt
import pytest
from support import slow_cases
from support.any_calls import BRANCHES, COMPUTING, SLOW, TEXT, calls, inside, methods, objects, public
from support.any_values import VALUES

import vibro_sweep as vs

SECONDS = 5.0  # of processor time, in which a value is refused
LONGEST = 600  # letters of a line: it has the value shortened, and what is allowed


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Objects of all kinds, in a folder with files of all kinds."""
    before = Path.cwd()
    os.chdir(tmp_path_factory.mktemp("arguments"))
    Path("scene.yaml").write_text(TEXT)
    Path("branches.yaml").write_text(BRANCHES)
    vs.run(vs.load_scene("scene.yaml"), "sweep.h5")
    found = objects()
    found["PeriodicOrbit"].save("orbit.json")
    yield found
    plt.close("all")
    os.chdir(before)


def test_every_public_function_is_called(made):
    table = calls(made)
    known = {(name, argument) for name, call in table.items() for argument in call.valid}
    assert {*public(), *methods(made)} <= known


def draws(made, share: int):
    """(function, argument, kind of value, arguments), in an order without order; a quarter of them are valid."""
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
    for name, argument, kind, place in bad[::share]:
        value = values[kind]()
        value = value if place < 0 else inside(argument, value)[place]
        changed = {"F": value} if argument == "given" else {argument: value}
        yield name, argument, kind, table[name].given(changed), table[name]
    weights = [1 if name in COMPUTING else SLOW for name in table]
    for name in choose.choices(list(table), weights, k=len(bad) // share // 3):
        call = table[name]
        argument = choose.choice([*call.valid, "nothing"])
        yield name, argument, "valid", call.given(choose.choice(call.valid.get(argument, [{}]))), call


@pytest.mark.parametrize("share", [150, *slow_cases(10), pytest.param(1, marks=pytest.mark.soak)])
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_any_value_for_any_argument(made, share):
    outcomes, files, slowest = Counter(), sorted(os.listdir()), (0.0, "")
    for name, argument, kind, given, call in draws(made, share):
        what, began = f"{name}({argument} = {kind})", time.process_time()
        try:
            call(given)
        except Exception as error:
            assert kind != "valid", (what, repr(error))
            check(error, argument, what)
            seconds = time.process_time() - began
            assert seconds < SECONDS, (what, seconds)
            slowest = max(slowest, (seconds, what))
            outcomes[name, type(error).__name__] += 1
            assert sorted(os.listdir()) == files, what
        else:
            outcomes[name, "valid" if kind == "valid" else "accepted"] += 1
            for left in {*os.listdir()}.difference(files):
                os.unlink(left)
        plt.close("all")
    tell(outcomes, slowest)
    assert sum(count for (_, what), count in outcomes.items() if what == "valid") > outcomes.total() / 5


def tell(outcomes: Counter, slowest: tuple[float, str]) -> None:
    """A line for each function."""
    print(f"\n{outcomes.total()} calls; slowest refusal {slowest[0]:.2f} s: {slowest[1]}")
    by_function: dict[str, Counter] = defaultdict(Counter)
    for (name, what), count in outcomes.items():
        by_function["all"][what] += count
        by_function[name][what] += count
    for name, found in by_function.items():
        print(f"{name}: {found.total()}: {', '.join(f'{what} {count}' for what, count in found.most_common())}")


def check(error: Exception, argument: str, what: str) -> None:
    """The package's own error, or one that names argument, value and what is allowed; a message of one size."""
    text = str(error)
    assert all(len(line) < LONGEST for line in text.splitlines()), (what, text)
    assert isinstance(error, vs.VibroSweepError), (what, repr(error))
    if type(error).__name__ not in ("ArgumentError", "ArgumentTypeError"):
        return
    assert argument in text and "must be" in text, (what, repr(error))
