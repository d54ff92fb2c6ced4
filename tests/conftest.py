"""How hypothesis behaves in every test, and what stands in for what is not built.

Hypothesis: reproducibly where a machine checks, freely where a person does.

HYPOTHESIS_PROFILE=thorough looks at twenty times as many examples.
"""

import os
import subprocess
import sys

import pytest
from hypothesis import HealthCheck, settings

from browsing import browser, visit
from tippetop.export import bundle
from tippetop.page_engine import HERE

__all__ = ["browser", "visit"]

SOURCE = HERE.parent
GENERATED = (HERE / "mechanics.js", HERE / "tables.js")

anywhere = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("default", anywhere)
settings.register_profile("ci", anywhere, derandomize=True)
settings.register_profile("thorough", anywhere, max_examples=2000)
settings.load_profile(
    os.environ.get("HYPOTHESIS_PROFILE", "ci" if "CI" in os.environ else "default")
)


def pytest_configure(config: pytest.Config) -> None:
    """Generate the page's engine if a source is newer; pytest's workers need not."""
    if hasattr(config, "workerinput"):
        return
    sources = [path.stat().st_mtime for path in SOURCE.rglob("*.py")]
    if any(not path.exists() or path.stat().st_mtime < max(sources) for path in GENERATED):
        subprocess.run([sys.executable, "-m", "tippetop.page_engine"], check=True)
        for path in GENERATED:
            path.touch()


@pytest.fixture(autouse=True, scope="session")
def _player(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Where what runs in browsers is not built, pages are written with a stand-in for it."""
    if not (bundle.BUILT / "player.js").exists():
        bundle.BUILT = tmp_path_factory.mktemp("built")
        (bundle.BUILT / "player.js").write_text(
            "export const createPlayer = () => {};", encoding="utf-8"
        )


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark what needs the browser, so that it can be run by itself: it is the slowest part of the
    tests.
    """
    for item in items:
        if "browser" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.browser)
