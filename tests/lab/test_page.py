"""The page in a real browser, from its file and without a network, as its visitors use it."""

import json
import math
import re
from collections.abc import Callable
from pathlib import Path
from urllib.parse import quote

import numpy as np
import pandas as pd
import pytest

import tippetop as tt
from browsing import Visit
from bundled import found_in_the_page
from tippetop.export.solid import solids
from tippetop.results.catalogue import DERIVED

BEECH = 720.0
"""Density of the page's first material, kg/m^3."""

Lab = Callable[..., Visit]

PROBLEM = "tippetopLab.track.header.problem"


def problem_of(visitor: Visit) -> tt.Problem:
    return tt.Problem(**visitor.ask(f"() => {PROBLEM}"))


def settled(visitor: Visit, condition: str) -> None:
    """Wait until a launch is shown of which something holds, and that is no longer about to
    change.
    """
    visitor.wait(f"() => ((problem) => {condition})({PROBLEM}) && !tippetopLab.engine.busy")


def open_all(visitor: Visit) -> None:
    """Show every control of the launch."""
    for summary in visitor.page.locator(".controls summary").all():
        summary.click()


def headline(visitor: Visit) -> str:
    return str(visitor.page.locator(".tt-words strong").inner_text())


def test_the_page_is_one_small_file_that_asks_for_nothing(page: Path, lab: Lab) -> None:
    assert page.stat().st_size < 2_000_000
    visitor = lab("launch.spin=155")
    assert [
        url for url in visitor.requests if not url.startswith(("file:", "blob:", "data:"))
    ] == []
    run = tt.simulate(tt.presets.report_problem(), 20.0, samples=3)
    turns, since = (float(run[name]) for name in ("turnover_time", "settling_time"))
    assert headline(visitor) == (
        f"Turns over: its axis passes the horizontal at {turns:.2f} s; settles upside down:"
        f" from {since:.2f} s on it stays within 0.6° of that"
    )
    visitor.wait("() => tippetopLab.player.time > 0.2")  # it plays


def test_the_page_shows_the_same_motion_as_python(lab: Lab) -> None:
    visitor = lab("launch.spin=175&duration=8")
    times = np.sort(np.random.default_rng(4).uniform(0.0, 8.0, 100))
    exact = tt.simulate(tt.presets.report_problem(spin=175.0), 8.0, times=times)
    shown = visitor.ask(
        """(times) => times.map((t) => { const { orientation, position } = tippetopLab.track.at(t);
        return [...orientation, ...position]; })""",
        times.tolist(),
    )
    quaternions, positions = np.array(shown)[:, :4], np.array(shown)[:, 4:]
    overlap = np.abs(np.einsum("ij,ij->i", quaternions, exact["orientation"].values))
    assert 2 * np.arccos(np.clip(overlap, 0, 1)).max() < 2e-2
    assert positions == pytest.approx(exact[["x", "y", "height"]].to_array().values.T, abs=5e-5)
    flights = visitor.ask("() => tippetopLab.track.header.flights.map(([start]) => start)")
    assert flights == pytest.approx(exact["flight_start"].values, abs=1e-5)


def test_the_story_asks_first_and_then_shows_and_says_why(lab: Lab) -> None:
    visitor = lab()
    page = visitor.page
    assert page.locator(".story h2").inner_text() == "A top that stands on its head"
    assert not page.locator(".tt-words").is_visible(), "the answer is not given away"
    assert not page.locator(".plots-host").is_visible()
    page.get_by_role("button", name="Next").click()
    settled(visitor, "problem.launch.spin === 20")
    page.get_by_label("Stay upright").check()
    page.get_by_role("button", name="Spin it").click()
    page.get_by_role("button", name="Tell me now").wait_for()
    assert not page.locator(".tt-words").is_visible(), "what happens is seen before it is told"
    assert "watching" in focused(visitor)
    page.get_by_role("button", name="Tell me now").click()
    page.get_by_text("You were right.").wait_for()
    assert "answer" in focused(visitor)
    assert page.locator(".tt-words").is_visible()
    assert "critical spin" in page.locator(".answer").inner_text()
    for _ in range(8):
        page.get_by_role("button", name="Next").click()
    assert "Step 10 of 10" in page.locator(".step").inner_text()
    assert page.get_by_role("button", name="Next").is_disabled()


def focused(visitor: Visit) -> str:
    return str(visitor.ask("() => document.activeElement.className"))


def test_an_answer_is_told_once_it_has_been_seen(lab: Lab) -> None:
    visitor = lab()
    page = visitor.page
    page.get_by_role("button", name="Just show me").click()
    page.get_by_role("button", name="Tell me now").wait_for()
    visitor.wait("() => !tippetopLab.isAwaited && tippetopLab.player.playing")
    visitor.pause(1.0)
    visitor.wait("() => tippetopLab.player.time === 1")
    assert page.locator(".answer").count() == 0
    visitor.ask("() => tippetopLab.player.seek(tippetopLab.player.turnsOver + 0.7)")
    page.locator(".answer").wait_for()
    assert page.locator(".tt-words").is_visible()


def test_what_happens_is_spoken_as_it_happens(lab: Lab) -> None:
    visitor = lab("launch.spin=155")
    visitor.ask("""() => {
      globalThis.heard = [];
      const line = document.querySelector(".stage > [role=status]");
      new MutationObserver(() => heard.push(line.textContent)).observe(line, {
        childList: true, characterData: true, subtree: true });
      const { player } = tippetopLab;
      player.speed = 1;
      player.slow(false);
      player.seek(4);
      player.toggle(true);
    }""")
    visitor.wait("() => heard.includes('It stands upside down.')")
    heard = visitor.ask("() => heard")
    leans = [f"It leans {angle} degrees." for angle in (45, 90, 135)]
    assert [one for one in heard if one in leans] == leans


def test_a_refused_value_of_a_link_is_told_where_it_is_seen(lab: Lab) -> None:
    for link in ("duration=1e99", "launch.tilt_rate=abc"):
        visitor = lab()
        visitor.ask("(hash) => { location.hash = hash; }", link)
        visitor.page.locator(".refused").first.wait_for()
        assert visitor.page.locator(".refused").first.is_visible()
    german = lab("lang=de")
    assert german.page.locator(".story .step").inner_text() == "Schritt 1 von 10"


def test_every_control_is_explained_in_place(lab: Lab) -> None:
    visitor = lab("tab=launch")
    page = visitor.page
    open_all(visitor)
    dials = page.locator(".dial").count()
    assert dials >= 12
    for button in page.locator(".why").all():
        button.click()
    texts = page.locator(".why-text").all_inner_texts()
    assert len(texts) == dials
    assert all(len(text) > 20 for text in texts)
    page.get_by_role("button", name="What is what").click()
    assert "Jellett" in page.locator("dialog").inner_text()
    page.keyboard.press("Escape")
    page.locator("dialog").wait_for(state="detached")


def test_a_pinned_run_plays_beside_the_next(lab: Lab) -> None:
    visitor = lab("tab=compare&duration=12")
    page = visitor.page
    page.get_by_role("button", name="Pin this run").click()
    page.get_by_text("The same launch.").wait_for()
    visitor.ask("() => tippetopLab.change({'launch.spin': 175})")
    settled(visitor, "problem.launch.spin === 175")
    assert "155 rad/s → 175 rad/s" in page.locator(".pinned").inner_text()
    ours, theirs = (
        float(tt.simulate(tt.presets.report_problem(spin=spin), 12.0, samples=3)["turnover_time"])
        for spin in (175.0, 155.0)
    )
    cells = page.locator("tr[data-metric=turnover_time] td").all_inner_texts()
    assert [float(cell) for cell in cells] == pytest.approx([theirs, ours, ours - theirs], abs=1e-3)
    assert visitor.ask("() => tippetopLab.player.scene.ghosts.length") == 1
    other = lab(visitor.ask("() => tippetopLab.link().split('#')[1]"))
    other.wait("() => tippetopLab.player.scene.ghosts.length === 1")
    assert problem_of(other).launch.spin == 175.0


def test_the_camera_sinks_as_the_top_turns_over_unless_it_is_held(lab: Lab) -> None:
    visitor = lab("launch.spin=155")
    visitor.ask(
        "() => { tippetopLab.player.toggle(false); tippetopLab.player.scene.eye.release(); }"
    )
    down = """(t) => { const { player } = tippetopLab; player.seek(t); player.draw();
      return player.scene.eye.place[1]; }"""
    turned = visitor.ask("() => tippetopLab.player.turnsOver")
    high, low, after = (visitor.ask(down, time) for time in (1.0, turned, turned + 3.0))
    assert low > 1.45
    assert high == pytest.approx(after)
    assert high < 1.2
    visitor.ask("() => tippetopLab.player.scene.eye.turn(0.3, 0)")
    assert visitor.ask(down, turned) == pytest.approx(high, abs=0.01)
    visitor.page.get_by_role("button", name="Jump to the turning over").click()
    visitor.wait("(t) => tippetopLab.player.time > t - 0.79 && tippetopLab.player.playing", turned)
    assert visitor.page.locator(".tt-mode").inner_text() == "slides"


def test_a_top_of_ones_own_is_weighed_and_spun(lab: Lab, tmp_path: Path) -> None:
    visitor = lab("tab=own")
    page = visitor.page
    first = page.locator(".facts").inner_text()
    page.locator("[data-own=hollow]").focus()
    for _ in range(5):
        page.keyboard.press("ArrowLeft")
    assert page.locator(".facts").inner_text() != first
    page.locator(".own-verdict", has_text="turn over").wait_for()
    page.get_by_role("button", name="Spin it").click()
    settled(visitor, "Array.isArray(problem.body.shape)")
    body = problem_of(visitor).body
    assert len(body.shape) >= 2
    page.get_by_role("tab", name="Keep").click()
    with page.expect_download() as download:
        page.locator("[data-kind=stl]").click()
    download.value.save_as(tmp_path / "top.stl")
    piece = tt.Workpiece(profile=body.profile, density=BEECH)
    mass, center, across, along = piece.mass_properties
    assert (body.mass, body.I1, body.I3) == pytest.approx((mass, across, along), rel=1e-6)
    assert center == pytest.approx(0.0, abs=2e-9)
    trimesh = pytest.importorskip(
        "trimesh", reason="trimesh reads solids; it comes with the lathe extra"
    )
    printed = trimesh.load(tmp_path / "top.stl")
    assert printed.is_watertight
    (expected,) = solids(piece, 180).values()
    assert printed.volume == pytest.approx(expected.volume, rel=1e-5)
    assert printed.bounds == pytest.approx(expected.bounds, abs=1e-4)
    assert BEECH * 1e-9 * printed.volume == pytest.approx(body.mass, rel=2e-3), "but for the facets"


def test_downloads_open_again(lab: Lab, tmp_path: Path) -> None:
    visitor = lab("tab=keep&launch.spin=120&friction.mu=0.2&duration=3")
    files = {}
    for kind in ("csv", "toml", "glb", "picture"):
        with visitor.page.expect_download() as download:
            visitor.page.locator(f"[data-kind={kind}]").click()
        files[kind] = tmp_path / download.value.suggested_filename
        download.value.save_as(files[kind])
    problem = tt.presets.report_problem(spin=120.0, mu=0.2)
    written = tt.Problem.read(files["toml"])
    assert written.launch == problem.launch
    assert written.friction == problem.friction
    assert pytest.approx(problem.body.I1, rel=1e-12) == written.body.I1
    tt.write_csv(tt.simulate(written, 3.0), tmp_path / "python.csv")
    numbers, expected = (pd.read_csv(path) for path in (files["csv"], tmp_path / "python.csv"))
    expected = expected[[name for name in expected if not name.startswith(tuple(DERIVED))]]
    assert list(numbers.columns) == list(expected.columns)
    assert list(numbers["mode"]) == list(expected["mode"])
    for name in expected.columns.drop("mode"):
        within = 1e-6 * expected[name].abs().max() + 1e-12
        assert numbers[name].to_numpy() == pytest.approx(
            expected[name].to_numpy(), abs=within, nan_ok=True
        )
    model = pytest.importorskip("pygltflib").GLTF2().load(str(files["glb"]))
    assert len(model.animations) == 1
    assert files["picture"].read_bytes().startswith(b"\x89PNG")
    command = visitor.page.locator("pre").inner_text()
    assert "--set 'launch.spin=120'" in command
    assert "--duration 3" in command


def test_going_back_takes_back(lab: Lab) -> None:
    visitor = lab("tab=launch&launch.spin=100")
    number = visitor.page.get_by_label("Spin ω₃ (rad/s)").and_(
        visitor.page.locator("input[type=text]")
    )
    number.fill("60")
    number.press("Enter")
    settled(visitor, "problem.launch.spin === 60")
    visitor.page.locator("h1").click()
    visitor.page.keyboard.press("Control+z")
    settled(visitor, "problem.launch.spin === 100")
    assert number.input_value() == "100"


def test_what_cannot_be_is_refused_at_its_control_in_the_visitors_units(lab: Lab) -> None:
    visitor = lab("tab=launch")
    number = visitor.page.get_by_label("Tilt θ (°)").and_(visitor.page.locator("input[type=text]"))
    number.fill("200")
    number.press("Enter")
    said = visitor.page.locator(".dial .refused")
    said.wait_for()
    assert said.inner_text() == "Tilt: 200° is not a number at least 0 and at most 180°."
    assert number.get_attribute("aria-invalid") == "true"
    assert problem_of(visitor).launch.tilt == 0.1
    number.fill("11.459155902616466")
    number.press("Enter")
    settled(visitor, "Math.abs(problem.launch.tilt - 0.2) < 1e-9")
    assert not said.is_visible()
    spin = visitor.page.get_by_label("Spin ω₃ (rad/s)").and_(
        visitor.page.locator("input[type=text]")
    )
    spin.fill("1e7")
    spin.press("Enter")
    visitor.page.get_by_text("Spin of 1.00e+7 rad/s means").wait_for()


@pytest.mark.parametrize(
    ("language", "refused"),
    [
        (
            "en",
            [
                ("launch.spin", "", "Spin: “” is not a number."),
                (
                    "body.I3",
                    "5",
                    "Inertia along: 5 mR² is more than any body with this I1 has"
                    " (write at most 2 I1 = 0.7485 mR²).",
                ),
            ],
        ),
        (
            "de",
            [
                ("launch.tilt", "x", "Neigung: „x“ ist nicht möglich, nur eine Zahl."),
                (
                    "rolling_resistance",
                    "50",
                    "Rollwiderstand: 50 mm ist nicht möglich, nur eine Länge von 0 bis 20 mm,"
                    " der Größe dieses Körpers.",
                ),
            ],
        ),
    ],
)
def test_bounds_are_told_in_the_units_and_the_language_of_the_dial(
    lab: Lab, language: str, refused: list[tuple[str, str, str]]
) -> None:
    visitor = lab(f"tab=launch&lang={language}&duration=1")
    open_all(visitor)
    for field, typed, sentence in refused:
        dial = visitor.page.locator(f'.dial:has([data-field="{field}"])')
        number = dial.locator(".dial-number")
        before = number.input_value()
        number.fill(typed)
        number.press("Enter")
        dial.locator(".refused").wait_for()
        assert dial.locator(".refused").inner_text() == sentence
        assert number.input_value() == before


def test_numbers_have_the_decimal_sign_of_the_language(lab: Lab) -> None:
    visitor = lab("tab=launch&lang=de&t=1.5")
    number = visitor.page.get_by_label("Reibung μ (s/m)").and_(
        visitor.page.locator("input[type=text]")
    )
    assert number.input_value() == "0,3"
    assert visitor.page.locator(".tt-time").inner_text() == "1,500 s"
    number.fill("0,25")
    number.press("Enter")
    settled(visitor, "problem.friction.mu === 0.25")


def group(ratio: float) -> tt.Body:
    """The report's top with other moments of inertia: I1 over I3."""
    body = tt.presets.report_problem().body
    return body.model_copy(update={"I1": ratio * body.I3})


def link_of(body: tt.Body) -> str:
    fields = body.model_dump(mode="json", exclude={"profile"})
    return "&".join(f"body.{name}={quote(json.dumps(value))}" for name, value in fields.items())


@pytest.mark.parametrize(
    ("body", "launch", "said"),
    [
        (tt.presets.COIN, "launch.spin=0&launch.tilt=0.5", "Lies down on its face"),
        (
            tt.presets.HURRICANE_BALLS,
            "launch.spin=60&launch.tilt=0.3",
            "Rocks from one surface to another",
        ),
    ],
)
def test_the_headline_is_true_of_other_bodies(
    lab: Lab, body: tt.Body, launch: str, said: str
) -> None:
    assert headline(lab(f"tab=launch&duration=3&{launch}&{link_of(body)}")).startswith(said)


@pytest.mark.parametrize(
    ("language", "said"),
    [
        ("en", "Implausible: the spin at launch is 12000 rad/s, beyond 10000 rad/s."),
        ("de", "Unplausibel: Die Drehung beim Start"),
    ],
)
def test_an_implausible_launch_is_said_to_be_so_beside_the_headline(
    lab: Lab, language: str, said: str
) -> None:
    visitor = lab(f"lang={language}&launch.spin=12000&duration=1")
    visitor.page.locator(".tt-words", has_text=said).wait_for()
    visitor.ask("() => tippetopLab.change({ 'launch.spin': 155 })")
    settled(visitor, "problem.launch.spin === 155")
    doubt = visitor.page.locator(".tt-words", has_text=said.partition(":")[0])
    doubt.wait_for(state="detached")


@pytest.mark.parametrize(
    "body",
    [*(group(ratio) for ratio in (0.6, 0.94, 1.4)), tt.presets.EGG],
    ids=["one mark", "two marks", "the other mark", "an egg"],
)
def test_of_the_marks_no_more_is_said_than_holds(lab: Lab, body: tt.Body) -> None:
    """Between two a sphere rises half-way, and beyond turns over; of one, or an egg, a change is
    known.
    """
    visitor = lab(f"tab=launch&duration=1&{link_of(body)}")
    said = visitor.page.locator(".prospect", has_text=re.compile("ω_c[12] =")).inner_text()
    spins = tt.critical_spins(problem_of(visitor))
    marks = {"ω_c1": spins.upright, "ω_c2": spins.inverted}
    shown = [name for name, spin in marks.items() if math.isfinite(spin) and spin < 250.0]
    assert [name for name in marks if f"{name} =" in said] == shown
    claims = (
        len(shown) == 2
        and spins.upright < spins.inverted
        and isinstance(body.shape, tt.EccentricSphere)
    )
    assert ("turns over completely" in said) is claims
    assert said.count("changes between stable and unstable") == (0 if claims else len(shown))


BOUNDS = [
    ("body.I3", "5", r"2 I1 = (\S+) mR²", "problem.body.I3 > 1.999 * problem.body.I1"),
    ("launch.tilt", "200", r"at most (\S+)°", "problem.launch.tilt > 3.14"),
    ("rolling_resistance", "50", r"to (\S+) mm", "problem.rolling_resistance > 0.0199"),
    ("friction.patch_radius", "50", r"to (\S+) mm", "problem.friction.patch_radius > 0.0199"),
]


def test_a_bound_that_is_told_is_possible(lab: Lab) -> None:
    visitor = lab("tab=launch&friction.kind=contensou&duration=1")
    open_all(visitor)
    visitor.ask("() => { globalThis.first = tippetopLab.state.setup; }")
    for field, typed, bound, condition in BOUNDS:
        visitor.ask("() => tippetopLab.go(first, { play: false })")
        number = visitor.page.locator(f'.dial:has([data-field="{field}"]) .dial-number')
        said = visitor.page.locator(".dial .refused")
        number.fill(typed)
        number.press("Enter")
        said.wait_for()
        told = re.search(bound, said.inner_text())
        assert told, said.inner_text()
        number.fill(told[1])
        number.press("Enter")
        settled(visitor, condition)
        assert not said.is_visible()


def test_what_a_link_leaves_out_is_missing(page: Path, lab: Lab) -> None:
    """It is told above all controls: what is missing has none."""
    visitor = lab("tab=launch")
    shape = quote('{"kind":"eccentric_sphere","radius":0.02}')
    visitor.page.goto(f"{page.as_uri()}#tab=launch&body.shape={shape}")
    visitor.page.reload()
    visitor.page.locator(".refused", has_text="Eccentricity is missing.").wait_for()


def test_a_map_leads_to_its_launches(lab: Lab) -> None:
    visitor = lab("tab=map&duration=1")
    page = visitor.page
    page.get_by_role("button", name="Compute the map").click()
    page.locator(".mapping", has_text=re.compile(r"[1-9]\d* of")).wait_for()
    page.locator(".chart canvas").focus()
    for key in ("ArrowRight", "ArrowRight"):
        page.keyboard.press(key)
    page.locator(".map .tip", has_text="s/m").wait_for()
    page.keyboard.press("Enter")
    settled(visitor, "problem.launch.spin < 60 && problem.friction.mu < 0.1")
    if page.get_by_role("button", name="Stop").count():
        page.get_by_role("button", name="Stop").click()


FORESEEN = """
import { readLaunch } from "./link.js";
import { foresee } from "../run/foresee.js";
const links = ["spin=20", "spin=50", "spin=155", "spin=90&launch.precession=12"];
export const found = links.map((link) => {
  const { problem } = readLaunch(new URLSearchParams(`launch.${link}`)).setup;
  return [problem, foresee(problem)];
});
"""


def test_what_is_foreseen_is_what_the_theory_says() -> None:
    for fields, told in found_in_the_page(FORESEEN):
        problem = tt.Problem(**fields)
        spins, expected = tt.critical_spins(problem), tt.predict(problem)
        critical = {"upright": spins.upright, "inverted": spins.inverted}
        assert told["critical"] == pytest.approx(critical)
        (end,) = told["ends"]
        assert end["kind"] == expected.final.kind.value
        for name in ("tilt", "spin", "precession"):
            assert end[name] == pytest.approx(getattr(expected.final, name), rel=1e-6, abs=1e-6)


def test_critical_spins_are_marked_at_the_slider(lab: Lab) -> None:
    visitor = lab("tab=launch&duration=1&launch.spin=155")
    visitor.wait("() => document.querySelectorAll('.dial-marks span').length === 2")


def test_the_page_runs_where_no_code_may_be_made(
    page: Path, tmp_path: Path, visit: Callable[..., Visit]
) -> None:
    """Under a policy of content security without unsafe-eval, as schools' servers send one."""
    policy = (
        "default-src 'none'; script-src 'unsafe-inline'; worker-src blob:; style-src"
        " 'unsafe-inline'; img-src data: blob:"
    )
    told = f'<meta http-equiv="Content-Security-Policy" content="{policy}">'
    asked = (
        "<script>try { new Function('')(); } catch (error) { globalThis.refused = error.name;"
        " }</script>"
    )
    strict = tmp_path / "lab.html"
    text = page.read_text(encoding="utf-8")
    assert "<head>" in text
    strict.write_text(text.replace("<head>", f"<head>{told}{asked}", 1), encoding="utf-8")
    visitor = visit(offline=True, locale="en-US")
    visitor.open(f"{strict.as_uri()}#tab=launch&launch.spin=155", "globalThis.tippetopLab?.track")
    assert visitor.ask("() => refused") == "EvalError"
    visitor.page.locator(".tt-words strong", has_text="Turns over").wait_for()
