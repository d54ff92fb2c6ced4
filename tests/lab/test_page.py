"""The page in a real browser, as its visitors use it."""

import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from urllib.parse import parse_qs, urlparse

import numpy as np
import pytest

import tippetop as tt
from tippetop.export.words import tell
from tippetop.lab.phase_map import COLUMNS
from tippetop.theory.thresholds import critical_spins

SLIDER = ".q-slider__track-container"

# How many shades there are in the scene, what share is the toy's blue, and where that is from left to right.
COLOURS = """() => {
  const { scene } = tippetopLab.player;
  scene.draw(6.5);
  const gl = scene.renderer.getContext();
  const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
  const data = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, data);
  const blue = [];
  const shades = new Set();
  for (let i = 0; i < data.length; i += 4) {
    shades.add((data[i] >> 3) * 4096 + (data[i + 1] >> 3) * 64 + (data[i + 2] >> 3));
    if (data[i + 2] > data[i] + 50) blue.push((i / 4) % width / width);
  }
  return [shades.size, blue.length / (width * height), blue.reduce((a, b) => a + b, 0) / blue.length];
}"""


class Forgiving(list[str]):
    """What goes wrong on a page, but for what is expected to."""

    def __init__(self, expected: str) -> None:
        super().__init__()
        self.expected = expected

    def append(self, said: str) -> None:
        if self.expected not in said:
            super().append(said)


def luminance(colour: list[float]) -> float:
    """Relative luminance of an sRGB colour, as WCAG defines it."""
    value = np.array(colour) / 255
    linear = np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def test_a_visitor_sees_the_top_turn_over(server: str, visit: Callable) -> None:
    visitor = visit().open(server)
    page = visitor.page
    expected = tell(tt.simulate(tt.presets.report_problem(), 20.0, samples=5001)).headline
    assert page.locator(".tt-words strong").inner_text().lower() == expected
    visitor.wait("() => tippetopLab.player.time > 0.2")  # it plays
    visitor.pause(6.5)
    shades, share, middle = visitor.ask(COLOURS)
    assert shades > 100, "lit, not flat"
    assert 0.01 < share < 0.3
    assert middle == pytest.approx(0.5, abs=0.1), "the camera follows the top"
    spins = critical_spins(tt.presets.report_problem())
    marks = page.locator(".lab-dial-marks").first.inner_text()
    assert f"{spins.upright:.1f}" in marks
    assert f"{spins.inverted:.1f}" in marks


def test_the_player_shows_the_simulation_at_any_time(server: str, visit: Callable) -> None:
    visitor = visit().open(f"{server}/?launch.spin=175&duration=10")
    times = np.sort(np.random.default_rng(4).uniform(0.0, 10.0, 200))
    exact = tt.simulate(tt.presets.report_problem(spin=175.0), 10.0, times=times)
    shown = visitor.ask(
        """(times) => times.map((t) => { const { orientation, position } = tippetopLab.player.track.at(t);
        return [...orientation, ...position]; })""",
        times.tolist(),
    )
    quaternions, positions = np.array(shown)[:, :4], np.array(shown)[:, 4:]
    overlap = np.abs(np.einsum("ij,ij->i", quaternions, exact["orientation"].values))
    assert 2 * np.arccos(np.clip(overlap, 0, 1)).max() < 5e-3
    assert positions == pytest.approx(exact[["x", "y", "height"]].to_array().values.T, abs=2e-5)
    flights = visitor.ask("() => tippetopLab.player.track.header.flights")
    run = tt.simulate(tt.presets.report_problem(spin=175.0), 10.0)
    assert np.array(flights)[:, 0] == pytest.approx(run["flight_start"].values)


def test_dragging_a_slider_simulates_at_once(server: str, visit: Callable) -> None:
    visitor = visit().open(server)
    visitor.pause()
    box = visitor.page.locator(SLIDER).first.bounding_box()
    middle = box["y"] + box["height"] / 2
    visitor.page.mouse.move(box["x"] + box["width"] * 155 / 250, middle)
    visitor.page.mouse.down()
    visitor.page.mouse.move(box["x"] + box["width"] * 60 / 250, middle, steps=6)
    visitor.page.mouse.move(box["x"] + box["width"] * 20 / 250, middle, steps=6)
    visitor.page.mouse.up()
    visitor.launched("problem.launch.spin < 25")
    spin = visitor.ask("() => tippetopLab.player.track.header.problem.launch.spin")
    headline = tell(tt.simulate(tt.presets.report_problem(spin=spin), 20.0)).headline
    visitor.wait("(words) => document.querySelector('.tt-words strong').textContent === words", headline)
    visitor.wait("(spin) => document.querySelector('.lab-dial input').value === String(spin)", spin)
    visitor.wait("(spin) => new URLSearchParams(location.search).get('launch.spin') === String(spin)", spin)


def test_time_is_one_for_scene_plots_and_strip(server: str, visit: Callable) -> None:
    visitor = visit().open(f"{server}/?launch.spin=175")
    visitor.pause(5.0)
    strip = visitor.page.locator(".tt-scrub input")
    box = strip.bounding_box()
    visitor.page.mouse.click(box["x"] + 0.4 * box["width"], box["y"] + box["height"] / 2)
    visitor.wait("() => Math.abs(tippetopLab.player.time - 8) < 0.1")
    visitor.page.locator(".lab-plots-overlay").scroll_into_view_if_needed()
    plot = visitor.page.locator(".lab-plots-overlay").bounding_box()
    first, last = plot["x"] + 58, plot["x"] + plot["width"] / 2 - 14
    visitor.page.mouse.move(first + 5, plot["y"] + 90)
    visitor.page.mouse.down()
    visitor.page.mouse.move(first + 0.25 * (last - first), plot["y"] + 90, steps=4)
    visitor.page.mouse.up()
    visitor.wait("() => Math.abs(tippetopLab.player.time - 5) < 0.1")
    cursor = visitor.page.locator(".lab-plot-cursor").first.bounding_box()
    assert cursor["x"] == pytest.approx(first + 0.25 * (last - first), abs=2.5)
    shown = float(visitor.page.locator(".lab-plot-title b").first.inner_text())
    time = visitor.ask("() => tippetopLab.player.time")
    theta = tt.simulate(tt.presets.report_problem(spin=175.0), 20.0, times=[0.0, time])["theta"][-1]
    assert shown == pytest.approx(float(theta), abs=5e-3)  # straight between samples


def test_everything_is_within_reach_of_the_keyboard(server: str, visit: Callable) -> None:
    visitor = visit().open(server)
    visitor.pause(1.0)
    page = visitor.page
    page.locator("canvas.tt-canvas").focus()
    page.keyboard.press("ArrowRight")
    assert visitor.ask("() => tippetopLab.player.time") == pytest.approx(1.0 + 1 / 60)
    page.keyboard.press(" ")
    visitor.wait("() => tippetopLab.player.playing && tippetopLab.player.time > 1.05")
    page.keyboard.press(" ")
    assert not visitor.ask("() => tippetopLab.player.playing")
    page.locator("[data-do=speed]").select_option(label="1/1000")
    start = visitor.ask("() => { tippetopLab.player.seek(2); return 2; }")
    page.locator("canvas.tt-canvas").focus()
    page.keyboard.press("ArrowRight")
    assert visitor.ask("() => tippetopLab.player.time") == pytest.approx(start + 1 / 60_000)
    seen = set()
    page.locator("body").click(position={"x": 3, "y": 3})
    for _ in range(40):
        page.keyboard.press("Tab")
        seen.add(
            visitor.ask(
                """() => { const e = document.activeElement; return e.getAttribute("aria-label") ||
                (e.matches("button, a") && e.textContent.trim()) ||
                e.closest("[aria-label]")?.getAttribute("aria-label"); }"""
            )
        )
    wanted = {"Play", "Time", "Speed", "View", "Spin ω₃ (rad/s)", "Tilt θ (rad)", "Friction μ", "Zoom in"}
    assert wanted <= seen


def test_what_cannot_be_is_refused_with_a_sentence(server: str, visit: Callable) -> None:
    visitor = visit().open(f"{server}/?launch.tilt=9")
    page = visitor.page
    assert "launch.tilt = 9 is not possible" in page.locator(".lab-refused").inner_text()
    assert visitor.ask("() => tippetopLab.player.track.header.problem.launch.tilt") == 0.1
    number = page.get_by_label("Tilt θ (rad)").and_(page.locator("input"))
    number.fill("-1")
    number.press("Enter")
    page.get_by_text(
        re.compile("launch.tilt = -1.0 is not possible; accepted: a number at least 0")
    ).wait_for()
    number.fill("0.2")
    number.press("Enter")
    visitor.launched("problem.launch.tilt === 0.2")
    assert not page.locator(".lab-refused").is_visible()


def test_what_is_refused_does_not_spoil_what_is_asked_next(server: str, visit: Callable) -> None:
    visitor = visit().open(f"{server}/?contact.liftoff=stop&launch.spin=100")
    visitor.trouble = Forgiving("422")
    page = visitor.page
    page.get_by_text("How it is let go").click()
    gap = page.locator(".lab-dial", has_text="Gap below")
    gap.locator(SLIDER).focus()
    page.keyboard.press("ArrowRight")
    page.locator(".lab-refused", has_text="launch.gap").wait_for()
    visitor.wait("() => !tippetopLab.link.includes('launch.gap=0.001')")
    visitor.wait("(box) => box.value === '0'", gap.locator("input").element_handle())
    page.locator(SLIDER).first.focus()
    for _ in range(4):
        page.keyboard.press("ArrowRight")
    visitor.launched("problem.launch.spin === 102 && problem.launch.gap === 0")
    page.get_by_text("The top", exact=True).click()
    number = page.get_by_label("Inertia I₃ (mR²)").and_(page.locator("input"))
    before = number.input_value()
    number.fill("2")
    number.press("Enter")
    page.locator(".lab-refused", has_text="I3").wait_for()
    visitor.wait("([box, value]) => box.value === value", [number.element_handle(), before])


def test_a_launch_that_cannot_be_followed_is_gone_back_from(server: str, visit: Callable) -> None:
    visitor = visit().open(f"{server}/?launch.spin=100")
    visitor.trouble = Forgiving("422")
    page = visitor.page
    page.route("**/lab/track*", lambda route: route.fulfill(status=422, body="It gets too fast."))
    spin = page.locator(".lab-dial", has_text="Spin")
    spin.locator(SLIDER).focus()
    page.keyboard.press("ArrowRight")
    page.locator(".lab-refused", has_text="It gets too fast.").wait_for()
    visitor.wait("(box) => box.value === '100'", spin.locator("input").element_handle())
    page.unroute("**/lab/track*")
    page.locator(SLIDER).nth(1).focus()
    page.keyboard.press("ArrowRight")
    visitor.launched("problem.launch.tilt === 0.11 && problem.launch.spin === 100")
    page.locator(".lab-refused").wait_for(state="hidden")


def test_a_fault_of_the_player_is_not_laid_on_the_server(server: str, visit: Callable) -> None:
    visitor = visit().open(server)
    visitor.trouble = Forgiving("not a run")
    page = visitor.page
    page.route("**/lab/track*", lambda route: route.fulfill(body="something else"))
    page.locator(SLIDER).first.focus()
    page.keyboard.press("ArrowRight")
    page.locator(".lab-trouble", has_text="this is not a run").wait_for()
    page.unroute("**/lab/track*")
    page.keyboard.press("ArrowRight")
    visitor.launched("problem.launch.spin === 156")
    page.locator(".lab-trouble").wait_for(state="hidden")


def test_a_slider_by_powers_of_ten_keeps_every_step(server: str, visit: Callable) -> None:
    visitor = visit().open(server)
    visitor.pause()
    slider = visitor.page.locator(".lab-dial", has_text="Friction μ").locator("[role=slider]")
    assert slider.get_attribute("aria-valuetext") == "0.3"
    slider.locator(SLIDER).focus()
    for _ in range(40):
        visitor.page.keyboard.press("ArrowRight")
        visitor.page.wait_for_timeout(33)
    places = round(np.log10(0.3) + 0.01, 2) + 0.39
    visitor.launched(f"problem.friction.mu === {float(f'{10**places:.3g}')}")
    visitor.page.wait_for_timeout(400)  # Nothing pushes it back.
    assert float(slider.get_attribute("aria-valuenow")) == pytest.approx(places)
    assert slider.get_attribute("aria-valuetext") == f"{10**places:.3g}"
    mass = visitor.page.locator(".lab-dial", has_text="Mass").locator("[role=slider]")
    assert mass.get_attribute("aria-valuetext").endswith(" kg")


def test_a_run_that_takes_long_is_seen_to_come_and_plays_when_asked(server: str, visit: Callable) -> None:
    visitor = visit().open(server)
    page = visitor.page
    visitor.pause(3.0)
    held, holding = [], [True]
    page.route("**/lab/track*", lambda route: held.append(route) if any(holding) else route.continue_())
    page.locator(SLIDER).first.focus()
    page.keyboard.press("ArrowRight")
    page.locator(".lab-player[aria-busy=true]").wait_for()
    page.locator(".lab-controls .q-select").first.click()
    page.get_by_role("option", name="Fig. 9").click()
    visitor.wait("() => tippetopLab.link.includes('launch.spin=175')")
    assert len(held) == 1, "only one is on its way"
    holding.clear()
    held[0].continue_()
    visitor.launched("problem.launch.spin === 175")
    visitor.wait("() => tippetopLab.player.playing && tippetopLab.player.time < 3")
    assert page.locator(".lab-player[aria-busy]").count() == 0


def test_a_run_that_ended_at_its_launch_is_a_point(server: str, visit: Callable) -> None:
    visitor = visit().open(f"{server}/?contact.liftoff=stop&launch.precession=100&launch.tilt=1.5")
    assert visitor.ask("() => tippetopLab.player.duration") == 0
    painted = """() => { const canvas = document.querySelector(".lab-plots-host canvas");
      const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      let count = 0;
      for (let i = 0; i < data.length; i += 4) {
        if (data[i] === 11 && data[i + 1] === 95 && data[i + 2] === 165) count++;
      }
      return count; }"""
    visitor.wait(f"() => ({painted})() > 10")


def test_a_link_that_cannot_be_copied_is_shown(server: str, visit: Callable) -> None:
    visitor = visit().open(server)
    page = visitor.page
    visitor.ask("() => Object.defineProperty(navigator, 'clipboard', { value: undefined })")
    page.get_by_role("button", name="Copy link").click()
    field = page.get_by_label("Link to this launch").and_(page.locator("input"))
    field.wait_for()
    link = visitor.ask("() => tippetopLab.link")
    visitor.wait("(link) => getSelection().toString() === link", link)
    assert field.input_value() == link


def test_a_link_is_copied(server: str, visit: Callable) -> None:
    visitor = visit(permissions=["clipboard-read", "clipboard-write"]).open(server)
    visitor.page.get_by_role("button", name="Copy link").click()
    visitor.page.get_by_text("is on the clipboard").wait_for()
    assert visitor.ask("() => navigator.clipboard.readText()") == visitor.ask("() => tippetopLab.link")


def test_nothing_moves_by_itself_where_that_is_not_wanted(server: str, visit: Callable) -> None:
    visitor = visit(reduced_motion="reduce").open(server)
    visitor.page.wait_for_timeout(300)
    assert visitor.ask("() => [tippetopLab.player.playing, tippetopLab.player.time]") == [False, 0]
    visitor.page.locator(".tt-scrub input").focus()
    outline = "() => getComputedStyle(document.querySelector('.tt-scrub')).outlineStyle"
    assert visitor.ask(outline) == "solid", "the strip shows that it has the keyboard"


def test_both_ends_are_told_where_both_are_stable(server: str, visit: Callable) -> None:
    visitor = visit().open(f"{server}/?launch.spin=45&body.shape.eccentricity=0.1")
    assert "each is stable" in visitor.page.locator(".lab-prospect").inner_text()


def test_a_cell_of_the_map_is_a_launch(server: str, visit: Callable) -> None:
    visitor = visit().open(f"{server}/?duration=4")
    page = visitor.page
    page.get_by_role("button", name="Compute").click()
    page.locator(".lab-map-tip", has_text="Point at a cell").wait_for()
    page.locator(".lab-note", has_text="launches. Click one").wait_for()
    canvas = page.locator(".lab-map-chart")
    canvas.scroll_into_view_if_needed()
    box = canvas.bounding_box()
    page.mouse.move(box["x"] + 54 + 0.5 * (box["width"] - 64), box["y"] + box["height"] - 42)
    tip = page.locator(".lab-map-tip").inner_text()
    spin, mu, angle = (float(number) for number in re.findall(r"(?:spin|μ|at) ([\d.]+)", tip))
    page.mouse.down()
    page.mouse.up()
    visitor.launched(f"problem.launch.spin === {spin} && problem.friction.mu === {mu}")
    problem = visitor.ask("() => tippetopLab.player.track.header.problem")
    run = tt.simulate(tt.Problem(**problem), 4.0)
    assert np.degrees(float(run["theta"][-1])) == pytest.approx(angle, abs=0.051)
    canvas.focus()
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("Enter")
    two_to_the_left = spin - 2 * 250 / COLUMNS
    visitor.launched(
        f"Math.abs(problem.launch.spin - {two_to_the_left}) < 0.1 && problem.friction.mu === {mu}"
    )


def test_a_cell_is_launched_as_the_map_was_computed(server: str, visit: Callable) -> None:
    visitor = visit().open(f"{server}/?duration=2")
    page = visitor.page
    page.get_by_role("button", name="Compute").click()
    page.get_by_role("button", name="Stop").wait_for()
    page.locator(".lab-note", has_text="launches. Click one").wait_for()
    page.get_by_role("button", name="Compute again").wait_for()
    marked = "() => Boolean(tippetopLab.map.now)"
    assert visitor.ask(marked)
    number = page.get_by_label("Tilt θ (rad)").and_(page.locator("input"))
    number.fill("1")
    number.press("Enter")
    visitor.launched("problem.launch.tilt === 1")
    visitor.wait(f"() => !({marked})()")
    canvas = page.locator(".lab-map-chart")
    canvas.focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("Enter")
    visitor.launched("problem.launch.tilt === 0.1 && problem.launch.spin < 4")
    visitor.wait(marked)
    assert number.input_value() == "0.1"


def test_a_map_can_be_stopped(server: str, visit: Callable) -> None:
    visitor = visit().open(f"{server}/?duration=60")
    page = visitor.page
    page.get_by_role("button", name="Compute").click()
    page.get_by_role("button", name="Stop").click()
    page.locator(".lab-note", has_text="Stopped").wait_for()
    page.wait_for_timeout(3000)
    assert "Stopped" in page.locator(".lab-note").inner_text(), "nothing more comes of it"
    page.get_by_role("button", name="Compute again").click()
    page.locator(".lab-note", has_text="launches followed").wait_for()
    page.get_by_role("button", name="Stop").click()
    page.get_by_role("button", name="Compute again").wait_for()


def test_a_cell_without_a_final_tilt_says_why(server: str, visit: Callable) -> None:
    visitor = visit().open(f"{server}/?contact.liftoff=stop&duration=8")
    page = visitor.page
    page.get_by_role("button", name="Compute").click()
    page.locator(".lab-note", has_text="launches. Click one").wait_for()
    canvas = page.locator(".lab-map-chart")
    canvas.scroll_into_view_if_needed()
    box = canvas.bounding_box()
    page.mouse.move(box["x"] + box["width"] - 16, box["y"] + 40)
    assert "leaves the table, where the run stops" in page.locator(".lab-map-tip").inner_text()


def test_two_visitors_do_not_disturb_each_other(server: str, visit: Callable) -> None:
    one, two = visit().open(f"{server}/?launch.spin=100"), visit().open(f"{server}/?launch.spin=50")
    one.pause()
    two.pause()
    for visitor, key in ((one, "ArrowRight"), (two, "ArrowLeft")):
        visitor.page.locator(SLIDER).first.focus()
        for _ in range(4):
            visitor.page.keyboard.press(key)
    one.launched("problem.launch.spin === 102")
    two.launched("problem.launch.spin === 48")
    one.page.locator(SLIDER).nth(1).focus()
    one.page.keyboard.press("ArrowRight")
    one.launched("problem.launch.spin === 102 && problem.launch.tilt > 0.1")
    assert two.ask("() => tippetopLab.player.track.header.problem.launch") | {"slip": None} == {
        "spin": 48, "tilt": 0.1, "azimuth": 0, "tilt_rate": 0, "precession": 0, "gap": 0, "slip": None,
    }  # fmt: skip


def test_a_link_holds_the_launch(server: str, visit: Callable) -> None:
    query = (
        "launch.spin=120&launch.slip=%5B0.1%2C0.0%5D&friction.kind=regularized_coulomb&friction.mu=0.2"
        "&friction.eps=0.002&contact.liftoff=stop&body.shape.eccentricity=0.25&gravity=9.81&duration=7"
    )
    visitor = visit().open(f"{server}/?{query}")
    problem = tt.Problem(**visitor.ask("() => tippetopLab.player.track.header.problem"))
    assert problem.friction == tt.RegularizedCoulombFriction(mu=0.2, eps=0.002)
    assert problem.launch.slip == (0.1, 0.0)
    link = visitor.ask("() => tippetopLab.link")
    other = visit().open(link)
    assert tt.Problem(**other.ask("() => tippetopLab.player.track.header.problem")) == problem
    assert parse_qs(urlparse(link).query)["duration"] == ["7"]


def test_downloads_open_again(files: dict[str, Path]) -> None:
    problem = tt.presets.report_problem(spin=175.0)
    run = tt.read_run(files["nc"])
    assert tt.Problem.from_json(run.attrs["problem"]) == problem
    assert float(run["time"][-1]) == 7.0
    assert tt.Problem.read(files["toml"]) == problem
    assert tomllib.loads(files["toml"].read_text())["launch"]["spin"] == 175.0
    assert len(files["csv"].read_text().splitlines()) == run.sizes["time"] + 1
    model = pytest.importorskip("pygltflib").GLTF2().load(str(files["glb"]))
    assert len(model.animations) == 1


def test_the_html_file_plays_without_a_network(files: dict[str, Path], visit: Callable) -> None:
    visitor = visit(offline=True)
    visitor.page.goto(files["html"].as_uri())
    visitor.wait("() => globalThis.tippetopPlayer?.time > 0.1")
    assert "leaves the table" in visitor.page.locator(".tt-words strong").inner_text()
    assert [url for url in visitor.requests if not url.startswith(("file:", "blob:", "data:"))] == []


def test_the_html_file_waits_where_motion_is_not_wanted(files: dict[str, Path], visit: Callable) -> None:
    visitor = visit(offline=True, reduced_motion="reduce")
    visitor.page.goto(files["html"].as_uri())
    visitor.wait("() => globalThis.tippetopPlayer?.frames > 0")
    assert not visitor.ask("() => tippetopPlayer.playing")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_page_fits_a_phone_in_light_and_dark(server: str, visit: Callable, scheme: str) -> None:
    visitor = visit(
        viewport={"width": 390, "height": 780}, color_scheme=scheme, has_touch=True, is_mobile=True
    ).open(server)
    assert visitor.ask("() => document.documentElement.scrollWidth") <= 390
    assert visitor.ask("() => tippetopLab.player.dark") is (scheme == "dark")
    ink, paper = visitor.ask(
        """() => { const s = getComputedStyle(document.querySelector(".lab-controls"));
        return [s.color, s.backgroundColor].map((c) => c.match(/[\\d.]+/g).slice(0, 3).map(Number)); }"""
    )
    bright, dim = sorted((luminance(ink), luminance(paper)), reverse=True)
    assert (bright + 0.05) / (dim + 0.05) > 7, "text is told from its background (WCAG AAA)"
    small = visitor.ask(
        """() => [...document.querySelectorAll(".tt-bar button")].map((b) => b.getBoundingClientRect())
        .filter((box) => Math.min(box.width, box.height) < 32).length"""
    )
    assert small == 0, "buttons are large enough for a thumb"
