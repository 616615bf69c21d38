"""Any value for any argument of any public function: tests/support/any_arguments.py."""

import pytest
from support import slow_cases
from support.any_arguments import said_wrong, study, workshop
from support.any_calls import calls, methods, public
from support.searching import searched

import vibro_sweep as vs


def test_every_public_function_is_called():
    _, made = workshop()
    known = {(name, argument) for name, call in calls(made).items() for argument in call.valid}
    assert {*public(), *methods(made)} <= known


@pytest.mark.parametrize("seeds", [[0], *slow_cases(range(1, 5))], ids=len)
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_any_value_for_any_argument(seeds):
    counted, wrong = searched(study, seeds)
    assert wrong == [] and counted["valid"] > counted["calls"] / 5 > 50 * len(seeds)


@pytest.mark.parametrize(
    "error, words",
    [
        (KeyError("b"), ["not the package's error"]),
        (vs.ParameterError("R", 2, "at most 1"), []),
        (vs.SceneError("a.yaml", ["x" * 1000]), ["a line is too long"]),
    ],
    ids=["another error", "a good one", "a long one"],
)
def test_a_bad_message_is_seen(error, words):
    assert said_wrong(error, "R") == words
