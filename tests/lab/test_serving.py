import http.client
import json
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

import pytest
import typer
from typer.testing import CliRunner

import tippetop as tt
from tippetop.cli.lab import lab
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
        with pytest.raises(tt.Unavailable, match=f"port {port} .*--port"):
            serve(port=port, browser=False)


def test_an_address_of_another_machine_is_refused_with_a_sentence() -> None:
    pytest.importorskip("nicegui")
    with pytest.raises(tt.Unavailable, match=r"192\.0\.2\.1 is no address of this machine; .*--host"):
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
    assert set(answers) <= {422, 503}
    assert answers.count(503) >= 39
    assert log.read_text() == ""
