"""Files and parts damaged or made up in every way: tests/support/fuzzed_commands.py."""

import pytest
from support import slow_cases
from support.fuzzed_commands import COMMANDS, seeds_of, study
from support.searching import searched


@pytest.mark.parametrize("name, few", [("whole.h5", 1), *slow_cases(("whole.h5", 8), ("half.h5.part", 8))])
def test_damaged_files(name, few):
    counted, wrong = searched(study, seeds_of(name, few))
    assert wrong == [] and counted.total() == 5 * few * len(COMMANDS)
