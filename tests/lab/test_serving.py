import asyncio
import http.client
import json
import logging
import os
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
import typer
from typer.testing import CliRunner

import tippetop as tt
from tippetop.cli.lab import lab
from tippetop.lab.guard import log_malformed_once
from tippetop.lab.server import serve


def test_the_address_is_this_machine_unless_another_is_asked_for() -> None:
    app = typer.Typer()
    app.command()(lab)
    said = CliRunner().invoke(app, ["--help"], env={"COLUMNS": "200", "TERM": "dumb"}).stdout
    for part in ("--host", "127.0.0.1", "--port", "--no-browser"):
        assert part in said


def test_a_port_that_is_taken_is_refused_with_a_sentence() -> None:
    pytest.importorskip("nicegui")
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]
        with pytest.raises(tt.Unavailable, match=f"port {port} .*choose another"):
            serve(port=port, browser=False)


def test_an_address_of_another_machine_is_refused_with_a_sentence() -> None:
    pytest.importorskip("nicegui")
    with pytest.raises(tt.Unavailable, match=r"192\.0\.2\.1 is no address of this machine; choose another"):
        serve(host="192.0.2.1", browser=False)  # kept for documentation, so nobody's


def test_without_nicegui_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "nicegui", None)
    with pytest.raises(tt.Unavailable, match=r"pip install 'tippetop\[lab\]'"):
        serve(browser=False)


def test_requests_are_checked_like_any_problem(server: str) -> None:
    for query in ("launch.tilt=9", "duration=1e6", "friction.kind=glue"):
        with pytest.raises(urllib.error.HTTPError) as refusal:
            urllib.request.urlopen(f"{server}/lab/track?{query}", timeout=30)
        with refusal.value as answer:
            assert answer.code == 422
            assert "is not possible; accepted:" in answer.read().decode()


def answer_to(server: str, path: str = "/", **headers: str) -> tuple[int, http.client.HTTPMessage]:
    """Status and headers of an answer, for headers as a browser would send them."""
    line = http.client.HTTPConnection(urlsplit(server).netloc, timeout=120)
    line.request("GET", path, headers=headers)
    answer = line.getresponse()
    answer.read()
    line.close()
    return answer.status, answer.headers


SOCKET = "/_nicegui_ws/socket.io/?EIO=4&transport=polling"


@pytest.mark.parametrize("path", ["/", "/lab/file/tippetop.toml", SOCKET])
def test_only_its_own_pages_are_answered(server: str, path: str) -> None:
    port = urlsplit(server).port
    for host in ("localhost", "127.0.0.1", "[::1]", socket.gethostname().upper()):
        own = f"http://{host}:{port}"
        for headers in ({}, {"Origin": own}):
            assert answer_to(server, path, Host=f"{host}:{port}", **headers)[0] == 200
        for origin in ("null", "https://elsewhere.example", f"http://{host}:1", f"{own}.example", "http://["):
            assert answer_to(server, path, Host=f"{host}:{port}", Origin=origin)[0] == 403
    for host in ("elsewhere.example", "127.0.0.1.elsewhere.example", "[", ""):
        assert answer_to(server, path, Host=host)[0] == 403
        assert answer_to(server, path, Host=host, Origin=f"http://{host}")[0] == 403


def test_a_socket_is_opened_for_its_own_pages_only(server: str) -> None:
    port = urlsplit(server).port
    upgrade = {
        "Connection": "Upgrade",
        "Upgrade": "websocket",
        "Sec-WebSocket-Version": "13",
        "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
    }
    path = SOCKET.replace("polling", "websocket")
    statuses = []
    for origin in (f"http://127.0.0.1:{port}", "https://elsewhere.example"):
        with socket.create_connection(("127.0.0.1", port), timeout=30) as line:
            lines = [f"GET {path} HTTP/1.1", f"Host: 127.0.0.1:{port}", f"Origin: {origin}"]
            lines += [f"{name}: {value}" for name, value in upgrade.items()]
            line.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
            statuses.append(int(line.recv(1000).split()[1]))
    assert statuses == [101, 403]


def test_answers_tell_the_browser_what_the_page_may_do(server: str) -> None:
    for path in ("/", "/lab/file/tippetop.toml", "/lab/track?launch.tilt=9", "/nowhere"):
        _, headers = answer_to(server, path)
        assert headers["X-Content-Type-Options"] == "nosniff"
        policy = headers["Content-Security-Policy"]
        assert "default-src 'self'" in policy
        assert "frame-ancestors 'none'" in policy
        assert "http" not in policy


def test_malformed_messages_are_told_of_once(caplog: pytest.LogCaptureFixture) -> None:
    def handle(_: str, message: dict[str, str]) -> str:
        return message["client_id"]

    handlers: dict[str, Any] = {"event": handle, "ack": handle, "connect": handle}
    transport = logging.getLogger("transport")
    log_malformed_once(handlers, transport)
    assert handlers["connect"] is handle
    assert asyncio.run(handlers["event"]("visitor", {"client_id": "one"})) == "one"
    for _ in range(3):
        for wrong in ({}, [], None, "text", 3):
            asyncio.run(handlers["event"]("visitor", wrong))
    asyncio.run(handlers["ack"]("visitor", {}))
    for _ in range(3):
        try:
            int("garbage")
        except ValueError:
            transport.exception("not even a message")
    told = [record.getMessage() for record in caplog.records]
    assert told == [
        "a malformed message 'event' is passed over (KeyError)",
        "a malformed message 'event' is passed over (TypeError)",
        "a malformed message 'ack' is passed over (KeyError)",
        "a malformed message '?' is passed over (ValueError)",
    ]
    assert not any(record.exc_info for record in caplog.records)


def test_messages_of_strangers_are_one_line_in_the_log(server: str) -> None:
    """The log of the server is looked at in the end: no traceback may be in it."""
    line = http.client.HTTPConnection(urlsplit(server).netloc, timeout=120)

    def ask(method: str, path: str, body: str | None = None) -> str:
        line.request(method, path, body)
        return line.getresponse().read().decode()

    session = json.loads(ask("GET", SOCKET)[1:])["sid"]
    path = f"{SOCKET}&sid={session}"
    assert ask("POST", path, "40") == "OK"
    for message in ('42["event",{}]', '42["ack",[1]]', '42["event"]', '42["log",null]', "4garbage"):
        ask("POST", path, message)
    time.sleep(0.5)
    line.close()


def test_an_unknown_file_is_refused(server: str) -> None:
    with pytest.raises(urllib.error.HTTPError) as refusal:
        urllib.request.urlopen(f"{server}/lab/file/tippetop.doc", timeout=30)
    with refusal.value as answer:
        assert answer.code == 422


def test_a_file_can_be_had_without_the_page(server: str) -> None:
    with urllib.request.urlopen(f"{server}/lab/file/tippetop.toml?launch.spin=99", timeout=30) as answer:
        problem = tt.Problem.from_toml(answer.read().decode())
        assert answer.headers["Content-Disposition"] == 'attachment; filename="tippetop.toml"'
    assert problem == tt.presets.report_problem(spin=99.0)
    assert json.loads(problem.to_json())["launch"]["spin"] == 99.0


SERVE = "import typer; from tippetop.cli.lab import lab; typer.run(lab)"


def is_listening(port: int) -> bool:
    with socket.socket() as trial:
        return trial.connect_ex(("127.0.0.1", port)) == 0


def status_of(port: int, path: str, visitor: str = "127.0.0.1") -> int:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60, source_address=(visitor, 0))
    connection.request("GET", path)
    answer = connection.getresponse()
    answer.read()
    connection.close()
    return answer.status


@pytest.mark.skipif(sys.platform != "linux", reason="others have one loopback address only")
def test_a_greedy_visitor_stops_neither_the_others_nor_the_end(tmp_path: Path) -> None:
    pytest.importorskip("nicegui")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    log = tmp_path / "log"
    command = [sys.executable, "-u", "-c", SERVE, "--port", str(port), "--no-browser", "--workers", "1"]
    with (
        log.open("w") as trouble,
        subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=trouble, env=environment, text=True
        ) as process,
        ThreadPoolExecutor(45) as threads,
    ):
        assert process.stdout is not None
        process.stdout.readline()
        while not is_listening(port):
            time.sleep(0.1)
        assert status_of(port, "/lab/track?duration=0.1") == 200
        path = "/lab/track?friction.mu=1e6&duration=120"
        greedy = [threads.submit(status_of, port, path) for _ in range(45)]
        time.sleep(1.0)
        began = time.monotonic()
        assert status_of(port, "/", "127.0.0.2") == 200
        assert time.monotonic() - began < 3
        assert status_of(port, "/lab/track?duration=0.1", "127.0.0.2") == 200
        assert time.monotonic() - began < 20, "it waits for one run, and for another worker"
        began = time.monotonic()
        process.send_signal(signal.SIGINT)
        process.wait(timeout=15)
        assert time.monotonic() - began < 10
        answers = sorted(each.result() for each in greedy)
    assert set(answers) <= {200, 422, 503}, "ended by its budget of steps, by the page's patience, or refused"
    assert answers.count(503) >= 39
    assert log.read_text() == ""
