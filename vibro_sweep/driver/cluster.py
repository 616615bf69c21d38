"""Dask: an executor of the workers of a scheduler. Nothing else in the package knows of it."""

import contextlib
import ipaddress
import logging
import socket
from collections.abc import Iterator
from concurrent.futures import CancelledError, Executor

from distributed import Client
from distributed import client as client_module
from distributed.cfexecutor import ClientExecutor
from distributed.comm import get_address_host_port

from vibro_sweep.driver.blocks import version
from vibro_sweep.driver.compute import RunError
from vibro_sweep.model.errors import VibroSweepError

_log = logging.getLogger("vibro_sweep")

CONNECT_SECONDS, JOIN_SECONDS = 5, 60


# What a client raises whose scheduler is away, or has died; the last of these in newer versions only.
GONE = (OSError, RuntimeError, getattr(client_module, "ClosedClientError", RuntimeError))


class ClusterError(VibroSweepError, RuntimeError):
    """A scheduler that cannot be reached, or workers that cannot compute for this program."""


class ClusterExecutor(ClientExecutor):
    """Dask's own executor, which also says how many blocks its workers compute at a time: some may join or die."""

    def __init__(self, client: Client):
        super().__init__(client, pure=False)  # two runs share no block
        self._threads = client.nthreads
        self._last = 1

    @property
    def num_workers(self) -> int:
        with contextlib.suppress(*GONE):  # the scheduler may be away for a moment
            self._last = sum(self._threads().values())
        return self._last

    @property
    def gone(self) -> bool:
        """Whether the scheduler has died. A block that was sent at that moment is never answered."""
        return self._client.status in ("closing", "closed")

    def submit(self, function, *arguments, **named):
        try:
            return super().submit(function, *arguments, **named)
        except GONE as error:
            raise RunError(f"the scheduler has died ({error})") from error


def _is_news(record: logging.LogRecord) -> bool:
    """Whether a log record is news. That blocks were cancelled, or cannot be since the scheduler is dead, is not: the
    run says so in one line."""
    return not (record.exc_info and isinstance(record.exc_info[1], (*GONE, CancelledError)))


def _filter_callbacks() -> None:
    """These log what callbacks raise, with a traceback; from here on without what is not news, since some are still
    called when the client is closed."""
    for name in ("concurrent.futures", "tornado.application"):
        logging.getLogger(name).addFilter(_is_news)


@contextlib.contextmanager
def cluster(address: str) -> Iterator[Executor]:
    """An executor of all workers of the scheduler at `address`, those included that join later.

    Waits for the first of them. Raises ClusterError, before anything is computed: no scheduler there, no workers, or
    one without this version of the package. One that joins later and has another, refuses its first
    block and so ends the run. Warns where the address is in reach of other machines without TLS.
    """
    for name in ("distributed", "distributed.client"):  # what they would say in many lines, errors say in one
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        host, _ = get_address_host_port(address)  # a client with a wrong address takes long to give up
        client = Client(address, timeout=CONNECT_SECONDS, set_as_default=False)
    except (OSError, ValueError) as error:
        raise ClusterError(f"no dask scheduler answers there: {error}") from None
    except TypeError as error:  # TLS without certificates
        raise ClusterError(f"{error}; Dask finds them in its configuration: distributed.comm.tls") from None
    if not (address.startswith("tls://") or _is_loopback(host)):
        _log.warning(
            "the scheduler %s is reached without TLS: whoever can reach it or a worker can run programs there, "
            "so the network must be closed (docs/how/many_machines.md)",
            address,
        )
    _filter_callbacks()
    with _closing(client):
        try:
            client.wait_for_workers(1, timeout=JOIN_SECONDS)
        except TimeoutError:
            raise ClusterError(f"the scheduler has no workers, and none joined in {JOIN_SECONDS} s") from None
        except GONE as error:
            raise ClusterError(f"the scheduler has died ({error})") from None
        _check(client)
        yield ClusterExecutor(client)


@contextlib.contextmanager
def _closing(client: Client) -> Iterator[None]:
    """Close the client in the end, also one whose scheduler has died."""
    try:
        yield
    finally:
        with contextlib.suppress(*GONE):
            client.close()


def _is_loopback(host: str) -> bool:
    """Whether only this machine can reach what listens there."""
    try:
        found = {entry[4][0] for entry in socket.getaddrinfo(host, None)}
        return all(ipaddress.ip_address(address.partition("%")[0]).is_loopback for address in found)
    except (OSError, ValueError):  # an unknown name, or not an address of a network
        return False


def _check(client: Client) -> None:
    """Raise ClusterError, with their addresses, where workers that answer have not the version of this program."""
    try:
        answers = client.run(version, on_error="return")
    except GONE as error:
        raise ClusterError(f"the scheduler has died ({error})") from None
    wrong = [
        f"{address} has {_described(answer)}"
        for address, answer in answers.items()
        if answer != version() and not isinstance(answer, OSError)  # of a worker that has died meanwhile
    ]
    if wrong:
        raise ClusterError(f"worker {'; worker '.join(wrong)}. This program is {version()}: install the same on all")


def _described(answer: str | Exception) -> str:
    if isinstance(answer, str):
        return answer
    missing = "ModuleNotFoundError" in repr(answer)
    return f"no package vibro_sweep ({answer})" if missing else f"another vibro_sweep ({answer})"
