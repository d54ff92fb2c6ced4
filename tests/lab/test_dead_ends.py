"""Whatever is typed, opened or linked, the page stands, and says what it does not accept."""

import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import tippetop as tt
from browsing import DROP, Visit

Lab = Callable[..., Visit]

CASES = 40
"""Random links, and damaged files, that are tried."""

PANEL = "() => document.querySelector('.panel-body').innerText.trim().length"


def field(visitor: Visit, name: str) -> Any:
    return visitor.page.locator(f'.dial:has([data-field="{name}"]) .dial-number')


def enter(visitor: Visit, name: str, text: str) -> None:
    field(visitor, name).fill(text)
    field(visitor, name).press("Enter")


@pytest.mark.parametrize(
    ("language", "entries"),
    [
        (
            "en",
            {
                "1480rpm": 1480 * 3.14159265 / 30,
                "20 turns/s": 20 * 2 * 3.14159265,
                "0.1k": None,
                "1,000": 1000.0,
                "1,5": 1.5,
                "−90": -90.0,
            },
        ),
        ("de", {"1.000": 1000.0, "0,125": 0.125, "1480,5 rpm": 1480.5 * 3.14159265 / 30}),
    ],
)
def test_a_number_is_typed_with_its_unit_or_without(
    lab: Lab, language: str, entries: dict[str, float | None]
) -> None:
    visitor = lab(f"tab=launch&lang={language}&duration=1")
    for text, spin in entries.items():
        enter(visitor, "launch.spin", text)
        if spin is None:
            visitor.page.locator(".dial .refused").wait_for()
            continue
        visitor.launched(f"Math.abs(problem.launch.spin - {spin}) < 1e-4")
        for tab in ("own", "compare", "class", "keep", "launch"):
            visitor.ask("(tab) => tippetopLab.set({ tab })", tab)
            visitor.wait(f"() => ({PANEL})() > 100")


def test_a_unit_does_not_pass_the_limit_on_turns(lab: Lab) -> None:
    visitor = lab("tab=launch&duration=1")
    enter(visitor, "launch.spin", "1e9rpm")
    visitor.page.locator(".dial .refused", has_text="turns to compute").wait_for()


WHOLE = """[body]
mass = 0.02
I1 = 3.0e-6
I3 = 3.2e-6
shape = { kind = "eccentric_sphere", radius = 0.02, eccentricity = 0.3 }
[friction]
kind = "viscous"
mu = 0.3
[launch]
tilt = 0.1
spin = 99.0
"""


def without(part: str) -> str:
    blocks = WHOLE.split("[")
    return "[".join(block for block in blocks if not block.startswith(part))


def test_a_file_without_a_part_is_not_said_to_be_launched(lab: Lab) -> None:
    visitor = lab("tab=own&duration=1&launch.spin=60")
    page = visitor.page
    for part in ("body", "friction", "launch"):
        visitor.ask(DROP, [f"{part}.toml", without(part)])
        said = f"{part}.toml was not launched. {part} is missing."
        page.locator(".bring .refused").get_by_text(said, exact=True).wait_for()
        assert page.get_by_text("Launched: ").count() == 0
    assert visitor.ask("() => tippetopLab.state.setup.problem.launch.spin") == 60
    visitor.ask(DROP, ["all.toml", WHOLE])
    page.get_by_text("Launched: all.toml.").wait_for()
    visitor.launched("problem.launch.spin === 99")
    visitor.ask(DROP, ["bad.toml", WHOLE.replace("0.1", "9.9")])
    page.locator(".bring .refused", has_text="bad.toml was not launched. Tilt: ").wait_for()


def test_a_broken_file_is_shown_where_it_breaks(lab: Lab) -> None:
    visitor = lab("tab=own&duration=1")
    visitor.ask(DROP, ["wrong.toml", "[body]\nmass = = 1\n"])
    said = visitor.page.locator(".bring .refused")
    said.wait_for()
    assert said.inner_text() == "wrong.toml, line 2, is no TOML: “mass = = 1”."


REFUSED_LINKS = [
    "launch.spin.x=1",
    "pin=launch.spin.x%3D1",
    "lang=toString",
    "tab=__proto__",
    "duration=200",
    "duration=1e99&tab=launch",
    "launch.spin=1000&duration=120",
    "launch.spin=null",
    "plots=constructor",
    "body.shape=7",
    "body=3",
    "friction.mu=[1]",
    "friction.kind=sticky",
    "nonsense=1",
    "&".join(f"pin=launch.spin%3D{spin}" for spin in range(50, 60)),
]


OPENED = 5
"""Links that are opened with the page; the others are followed within it."""


def test_every_link_gives_a_page_and_a_sentence(lab: Lab, page: Path) -> None:
    visitor = lab("duration=1")
    for number, link in enumerate(REFUSED_LINKS):
        if number < OPENED:
            visitor.page.goto("about:blank")
            visitor.open(f"{page.as_uri()}#{link}", "globalThis.tippetopLab?.track")
        else:
            visitor.ask("() => tippetopLab.set({ trouble: null })")
            visitor.page.locator(".refused").first.wait_for(state="detached")
            visitor.ask("(hash) => { location.hash = hash; }", link)
        said = visitor.page.locator(".refused").first
        said.wait_for()
        assert len(said.inner_text()) > 12, link
        assert visitor.page.locator("h1").is_visible(), link
        assert visitor.ask(PANEL) > 100, link
        assert visitor.ask("() => tippetopLab.track.count") > 10, link
        assert len(visitor.ask("() => tippetopLab.state.pins")) <= 3, link


def test_copying_says_so_and_works_without_https(lab: Lab) -> None:
    visitor = lab("tab=class&duration=1")
    page = visitor.page
    visitor.ask(
        """() => { Object.defineProperty(navigator, "clipboard", { value: undefined });
        globalThis.copied = [];
        document.addEventListener("copy", () => copied.push(document.activeElement.value)); }"""
    )
    page.get_by_role("button", name="Copy code").click()
    page.get_by_text("Copied.").wait_for()
    assert visitor.ask("() => copied.at(-1)") == page.locator(".mine").inner_text()
    page.get_by_role("button", name="Copy link", exact=True).click()
    page.get_by_text("Copied: launch, view").wait_for()
    page.get_by_role("tab", name="Keep").click()
    page.get_by_role("button", name="Copy", exact=True).click()
    page.get_by_text("Copied.").wait_for()
    assert "tippetop simulate" in visitor.ask("() => copied.at(-1)")
    visitor.ask("() => { document.execCommand = () => false; }")
    page.get_by_role("button", name="Copy", exact=True).click()
    assert "tippetop simulate" in page.locator(".keep .linked input").input_value()


NAMES = [
    *("launch.spin", "launch.tilt", "friction.mu", "friction.kind", "body.shape", "body.mass"),
    *("body.I1", "duration", "gravity", "contact.restitution", "tab", "step", "t", "plots", "free"),
    *("lang", "theme", "units", "camera", "show", "pin", "launch", "friction", "body", "result"),
    *("launch.velocity", "contact", "body.shape.radius", "friction.x.y", "speed", "own", "class"),
]
VALUES = [
    *("", "null", "1", "-1", "1e99", "nan", "{}", "[]", "[1,2,3]", "true", '"x"', "constructor"),
    *("__proto__", "155", "0.1", "1480rpm", "launch", "viscous", "coulomb", "0", "%", "θ", "9 9"),
    *('{"kind":"ring"}', '[{"kind":"sphere","radius":0.01,"center":0.01}]', "a" * 200, "2 s"),
]


def test_random_links_never_leave_an_empty_page(lab: Lab, page: Path) -> None:
    """Every tenth as a page of its own, the others one after another."""
    draw = random.Random(64)
    visitor = lab("duration=1")
    for number in range(CASES):
        count = draw.randint(1, 4)
        link = "&".join(f"{draw.choice(NAMES)}={draw.choice(VALUES)}" for _ in range(count))
        if number % 10:
            visitor.ask("(hash) => { location.hash = hash; }", f"{link}&n={number}")
        else:
            visitor.page.goto("about:blank")
            visitor.page.goto(f"{page.as_uri()}#{link}")
            visitor.wait("() => globalThis.tippetopLab?.track")
        found = visitor.ask(
            """() => new Promise((done) => setTimeout(() => done({
              panel: document.querySelector(".panel-body")?.innerText.trim().length ?? 0,
              title: document.querySelector("h1")?.innerText ?? "",
              isShown: Boolean(tippetopLab.track) }), 20))"""
        )
        assert found["panel"] > 60, link
        assert found["title"], link
        assert found["isShown"], link
        assert not visitor.trouble, link


def test_damaged_files_never_lie_about_what_was_launched(lab: Lab) -> None:
    draw = random.Random(65)
    visitor = lab("tab=own&duration=1&launch.spin=60")
    for number in range(CASES):
        text = list(WHOLE)
        for _ in range(draw.randint(1, 4)):
            place = draw.randrange(len(text))
            if draw.random() < 0.5:
                text[place] = draw.choice('0123456789=."[]{}ae\n-#')
            else:
                del text[place : place + draw.randint(1, 12)]
        name = f"file{number}.toml"
        # A file is read a little later than it is dropped.
        visitor.ask("() => tippetopLab.set({ brought: { isWaiting: true }, trouble: null })")
        visitor.ask(DROP, [name, "".join(text)])
        visitor.wait(
            """(name) => { const { brought } = tippetopLab.state;
            return !brought || (brought.name === name && !brought.isWaiting); }""",
            name,
        )
        found = visitor.ask(
            """() => ({ launched: document.querySelector(".bring [role=status]")?.innerText ?? "",
              refused: document.querySelector(".panel .refused")?.innerText ?? "",
              brought: document.querySelector(".own")?.innerText.length ?? 0,
              content: Boolean(tippetopLab.state.brought?.content),
              problem: tippetopLab.track.header.problem })"""
        )
        assert found["brought"] > 60, name
        assert not visitor.trouble, "".join(text)
        if found["launched"]:
            try:
                ours = tt.Problem.from_json(tt.Problem(**found["problem"]).model_dump_json())
            except tt.InvalidInput:
                ours = None
            assert ours is not None, "".join(text)
            assert name in found["launched"], "".join(text)
        elif not found["content"]:
            assert found["refused"], "".join(text)
