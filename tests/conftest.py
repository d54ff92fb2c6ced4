"""How hypothesis behaves in every test, what stands in for what is not built, and what must not be
left running.

Hypothesis searches with fixed seeds, so that a check fails for a change and for nothing else;
`make test-all` tries more examples than `make test`. `--hypothesis-profile=search`, which `make
campaigns` asks for, searches at random and for longer.
"""

import gc
import os
import subprocess
import sys
import uuid
from collections.abc import Iterator

import pytest
from hypothesis import HealthCheck, settings

from browsing import browser, visit
from campaigns import examples, note_marks
from children import RUN, end_leftovers, signals_heard
from launches import end_processes
from tippetop.export import bundle
from tippetop.page_engine import HERE

__all__ = ["browser", "visit"]

SOURCE = HERE.parent
GENERATED = (HERE / "mechanics.js", HERE / "tables.js")

anywhere = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("fixed", anywhere, max_examples=25, derandomize=True, database=None)
settings.register_profile("search", anywhere, max_examples=2000, print_blob=True)
settings.load_profile("fixed")


def pytest_configure(config: pytest.Config) -> None:
    """Generate the page's engine if a source is newer; pytest's workers need not. Before, note
    which parameters need not be made, and how many examples hypothesis tries.
    """
    note_marks(config.option.markexpr)
    if settings().derandomize:
        settings.register_profile("fixed", settings(), max_examples=examples(25, claim=2000))
        settings.load_profile("fixed")
    is_worker = hasattr(config, "workerinput")
    if is_worker or not config.getoption("numprocesses", None):
        gc.disable()  # until all is collected: to walk over what tests import takes a fifth longer
    if is_worker:
        return
    os.environ[RUN] = uuid.uuid4().hex  # all that is started from here on inherits it
    sources = [path.stat().st_mtime for path in SOURCE.rglob("*.py")]
    if any(not path.exists() or path.stat().st_mtime < max(sources) for path in GENERATED):
        subprocess.run([sys.executable, "-m", "tippetop.page_engine"], check=True)
        for path in GENERATED:
            path.touch()


def pytest_collection_finish() -> None:
    """Keep the collection of garbage from walking over all modules again and again."""
    gc.collect()
    gc.freeze()
    gc.enable()
    gc.set_threshold(10_000, 10, 10)


@pytest.hookimpl(wrapper=True)
def pytest_sessionfinish(session: pytest.Session) -> Iterator[None]:
    """Fail if a test left a process behind, once pytest's workers have ended."""
    end_processes()
    yield
    if hasattr(session.config, "workerinput"):
        return
    if left := end_leftovers(os.environ[RUN]):
        print("\nThese tests left processes running, which were ended:", *left, sep="\n")
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


@pytest.fixture
def heard_signals() -> Iterator[None]:
    """Let a test hear Ctrl-C wherever the tests are started from; see `signals_heard`."""
    with signals_heard():
        yield


@pytest.fixture(autouse=True, scope="session")
def _player(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Where what runs in browsers is not built, pages are written with a stand-in for it."""
    if not (bundle.BUILT / "player.js").exists():
        bundle.BUILT = tmp_path_factory.mktemp("built")
        (bundle.BUILT / "player.js").write_text(
            "/*!\n=== none ===\n*/\nexport const createPlayer = () => {};", encoding="utf-8"
        )


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark what needs the browser, so that it can be run by itself: it is the slowest part of the
    tests.
    """
    for item in items:
        if "browser" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.browser)
