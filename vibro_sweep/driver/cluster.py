"""Dask's executor of the workers of a scheduler."""

import contextlib
import logging
from collections.abc import Iterator
from concurrent.futures import Executor

from distributed import Client
from distributed.comm import get_address_host_port

from vibro_sweep.checks.errors import VibroSweepError
from vibro_sweep.driver.blocks import version

CONNECT_SECONDS, JOIN_SECONDS = 5, 60
WORDY = ("distributed", "distributed.client", "concurrent.futures", "tornado.application")  # errors say it in one line


class ClusterError(VibroSweepError, RuntimeError):
    """A scheduler that cannot be reached, or workers that cannot compute for this program."""


@contextlib.contextmanager
def cluster(address: str) -> Iterator[Executor]:
    """An executor of all workers of the scheduler at `address`, those included that join later.

    Waits for the first of them. Raises ClusterError, before anything is computed: no scheduler there, no workers, or
    one without this version of the package. One that joins later and has another refuses its first block and so ends
    the run.
    """
    for name in WORDY:
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        get_address_host_port(address)  # a client with a wrong address takes long to give up
        client = Client(address, timeout=CONNECT_SECONDS, set_as_default=False)
    except (OSError, ValueError) as error:
        raise ClusterError(f"no dask scheduler answers there: {error}") from None
    except TypeError as error:  # TLS without certificates
        raise ClusterError(f"{error}; Dask finds them in its configuration: distributed.comm.tls") from None
    try:
        _wait_for_workers(client)
        yield client.get_executor(pure=False)  # two runs share no block
    finally:
        with contextlib.suppress(Exception):  # the scheduler may have died
            client.close()


def _wait_for_workers(client: Client) -> None:
    """Raises ClusterError where none joins; or, with their addresses, where some have not this program's version."""
    try:
        client.wait_for_workers(1, timeout=JOIN_SECONDS)
        answers = client.run(version, on_error="return")
    except TimeoutError:
        raise ClusterError(f"the scheduler has no workers, and none joined in {JOIN_SECONDS} s") from None
    except (OSError, RuntimeError) as error:
        raise ClusterError(f"the scheduler has died ({error})") from None
    died = {address for address, answer in answers.items() if isinstance(answer, OSError)}  # meanwhile
    wrong = [
        f"{name} has {_described(answer)}"
        for name, answer in answers.items()
        if answer != version() and name not in died
    ]
    if wrong:
        raise ClusterError(f"worker {'; worker '.join(wrong)}. This program is {version()}: install the same on all")


def _described(answer: str | Exception) -> str:
    """What a worker has."""
    if isinstance(answer, str):
        return answer
    return f"{'no' if 'ModuleNotFoundError' in repr(answer) else 'another'} vibro_sweep ({answer})"
