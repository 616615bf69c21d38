"""A cluster of Dask for one test."""

import pytest
from support.clusters import Cluster


@pytest.fixture
def cluster(tmp_path):
    folder = tmp_path / "cluster"
    folder.mkdir()
    cluster = Cluster(folder)
    yield cluster
    cluster.end()
