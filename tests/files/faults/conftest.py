"""The folder of a run that something goes wrong with, its scene, and what the run should give."""

import pytest
from support.contents import arrays_of
from support.faults import TEXT
from support.scene_texts import parsed

import vibro_sweep as vs


@pytest.fixture
def path(tmp_path):
    return tmp_path / "folder" / "out.h5"


@pytest.fixture(autouse=True)
def folder(path):
    path.parent.mkdir()


@pytest.fixture
def scene():
    return parsed(TEXT, "the_scene.yaml")


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    path = tmp_path_factory.mktemp("whole") / "whole.h5"
    vs.run(parsed(TEXT), path)
    return arrays_of(path)
