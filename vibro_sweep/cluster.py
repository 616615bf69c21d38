"""Dask: an executor of the workers of a scheduler. Nothing else in the package knows of it."""

import contextlib
import logging
from collections.abc import Iterator
from concurrent.futures import Executor

from distributed import Client
from distributed.cfexecutor import ClientExecutor
from distributed.comm import get_address_host_port

from vibro_sweep.blocks import version

CONNECT_SECONDS, JOIN_SECONDS = 5, 60


class ClusterError(RuntimeError):
    """A scheduler that cannot be reached, or workers that cannot compute for this program."""


class ClusterExecutor(ClientExecutor):
    """Dask's own executor, which also says how many blocks its workers compute at a time: some may join or die."""

    def __init__(self, client: Client):
        super().__init__(client, pure=False)  # two runs share no block
        self._threads = client.nthreads
        self._last = 1

    @property
    def num_workers(self) -> int:
        with contextlib.suppress(OSError):  # the scheduler may be away for a moment
            self._last = sum(self._threads().values())
        return self._last


@contextlib.contextmanager
def cluster(address: str) -> Iterator[Executor]:
    """An executor of all workers of the scheduler at `address`, those included that join later.

    Waits for the first of them. Raises ClusterError, before anything is computed: no scheduler there, no workers, or
    one without this version of the package. One that joins later and has another, refuses its first
    block and so ends the run.
    """
    for name in ("distributed", "distributed.client"):  # what they would say in many lines, errors say in one
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        get_address_host_port(address)  # a client that is told nonsense takes long to go away
        client = Client(address, timeout=CONNECT_SECONDS, set_as_default=False)
    except (OSError, ValueError) as error:
        raise ClusterError(f"no dask scheduler answers there: {error}") from None
    with client:
        try:
            client.wait_for_workers(1, timeout=JOIN_SECONDS)
        except TimeoutError:
            raise ClusterError(f"the scheduler has no workers, and none joined in {JOIN_SECONDS} s") from None
        _check(client)
        yield ClusterExecutor(client)


def _check(client: Client) -> None:
    """Raise ClusterError, with their addresses, where workers have not the version of this program."""
    answers = client.run(version, on_error="return")
    wrong = [f"{address} has {_told(answer)}" for address, answer in answers.items() if answer != version()]
    if wrong:
        raise ClusterError(f"worker {'; worker '.join(wrong)}. This program is {version()}: install the same on all")


def _told(answer: str | Exception) -> str:
    if isinstance(answer, str):
        return answer
    missing = "ModuleNotFoundError" in repr(answer)
    return f"no package vibro_sweep ({answer})" if missing else f"another vibro_sweep ({answer})"
