"""The built documentation, as a reader's browser sees it: `make docs`, then `make test-docs`."""

import os
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

BUILT = Path(os.environ.get("DOCS", "docs/_build/html")).resolve()
PAGES = sorted(
    path
    for path in BUILT.rglob("*.html")
    if not {"_static", "_players"} & set(path.relative_to(BUILT).parts)
)
CHROMIUM = Path("/usr/bin/chromium")

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(not PAGES, reason="the documentation is not built: make docs"),
]


class Links(HTMLParser):
    """The places that a page links to, and those in it that can be linked to."""

    def __init__(self):
        super().__init__()
        self.targets, self.places = set(), set()

    def handle_starttag(self, tag, attrs):
        found = dict(attrs)
        self.places |= {found.get("id"), found.get("name")} - {None}
        if tag != "link" or found.get("rel") == "stylesheet":
            self.targets |= {found.get("href"), found.get("src")} - {None}


@pytest.fixture(scope="module")
def links():
    """The links of every page."""
    found = {}
    for page in PAGES:
        found[page] = Links()
        found[page].feed(page.read_text(encoding="utf-8"))
    return found


def test_no_link_is_dead(links):
    dead = []
    for page, one in links.items():
        for target in one.targets:
            parts = urlsplit(target)
            if parts.scheme:
                continue
            where = (page.parent / unquote(parts.path)).resolve() if parts.path else page
            known = (
                where not in links
                or not parts.fragment
                or unquote(parts.fragment) in links[where].places
            )
            if not (where.exists() and known):
                dead.append((page.relative_to(BUILT).as_posix(), target))
    assert dead == []


@pytest.fixture(scope="module")
def browser():
    """Chromium, once for all pages."""
    if not CHROMIUM.exists():
        pytest.skip("needs Debian's chromium: make chromium")
    from playwright.sync_api import sync_playwright  # noqa: PLC0415 - optional

    with sync_playwright() as playwright:
        started = playwright.chromium.launch(
            executable_path=CHROMIUM, args=["--no-sandbox", "--use-gl=swiftshader"]
        )
        yield started
        started.close()


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(BUILT).as_posix())
def test_a_page_is_whole_on_a_phone_and_accessible(page, scheme, browser):
    """It asks nobody for anything, fits a phone, equations begin in sight; axe has no serious
    finding.
    """
    axe = pytest.importorskip("axe_playwright_python.sync_playwright").Axe()
    tab = browser.new_page(viewport={"width": 390, "height": 800}, color_scheme=scheme)
    asked, wrong = [], []
    tab.on("request", lambda request: asked.append(request.url))
    tab.on("pageerror", lambda error: wrong.append(str(error)))
    tab.route("**/_players/**", lambda route: route.abort())  # tested where they are made
    tab.goto(page.as_uri())
    too_wide = tab.evaluate("document.documentElement.scrollWidth - innerWidth")
    cut_off = tab.evaluate(
        """[...document.querySelectorAll('div.math > math')].filter((one) =>
        one.getBoundingClientRect().left
          < one.parentElement.getBoundingClientRect().left - 1).length"""
    )
    serious = [
        (finding["id"], finding["nodes"][0]["html"])
        for finding in axe.run(tab).response["violations"]
        if finding["impact"] in ("serious", "critical")
    ]
    tab.close()
    assert [url for url in asked if not url.startswith(("file:", "data:", "blob:"))] == []
    assert wrong == []
    assert too_wide <= 0
    assert cut_off == 0
    assert serious == []


def test_dark_that_is_chosen_by_hand_reaches_the_laboratory_in_its_frame(browser):
    tab = browser.new_page(color_scheme="light")
    tab.goto((BUILT / "learn" / "lab.html").as_uri())
    frame = tab.locator("figure.player iframe").first
    frame.scroll_into_view_if_needed()
    page = frame.element_handle().content_frame()
    page.wait_for_selector("html[data-theme=light] header")
    tab.evaluate("document.documentElement.dataset.theme = 'dark'")
    page.wait_for_selector("html[data-theme=dark] header")
    tab.close()


def test_code_is_copied_without_prompts(browser):
    tab = browser.new_page()
    tab.goto((BUILT / "teach" / "lesson2.html").as_uri())
    tab.evaluate(
        "Object.defineProperty(navigator, 'clipboard', "
        "{ value: { writeText: async (text) => { globalThis.copied = text; } } })"
    )
    block = tab.locator("div.highlight").first
    block.hover()
    block.get_by_role("button", name="Copy").click()
    block.get_by_role("button", name="Copied").wait_for()
    assert tab.evaluate("copied").startswith("import tippetop as tt")
    tab.close()


def test_no_page_shows_a_raw_warning():
    raw = [page for page in PAGES if "Implausible: " in page.read_text(encoding="utf-8")]
    assert [page.relative_to(BUILT).as_posix() for page in raw] == []


def test_a_search_for_class_finds_the_lessons(browser):
    tab = browser.new_page()
    tab.goto(f"{(BUILT / 'search.html').as_uri()}?q=class")
    tab.locator("#search-results a", has_text="Lesson 1").first.wait_for()
    tab.close()
