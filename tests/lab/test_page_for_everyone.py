"""The page for everyone: by keyboard, on phones, in another language, without motion, read
aloud.
"""

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from browsing import Visit
from tippetop.problem.implausible import SENTENCES
from tippetop.report.gallery import PLATES

Lab = Callable[..., Visit]


def test_everything_is_within_reach_of_the_keyboard(lab: Lab) -> None:
    visitor = lab("tab=launch&t=1")
    page = visitor.page
    page.locator("canvas.tt-canvas").focus()
    page.keyboard.press("ArrowRight")
    assert visitor.ask("() => tippetopLab.player.time") == pytest.approx(1.0 + 1 / 180), "a picture"
    page.keyboard.press(" ")
    visitor.wait("() => tippetopLab.player.playing && tippetopLab.player.time > 1.05")
    page.keyboard.press(" ")
    assert not visitor.ask("() => tippetopLab.player.playing")
    page.locator("h1").click()
    seen = set()
    for _ in range(45):
        page.keyboard.press("Tab")
        seen.add(
            visitor.ask(
                """() => { const e = document.activeElement; return e.getAttribute("aria-label") ||
                e.labels?.[0]?.textContent || e.textContent.trim(); }"""
            )
        )
    wanted = {
        "Play (space)",
        "Time",
        "Copy link",
        "What is what",
        "Launch",
        "Spin ω₃ (rad/s)",
        "Zoom in",
    }
    assert wanted <= seen


def test_a_swipe_scrolls_past_the_scene_on_a_phone(lab: Lab) -> None:
    visitor = lab(viewport={"width": 390, "height": 780}, has_touch=True, is_mobile=True)
    assert visitor.ask("() => document.documentElement.scrollWidth") <= 390
    session = visitor.context.new_cdp_session(visitor.page)
    point = [{"x": 180, "y": 400}]
    session.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": point})
    for step in range(1, 13):
        moved = [{"x": 180, "y": 400 - 25 * step}]
        session.send("Input.dispatchTouchEvent", {"type": "touchMove", "touchPoints": moved})
    session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    visitor.wait("() => scrollY > 100")
    small = visitor.ask(
        """() => [...document.querySelectorAll("button, select, summary")]
        .filter((e) => e.checkVisibility()).map((e) => e.getBoundingClientRect().height)
        .filter((height) => height < 43.5).length"""
    )
    assert small == 0, "all is large enough for a thumb"


def test_the_play_bar_is_seen_on_a_phone_held_across(lab: Lab) -> None:
    visitor = lab(viewport={"width": 780, "height": 390}, has_touch=True, is_mobile=True)
    box = visitor.page.locator(".tt-play").bounding_box()
    assert box["y"] + box["height"] <= 390


def test_the_page_speaks_another_language(lab: Lab) -> None:
    visitor = lab("tab=launch", locale="de-DE")
    assert visitor.ask("() => document.documentElement.lang") == "de"
    german = visitor.page.locator("h1").inner_text()
    visitor.page.get_by_role("combobox", name="Sprache").select_option("en")
    visitor.page.get_by_role("button", name="Copy link").wait_for()
    assert visitor.page.locator("h1").inner_text() != german


def test_a_language_is_chosen_before_the_page_is_painted(lab: Lab) -> None:
    visitor = lab("tab=launch", locale="de-DE")
    script = """async () => {
      tippetopLab.set({});
      await null; // The page is written anew, and language is chosen before that is painted.
      tippetopLab.set({ lang: "en" });
    }"""
    visitor.ask(script)
    assert visitor.page.locator(".tt-play").get_attribute("aria-label") in (
        "Play (space)",
        "Pause (space)",
    )


def test_every_text_is_in_every_language() -> None:
    def names(value: object, prefix: str = "") -> set[str]:
        if isinstance(value, dict):
            return {name for key, one in value.items() for name in names(one, f"{prefix}/{key}")}
        if isinstance(value, list):
            return {name for key, one in enumerate(value) for name in names(one, f"{prefix}/{key}")}
        return {prefix}

    folder = Path(__file__).parents[2] / "web" / "texts"
    english, german = (
        names(json.loads((folder / f"{one}.json").read_text(encoding="utf-8")))
        for one in ("en", "de")
    )
    english |= {f"/doubts/{kind}" for kind in SENTENCES}  # of which the page has Python's
    # Of the account the page has Python's texts in English.
    assert english == {name for name in german if not name.startswith(("/refusals", "/account"))}


SIZES = {
    "phone": [(360, 640), (390, 844), (667, 375), (844, 390)],
    "desktop": [(1024, 768)],
}

BESIDE = """(tab) => {
  tippetopLab.set({ tab });
  for (const one of document.querySelectorAll(".panel details")) one.open = true;
  return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() =>
    done(document.documentElement.scrollWidth - document.documentElement.clientWidth))));
}"""


@pytest.mark.parametrize("screen", SIZES)
def test_no_page_is_wider_than_its_screen(lab: Lab, screen: str) -> None:
    is_phone = screen == "phone"
    visitor = lab("lang=en&duration=2", has_touch=is_phone, is_mobile=is_phone)
    visitor.ask("() => tippetopLab.pin()")
    for language in ("en", "de"):
        visitor.ask("(lang) => tippetopLab.set({ lang })", language)
        for width, height in SIZES[screen]:
            visitor.page.set_viewport_size({"width": width, "height": height})
            visitor.wait("(width) => innerWidth === width", width)
            for tab in ("story", "launch", "own", "compare", "map", "class", "keep"):
                assert visitor.ask(BESIDE, tab) <= 0, (tab, language, width)


@pytest.mark.parametrize(
    ("theme", "tabs"),
    [("light", ["story", "launch", "compare", "class", "keep"]), ("dark", ["own", "map"])],
)
def test_axe_finds_nothing_above_minor(lab: Lab, theme: str, tabs: list[str]) -> None:
    axe = pytest.importorskip(
        "axe_playwright_python.sync_playwright", reason="axe comes with the test extra"
    )
    visitor = lab("tab=launch", color_scheme=theme)
    for tab in tabs:
        visitor.ask("(tab) => tippetopLab.set({ tab })", tab)
        visitor.page.locator(f"[role=tabpanel][aria-labelledby=tab-{tab}]").wait_for()
        found = axe.Axe().run(visitor.page).response["violations"]
        above = [one for one in found if one["impact"] != "minor"]
        assert [(one["id"], one["nodes"][0]["html"]) for one in above] == [], tab


def test_where_motion_is_not_wanted_nothing_moves_by_itself(lab: Lab) -> None:
    visitor = lab("launch.spin=155", reduced_motion="reduce")
    assert not visitor.ask("() => tippetopLab.player.playing")
    assert not visitor.ask("() => tippetopLab.player.climax")


def test_the_page_leads_to_figures_that_there_are() -> None:
    code = (Path(__file__).parents[2] / "web" / "src" / "lab" / "presets.js").read_text(
        encoding="utf-8"
    )
    led_to = re.findall(r'"(fig\w+)"', code)
    assert len(led_to) == 4
    assert set(led_to) <= set(PLATES)
