"""What the scene shows and what is taken along: film, sheet, tone, repetition, a run stopped, the
link.
"""

import math
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from browsing import Visit

Lab = Callable[..., Visit]

EBML = bytes.fromhex("1a45dfa3")

SEEN = """() => { const { player } = tippetopLab; player.draw();
  const copy = document.createElement("canvas"); const { width, height } = player.canvas;
  Object.assign(copy, { width, height });
  const pen = copy.getContext("2d"); pen.drawImage(player.canvas, 0, 0);
  const { data } = pen.getImageData(0, 0, width, height);
  return [width, height, Array.from(data.filter((_, k) => k % 4 === 1))]; }"""


def picture(visitor: Visit) -> np.ndarray:
    """The green of every pixel of the scene, rows from above."""
    width, height, values = visitor.ask(SEEN)
    return np.array(values, dtype=float).reshape(height, width)


def settled(visitor: Visit, condition: str) -> None:
    visitor.wait(
        f"() => ((problem) => {condition})(tippetopLab.track.header.problem) &&"
        " !tippetopLab.engine.busy"
    )


def test_a_shadow_lies_under_the_top_and_darkens_once(lab: Lab) -> None:
    visitor = lab("launch.spin=155&t=3")
    visitor.ask("() => tippetopLab.player.show({ glass: false })")
    show = "(on) => (tippetopLab.player.scene.shadow.visible = on)"
    visitor.ask(show, False)
    without = picture(visitor)
    visitor.ask(show, True)
    share = picture(visitor) / np.maximum(without, 1)
    dark = share < 0.95
    assert 0.005 < dark.mean() < 0.1, "a shadow as large as the top casts"
    assert np.percentile(share[dark], 98) - np.percentile(share[dark], 2) < 0.05, "evenly dark"
    assert visitor.ask("() => tippetopLab.player.scene.renderer.info.render.calls") <= 12


def test_the_film_of_a_run_can_be_watched(lab: Lab, tmp_path: Path) -> None:
    visitor = lab("tab=keep&duration=1&t=0")
    with visitor.page.expect_download() as download:
        visitor.page.get_by_role("button", name="Film (WebM)").click()
    assert download.value.suggested_filename == "tippetop.webm"
    download.value.save_as(tmp_path / "film.webm")
    content = (tmp_path / "film.webm").read_bytes()
    assert content.startswith(EBML)
    assert b"webm" in content[:64]
    assert b"V_VP" in content[:1000], "pictures, in a way that browsers know"
    assert len(content) > 5_000
    assert not visitor.ask("() => tippetopLab.player.playing"), "filmed to its end"


def unfold_options(visitor: Visit) -> None:
    """Show the options below the player's buttons."""
    visitor.page.locator(".tt-more summary").click()


def test_the_spin_is_heard_four_octaves_up(lab: Lab) -> None:
    # For so long its spin stays the same.
    visitor = lab("launch.spin=155&duration=2")
    page = visitor.page
    unfold_options(visitor)
    page.get_by_label("repeat").check()
    page.get_by_label("hear the spin").check()
    visitor.ask("() => tippetopLab.player.toggle(true)")
    visitor.wait("() => tippetopLab.player.tone.gain.gain.value > 0.05")
    pitch = visitor.ask("() => tippetopLab.player.tone.voice.frequency.value")
    assert pitch == pytest.approx(16 * 155 / (2 * math.pi), rel=0.02)
    page.get_by_role("button", name="Pause").click()
    visitor.wait("() => tippetopLab.player.tone.gain.gain.value < 0.005")
    context = page.evaluate_handle("() => tippetopLab.player.tone.context")
    page.get_by_label("hear the spin").uncheck()
    page.wait_for_function("(context) => context.state === 'closed'", arg=context)


def test_a_run_is_repeated_on_request(lab: Lab) -> None:
    visitor = lab("launch.spin=100&duration=2&t=0")
    unfold_options(visitor)
    visitor.page.get_by_label("repeat").check()
    visitor.ask("() => { tippetopLab.player.seek(1.9); tippetopLab.player.toggle(true); }")
    visitor.wait("() => tippetopLab.player.time < 1")
    assert visitor.ask("() => tippetopLab.player.playing")
    visitor.page.get_by_label("repeat").uncheck()
    visitor.ask("() => tippetopLab.player.seek(1.9)")
    visitor.wait("() => !tippetopLab.player.playing")
    assert visitor.ask("() => tippetopLab.player.time") == 2.0


def test_time_goes_slower_while_the_top_turns_over(lab: Lab) -> None:
    visitor = lab("launch.spin=155&t=0")
    passed = """(from) => { const { player } = tippetopLab; player.seek(from);
      player.playing = true; player.last = 1000; player.advance(1010); player.playing = false;
      return player.time - from; }"""
    visitor.ask("() => tippetopLab.player.goAt(1)")
    turned = visitor.ask("() => tippetopLab.player.turnsOver")
    assert visitor.ask(passed, 1.0) == pytest.approx(0.01)
    assert visitor.ask(passed, turned) == pytest.approx(0.0015)
    unfold_options(visitor)
    visitor.page.get_by_label("slow and low as it turns over").uncheck()
    assert visitor.ask(passed, turned) == pytest.approx(0.01)


def test_a_long_run_shows_how_far_it_is_and_can_be_stopped(lab: Lab) -> None:
    visitor = lab("tab=launch&launch.spin=60&duration=2")
    page = visitor.page
    visitor.ask("""() => { const { problem } = tippetopLab.state.setup;
        const launch = { ...problem.launch, spin: 240 };
        const friction = { kind: "regularized_coulomb", mu: 0.3, eps: 1e-5 };
        tippetopLab.go({ duration: 120, problem: { ...problem, launch, friction } }); }""")
    stop = page.locator(".busy").get_by_role("button", name="Stop")
    stop.wait_for()
    visitor.wait("() => tippetopLab.state.busy > 0")
    stop.click()
    page.get_by_text("Stopped: you see the launch before.").wait_for()
    assert page.locator(".busy").count() == 0
    assert visitor.ask("() => tippetopLab.state.setup.problem.launch.spin") == 60
    visitor.ask("() => tippetopLab.change({ 'launch.spin': 70 })")
    settled(visitor, "problem.launch.spin === 70")


def test_the_stem_is_dragged_to_its_length(lab: Lab) -> None:
    visitor = lab("tab=own")
    page = visitor.page
    grip = page.locator(".grip")
    facts, before = page.locator(".facts").inner_text(), float(grip.get_attribute("aria-valuenow"))
    box, scale = (
        grip.bounding_box(),
        visitor.ask("() => document.querySelector('.section').getScreenCTM().a"),
    )
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x, y - 2 * scale)
    page.mouse.move(x, y - 5 * scale)
    page.mouse.up()
    after = float(grip.get_attribute("aria-valuenow"))
    assert after - before == pytest.approx(5.0, abs=0.6), (
        "a millimetre of the drawing is one of the stem"
    )
    assert page.locator(".facts").inner_text() != facts
    page.mouse.move(x, y - 9 * scale)
    assert float(grip.get_attribute("aria-valuenow")) == after, "let go"
    grip.focus()
    page.keyboard.press("ArrowDown")
    page.keyboard.press("ArrowDown")
    visitor.wait(
        "([after]) => document.querySelector('.grip').getAttribute('aria-valuenow') <= after - 1",
        [after],
    )


def test_a_sheet_is_printed_with_launch_picture_curves_and_link(lab: Lab, tmp_path: Path) -> None:
    visitor = lab("tab=launch&launch.spin=120&t=2")
    page = visitor.page
    page.emulate_media(media="print")
    visitor.ask("() => dispatchEvent(new Event('beforeprint'))")
    visitor.wait("() => document.querySelector('.print img').naturalWidth > 100")
    text = page.locator("section.print").inner_text()
    assert "120 rad/s" in text
    assert "Turns over" in text
    assert "launch.spin=120" in page.locator(".address").inner_text()
    assert page.locator(".plots-host canvas").first.is_visible()
    for hidden in ("header", ".panel", ".tt-bar"):
        assert not page.locator(hidden).first.is_visible()
    visitor.ask("() => dispatchEvent(new Event('afterprint'))")
    assert page.locator(".print").count() == 0
    page.emulate_media(media="null")
    content = page.pdf(format="A4")
    assert content.startswith(b"%PDF")
    assert content.count(b"/Type /Page\n") == 1, "one sheet"


def test_the_link_carries_time_camera_units_arrows_and_pins(lab: Lab) -> None:
    visitor = lab("tab=launch&launch.spin=120&duration=6&t=0")
    page = visitor.page
    unfold_options(visitor)
    page.get_by_label("turns/s").check()
    page.get_by_text("rad", exact=True).check()
    page.get_by_label("axis", exact=True).check()
    visitor.ask(
        "() => { tippetopLab.player.seek(2.5); tippetopLab.player.scene.eye.turn(0.7, 0.2); }"
    )
    visitor.ask("() => tippetopLab.pin()")
    visitor.ask("() => tippetopLab.change({ 'friction.mu': 0.5 })")
    settled(visitor, "problem.friction.mu === 0.5")
    what = """() => { const { player, state: { units, pins, setup } } = tippetopLab;
      const { eye, shown } = player.scene;
      return { time: player.time, camera: eye.place, axis: shown.axis, units, pins, setup }; }"""
    sent = visitor.ask(what)
    other = lab(visitor.ask("() => tippetopLab.link().split('#')[1]"))
    other.wait("() => tippetopLab.player.scene.ghosts.length === 1")
    received = other.ask(what)
    assert received["camera"] == pytest.approx(sent["camera"], abs=2e-3)
    assert received["time"] == pytest.approx(sent["time"], abs=1e-4)
    for name in ("axis", "units", "pins", "setup"):
        assert received[name] == sent[name]
    assert received["units"] == {"spin": "turns/s", "angle": "rad"}
    assert received["pins"][0]["problem"]["friction"]["mu"] == 0.3


def test_the_link_takes_along_a_profile_of_many_points(lab: Lab) -> None:
    angles = np.linspace(-np.pi / 2, np.pi / 2, 101)
    points = np.stack([0.02 * np.cos(angles), 0.006 + 0.02 * np.sin(angles)], axis=1)
    points[[0, -1], 0] = 0.0
    visitor = lab("duration=2")
    visitor.ask("(points) => tippetopLab.change({ 'body.profile': points })", points.tolist())
    settled(visitor, "problem.body.profile")
    sent = visitor.ask("() => tippetopLab.link().split('#')[1]")
    assert len(sent) > 2000
    assert lab(sent).ask("() => tippetopLab.state.setup.problem.body.profile") == points.tolist()


def test_undo_takes_back_a_pin_and_never_leaves_the_page(lab: Lab) -> None:
    visitor = lab("tab=compare&duration=2")
    undo = visitor.page.get_by_role("button", name="Undo")
    assert undo.is_disabled()
    visitor.page.get_by_role("button", name="Pin this run").click()
    visitor.wait("() => tippetopLab.player.scene.ghosts.length === 1")
    undo.click()
    visitor.wait("() => tippetopLab.player.scene.ghosts.length === 0")
    visitor.wait("() => document.querySelector('header button').disabled")


def test_the_mark_on_every_plot_is_at_the_time_that_is_shown(lab: Lab) -> None:
    visitor = lab("tab=launch&duration=20&t=6")
    shares = """() => [...document.querySelectorAll(".plots .u-over")].map((over) => {
      const mark = over.querySelector(".plot-now").getBoundingClientRect();
      const { left, width } = over.getBoundingClientRect();
      return (mark.left + mark.width / 2 - left) / width; })"""
    visitor.wait("() => document.querySelectorAll('.plot-now').length === 6")
    assert visitor.ask(shares) == pytest.approx([0.3] * 6, abs=0.01)
    visitor.ask("() => tippetopLab.player.seek(15)")
    visitor.wait("() => document.querySelector('.tt-time').textContent === '15.000 s'")
    assert visitor.ask(shares) == pytest.approx([0.75] * 6, abs=0.01)
    visitor.page.set_viewport_size({"width": 800, "height": 700})
    visitor.wait(
        "(share) => Math.abs(share()[0] - 0.75) < 0.01".replace("share()", f"({shares})()")
    )


def test_flights_shade_what_they_fill_once(lab: Lab) -> None:
    """However many there are in a pixel, what flies under the shade is seen."""
    visitor = lab("tab=launch&duration=2&t=0&plots=tilt")
    shade = """(count) => {
      const hop = (_, k) => [0.5 + k / count, 0.5 + (k + 1) / count];
      tippetopLab.track.header.flights = Array.from({ length: count }, hop);
      const [{ chart }] = tippetopLab.plots.charts, { ctx, bbox } = chart;
      chart.redraw(false);
      return new Promise((done) => requestAnimationFrame(() => {
        const x = bbox.left + bbox.width / 2, y = bbox.top + bbox.height / 3;
        const { data } = ctx.getImageData(x, y, 1, 1);
        done(data[3]);
      }));
    }"""
    one, many = (visitor.ask(shade, count) for count in (1, 5000))
    assert 0 < one < 64
    assert many == one


def test_a_graph_with_free_axes_tells_the_values_under_the_pointer(lab: Lab) -> None:
    visitor = lab("tab=launch&launch.spin=155&t=0&free=tilt spin")
    page = visitor.page
    visitor.pause(0.0)
    graph = page.locator(".free svg")
    graph.scroll_into_view_if_needed()
    page.locator(".free select").nth(1).select_option("energy")
    assert "free=tilt+energy" in visitor.ask("() => tippetopLab.link()")
    box = graph.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 0.9 * box["width"], box["y"] + 0.8 * box["height"])
    words = page.locator(".free .hint").inner_text()
    number = r"([\d.]+)"
    read = re.search(rf"θ = {number} °, E = {number} mJ, t = {number} s", words)
    assert read is not None, words
    tilt, energy, time = map(float, read.groups())
    at = visitor.ask(
        "(t) => ['tilt', 'energy'].map((name) => tippetopLab.track.value(name, t))", time
    )
    assert [tilt, energy] == pytest.approx([math.degrees(at[0]), 1e3 * at[1]], rel=2e-3)
