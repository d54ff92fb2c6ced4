"""A class collects the results of its groups in one plot, and a hand flicks the top."""

import time
from collections.abc import Callable
from typing import Any

import tippetop as tt
from browsing import Visit
from bundled import found_in_the_page

Lab = Callable[..., Visit]

RESULTS = """
import { launchQuery } from "./link.js";
import { FIRST, changed } from "./setup.js";
import { readResults as readAll, resultCode, resultLink, spinsOf } from "./results.js";
const readResults = (text) => readAll(text, FIRST);
const run = { problem: { launch: { spin: 123.456 } }, metrics: { final_tilt: Math.PI / 2 } };
const code = resultCode(run);
export const found = {
  code,
  back: readResults(code),
  link: readResults(resultLink("https://school/lab.html", new URLSearchParams("tab=class"), run)),
  none: readResults(resultLink(
    "https://school/lab.html", launchQuery(changed(FIRST, { "friction.mu": 0 })), run)),
  odd: readResults("99999 90\\n-155 179.9\\n−50 86.1"),
  bare: readResults("https://school/lab.html#launch.spin=155"),
  mixed: readResults("155 179,9\\n\\nabout 12\\n50;86.1°\\n20 200\\n"),
  spins: spinsOf(4, 10, 100),
};
"""


def test_result_codes_are_read_back() -> None:
    found = found_in_the_page(RESULTS)
    assert found["code"] == "123.5 90.0"
    assert found["back"] == {"points": [[123.5, 90.0]], "wrong": [], "others": []}
    assert found["link"] == found["back"], "a link brings its result along"
    assert found["none"] == {"points": [], "wrong": [], "others": [1]}, "from another table"
    assert found["odd"] == {"points": [[-155, 179.9], [-50, 86.1]], "wrong": [1], "others": []}
    assert found["bare"] == {"points": [], "wrong": [1], "others": []}
    assert found["mixed"] == {"points": [[155, 179.9], [50, 86.1]], "wrong": [3, 5], "others": []}
    assert found["spins"] == [10, 40, 70, 100]


def test_a_class_makes_one_diagram(lab: Lab) -> None:
    visitor = lab("tab=class&launch.spin=50&duration=12")
    page = visitor.page
    assert page.locator(".codes li").count() == 8
    assert "tippetop lab --host" in page.locator(".classroom .refused").inner_text()
    tilt = float(tt.simulate(tt.presets.report_problem(spin=50.0), 12.0, samples=2)["final_tilt"])
    code = page.locator(".mine").inner_text()
    assert code == f"50 {tilt * 57.29577951308232:.1f}"
    page.locator(".classroom textarea:not(.links)").fill(f"{code}\n155 179.9\nnothing\n")
    assert page.locator(".scatter .dot").count() == 2
    assert "lines 3" in page.locator(".classroom [role=alert]").inner_text()
    address = page.locator(".codes a").last.get_attribute("href")
    assert address is not None
    page.get_by_role("combobox", name="Language").select_option("de")
    page.locator(".mine", has_text=code.replace(".", ",")).wait_for()
    group = lab(address.partition("#")[2])
    group.launched("problem.launch.spin === 150")


def flick(page: Any, x: float, y: float) -> None:
    """Drag to the right for 60 ms and let go, by a hand whose speed is not that of the machine."""
    begun = time.time() - 0.1
    mouse = page.context.new_cdp_session(page)

    def send(kind: str, step: int) -> None:
        place = {"x": x + 20 * min(step, 6), "y": y, "button": "left", "clickCount": 1}
        event = {"type": kind, "timestamp": begun + 0.01 * step, "buttons": 1, **place}
        mouse.send("Input.dispatchMouseEvent", event)

    send("mousePressed", 0)
    for step in range(1, 7):
        send("mouseMoved", step)
    send("mouseReleased", 7)


def test_a_flick_of_the_top_launches_it(lab: Lab) -> None:
    visitor = lab("tab=launch&t=0")
    visitor.pause(0.0)
    page = visitor.page
    box = page.locator("canvas.tt-canvas").bounding_box()
    assert box is not None
    x, y = box["x"] + 0.5 * box["width"], box["y"] + 0.6 * box["height"]
    flick(page, x, y)
    visitor.launched("problem.launch.spin !== 155 && problem.launch.spin > 5")
    assert 0.0 < visitor.ask("() => tippetopLab.track.header.problem.launch.spin") <= 250.0
    assert visitor.ask("() => tippetopLab.player.scene.controls.enabled")
