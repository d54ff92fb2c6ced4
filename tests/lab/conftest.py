from collections.abc import Callable
from pathlib import Path

import pytest

from browsing import Visit
from tippetop.lab.serve import page_path
from tippetop.support.errors import Unavailable


@pytest.fixture(scope="session")
def page() -> Path:
    """The laboratory's page, as it is built."""
    try:
        return page_path()
    except Unavailable as error:
        pytest.skip(str(error))


@pytest.fixture
def lab(page: Path, visit: Callable[..., Visit]) -> Callable[..., Visit]:
    """Opens the page from its file, without a network, at what a link says."""

    def open_page(link: str = "", **options: object) -> Visit:
        visitor = visit(offline=True, **{"locale": "en-US", **options})
        address = f"{page.as_uri()}#{link}" if link else page.as_uri()
        return visitor.open(
            address, "globalThis.tippetopLab?.track && tippetopLab.player.frames > 0"
        )

    return open_page
