"""The paths of a pupil and of a teacher through the page, with axe and the width at each stop."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from browsing import Visit

Lab = Callable[..., Visit]

PHONE = {"has_touch": True, "is_mobile": True}
SCREENS: dict[str, dict[str, object]] = {
    "desktop": {"viewport": {"width": 1280, "height": 800}},
    "phone": {"viewport": {"width": 390, "height": 844}, **PHONE},
    "phone held across": {"viewport": {"width": 844, "height": 390}, **PHONE},
    "desktop, dark": {"viewport": {"width": 1280, "height": 800}, "color_scheme": "dark"},
}
TEXTS = Path(__file__).parents[2] / "web" / "texts"


def texts(language: str) -> dict[str, dict[str, object]]:
    """The page's words in a language."""
    read: dict[str, dict[str, object]] = json.loads((TEXTS / f"{language}.json").read_text("utf-8"))
    return read


def look(visitor: Visit) -> None:
    """Check that nothing is wider than the screen, and that axe finds nothing above minor."""
    axe = pytest.importorskip("axe_playwright_python.sync_playwright", reason="test extra")
    width = "() => document.documentElement.scrollWidth - document.documentElement.clientWidth"
    assert visitor.ask(width) <= 0
    violations = axe.Axe().run(visitor.page).response["violations"]
    found = [one for one in violations if one["impact"] != "minor"]
    assert [(one["id"], one["nodes"][0]["html"]) for one in found] == []


def is_seen(visitor: Visit, selector: str) -> bool:
    """Whether at least a part of an element is on the screen."""
    box = visitor.page.locator(selector).bounding_box()
    height = visitor.ask("() => innerHeight")
    return box is not None and box["y"] + box["height"] > 0 and box["y"] < height


@pytest.mark.parametrize(
    ("screen", "language"),
    [
        ("desktop", "en"),
        ("phone", "en"),
        ("phone", "de"),
        ("phone held across", "de"),
        ("desktop, dark", "de"),
    ],
)
def test_a_pupil_guesses_watches_and_reads(lab: Lab, screen: str, language: str) -> None:
    words = texts(language)["story"]
    steps = words["steps"]
    assert isinstance(steps, list)
    visitor = lab(f"lang={language}&step=5", **SCREENS[screen])
    page = visitor.page
    assert page.locator(".story h2").inner_text() == steps[5]["title"]
    assert not page.locator(".tt-words").is_visible(), "nothing is told before the guess"
    look(visitor)
    if screen == "phone":
        assert is_seen(visitor, ".question .strong"), "one sees what to press"
    page.get_by_label(steps[5]["answers"][2], exact=True).check()
    page.get_by_role("button", name=str(words["go"]), exact=True).click()
    visitor.wait("() => tippetopLab.player.playing && tippetopLab.player.scene.ghosts.length === 1")
    assert is_seen(visitor, ".tt-canvas"), "the stage is in view when the top spins"
    assert not page.locator(".tt-words").is_visible(), "nothing is told before it is seen"
    assert page.locator(".question label.chosen .yours").inner_text() == words["yours"]
    look(visitor)
    page.get_by_role("button", name=str(words["tell"]), exact=True).click()
    page.get_by_text(str(words["right"]), exact=True).wait_for()
    asked = page.locator(".answer .asked")
    assert steps[5]["answers"][2] in asked.text_content()
    assert asked.is_visible() == ("phone" in screen), "what was asked is told again on phones"
    assert page.locator(".tt-words strong").inner_text() == steps[5]["happened"]
    assert "155 rad/s" in page.locator(".tt-facts").inner_text()
    look(visitor)
    if screen == "phone":
        assert is_seen(visitor, ".story-nav .strong"), "one sees how to go on"
    page.get_by_role("button", name=str(words["next"]), exact=True).click()
    page.get_by_role("heading", name=steps[6]["title"]).wait_for()
    visitor.wait("() => tippetopLab.player.scene.ghosts.length === 0")


def test_a_pupil_finds_the_answer_by_keyboard_alone(lab: Lab) -> None:
    visitor = lab()
    page = visitor.page
    skip = "() => document.activeElement.className"
    page.keyboard.press("Tab")
    assert visitor.ask(skip) == "skip"
    page.keyboard.press("Enter")
    for _ in range(6):
        page.keyboard.press("Tab")
        if visitor.ask("() => document.activeElement.name") == "guess":
            break
    page.keyboard.press("ArrowDown")
    assert visitor.ask("() => document.activeElement.value") == "1"
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    visitor.wait("() => document.activeElement.classList.contains('watching')")
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    visitor.wait("() => document.activeElement.classList.contains('answer')")
    assert "You were right." in page.locator(".answer").inner_text()
    page.locator(".torque .grip").focus()
    tilt = page.locator(".torque .grip").get_attribute("aria-valuenow")
    page.keyboard.press("ArrowDown")
    visitor.wait(
        "(tilt) => document.querySelector('.torque .grip').getAttribute('aria-valuenow') > tilt",
        tilt,
    )
    look(visitor)


@pytest.mark.parametrize("screen", ["desktop", "phone"])
def test_a_teacher_sends_links_and_collects_what_comes_back(lab: Lab, screen: str) -> None:
    teacher = lab("tab=class&duration=10", **SCREENS[screen])
    page = teacher.page
    look(teacher)
    page.get_by_label("Groups").fill("3")
    page.get_by_label("Groups").press("Enter")
    teacher.wait("() => document.querySelectorAll('.codes li').length === 3")
    page.get_by_text("The same as links to send").click()
    links = page.locator("textarea.links").input_value().split("\n")
    assert [link.split("launch.spin=")[1].split("&")[0] for link in links] == ["10", "80", "150"]
    results = []
    for link in links[1:]:
        pupil = lab(link.partition("#")[2], **SCREENS["phone"])
        pupil.ask(
            "() => { navigator.clipboard.writeText = (text) => { globalThis.sent = text; }; }"
        )
        pupil.page.get_by_role("button", name="Copy link to it").click()
        results.append(pupil.ask("() => globalThis.sent"))
    assert all("result=" in result for result in results)
    page.locator(".classroom textarea:not(.links)").fill("\n".join(["10 0.0", *results]))
    assert page.locator(".scatter .dot").count() == 3
    assert page.locator(".classroom [role=alert]").count() == 0
    look(teacher)
    again = lab(results[1].partition("#")[2])
    again.launched("problem.launch.spin === 150")
