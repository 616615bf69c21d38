"""A program `vibro-sweep explore` and a page of it, for the tests of this folder."""

import pytest
from support.explorers import answers, explorer


@pytest.fixture(scope="package")
def program():
    with explorer() as running:
        yield running
        status, errors = running.end()
    assert status == 0 and "Traceback" not in errors and "warning" not in errors.lower(), errors


@pytest.fixture
def page(program):
    with program.socket() as socket:
        yield socket


@pytest.fixture
def view(page):
    return answers(page, "open", 1)[0]["view"] | {"columns": 64, "transient": 100, "record": 20}
