"""The server of the page: its files, and a socket over which it asks and is answered."""

import asyncio
import contextlib
import socket
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import uvicorn
from starlette.responses import PlainTextResponse, Response
from starlette.types import Receive, Scope, Send
from starlette.websockets import WebSocket, WebSocketDisconnect

from vibro_sweep.live.access import HEADERS, host_is_here, knows_token, new_token, origin_is_foreign, origin_is_here
from vibro_sweep.live.answers import Answers, Message
from vibro_sweep.live.engine_thread import EngineThreads, Visitor
from vibro_sweep.live.pace import Pace
from vibro_sweep.live.requests import LONGEST, RequestError, request_of
from vibro_sweep.scene import Scene

SLOWEST = 20.0  # seconds in which a page takes a message
PAUSE = 0.001  # seconds between two requests of a page
BAD_REQUEST, TAKEN_OVER = 1008, 4000  # codes with which a socket is closed
SWITCH = 0.0002  # seconds after which Python lets another thread run: answers leave at once
TYPES = {".html": "text/html; charset=utf-8", ".css": "text/css", ".js": "text/javascript", ".svg": "image/svg+xml"}
FILES = {path.name: path.read_bytes() for path in (Path(__file__).parent / "page").iterdir() if path.suffix in TYPES}
NO_TOKEN = "403: this address lacks the token. Open the address that `vibro-sweep explore` has printed.\n"


class Explorer:
    """The application: an ASGI callable. presets : scenes by name; first : that which a page begins with."""

    def __init__(self, presets: dict[str, Scene], first: str):
        self.token = new_token()
        self._presets, self._first = presets, first
        self._engine, self._pace = EngineThreads(), Pace()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "http":
            await self._file(scope)(scope, receive, send)
        elif scope["type"] == "websocket":
            await self._socket(WebSocket(scope, receive, send))

    def close(self) -> None:
        """End the threads of the engine."""
        self._engine.close()

    def _file(self, scope: Scope) -> Response:
        if not host_is_here(scope):
            return PlainTextResponse("403: another host\n", 403, HEADERS)
        if origin_is_foreign(scope):
            return PlainTextResponse("403: a page of another site\n", 403, HEADERS)
        if scope["method"] not in ("GET", "HEAD"):
            return PlainTextResponse("405\n", 405, HEADERS)
        if scope["path"] == "/" and not knows_token(scope, self.token):
            return PlainTextResponse(NO_TOKEN, 403, HEADERS)
        name = scope["path"].removeprefix("/") or "index.html"
        if name not in FILES:
            return PlainTextResponse("404\n", 404, HEADERS)
        return Response(FILES[name], 200, HEADERS, TYPES[Path(name).suffix])

    async def _socket(self, ws: WebSocket) -> None:
        allowed = host_is_here(ws.scope) and origin_is_here(ws.scope) and knows_token(ws.scope, self.token)
        if not allowed or ws.scope["path"] != "/socket":
            await ws.close()  # before it is accepted: 403
            return
        await ws.accept()
        await self._talk(ws)

    async def _talk(self, ws: WebSocket) -> None:
        """Read requests and send answers, until one of the two ends."""
        loop, answers, over = asyncio.get_running_loop(), asyncio.Queue[Message](), asyncio.Event()

        def put(message: Message | None) -> None:
            with contextlib.suppress(RuntimeError):  # the loop is closed
                if message is None:
                    loop.call_soon_threadsafe(over.set)
                else:
                    loop.call_soon_threadsafe(answers.put_nowait, message)

        visitor = Visitor(Answers(self._presets, self._first, self._pace), put)
        self._engine.welcome(visitor)
        talk = (self._read(ws, visitor), self._write(ws, visitor, answers), over.wait())
        tasks = [asyncio.ensure_future(task) for task in talk]
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            self._engine.leave(visitor)
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
        if over.is_set():  # whatever is still on its way
            with contextlib.suppress(RuntimeError, WebSocketDisconnect):  # it has left meanwhile
                await ws.close(TAKEN_OVER, "Another tab or window shows this page now")

    async def _read(self, ws: WebSocket, visitor: Visitor) -> None:
        with contextlib.suppress(WebSocketDisconnect):
            while True:
                message = await ws.receive()
                if message["type"] == "websocket.disconnect":
                    return
                try:
                    request = request_of(message.get("text") or "")
                except RequestError as error:
                    await ws.close(BAD_REQUEST, str(error)[:100])
                    return
                self._engine.ask(visitor, request)
                await asyncio.sleep(PAUSE)

    async def _write(self, ws: WebSocket, visitor: Visitor, answers: "asyncio.Queue[Message]") -> None:
        with contextlib.suppress(WebSocketDisconnect, TimeoutError):
            while True:
                message = await answers.get()
                sending = ws.send_text(message) if isinstance(message, str) else ws.send_bytes(message)
                await asyncio.wait_for(sending, SLOWEST)
                self._engine.sent(visitor)


class _Server(uvicorn.Server):
    """Says when it can be reached."""

    def __init__(self, config: uvicorn.Config, ready: Callable[[], None]):
        super().__init__(config)
        self._ready = ready

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        self._ready()


def bound(port: int) -> socket.socket:
    """A socket of this machine alone; port 0: any free one. Raises OSError."""
    result = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        result.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        result.bind(("127.0.0.1", port))
    except OSError:
        result.close()
        raise
    return result


def _server(explorer: Explorer, ready: Callable[[], None]) -> _Server:
    config = uvicorn.Config(
        explorer,
        ws="websockets-sansio",
        ws_max_size=LONGEST,
        ws_per_message_deflate=False,
        access_log=False,  # it would hold the token
        log_level="error",
        server_header=False,
        lifespan="off",
        timeout_graceful_shutdown=1,
    )
    return _Server(config, ready)


def _address(explorer: Explorer, sock: socket.socket) -> str:
    return f"http://127.0.0.1:{sock.getsockname()[1]}/?token={explorer.token}"


def serve(presets: dict[str, Scene], first: str, sock: socket.socket, ready: Callable[[str], None]) -> None:
    """Serve pages until Ctrl-C. ready : called with the address once it can be opened."""
    explorer = Explorer(presets, first)
    before = sys.getswitchinterval()
    sys.setswitchinterval(SWITCH)
    try:
        _server(explorer, lambda: ready(_address(explorer, sock))).run(sockets=[sock])
    except KeyboardInterrupt:
        pass
    finally:
        sys.setswitchinterval(before)
        explorer.close()


class Serving:
    """Pages served by a thread of this process until `close`, at `address`."""

    def __init__(self, presets: dict[str, Scene], first: str):
        self._explorer, sock = Explorer(presets, first), bound(0)
        self.address, ready = _address(self._explorer, sock), threading.Event()
        self._server = _server(self._explorer, ready.set)
        self._thread = threading.Thread(target=self._server.run, args=([sock],), daemon=True)
        self._thread.start()
        ready.wait()

    def close(self) -> None:
        """End the server and the engine's threads, once they have finished what they compute."""
        self._server.should_exit = True
        self._thread.join()
        self._explorer.close()
