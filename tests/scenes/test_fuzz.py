"""Random scenes: a result or one message each; and what every result must be, whoever computes it."""

import pytest
from support import any_scenes, slow_cases
from support.searching import searched


@pytest.mark.parametrize("count", [20, *slow_cases(200)])
def test_every_scene_ends_in_a_result_or_one_message(count):
    counted, wrong = searched(any_scenes.study, range(count))
    assert wrong == []
    assert counted["accepted"] > count / 10 and counted["scenes"] - counted["accepted"] > count / 10


@pytest.mark.parametrize("count", [25, *slow_cases(50)])
def test_every_run_keeps_what_every_run_must(count):
    counted, wrong = searched(any_scenes.study_of_runs, range(count))
    assert wrong == [] and counted["refused"] < count / 5 and counted["well"] > 0.9 * counted["orbits"]


@pytest.mark.slow
def test_numbers_at_the_ends_of_the_floats():
    counted, wrong = searched(any_scenes.study_of_extremes, range(50))
    assert wrong == [] and len(counted) >= 4


def test_a_scene_that_is_accepted_and_should_not_be_is_seen():
    refused = next(n for n in range(100) if any_scenes.study(n).counted["refused: form"])
    assert any_scenes.agreement(refused, 0)[1]
