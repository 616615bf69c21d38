"""A program `vibro-sweep explore` that runs beside the tests, and what its page would ask it."""

import json
import os
import signal
import subprocess
import sys
from contextlib import contextmanager
from urllib.parse import urlsplit

import numpy as np

SECONDS = 300  # for kernels that are to be compiled on a busy machine


class Explorer:
    """A running program; `address` is what it has printed."""

    def __init__(self, *arguments):
        command = [sys.executable, "-m", "vibro_sweep", "explore", "--no-browser", *map(str, arguments)]
        self.process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=os.environ | {"COLUMNS": "200"}
        )
        self.address = self.process.stdout.readline().strip()
        self.port = urlsplit(self.address).port
        self.host = f"127.0.0.1:{self.port}"
        self.token = self.address.partition("token=")[2]

    def end(self):
        """Exit status and what it wrote to stderr, after Ctrl-C."""
        self.process.send_signal(signal.SIGINT)
        _, errors = self.process.communicate(timeout=20)
        return self.process.returncode, errors

    def socket(self, token=None, **options):
        """A socket to it, as its page opens one."""
        from websockets.sync.client import connect

        query = f"?token={self.token if token is None else token}"
        options = {"origin": f"http://{self.host}", "max_size": None, "compression": None} | options
        return connect(f"ws://{self.host}/socket{query}", open_timeout=10, **options)


@contextmanager
def explorer(*arguments):
    running = Explorer(*arguments)
    try:
        yield running
    finally:
        if running.process.poll() is None:
            running.process.kill()
            running.process.communicate()


def decoded(message):
    """Words and arrays of a message."""
    if isinstance(message, str):
        return json.loads(message), {}
    length = int(np.frombuffer(message[:4], "<u4")[0])
    words, at, arrays = json.loads(message[4 : 4 + length]), 4 + length, {}
    for name, kind, size in words["arrays"]:
        arrays[name] = np.frombuffer(message, np.dtype(kind).newbyteorder("<"), size, at)
        at += -(-arrays[name].nbytes // 8) * 8
    return words, arrays


def requested(view):
    """A view, in which every number has a place of its own, as a request has it: a scene, and what stands on the
    vertical axis. As `requestOf` of page/scene.js."""
    view = {"dynamics": "flow", "order": 1, "expand_at": None, "numbers": {}, "start": {}, "y": "x1"} | view
    system = dict(view["system"])
    for name, value in view["numbers"].items():
        letters = name.rstrip("0123456789")
        if isinstance(system.get(letters), list):
            system[letters] = [value if f"{letters}{i}" == name else x for i, x in enumerate(system[letters], 1)]
        else:
            system[name] = value
    sweep = {view["axis"]: {"start": view["low"], "stop": view["high"], "num": view["columns"]}}
    scene = {"system": system, "sweep": sweep, "start": view["start"]}
    scene["orbit"] = {name: view[name] for name in ("transient", "record")}
    scene |= {name: view[name] for name in ("dynamics", "order", "expand_at")}
    return {"scene": scene, "y": view["y"]}


def flat(view):
    """The same the other way round."""
    scene = dict(view["scene"])
    ((axis, ends),) = scene.pop("sweep").items()
    places = {"axis": axis, "low": ends["start"], "high": ends["stop"], "columns": ends["num"]}
    return scene.pop("orbit") | scene | places | {"numbers": {}, "y": view["y"]}


def ask(socket, kind, seq, **values):
    values |= {"view": requested(values["view"])} if "view" in values else {}
    socket.send(json.dumps({"type": kind, "seq": seq, **values}))


def answers(socket, kind, seq, **values):
    """The answer to a request, or all frames of a diagram."""
    ask(socket, kind, seq, **values)
    found = []
    while True:
        words, arrays = decoded(socket.recv(timeout=SECONDS))
        if words["seq"] != seq:
            continue
        if words["type"] == "model":
            words["view"] = flat(words["view"])
        found.append((words, arrays))
        if words["type"] != "frame":
            return found[0]
        if words["last"]:
            return found


def heights(frames, columns, starts, record):
    """What stands on the vertical axis, (columns, starts, record), of a periodic orbit the last points; float32."""
    result, seen = np.full((columns, starts, record), np.nan, "f4"), np.zeros((columns, starts), int)
    for words, arrays in frames:
        if words["kind"] == "preview":
            continue
        here = len(arrays["count"]) // words["length"]
        parts = np.split(arrays["y"], np.cumsum(arrays["count"])[:-1])
        for n, part in enumerate(parts):
            column, start = words["first"] + n // here * words["step"], words["first_start"] + n % here
            result[column, start, record - len(part) :] = part
            seen[column, start] += 1
    assert (seen == 1).all()
    return result
