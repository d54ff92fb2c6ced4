"""`tippetop lab`: the page opened, written, and given to other devices, read-only."""

import http.client
import threading
from collections.abc import Iterator
from http.server import ThreadingHTTPServer
from pathlib import Path

import pytest
from typer.testing import CliRunner

import tippetop as tt
from tippetop.cli.commands import app
from tippetop.export import bundle
from tippetop.lab.serve import PageHandler, qr_code, serve


@pytest.fixture
def address(page: Path) -> Iterator[tuple[str, int]]:
    with ThreadingHTTPServer(("127.0.0.1", 0), PageHandler) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield "127.0.0.1", server.server_port
        server.shutdown()
        thread.join()


def asked(address: tuple[str, int], method: str, path: str) -> http.client.HTTPResponse:
    connection = http.client.HTTPConnection(*address, timeout=10)
    connection.request(method, path)
    return connection.getresponse()


def test_the_page_is_served_and_nothing_else(address: tuple[str, int], page: Path) -> None:
    for path in ("/", "/?launch.spin=120"):
        assert asked(address, "GET", path).read() == page.read_bytes()
    assert asked(address, "HEAD", "/").read() == b""
    for path in ("/../pyproject.toml", "/player.js", "/lab.html/..", "//etc/passwd"):
        assert asked(address, "GET", path).status == 404
    assert asked(address, "POST", "/").status == 501


def test_other_devices_are_told_where_it_is() -> None:
    pytest.importorskip("segno", reason="segno draws codes to scan; it comes with the lab extra")
    code = qr_code("http://192.0.2.7:8421/")
    assert len(code.splitlines()) > 10
    assert len({len(line) for line in code.splitlines()}) <= 2


def test_the_page_is_written_but_never_over_a_file(page: Path, tmp_path: Path) -> None:
    path = tmp_path / "lab.html"
    runner = CliRunner()
    assert runner.invoke(app, ["lab", "--out", str(path)]).exit_code == 0
    assert path.read_bytes() == page.read_bytes()
    again = runner.invoke(app, ["lab", "--out", str(path)])
    assert again.exit_code != 0
    assert isinstance(again.exception, tt.TippetopError)
    assert runner.invoke(app, ["lab", "--out", str(path), "--force"]).exit_code == 0


def test_where_it_is_not_built_one_is_told_how(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(bundle, "BUILT", tmp_path)
    bundle.built.cache_clear()
    with pytest.raises(tt.TippetopError, match="make page"):
        bundle.built("lab.html")


def test_an_address_that_is_not_here_is_refused(page: Path) -> None:
    with pytest.raises(tt.InvalidInput, match=r"cannot be served at .*another --port"):
        serve("192.0.2.1", 0, False, lambda _: None)
