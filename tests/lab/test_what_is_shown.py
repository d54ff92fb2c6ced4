"""What the page shows is so: maps, turns, verdicts and numbers."""

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import tippetop as tt
from browsing import Visit
from bundled import found_in_the_page
from campaigns import among
from tippetop.results.account import Clause
from tippetop.results.account_text import phrase

Lab = Callable[..., Visit]

SIXTH = math.pi / 3


def test_answers_belong_to_the_map_that_asked_for_them(lab: Lab) -> None:
    visitor = lab("tab=map&duration=1")
    page = visitor.page
    page.get_by_role("button", name="Compute the map").click()
    visitor.wait("() => tippetopLab.state.map.count > 10")
    visitor.ask("() => { globalThis.first = tippetopLab.state.map; }")
    page.get_by_role("tab", name="Launch").click()
    page.locator(".mapping", has_text="launches followed").wait_for()
    visitor.ask("() => tippetopLab.change({ 'friction.kind': 'coulomb', duration: 2 })")
    page.get_by_role("tab", name="Map").click()
    page.locator(".mapping").get_by_role("button", name="Stop").click()
    page.get_by_text("Stopped: ").wait_for()
    followed = visitor.ask("() => first.count")
    page.get_by_role("button", name="Compute it again").click()
    visitor.wait("() => tippetopLab.state.map !== first && tippetopLab.state.map.count > 30")
    assert visitor.ask("() => first.count") == followed, "the first map is at rest"
    page.locator(".mapping").get_by_role("button", name="Stop").click()
    plan, cells = visitor.ask(
        "() => { const { plan, cells } = tippetopLab.state.map; return [plan, cells]; }"
    )
    checked = 0
    for place, answer in enumerate(cells):
        if answer is None or checked == 6:
            continue
        row, column = divmod(place, len(plan["spins"]))
        launch = plan["setup"]["problem"]
        launch["launch"]["spin"] = plan["spins"][column]
        launch["friction"]["mu"] = plan["frictions"][row]
        run = tt.simulate(tt.Problem(**launch), 2.0, samples=2)
        assert answer["tilt"] == pytest.approx(float(run["final_tilt"]), abs=1e-3)
        checked += 1
    assert checked == 6


def test_a_map_marks_no_launch_that_is_not_on_it(lab: Lab) -> None:
    visitor = lab("tab=map&duration=1")
    page = visitor.page
    page.get_by_role("button", name="Compute the map").click()
    visitor.wait("() => tippetopLab.state.map.count > 3")
    page.locator(".mapping").get_by_role("button", name="Stop").click()
    pink = """() => { const { chart } = tippetopLab; chart.draw();
      const { width, height } = chart.canvas;
      const { data } = chart.canvas.getContext("2d").getImageData(0, 0, width, height);
      let count = 0;
      for (let i = 0; i < data.length; i += 4)
        if (data[i] === 0xd6 && data[i + 1] === 0x33 && data[i + 2] === 0x6c) count += 1;
      return count; }"""
    visitor.wait(f"() => ({pink})() > 10")
    visitor.ask("() => tippetopLab.change({ 'friction.kind': 'coulomb' })")
    visitor.wait(f"() => ({pink})() === 0")


PICTURES = """([from, count]) => { const { player } = tippetopLab;
  player.toggle(true);
  player.seek(from);
  player.last = 0;
  player.interval = 1 / 60; // whatever this machine's pictures took so far
  const turns = [];
  for (let k = 1; k <= count; k += 1) {
    const before = player.time;
    const { rate } = player.track.turning(before);
    player.advance((1000 * k) / 60);
    turns.push(rate * (player.time - before));
  }
  player.lastReading = -Infinity; // what was told before is not to stand
  player.draw();
  const said = document.querySelector(".tt-pace").textContent;
  player.toggle(false);
  return [turns, said]; }"""


def test_turns_are_seen_as_they_are(lab: Lab) -> None:
    """Up to a sixth of a turn a picture an eye sees which way round it goes."""
    visitor = lab("tab=launch&launch.spin=155&duration=4&t=0")
    for spin, said in ((155, "1/3 of"), (50, "real time"), (240, "1/5 of")):
        visitor.ask("(spin) => tippetopLab.change({ 'launch.spin': spin })", spin)
        visitor.launched(f"problem.launch.spin === {spin} && !tippetopLab.isAwaited")
        visitor.pause(0.0)
        turns, pace = visitor.ask(PICTURES, [0.5, 30])
        assert max(turns) <= SIXTH * 1.001
        assert min(turns) > 0.2 * SIXTH, "and no slower than it must be"
        assert said in pace
        late = visitor.ask(
            "() => { const { player } = tippetopLab; player.interval = 1 / 10;"
            " return player.track.turning(1).rate * player.gain(0.25); }"
        )
        assert late <= SIXTH * 1.001, "where pictures come late, too"


def test_a_top_has_one_mark_a_turn_that_blurs_as_it_turns(lab: Lab) -> None:
    visitor = lab("tab=launch&launch.spin=155&duration=4&t=1")
    for part in visitor.ask("() => tippetopLab.track.header.body.parts"):
        colours = part["colours"]
        turned = [colours[k:] + colours[:k] for k in range(1, len(colours))]
        assert colours not in turned, part["name"]
    visitor.ask(
        "() => { const { player } = tippetopLab; player.scene.draw(1, 0, 0);"
        " globalThis.sharp = Array.from("
        "player.scene.toy.getObjectByName('solid').geometry.attributes.color.array); }"
    )
    blurred = visitor.ask(
        """() => { const { player } = tippetopLab; player.scene.draw(1, 0, 0.005);
        const { array } = player.scene.toy.getObjectByName("solid").geometry.attributes.color;
        return array.filter((value, k) => Math.abs(value - sharp[k]) > 0.02).length / array.length;
        }"""
    )
    assert 0.05 < blurred < 0.6, "the edges of the mark, and not all of the top"
    again = visitor.ask(
        """() => { const { player } = tippetopLab; player.scene.draw(1, 0, 0);
        const { array } = player.scene.toy.getObjectByName("solid").geometry.attributes.color;
        return array.every((value, k) => value === sharp[k]); }"""
    )
    assert again, "at rest it is sharp"


def test_no_number_gives_the_answer_away(lab: Lab) -> None:
    visitor = lab("step=3")
    page = visitor.page
    visitor.ask("() => tippetopLab.player.seek(tippetopLab.player.duration)")
    visitor.wait("() => document.querySelector('.tt-facts').textContent.includes('−82')")
    assert not page.locator(".tt-facts").is_visible()
    page.get_by_role("button", name="Just show me").click()
    page.get_by_role("button", name="Tell me now").wait_for()
    assert not page.locator(".tt-facts").is_visible()
    assert not any(value.is_visible() for value in page.locator(".plots figcaption b").all())
    page.get_by_role("button", name="Tell me now").click()
    page.locator(".tt-facts").wait_for()


def test_a_film_shows_its_speed_and_is_not_cut_by_a_pause(lab: Lab, tmp_path: Path) -> None:
    visitor = lab("tab=keep&duration=2&t=0")
    page = visitor.page
    page.get_by_role("button", name="Film (WebM)").click()
    visitor.wait("() => tippetopLab.player.playing && tippetopLab.player.time > 0.05")
    assert visitor.ask("() => 1 / tippetopLab.player.paceAt(0.1)") >= 5, "30 pictures a second"
    page.get_by_role("button", name="Pause").click()
    page.wait_for_timeout(400)
    assert page.get_by_role("button", name="End the film").is_visible(), "a pause does not cut it"
    page.get_by_role("button", name="Play").click()
    visitor.wait("() => tippetopLab.player.time > 0.1")
    with page.expect_download() as download:
        page.get_by_role("tab", name="Story").click()  # leaving ends it
    download.value.save_as(tmp_path / "film.webm")
    assert (tmp_path / "film.webm").stat().st_size > 2_000
    assert not visitor.ask("() => tippetopLab.player.playing")


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ("friction.kind=viscous&friction.mu=0.3", "It can turn over"),
        ("friction.kind=coulomb&friction.mu=0.3", "does not turn over on this table"),
        ("friction.mu=0", "without friction nothing lifts it"),
        ("friction.kind=contensou", "no theory gives the spin"),
    ],
)
def test_the_verdict_on_a_top_is_that_of_the_set_table(lab: Lab, table: str, said: str) -> None:
    visitor = lab(f"tab=own&launch.spin=77&duration=1&{table}")
    page = visitor.page
    page.locator(".own-verdict", has_text=said).wait_for()
    page.get_by_role("button", name="Spin it").click()
    visitor.launched("Array.isArray(problem.body.shape)")
    spin = visitor.ask("() => tippetopLab.track.header.problem.launch.spin")
    assert (spin == 77) is ("viscous" not in table), "no spin is promised that would not do"
    try:
        tt.predict(tt.Problem(**{**_ball(visitor), "body": tt.presets.REPORT}))
        is_foreseen = True
    except tt.InvalidInput:
        is_foreseen = False
    assert is_foreseen is ("viscous" in table), "as the theory of predictions has it"


def _ball(visitor: Visit) -> dict[str, object]:
    problem: dict[str, object] = visitor.ask("() => tippetopLab.track.header.problem")
    return problem


FOLLOWED = """
import { simulate, timeDigits } from "engine";
import { PRESETS } from "./presets.js";
import { phrase } from "./words.js";
const others = %s;
const all = [...PRESETS.map(({ key, setup }) => [key, setup]), ...others];
const launches = all.filter((_, k) => k %% 4 === %d);
export const found = launches.map(([name, { problem, duration }]) => {
  const run = simulate(problem, { duration });
  const account = run.account.map(({ name, numbers }) => [name, numbers]);
  const digits = timeDigits(problem, { duration });
  const units = { spin: "rad/s", angle: "deg" };
  const texts = run.account.map((clause) => phrase(clause, units, digits[clause.name]));
  return [name, problem, duration, account, run.metrics, run.jumps, texts];
});
"""


def others() -> list[tuple[str, dict[str, object]]]:
    """Launches of bodies that the page's presets do not have, one of which rocks on dry friction,
    and a drop that bounces.
    """
    dry: dict[str, Any] = {"friction": tt.CoulombFriction(mu=0.3)}
    bouncing: dict[str, Any] = {"contact": tt.Contact(restitution=0.5)}
    bodies: dict[str, tuple[tt.Body, tt.Launch, dict[str, Any]]] = {
        "hurricane": (tt.presets.HURRICANE_BALLS, tt.Launch(tilt=0.5, spin=30.0), {}),
        "hurricane faster": (tt.presets.HURRICANE_BALLS, tt.Launch(tilt=0.3, spin=60.0), {}),
        "hurricane dry": (tt.presets.HURRICANE_BALLS, tt.Launch(tilt=0.5, spin=30.0), dry),
        "hurricane dry faster": (tt.presets.HURRICANE_BALLS, tt.Launch(tilt=0.3, spin=60.0), dry),
        "coin": (tt.presets.COIN, tt.Launch(tilt=0.5, spin=0.0), {}),
        "egg": (tt.presets.EGG, tt.Launch(tilt=0.1, spin=155.0), {}),
        "drop": (tt.presets.REPORT, tt.Launch(tilt=0.3, spin=60.0, gap=0.002), bouncing),
    }
    launches = []
    for name, (body, launch, table) in bodies.items():
        fields = {"friction": tt.ViscousFriction(mu=0.3), **table}
        problem = tt.Problem(body=body, launch=launch, **fields)
        plain = json.loads(problem.model_dump_json(exclude_none=True))
        launches.append((name, {"problem": plain, "duration": 2.0}))
    return launches


COMPARED = ("turnover_time", "arrival_time", "final_tilt", "final_spin", "energy_lost", "max_gap")


@pytest.mark.parametrize("part", among(range(4), check=1))
def test_page_and_python_say_the_same_of_every_launch(part: int) -> None:
    found = found_in_the_page(FOLLOWED % (json.dumps(others()), part))
    assert len(found) == (5, 5, 5, 4)[part]
    for name, problem, duration, account, metrics, jumps, texts in found:
        run = tt.simulate(tt.Problem(**problem), duration, samples=2)
        ours = tt.describe(run)
        assert [one for one, _ in account] == [clause.name for clause in ours.clauses], name
        for (clause, numbers), other in zip(account, ours.clauses, strict=True):
            assert numbers == pytest.approx(dict(other.numbers), rel=5e-4, abs=1e-9), (name, clause)
        theirs = [math.nan if metrics[one] is None else metrics[one] for one in COMPARED]
        expected = [float(run[one]) for one in COMPARED]
        assert theirs == pytest.approx(expected, rel=5e-4, abs=1e-9, nan_ok=True), name
        said = [clause for clause in ours.clauses if clause.name.startswith("flies")]
        assert jumps["count"] == (said[0].numbers["count"] if said else 0), name
        uncertainties = tt.time_uncertainties(run)
        for text, clause in zip(texts, ours.clauses, strict=True):
            assert text == phrase(clause, uncertainties.get(clause.name, 0.0)), name


PHRASED = """
import { phrase } from "./words.js";
const said = (time, digits) => phrase({ name: "sticks", numbers: { time } }, {}, digits);
export const found = [
  ...[0, 1, 2, undefined].map((digits) => said(1.2345, digits)),
  ...[0.0012345, 12.345].map((time) => said(time)),
];
"""


def test_a_time_that_chance_decides_has_no_digits_in_page_and_python() -> None:

    def said(time: float, uncertainty: float = 0.0) -> str:
        return phrase(Clause("sticks", {"time": time}, "motion"), uncertainty)

    ours = [said(1.2345, uncertainty) for uncertainty in (math.inf, 0.3, 0.05, 0.0)]
    ours += [said(0.0012345), said(12.345)]
    assert found_in_the_page(PHRASED) == ours
    assert "a time that chance decides" in ours[0]
    assert len(set(ours)) == 6


def test_a_drop_is_no_jump_and_two_balls_have_no_stem(lab: Lab) -> None:
    visitor = lab(
        "tab=compare&launch.gap=0.002&launch.tilt=0.3&launch.spin=60&duration=2"
        "&contact.restitution=0.5"
    )
    page = visitor.page
    page.get_by_role("button", name="Pin this run").click()
    jumps = page.locator("tr[data-metric=jumps] td").first
    jumps.wait_for()
    count = int(jumps.inner_text())
    assert f"{count} times" in page.locator(".tt-words").inner_text()
    highest = page.locator("tr[data-metric=max_jump_gap] td").first.inner_text()
    assert float(highest) < 1.0, "it was dropped from 2 mm"
    body = json.loads(tt.presets.HURRICANE_BALLS.model_dump_json(exclude_none=True))
    modes = visitor.ask(
        """(body) => { const { track } = tippetopLab; track.header.problem.body = body;
        return track.kindOf(1); }""",
        body,
    )
    assert modes == "other"


def test_digits_are_found_out_once_the_picture_is_shown(lab: Lab) -> None:
    visitor = lab("tab=launch&duration=2")
    visitor.wait("() => tippetopLab.track.digits && tippetopLab.player.frames > 0")
    order = visitor.ask(
        """async () => { const lab = tippetopLab; const order = [];
        const { digits } = lab.engine;
        lab.engine.digits = (setup) => {
          order.push("digits");
          return digits.call(lab.engine, setup);
        };
        lab.addEventListener("time", () => {
          const isNew = lab.player.track.header.asked === 3;
          if (isNew && !order.includes("picture")) order.push("picture");
        });
        await lab.go({ ...lab.state.setup, duration: 3 });
        while (!lab.track.digits) await new Promise((done) => setTimeout(done, 20));
        return order; }"""
    )
    assert order == ["picture", "digits"]


def test_a_slope_is_set_seen_and_told(lab: Lab) -> None:
    visitor = lab("tab=launch&table.slope=0.05&duration=1")
    page = visitor.page
    page.get_by_text("is on a table that slopes by").first.wait_for()
    level, sloping = visitor.ask(
        """() => [0, 0.05].map((slope) => {
          const { eye } = tippetopLab.player.scene;
          eye.standBeside({ slope, azimuth: 0 });
          let up;
          eye.drawFrom(() => { up = eye.camera.quaternion.toArray(); });
          return up;
        })"""
    )
    half_turn = sum(one * other for one, other in zip(level, sloping, strict=True))
    assert 2.0 * math.acos(min(abs(half_turn), 1.0)) == pytest.approx(0.05)
