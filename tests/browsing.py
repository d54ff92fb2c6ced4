"""A browser for tests, and visitors who mind what a page asks for and what goes wrong in it."""

import shutil
from collections.abc import Callable, Iterator
from urllib.parse import urlparse

import pytest

CHROMIUM = (
    shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
)
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

DROP = """([name, text]) => {
  const transfer = new DataTransfer();
  transfer.items.add(new File([text], name));
  const options = { dataTransfer: transfer, bubbles: true, cancelable: true };
  document.querySelector(".own").dispatchEvent(new DragEvent("drop", options));
}"""
"""Script that drops a file of a name and a text onto the form for a body of one's own."""


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
        self.context = browser.new_context(
            **{"viewport": {"width": 1000, "height": 700}, **options}
        )
        self.page = self.context.new_page()
        self.page.set_default_timeout(60_000)
        self.trouble: list[str] = []
        self.requests: list[str] = []
        self.page.on(
            "console", lambda said: said.type == "error" and self.trouble.append(said.text)
        )
        self.page.on("pageerror", lambda error: self.trouble.append(str(error)))
        self.context.on("request", lambda request: self.requests.append(request.url))

    def open(
        self, address: str, ready: str = "globalThis.tippetopLab?.player?.frames > 0"
    ) -> "Visit":
        self.page.goto(address)
        self.page.wait_for_function(f"() => {ready}")
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
        assert not unexpected, unexpected
        away = {
            urlparse(url).hostname
            for url in self.requests
            if not url.startswith(("data:", "blob:", "file:"))
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
