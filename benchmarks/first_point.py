"""In a fresh process, with nothing else loaded: when the first point is there, and what was compiled on the way.

Called by compile_time.py with a scene; prints JSON.
"""

import gc
import json
import sys
import time

gc.disable()  # until `all_is_imported`, as the program does (vibro_sweep/__main__.py)

from numba.core import event  # noqa: E402


class Clock(event.Listener):
    """CPU seconds for each function without what it has compiled on the way."""

    def __init__(self):
        self.open, self.own = [], {}

    def on_start(self, _):
        self.open.append([time.process_time(), 0.0])

    def on_end(self, ended):
        began, others = self.open.pop()
        whole = time.process_time() - began
        function = ended.data["dispatcher"].py_func
        name = f"{function.__module__.rsplit('.', 1)[-1]}.{function.__name__}"
        self.own[name] = self.own.get(name, 0.0) + whole - others
        if self.open:
            self.open[-1][1] += whole


def first_point(path: str) -> dict:
    """Times since the epoch at which the scene is read and its first point computed; `own`: the Clock's seconds."""
    clock = Clock()
    event.register("numba:compile", clock)
    from vibro_sweep.cli.console import all_is_imported
    from vibro_sweep.driver import blocks, compute
    from vibro_sweep.scene import load_scene

    all_is_imported()
    block = next(blocks.blocks(load_scene(path), points_per_block=1))
    loaded = time.time()
    compute.compute(block)
    return {"loaded": loaded, "done": time.time(), "own": clock.own}


if __name__ == "__main__":
    print(json.dumps(first_point(sys.argv[1])))
