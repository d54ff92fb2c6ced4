"""What a class brings is read, and what it has done stays, on every screen and on paper."""

import base64
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import tippetop as tt
from browsing import DROP, Visit

Lab = Callable[..., Visit]


def test_the_example_of_points_is_a_ball_and_numbers_are_millimetres(lab: Lab) -> None:
    visitor = lab("tab=own&duration=1")
    page = visitor.page
    page.locator(".bring summary").click()
    area = page.locator(".bring textarea")
    area.fill(str(area.get_attribute("placeholder")))
    page.get_by_role("button", name="Read them").click()
    page.get_by_text("Brought: pasted points").wait_for()
    assert page.get_by_label("Numbers are in").input_value() == "mm"
    piece = tt.Workpiece(profile=[[0, -15], [15, 0, 15], [0, 15, 15]], density=720, unit="mm")
    page.locator(".facts", has_text=f"{1e3 * piece.mass_properties.mass:.4g} g").wait_for()
    assert page.locator(".own .refused").count() == 0


def test_points_of_a_german_spreadsheet_are_read(lab: Lab) -> None:
    visitor = lab("tab=own&lang=de&duration=1")
    visitor.ask(DROP, ["punkte.csv", "0;-15,5\n15,5;0;15,5\n0;15,5;15,5\n"])
    piece = tt.Workpiece(
        profile=[[0, -15.5], [15.5, 0, 15.5], [0, 15.5, 15.5]], density=720, unit="mm"
    )
    grams = f"{1e3 * piece.mass_properties.mass:.4g}".replace(".", ",")
    visitor.page.locator(".facts", has_text=f"{grams} g").wait_for()
    visitor.page.get_by_role("tab", name="Mitnehmen").click()
    with visitor.page.expect_download() as download:
        visitor.page.locator("[data-kind=csv]").click()
    rows = Path(download.value.path()).read_text(encoding="utf-8").splitlines()
    assert rows[0].startswith("time (s);")
    assert "," in rows[5]
    assert "." not in rows[5]
    assert len(rows[5].split(";")) == len(rows[0].split(";"))


NESTED = (
    '<svg xmlns="http://www.w3.org/2000/svg"><g id="a0"><line x2="1" y2="1"/></g>'
    + "".join(f'<g id="a{k}">' + f'<use href="#a{k - 1}"/>' * 10 + "</g>" for k in range(1, 12))
    + "</svg>"
)


def test_too_much_is_refused_at_once(lab: Lab) -> None:
    visitor = lab("tab=own&duration=1")
    page = visitor.page
    visitor.ask(DROP, ["many.csv", "1,2\n" * 120_000])
    page.get_by_text("many.csv has 120000 points; here at most 20000 are read.").wait_for()
    visitor.ask(DROP, ["nested.svg", NESTED])
    page.locator(".refused", has_text="more than 20000 elements").wait_for(timeout=15_000)
    page.get_by_role("button", name="Back to the sliders").click()
    wavy = [
        f"{15 * np.cos(a) * (1 + 0.001 * np.sin(9 * a)):.6f},{15 * np.sin(a):.6f}"
        for a in np.linspace(-np.pi / 2, np.pi / 2, 15_001)
    ]
    visitor.ask(DROP, ["wavy.csv", "\n".join(wavy)])
    page.get_by_text("Brought: wavy.csv").wait_for()
    page.locator(".own").get_by_role("button", name="Stop").click()
    page.get_by_text("Stopped: it is not known what this is.").wait_for()


def test_results_of_a_class_stay(lab: Lab) -> None:
    visitor = lab("tab=class&launch.spin=50&duration=2")
    page = visitor.page
    visitor.ask("() => tippetopLab.go({ ...tippetopLab.state.setup, duration: 1 })")
    area = page.locator(".classroom textarea:not(.links)")
    area.fill("155 179.9\n99999 90\n-155 179.9\n")
    page.keyboard.type("7")
    page.keyboard.press("Control+z")
    page.wait_for_timeout(400)
    assert visitor.ask("() => tippetopLab.state.setup.duration") == 1, "no launch is undone"
    assert "lines 2" in page.locator(".classroom [role=alert]").inner_text()
    page.get_by_text("2 of 3 lines read").wait_for()
    assert page.locator(".scatter .dot").count() == 2
    assert "−155 rad/s" in str(page.locator(".scatter").get_attribute("aria-label"))
    other = "https://school/lab.html#friction.mu=0&launch.spin=50&tab=launch&result=50+6.0"
    area.fill(f"155 179.9\n{other}\n")
    page.locator(".classroom .refused", has_text="another launch").wait_for()
    visitor.wait("() => location.hash.includes('results')")
    page.reload()
    visitor.wait("() => globalThis.tippetopLab?.track")
    assert "155 179.9" in page.locator(".classroom textarea:not(.links)").input_value()
    visitor.ask("() => tippetopLab.set({ units: { spin: 'rpm', angle: 'deg' } })")
    assert "rpm" in str(page.locator(".scatter").text_content())
    assert "rpm" in page.locator(".codes span").first.inner_text()


PHONE = {"viewport": {"width": 390, "height": 780}, "has_touch": True, "is_mobile": True}
ACROSS = {"viewport": {"width": 780, "height": 390}, "has_touch": True, "is_mobile": True}


@pytest.mark.parametrize("screen", [PHONE, ACROSS, {}], ids=["phone", "across", "desktop"])
def test_speed_views_and_arrows_are_on_every_screen(lab: Lab, screen: dict[str, object]) -> None:
    visitor = lab("tab=launch&launch.spin=155&duration=3", **screen)
    page = visitor.page
    inside = """() => { const { bottom } = document.querySelector(".stage").getBoundingClientRect();
      return [".tt-play", ".tt-more summary"].every((name) =>
        document.querySelector(name).getBoundingClientRect().bottom <= bottom + 1); }"""
    assert visitor.ask(inside), "nothing is cut off"
    assert page.locator(".tt-pace").is_visible()
    assert page.locator(".tt-pace").inner_text().startswith("1/"), "slow motion is said to be that"
    page.locator(".tt-more summary").click()
    page.get_by_label("Speed").select_option(label="1/100")
    page.get_by_role("combobox", name="View").select_option("side")
    page.get_by_label("angular momentum").check()
    for name in ("repeat", "hear the spin"):
        assert page.get_by_label(name).is_visible()
    page.locator(".tt-pace", has_text="1/100 of real speed").wait_for()
    assert visitor.ask("() => tippetopLab.player.scene.shown.momentum")
    stage = visitor.ask("() => document.querySelector('.tt-canvas').clientHeight")
    page.locator(".tt-more summary").click()
    assert stage > 120, "and leave a stage to look at"


def test_the_link_holds_what_it_says(lab: Lab) -> None:
    visitor = lab("tab=own&duration=1")
    page = visitor.page
    page.locator("[data-own=hollow]").focus()
    for _ in range(5):
        page.keyboard.press("ArrowLeft")
    page.locator(".tt-more summary").click()
    page.get_by_label("Speed").select_option(label="1/10")
    visitor.ask(
        "() => tippetopLab.set({ classroom: { groups: 9, low: 20, high: 90, results: '50 86.1' } })"
    )
    weight = page.locator(".facts").first.inner_text()
    other = lab(visitor.ask("() => tippetopLab.link().split('#')[1]"))
    assert other.page.locator(".facts").first.inner_text() == weight
    assert other.ask("() => tippetopLab.player.speed") == pytest.approx(0.1)
    other.page.get_by_role("tab", name="Class").click()
    assert other.page.locator(".codes li").count() == 9
    assert other.page.locator(".scatter .dot").count() == 1


def test_another_language_goes_on_with_what_is_played(lab: Lab) -> None:
    visitor = lab("tab=launch&launch.spin=155&duration=3&t=0")
    page = visitor.page
    page.locator(".tt-more summary").click()
    page.get_by_label("Speed").select_option(label="1/30")
    page.get_by_label("angular momentum").check()
    page.get_by_label("repeat").check()
    visitor.ask("() => tippetopLab.player.toggle(true)")
    visitor.wait("() => tippetopLab.player.time > 0.01")
    page.get_by_role("combobox", name="Language").select_option("de")
    page.get_by_role("button", name="Link kopieren").wait_for()
    found = visitor.ask(
        """() => { const { playing, speed, loop, scene, time } = tippetopLab.player;
        return [playing, speed, loop, scene.shown.momentum, time]; }"""
    )
    assert found[:4] == [True, pytest.approx(1 / 30), True, True]
    assert 0.0 < found[4] < 1.0
    assert page.get_by_label("Drehimpuls").is_checked()


def test_without_motion_a_launch_shows_its_end_and_steps(lab: Lab) -> None:
    visitor = lab("tab=launch&launch.spin=155&duration=8", reduced_motion="reduce")
    page = visitor.page
    page.get_by_role("button", name="Launch", exact=True).click()
    visitor.wait("() => !tippetopLab.isAwaited && tippetopLab.player.time === 8")
    assert not visitor.ask("() => tippetopLab.player.playing")
    page.get_by_role("button", name="Step back").click()
    assert visitor.ask("() => tippetopLab.player.time") == pytest.approx(8 - 8 / 50)


def test_paper_is_white_and_does_not_tell_the_answer(lab: Lab) -> None:
    visitor = lab("step=0&theme=dark")
    page = visitor.page
    page.emulate_media(media="print")
    visitor.ask("() => dispatchEvent(new Event('beforeprint'))")
    text = page.locator("section.print").inner_text()
    assert "What will the stem do?" in text
    assert "urns over" not in text
    visitor.wait("() => document.querySelector('.print img').naturalWidth > 100")
    mean = """() => { const image = document.querySelector(".print img");
      const copy = document.createElement("canvas");
      Object.assign(copy, { width: 40, height: 40 });
      const pen = copy.getContext("2d"); pen.drawImage(image, 0, 0, 40, 40);
      const { data } = pen.getImageData(0, 0, 40, 40);
      return data.reduce((sum, value) => sum + value, 0) / data.length; }"""
    assert visitor.ask(mean) > 170, "light"
    ink = "() => getComputedStyle(document.body).color"
    assert visitor.ask(ink) == "rgb(0, 0, 0)"
    assert visitor.ask("() => tippetopLab.plots.dark") is False
    visitor.ask("() => dispatchEvent(new Event('afterprint'))")
    assert visitor.ask("() => tippetopLab.plots.dark") is True
    assert visitor.ask("() => tippetopLab.player.dark") is True


def test_the_headline_does_not_lie_over_the_toy(lab: Lab) -> None:
    """At twice the size, which is half the width, too."""
    for width in (1000, 500):
        visitor = lab(
            "tab=launch&launch.spin=175&duration=8", viewport={"width": width, "height": 700}
        )
        boxes = [visitor.page.locator(name).bounding_box() for name in (".tt-words", ".tt-canvas")]
        words, canvas = boxes
        assert words["height"] > 15
        assert words["y"] + words["height"] <= canvas["y"] + 1
        assert canvas["height"] > 120


def test_a_drag_is_one_step_back(lab: Lab) -> None:
    visitor = lab("tab=launch&launch.spin=100&duration=1")
    page = visitor.page
    box = page.locator("[data-field='launch.spin']").bounding_box()
    y = box["y"] + box["height"] / 2
    page.mouse.move(box["x"] + 0.4 * box["width"], y)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.6 * box["width"], y)
    page.wait_for_timeout(500)  # longer than a link waits to be kept
    page.mouse.move(box["x"] + 0.8 * box["width"], y)
    page.mouse.up()
    visitor.launched("problem.launch.spin > 150")
    page.get_by_role("button", name="Undo").click()
    visitor.launched("problem.launch.spin === 100")


def test_before_a_guess_nothing_plays(lab: Lab) -> None:
    visitor = lab()
    page = visitor.page
    assert page.locator(".tt-play").is_disabled()
    page.locator(".tt-canvas").focus()
    for key in (" ", "End", "ArrowRight"):
        page.keyboard.press(key)
    assert visitor.ask("() => [tippetopLab.player.playing, tippetopLab.player.time]") == [False, 0]
    page.get_by_role("button", name="Just show me").click()
    visitor.wait("() => tippetopLab.player.playing")
    assert page.locator(".tt-play").is_enabled()


def test_step_seven_says_nothing_that_has_not_happened(lab: Lab) -> None:
    visitor = lab("step=6")
    page = visitor.page
    page.get_by_role("button", name="Just show me").click()
    page.get_by_role("button", name="Tell me now").wait_for()
    visitor.wait("() => !tippetopLab.isAwaited && tippetopLab.player.playing")
    visitor.ask("() => tippetopLab.player.toggle(false)")
    first = visitor.ask("() => tippetopLab.track.header.flights[0][0]")
    visitor.ask("(t) => tippetopLab.player.seek(t)", first + 0.6)
    page.wait_for_timeout(200)
    theta = visitor.ask("() => tippetopLab.track.value('tilt', tippetopLab.player.time)")
    assert theta < np.pi / 2
    assert page.locator(".answer").count() == 0, "it has not turned over"
    visitor.ask("() => tippetopLab.player.seek(tippetopLab.player.turnsOver + 0.7)")
    page.locator(".answer").wait_for()
    assert re.search("leaves the table", page.locator(".tt-words").inner_text())


NARROW = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}
# What lies below the stage, above the bar of the question, and how far apart, pixels.
ROOM = """(selectors) => {
  const stage = document.querySelector(".stage").getBoundingClientRect().bottom;
  const bar = document.querySelector(".question .row").getBoundingClientRect().top;
  return selectors.flatMap((selector) => [...document.querySelectorAll(selector)]).map((one) => {
    const { top, bottom } = one.getBoundingClientRect();
    return [top - stage, bar - bottom];
  });
}"""


@pytest.mark.parametrize("language", ["en", "de"])
def test_a_step_stands_under_the_picture(lab: Lab, language: str) -> None:
    visitor = lab(f"lang={language}", **NARROW)
    page = visitor.page
    answers = visitor.ask(ROOM, [".question label"])
    # In German the first screen has room for the question alone.
    hidden = [below < 0 or above < -1 for below, above in answers]
    assert language == "de" or not any(hidden)
    page.locator(".question .row button").last.click()
    page.locator(".watching button").click()
    page.locator(".answer").wait_for()
    page.locator(".story-nav .strong").click()
    page.wait_for_timeout(400)
    step, title = visitor.ask(ROOM, [".story .step", ".story h2"])
    assert 0 <= step[0] < 20
    assert 0 < title[0] < 60


def test_whole_lines_are_told_and_a_tap_tells_the_rest(lab: Lab) -> None:
    visitor = lab("tab=launch&launch.spin=175&duration=20", **NARROW)
    words = visitor.page.locator(".tt-words")
    sizes = """() => { const words = document.querySelector(".tt-words");
      const { paddingTop } = getComputedStyle(words);
      const line = parseFloat(getComputedStyle(words.querySelector("strong")).lineHeight);
      return [(words.clientHeight - parseFloat(paddingTop)) / line,
        words.scrollHeight - words.clientHeight]; }"""
    lines, hidden = visitor.ask(sizes)
    assert lines == pytest.approx(3, abs=0.1)
    assert hidden > 5
    words.tap()
    assert visitor.ask(sizes)[1] <= 1
    assert visitor.ask(sizes)[0] > 3.5


def test_no_curve_shows_ahead_of_the_mark(lab: Lab) -> None:
    visitor = lab("step=0", device_scale_factor=2, **NARROW)
    page = visitor.page
    page.locator(".question .row button").last.click()
    visitor.wait("() => tippetopLab.player.playing && !tippetopLab.isAwaited")
    visitor.pause(1.0)
    page.locator(".plots figure").first.scroll_into_view_if_needed()
    left, right, top = visitor.ask("""() => {
      const over = document.querySelector(".plots .u-over");
      const box = over.getBoundingClientRect();
      return [over.querySelector(".plot-now").getBoundingClientRect().left, box.right, box.top];
    }""")
    clip = {"x": left + 4, "y": top - 2, "width": right - left - 5, "height": 6}
    shot = base64.b64encode(page.screenshot(clip=clip)).decode()
    colours = """async (shot) => {
      const image = new Image();
      image.src = `data:image/png;base64,${shot}`;
      await image.decode();
      const copy = new OffscreenCanvas(image.width, image.height).getContext("2d");
      copy.drawImage(image, 0, 0);
      const { data } = copy.getImageData(0, 0, image.width, image.height);
      return new Set(new Uint32Array(data.buffer)).size;
    }"""
    assert visitor.ask(colours, shot) == 1, "nothing but paper"
