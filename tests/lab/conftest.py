import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from urllib.parse import urlparse

import pytest

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
ARGUMENTS = [
    "--no-sandbox",
    # The shared memory of a container is small.
    "--disable-dev-shm-usage",
    # Pictures without graphics hardware: WebGL in software, and the page put together without it.
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-gpu-compositing",
    # No errands of the browser's own.
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
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
def browser() -> Iterator[object]:
    playwright = pytest.importorskip(
        "playwright.sync_api", reason="Playwright drives the browser; test extra"
    )
    if CHROMIUM is None:
        pytest.skip("there is no Chromium here (make chromium)")
    with playwright.sync_playwright() as driver:
        running = driver.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield running
        running.close()


class Visit:
    """A visitor's page, which minds what it asks for and what goes wrong in it."""

    def __init__(self, browser, **options) -> None:  # type: ignore[no-untyped-def]
        self.context = browser.new_context(**{"viewport": {"width": 1000, "height": 700}, **options})
        self.page = self.context.new_page()
        self.page.set_default_timeout(60_000)
        self.trouble: list[str] = []
        self.requests: list[str] = []
        self.page.on("console", lambda said: said.type == "error" and self.trouble.append(said.text))
        self.page.on("pageerror", lambda error: self.trouble.append(str(error)))
        self.context.on("request", lambda request: self.requests.append(request.url))

    def open(self, address: str) -> "Visit":
        self.page.goto(address)
        self.page.wait_for_function("() => globalThis.tippetopLab?.player?.frames > 0")
        return self

    def ask(self, expression: str, argument: object = None):  # type: ignore[no-untyped-def]
        return self.page.evaluate(expression, argument)

    def pause(self, at: float = 0.0) -> None:
        self.ask("(t) => { tippetopLab.player.toggle(false); tippetopLab.player.seek(t); }", at)

    def wait(self, condition: str, argument: object = None) -> None:
        self.page.wait_for_function(condition, arg=argument)

    def launched(self, condition: str) -> None:
        """Wait until a launch is shown of which something holds."""
        self.wait(f"() => ((problem) => {condition})(tippetopLab.player.track.header.problem)")

    def close(self, expected: tuple[str, ...] = ()) -> None:
        self.context.close()
        unexpected = [said for said in self.trouble if not any(part in said for part in expected)]
        assert not unexpected
        away = {
            urlparse(url).hostname for url in self.requests if not url.startswith(("data:", "blob:", "file:"))
        }
        assert away <= {"127.0.0.1"}, "nothing is asked of any other machine"


@pytest.fixture
def visit(browser: object) -> Iterator[Callable[..., Visit]]:
    """Makes visitors' pages, which are closed and checked in the end."""
    visits: list[Visit] = []

    def make(**options: object) -> Visit:
        visits.append(Visit(browser, **options))
        return visits[-1]

    yield make
    for visitor in visits:
        visitor.close()


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
