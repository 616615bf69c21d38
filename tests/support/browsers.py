"""A page in a browser: Chromium, driven by playwright, or Firefox, by WebDriver BiDi, which it has built in."""

import contextlib
import functools
import http.server
import json
import re
import shutil
import subprocess
import tempfile
import threading
import time

import pytest

PATIENCE = 120.0  # seconds


class Chromium:
    """A page of an open Chromium of playwright."""

    def __init__(self, browser, address):
        self.tab, self.errors = browser.new_page(), []
        self.tab.on("pageerror", lambda error: self.errors.append(str(error)))
        self.tab.goto(address)

    def evaluate(self, expression):
        return self.tab.evaluate(expression)

    def wait_for(self, expression):
        self.tab.wait_for_function(expression, timeout=1000 * PATIENCE)

    def close(self):
        self.tab.close()


class Firefox:
    """A page of a running Firefox, through its socket."""

    def __init__(self, running, address):
        self.running = running
        self.errors = running.errors = []
        running.command("session.subscribe", events=["log.entryAdded"])
        self.context = running.command("browsingContext.create", type="tab")["context"]
        running.command("browsingContext.navigate", context=self.context, url=address, wait="complete")

    def evaluate(self, expression):
        answer = self.running.command(
            "script.evaluate", expression=f"Promise.resolve({expression}).then((found) => JSON.stringify(found))",
            target={"context": self.context}, awaitPromise=True,
        )  # fmt: skip
        assert answer["type"] == "success", answer
        return json.loads(answer["result"].get("value", "null"))

    def wait_for(self, expression):
        end = time.monotonic() + PATIENCE
        while not self.evaluate(f"Boolean({expression})"):
            assert time.monotonic() < end, expression
            time.sleep(0.05)

    def close(self):
        self.running.command("browsingContext.close", context=self.context)


class RunningFirefox:
    def __init__(self, socket):
        self.socket, self.number, self.errors = socket, 0, []

    def command(self, method, **parameters):
        self.number += 1
        self.socket.send(json.dumps({"id": self.number, "method": method, "params": parameters}))
        while True:
            message = json.loads(self.socket.recv(PATIENCE))
            if message.get("method") == "log.entryAdded" and message["params"]["type"] == "javascript":
                if message["params"]["level"] == "error":
                    self.errors.append(message["params"]["text"])
            elif message.get("id") == self.number:
                assert message["type"] == "success", message
                return message["result"]


@contextlib.contextmanager
def chromium_of_playwright():
    """A Chromium; a skip where there is none."""
    names = ("chromium", "chromium-browser", "google-chrome")
    found = next((path for name in names if (path := shutil.which(name))), None)
    if found is None:
        pytest.skip("no chromium here: apt-get install chromium")
    api = pytest.importorskip("playwright.sync_api", reason="the browser is driven by playwright")
    with api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=found, args=["--no-sandbox"])
        yield browser
        browser.close()


@contextlib.contextmanager
def chromium():
    """What opens pages in Chromium; a skip where there is none."""
    with chromium_of_playwright() as browser:
        yield functools.partial(Chromium, browser)


@contextlib.contextmanager
def firefox():
    """What opens pages in Firefox; a skip where there is none."""
    found = next((path for name in ("firefox", "firefox-esr") if (path := shutil.which(name))), None)
    if found is None:
        pytest.skip("no firefox here: apt-get install firefox-esr")
    client = pytest.importorskip("websockets.sync.client")
    with tempfile.TemporaryDirectory() as profile:
        command = [found, "--headless", "--no-remote", "--remote-debugging-port=0", "--profile", profile]
        process = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
        said = re.compile(r"BiDi listening on (ws://\S+)")
        address = next(match[1] for line in process.stderr if (match := said.search(line)))
        drain = threading.Thread(target=process.stderr.read, daemon=True)
        drain.start()
        try:
            with client.connect(f"{address}/session", max_size=None) as socket:
                running = RunningFirefox(socket)
                running.command("session.new", capabilities={})
                yield functools.partial(Firefox, running)
        finally:
            process.terminate()
            process.wait(30)
            drain.join()


@contextlib.contextmanager
def served(folder):
    """The address of a static server of a folder, which answers with files and sets no header of its own."""
    handler = functools.partial(_Quiet, directory=str(folder))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


class _Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *words):
        pass
