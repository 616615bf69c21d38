"""The threads in which the page is answered: one by turns, in pieces, and one for what takes long.

There is one visitor: a page that comes takes the place of the one before. A new request takes the place of the one that
waits, and what is left of the older one's pieces is dropped.
"""

import contextlib
import logging
import threading
from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from vibro_sweep.checks.errors import VibroSweepError
from vibro_sweep.live.answers import Answers, Message
from vibro_sweep.live.messages import text_message
from vibro_sweep.live.requests import Request, Sweep, WindowEnds

MOST_UNSENT = 4  # messages to the page, after which it gets no more
MOST_WORDS = 2000  # letters of an error
_log = logging.getLogger("vibro_sweep")


class Visitor:
    """The page: what it asks for, what it is sent.

    send : called in a thread of the engine; None: another page has taken its place
    """

    def __init__(self, answers: Answers, send: Callable[[Message | None], None]):
        self.answers, self.send = answers, send
        self.sweep: Sweep | None = None  # that waits
        self.frames: Iterator[Message] | None = None
        self.drawn: Sweep | None = None  # whose frames these are
        self.clicks: dict[str, Request] = {}  # by type: the last one of each
        self.window: WindowEnds | None = None
        self.unsent = 0
        self.newest = -1  # number of the last request that changes what is shown


class StaleError(Exception):
    """What is being computed is no longer asked for."""


class EngineThreads:
    """Answers the visitor. Every method may be called in any thread."""

    def __init__(self) -> None:
        self._visitor: Visitor | None = None
        self._changed = threading.Condition()
        self._closed = False
        for turns in (self._turns, self._slow_turns):
            threading.Thread(target=turns, daemon=True).start()

    def welcome(self, visitor: Visitor) -> None:
        """Answer this one from now on, and the one before no longer."""
        with self._changed:
            before, self._visitor = self._visitor, visitor
        if before is not None:
            before.send(None)

    def leave(self, visitor: Visitor) -> None:
        """Answer it no longer."""
        with self._changed:
            if self._visitor is visitor:
                self._visitor = None

    def ask(self, visitor: Visitor, request: Request) -> None:
        """A request of a visitor."""
        with self._changed:
            if isinstance(request, (Sweep, WindowEnds)):
                visitor.newest = request.seq
            if isinstance(request, Sweep):
                visitor.sweep, visitor.frames = request, None
            elif isinstance(request, WindowEnds):
                visitor.window = request
            else:
                visitor.clicks[request.type] = request
            self._changed.notify_all()

    def sent(self, visitor: Visitor) -> None:
        """A message has gone to it."""
        with self._changed:
            visitor.unsent -= 1
            self._changed.notify_all()

    def close(self) -> None:
        """End both threads, once they have finished what they compute."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def _next(self, has_work: Callable[[Visitor], bool]) -> Visitor | None:
        """The visitor, once there is something to do for it, and it reads; None: the engine is closed."""

        def is_ready() -> bool:
            visitor = self._visitor
            return self._closed or (visitor is not None and visitor.unsent < MOST_UNSENT and has_work(visitor))

        self._changed.wait_for(is_ready)
        return None if self._closed else self._visitor

    def _turns(self) -> None:
        while True:
            with self._changed:
                visitor = self._next(lambda page: bool(page.clicks or page.sweep or page.frames))
                if visitor is None:
                    return
                click = visitor.clicks.pop(next(iter(visitor.clicks))) if visitor.clicks else None
                sweep, frames = visitor.sweep, visitor.frames
                if click is None:
                    visitor.sweep = None
            if click is not None:
                self._answer(visitor, click, partial(visitor.answers.click, click))
                continue
            if sweep is not None:  # the first frame of a new diagram, or the next one of the last
                frames, visitor.drawn = visitor.answers.diagram(sweep), sweep
            more = self._answer(visitor, visitor.drawn, partial(next, frames, None))
            with self._changed:
                visitor.frames = frames if more and visitor.sweep is None else None

    def _slow_turns(self) -> None:
        while True:
            with self._changed:
                visitor = self._next(lambda page: page.window is not None)
                if visitor is None:
                    return
                request, visitor.window = visitor.window, None
            self._answer(visitor, request, partial(self._window, visitor, request))

    def _window(self, visitor: Visitor, request: WindowEnds) -> Message | None:
        def progress(points: int, value: float) -> None:
            if visitor.newest > request.seq or visitor is not self._visitor or self._closed:
                raise StaleError

        with contextlib.suppress(StaleError):
            return visitor.answers.window(request, progress)
        return None

    def _answer(self, visitor: Visitor, request: Request, make: Callable[[], Message | None]) -> bool:
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
            visitor.unsent += 1
        visitor.send(message)
        return made


def _words(error: Exception) -> str:
    """What is wrong with a request."""
    problems = getattr(error, "problems", None)
    return ("; ".join(problems) if problems else str(error))[:MOST_WORDS]
