"""The progress bar in notebooks, which needs IPython alone."""

import contextlib
import time
from collections.abc import Callable, Iterator

DELAY, PAUSE = 2.0, 0.2  # seconds before it is shown, and between its changes
PARTS = 400  # into which its length is divided


@contextlib.contextmanager
def notebook_bar() -> Iterator[Callable[[int, int], None]]:
    """A callable (done, total) that shows a bar and the time left, if the run takes longer than DELAY."""
    from IPython.display import HTML, display

    begun = changed = time.monotonic()
    handle = None

    def show(done: int, total: int) -> None:
        nonlocal changed, handle
        now = time.monotonic()
        if not done or now - begun < DELAY or now - changed < PAUSE:
            return
        changed, left = now, (total - done) * (now - begun) / done
        bar = f'<progress value="{done * PARTS // total}" max="{PARTS}"></progress>'
        text = HTML(f"{bar} {done:,} of {total:,} points, {left // 60:.0f}:{left % 60:02.0f} left")
        if handle is None:
            handle = display(text, display_id=True)
        else:
            handle.update(text)

    try:
        yield show
    finally:
        if handle is not None:
            handle.update(HTML(""))
