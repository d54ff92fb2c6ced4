import json
import socket
import sys
import urllib.error
import urllib.request

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
