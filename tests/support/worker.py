"""Commands on files in a process that is replaced where it hangs or dies."""

import contextlib
import multiprocessing
import os
import traceback
from collections.abc import Callable

from support.file_commands import Said, commands

Answer = Said | str  # a text is what went wrong


def answer(name: str, key: str, file: str) -> Answer:
    try:
        return commands(name)[key](file)
    except Exception:
        return traceback.format_exc()


def _work(pipe, function: Callable[..., Answer]) -> None:
    pipe.send("ready")
    with contextlib.suppress(EOFError):
        while True:
            folder, arguments = pipe.recv()
            os.chdir(folder)
            pipe.send(function(*arguments))


class Worker:
    """A process that calls a function, and is replaced where it hangs or dies."""

    def __init__(self, function: Callable[..., Answer] = answer):
        self.function = function
        self.begin()

    def begin(self) -> None:
        context = multiprocessing.get_context("spawn")
        self.pipe, other = context.Pipe()
        self.process = context.Process(target=_work, args=(other, self.function), daemon=True)
        self.process.start()
        other.close()
        self.pipe.recv()  # all is imported by then

    def __call__(self, *arguments, seconds: float) -> Answer:
        outcome = f"it hung for {seconds} s"
        with contextlib.suppress(OSError):
            self.pipe.send((os.getcwd(), arguments))
        with contextlib.suppress(EOFError, OSError):
            if self.pipe.poll(seconds):
                outcome = "the process died"
                return self.pipe.recv()
        self.close()
        self.begin()
        return outcome

    def close(self) -> None:
        self.process.kill()
        self.process.join()
