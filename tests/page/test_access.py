"""Whom `vibro-sweep explore` answers, what it refuses, and that nothing stops it."""

import http.client
import json
import socket
import time
from contextlib import ExitStack
from pathlib import Path

import pytest
from support.explorers import answers, ask, requested

pytest.importorskip("uvicorn")
pytest.importorskip("websockets.sync.client")

from websockets.exceptions import ConnectionClosed, InvalidStatus


def got(program, path="/", method="GET", **headers):
    connection = http.client.HTTPConnection(program.host, timeout=10)
    connection.request(method, path, headers=headers)
    answer = connection.getresponse()
    return answer.status, answer.read(), dict(answer.getheaders())


@pytest.mark.parametrize(
    "headers, path",
    [({}, "/"), ({}, "/?token=wrong"), ({"Host": "example.org"}, None), ({"Host": "127.0.0.1.example.org"}, None)],
)
def test_a_page_is_given_to_those_who_know_the_token_and_name_this_machine(program, headers, path):
    status, body, _ = got(program, path or f"/?token={program.token}", **headers)
    assert status == 403 and b"<html" not in body


def test_the_page_and_its_policy(program):
    for host in ("localhost:1234", program.host):
        status, body, headers = got(program, f"/?token={program.token}", Host=host)
        assert status == 200 and b"main.js" in body
    policy = headers["content-security-policy"]
    assert "default-src 'none'" in policy and "unsafe" not in policy and headers["referrer-policy"] == "no-referrer"
    assert program.token.encode() not in body and b"http" not in got(program, "/main.js")[1]
    for path in ("/../server.py", "/..%2fserver.py", "/page/main.js", "/etc/passwd"):
        assert got(program, path)[0] == 404
    assert got(program, f"/?token={program.token}", "POST")[0] == 405
    for path in (f"/?token={program.token}", "/main.js"):
        assert got(program, path, Origin="http://example.org")[0] == 403
        assert got(program, path, Origin=f"http://{program.host}")[0] == 200


@pytest.mark.parametrize(
    "options",
    [
        {"token": "wrong"},
        {"token": ""},
        {"origin": "http://example.org"},
        {"origin": None},
    ],
)
def test_sockets_of_others_are_refused(program, options):
    with pytest.raises(InvalidStatus) as refused, program.socket(**options):
        pass
    assert refused.value.response.status_code == 403


def test_a_socket_to_another_name_of_this_machine_is_refused(program):
    upgrade = {"Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13"}
    upgrade |= {"Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==", "Origin": "http://example.org", "Host": "example.org"}
    assert got(program, f"/socket?token={program.token}", **upgrade)[0] == 403


def test_it_listens_on_this_machine_alone(program):
    rows = [line.split() for file in ("tcp", "tcp6") for line in Path("/proc/net", file).read_text().splitlines()[1:]]
    local = [row[1].split(":") for row in rows if row[3] == "0A"]
    assert [place for place, port in local if int(port, 16) == program.port] == ["0100007F"]


@pytest.mark.parametrize(
    "message, code",
    [
        ("x" * 20_000, 1009),
        ("[" * 10_000, 1008),
        ("no JSON", 1008),
        ('{"type": "sweep", "seq": 1}', 1008),
        ('{"type": "open", "seq": NaN}', 1008),
        ('{"type": "open", "seq": 1, "path": "/etc/passwd"}', 1008),
        (b"\x00\x01", 1008),
    ],
    ids=range(7),
)
def test_what_is_no_request_closes_the_socket(program, message, code):
    with program.socket() as socket:
        socket.send(message)
        with pytest.raises(ConnectionClosed) as closed:
            socket.recv(timeout=10)
        assert closed.value.rcvd.code == code


def test_sizes_are_bounded(program, view):
    for key, value in {"columns": 10**6, "record": 10**9, "low": "x", "start": {"x1": [0]}}.items():
        with program.socket() as socket:
            ask(socket, "sweep", 1, view=view | {key: value})
            with pytest.raises(ConnectionClosed) as closed:
                socket.recv(timeout=10)
            assert closed.value.rcvd.code == 1008


@pytest.mark.parametrize("key", ["continue", "trajectory", "observe", "section", "picture", "output"])
def test_keys_of_scenes_that_name_files_or_take_long_are_refused(program, view, key):
    asked = requested(view)
    asked["scene"][key] = {"from": {"sweep": "/etc/passwd"}, "parameter": "b"} if key == "continue" else "x"
    with program.socket() as socket:
        socket.send(json.dumps({"type": "sweep", "seq": 1, "view": asked}))
        with pytest.raises(ConnectionClosed) as closed:
            socket.recv(timeout=10)
        assert closed.value.rcvd.code == 1008 and key in closed.value.rcvd.reason


def memory(program):
    status = Path("/proc", str(program.process.pid), "status").read_text()
    return int(status.partition("VmRSS:")[2].split()[0]) / 1000  # MB


@pytest.mark.slow
def test_a_page_that_does_not_read_costs_the_next_one_nothing(program, page, view):
    answers(page, "sweep", 2, view=view)
    before = memory(program)
    large = view | {"columns": 1000, "transient": 10, "record": 1000, "low": 4.4, "high": 4.6}
    with program.socket(max_queue=1, close_timeout=0.1) as silent:  # closing, it would wait for what it does not read
        for seq in range(1000):
            ask(silent, "sweep", seq, view=large)
        time.sleep(1)
        assert memory(program) - before < 150
        with program.socket() as other:
            began = time.perf_counter()
            answers(other, "sweep", 3, view=view)
            assert time.perf_counter() - began < 2
            with pytest.raises(ConnectionClosed) as closed:  # it is told all the same, once it reads
                for _ in range(10_000):
                    silent.recv(timeout=10)
            assert closed.value.rcvd.code == 4000


def test_a_second_page_takes_over_and_the_first_is_told(program, page, view):
    """Also while a diagram is on its way to the first one."""
    ask(page, "sweep", 2, view=view | {"columns": 4000, "transient": 2000, "record": 100})
    with program.socket() as second:
        assert answers(second, "sweep", 1, view=view)[-1][0]["last"]
        with pytest.raises(ConnectionClosed) as closed:
            for _ in range(100_000):
                page.recv(timeout=10)
        assert closed.value.rcvd.code == 4000 and "Another tab" in closed.value.rcvd.reason
        assert answers(second, "open", 2)[0]["type"] == "model"


@pytest.mark.slow
def test_a_thousand_connections(program, page, view):
    """Those that say nothing take little memory, those without a token get 403, and a page is answered beside them."""
    before = memory(program)
    with ExitStack() as stack:
        silent = [stack.enter_context(socket.create_connection(("127.0.0.1", program.port))) for _ in range(1000)]
        silent[0].sendall(b"GET / HTTP/1.1\r\n")  # and no more
        assert answers(page, "sweep", 2, view=view)[-1][0]["last"]
        assert memory(program) < before + 100
        for one in silent[1:]:
            one.sendall(b"GET /socket HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")
        assert all(one.recv(64).startswith(b"HTTP/1.1 40") for one in silent[1:])
        assert answers(page, "sweep", 3, view=view)[-1][0]["last"]
