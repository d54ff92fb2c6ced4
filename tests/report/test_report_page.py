"""The report's page in a real browser."""

from collections.abc import Callable
from pathlib import Path

import pytest

from judging import made_up_page
from tippetop.report.page import render
from tippetop.report.playable import playable
from tippetop.report.reproduce import reproduce
from tippetop.report.selection import select

pytestmark = pytest.mark.browser

SHOWN = (
    "() => [...document.querySelectorAll('.claim')].filter((one) => one.offsetParent).map((one) =>"
    " one.id)"
)
UNFOLD = "document.querySelectorAll('details').forEach((one) => { one.open = true; })"
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
    visitor.ask(UNFOLD)
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


@pytest.fixture(scope="module")
def story(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A page with all of its claims, in made-up values, and the story."""
    folder = tmp_path_factory.mktemp("story")
    (folder / "index.html").write_text(made_up_page(folder), encoding="utf-8")
    return (folder / "index.html").as_uri()


@pytest.mark.parametrize(("width", "height"), [(1280, 800), (390, 844)])
def test_the_story_fits_into_two_screens_and_the_cards_are_folded(
    story: str, visit: Callable, width: int, height: int
) -> None:
    visitor = visit(viewport={"width": width, "height": height}).open(story, READY)
    end = visitor.ask("document.querySelector('.story').getBoundingClientRect().bottom")
    assert end <= 2 * height
    assert visitor.page.locator(".claim").count() > 80
    assert not any(card.is_visible() for card in visitor.page.locator(".claim").all()[::20])


def test_a_section_opens_and_a_link_leads_into_it_without_javascript(
    story: str, visit: Callable
) -> None:
    page = visit(java_script_enabled=False).page
    page.goto(story)
    section = page.locator("details", has=page.locator("#section-3\\.1"))
    card = page.locator("#claim-fig04-flip-time")
    assert not card.is_visible()
    section.locator("summary").click()
    assert card.is_visible()
    page.goto(story + "#claim-eq-2.1")
    page.locator("#claim-eq-2\\.1").wait_for(state="visible")


def test_the_run_plays_where_it_stands_once_it_is_asked_to(address: str, visit: Callable) -> None:
    visitor = visit().open(address, READY)
    visitor.page.get_by_text("A run to play").last.click()
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
    visitor.ask(UNFOLD)
    assert visitor.ask("document.documentElement.scrollWidth") <= width
    visitor.page.locator("#stage").scroll_into_view_if_needed()
    visitor.wait("() => globalThis.tippetopPlayer?.frames > 0")
    found = axe.Axe().run(visitor.page)
    assert found.violations_count == 0, found.generate_report()
