import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from browsing import Visit, browser, visit

__all__ = ["browser", "visit"]

SERVE = "import typer; from tippetop.cli.lab import lab; typer.run(lab)"


def free_port() -> int:
    with socket.socket() as trial:
        trial.bind(("127.0.0.1", 0))
        return int(trial.getsockname()[1])


def wait_for(port: int) -> None:
    """Wait until someone listens at a port."""
    for _ in range(100):
        with socket.socket() as trial:
            if trial.connect_ex(("127.0.0.1", port)) == 0:
                return
        time.sleep(0.1)
    raise AssertionError("the server does not listen")


@pytest.fixture(scope="session")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The laboratory as the command line starts it, and its address; it ends when told to."""
    pytest.importorskip("nicegui", reason="the laboratory needs NiceGUI; it comes with the lab extra")
    port = free_port()
    # NiceGUI behaves differently where it sees pytest; this is to be as a user has it.
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    log = tmp_path_factory.mktemp("lab") / "log"
    command = [sys.executable, "-u", "-c", SERVE, "--port", str(port), "--no-browser", "--workers", "1"]
    with log.open("w") as output:
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=output, env=environment, text=True)
        assert process.stdout is not None
        said = process.stdout.readline()
        assert f"http://127.0.0.1:{port}/" in said, log.read_text()
        wait_for(port)
        yield f"http://127.0.0.1:{port}"
        process.send_signal(signal.SIGINT)
        process.wait(timeout=20)
        process.stdout.close()
    assert "Traceback" not in log.read_text(), log.read_text()


@pytest.fixture(scope="session")
def files(server: str, browser: object, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Every file that the page offers of a run of 175 rad/s over 7 s, downloaded from it."""
    visitor = Visit(browser).open(f"{server}/?launch.spin=175&duration=7")
    visitor.pause()
    folder = tmp_path_factory.mktemp("downloads")
    paths = {}
    for kind in ("nc", "csv", "toml", "glb", "html"):
        with visitor.page.expect_download() as download:
            visitor.page.locator(f"a[data-kind={kind}]").click()
        paths[kind] = folder / download.value.suggested_filename
        download.value.save_as(paths[kind])
    visitor.close()
    return paths


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark what needs the browser, so that it can be run by itself: it is the slowest part of the tests."""
    for item in items:
        if "browser" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.browser)
