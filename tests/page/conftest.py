"""A program `vibro-sweep explore`, a page of it and a browser, for the tests of this folder."""

import pytest
from support.browsers import chromium_of_playwright
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


@pytest.fixture(scope="module")  # its loop is not to be there in other modules, which have one of their own
def browser():
    with chromium_of_playwright() as opened:
        yield opened
