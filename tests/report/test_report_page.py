"""The report's page in a real browser."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tippetop.report.page import render
from tippetop.report.playable import playable
from tippetop.report.reproduce import reproduce
from tippetop.report.selection import select

pytestmark = pytest.mark.browser

SHOWN = (
    "() => [...document.querySelectorAll('.claim')].filter((one) => one.offsetParent).map((one) =>"
    " one.id)"
)
READY = "document.querySelector('#filter') !== null"


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A page with one figure, its claims and the run to play."""
    if playable(True) is None:
        pytest.skip("the player is not built (make page)")
    folder = tmp_path_factory.mktemp("page") / "out"
    done = reproduce(folder, only="fig13", quick=True, workers=1)
    text = render(
        select("fig13").plates,
        done.judgements,
        folder / "figures",
        player=playable(True),
        quick=True,
    )
    (folder / "index.html").write_text(text, encoding="utf-8")
    return Path(folder / "index.html").as_uri()


def test_statements_are_filtered_by_verdict_from_the_keyboard(
    address: str, visit: Callable
) -> None:
    visitor = visit().open(address, READY)
    everything = visitor.ask(SHOWN)
    assert everything == ["claim-eq-2.17-exception", "claim-fig13-upright"]
    visitor.page.locator("#only-all").focus()
    visitor.page.keyboard.press("ArrowRight")
    assert visitor.page.locator("#only-reproduced").is_checked()
    assert visitor.ask(SHOWN) == ["claim-fig13-upright"]
    assert not visitor.page.locator("#section-2\\.3").is_visible(), "nothing is left in it"
    assert visitor.page.locator("#fig13").is_visible()
    visitor.page.locator("#only-corrected").check()
    assert visitor.ask(SHOWN) == ["claim-eq-2.17-exception"]
    visitor.page.locator("#only-all").check()
    assert visitor.ask(SHOWN) == everything


def test_the_run_plays_where_it_stands_once_it_is_asked_to(address: str, visit: Callable) -> None:
    visitor = visit().open(address, READY)
    visitor.page.locator("#stage").scroll_into_view_if_needed()
    visitor.wait("() => globalThis.tippetopPlayer?.frames > 0")
    assert visitor.ask("tippetopPlayer.time") == 0.0, "nothing moves that was not asked to"
    visitor.page.locator("#stage [data-do=play]").click()
    visitor.wait("() => tippetopPlayer.time > 0.1")
    assert visitor.ask("tippetopPlayer.duration") == pytest.approx(9.0)


@pytest.mark.parametrize(
    ("width", "scheme"), [(1280, "light"), (1280, "dark"), (390, "light"), (390, "dark")]
)
def test_everyone_can_read_it(address: str, visit: Callable, width: int, scheme: str) -> None:
    axe = pytest.importorskip(
        "axe_playwright_python.sync_playwright", reason="axe comes with the test extra"
    )
    visitor = visit(viewport={"width": width, "height": 800}, color_scheme=scheme).open(
        address, READY
    )
    assert visitor.ask("document.documentElement.scrollWidth") <= width
    visitor.page.locator("#stage").scroll_into_view_if_needed()
    visitor.wait("() => globalThis.tippetopPlayer?.frames > 0")
    found = axe.Axe().run(visitor.page)
    assert found.violations_count == 0, found.generate_report()
