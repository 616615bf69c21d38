"""The threads in which pages are answered: one by turns, in pieces, and one for what takes long.

A page's new request takes the place of the one that waits, and what is left of the older one's pieces is dropped.
"""

import contextlib
import logging
import threading
from collections.abc import Callable, Iterator

import numpy as np

from vibro_sweep.checks.errors import VibroSweepError
from vibro_sweep.live.answers import Answers, Message
from vibro_sweep.live.messages import text_message
from vibro_sweep.live.requests import Request, Save, Sweep, WindowEnds

MOST_UNSENT = 4  # messages of a page, after which it gets no turn
MOST_WORDS = 2000  # letters of an error
_log = logging.getLogger("vibro_sweep")


class Page:
    """A page: what it asks for, what it is sent. send : called in a thread of the engine."""

    def __init__(self, answers: Answers, send: Callable[[Message], None]):
        self.answers, self.send = answers, send
        self.sweep: Sweep | None = None  # that waits
        self.frames: Iterator[Message] | None = None
        self.drawn: Sweep | None = None  # whose frames these are
        self.clicks: dict[object, Request] = {}  # by kind: the last one of each
        self.slow: dict[object, Request] = {}
        self.unsent = 0
        self.newest = -1  # number of the last request that changes what is shown


class StaleError(Exception):
    """What is being computed is no longer asked for."""


class EngineThreads:
    """Answers pages. Every method may be called in any thread."""

    def __init__(self) -> None:
        self._pages: list[Page] = []  # that whose turn is next comes first
        self._changed = threading.Condition()
        self._closed = False
        self._threads = [threading.Thread(target=one, daemon=True) for one in (self._turns, self._slow_ones)]
        for thread in self._threads:
            thread.start()

    def add(self, page: Page) -> None:
        """Answer a page from now on."""
        with self._changed:
            self._pages.append(page)

    def remove(self, page: Page) -> None:
        """Answer it no longer."""
        with self._changed:
            self._pages.remove(page)

    def ask(self, page: Page, request: Request) -> None:
        """A request of a page."""
        with self._changed:
            if isinstance(request, (Sweep, WindowEnds)):
                page.newest = request.seq
            if isinstance(request, Sweep):
                page.sweep, page.frames = request, None
            elif isinstance(request, (WindowEnds, Save)):
                page.slow[type(request)] = request
            else:
                page.clicks[type(request), getattr(request, "slot", 0)] = request
            self._changed.notify_all()

    def sent(self, page: Page) -> None:
        """A message to a page has gone."""
        with self._changed:
            page.unsent -= 1
            self._changed.notify_all()

    def close(self) -> None:
        """End both threads, once they have finished what they compute."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def _turns(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._closed or any(map(_waits, self._pages)))
                if self._closed:
                    return
                page = next((one for one in self._pages if one.clicks and _reads(one)), None)
                page = page or next(one for one in self._pages if _waits(one))
                self._pages.remove(page)
                self._pages.append(page)
                click = page.clicks.pop(next(iter(page.clicks))) if page.clicks else None
                sweep, frames = page.sweep, page.frames
                if click is None:
                    page.sweep = None
            if click is not None:
                self._answer(page, click, lambda page=page, click=click: _of_click(page, click))
            else:
                self._next_frame(page, sweep, frames)

    def _next_frame(self, page: Page, sweep: Sweep | None, frames: Iterator[Message] | None) -> None:
        """The first frame of a new diagram, or the next one of the last."""
        if sweep is not None:
            frames = page.answers.diagram(sweep)
            page.drawn = sweep
        more = self._answer(page, page.drawn, lambda: next(frames, None))
        with self._changed:
            page.frames = frames if more and page.sweep is None else None

    def _slow_ones(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._closed or any(one.slow and _reads(one) for one in self._pages))
                if self._closed:
                    return
                page = next(one for one in self._pages if one.slow and _reads(one))
                request = page.slow.pop(next(iter(page.slow)))
            self._answer(page, request, lambda page=page, request=request: self._of_slow(page, request))

    def _of_slow(self, page: Page, request: Request) -> Message | None:
        if isinstance(request, Save):
            return page.answers.saved(request)

        def progress(points: int, value: float) -> None:
            if page.newest > request.seq or page not in self._pages or self._closed:
                raise StaleError

        with contextlib.suppress(StaleError):
            return page.answers.window(request, progress)  # type: ignore[arg-type]
        return None

    def _answer(self, page: Page, request: Request, make: Callable[[], Message | None]) -> bool:
        """Send an answer, or why there is none. Returns whether there was one."""
        made = True
        try:
            with np.errstate(over="ignore"):  # of what is sent in single precision
                message = make()
        except (ValueError, VibroSweepError) as error:
            message, made = text_message("error", request.seq, of=request.type, text=_words(error)), False
        except Exception as error:
            _log.warning("a request of the page failed: %s: %s", type(error).__name__, error)
            text = f"This failed inside the program, which is a bug: {type(error).__name__}: {error}"
            message = text_message("error", request.seq, of=request.type, text=text[:MOST_WORDS])
            made = False
        if message is None:
            return False
        with self._changed:
            page.unsent += 1
        page.send(message)
        return made


def _reads(page: Page) -> bool:
    return page.unsent < MOST_UNSENT


def _waits(page: Page) -> bool:
    return _reads(page) and bool(page.clicks or page.sweep or page.frames)


def _of_click(page: Page, request: Request) -> Message:
    return page.answers.orbit(request) if request.type == "orbit" else page.answers.opened(request)  # type: ignore


def _words(error: Exception) -> str:
    """What is wrong with a request."""
    problems = getattr(error, "problems", None)
    return ("; ".join(problems) if problems else str(error))[:MOST_WORDS]
