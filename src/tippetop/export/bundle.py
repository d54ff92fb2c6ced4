"""Files that `make page` builds from `web/`: the player of runs, and the laboratory's page."""

import base64
import gzip
import re
from functools import cache
from pathlib import Path

from tippetop.support.errors import Unavailable
from tippetop.support.installation import reinstall_command

BUILT = Path(__file__).parent / "built"
"""Folder of the built files; released packages contain them."""

LOADER = Path(__file__).with_name("loader.js").read_text(encoding="utf-8")
"""JavaScript that unpacks the player from the element "player-code" of a page."""


_NOTICES = re.compile(r"/\*!\n(.*?)\n\*/\n", re.DOTALL)


@cache
def built(name: str) -> str:
    """Return the text of a built file; raise `Unavailable` if it is not built."""
    try:
        return (BUILT / name).read_text(encoding="utf-8")
    except FileNotFoundError:
        raise Unavailable(_not_built()) from None


@cache
def player_packed() -> str:
    """Return the built player as compressed base64; raise `Unavailable` if it is not built."""
    return packed(built("player.js").encode())


def _not_built() -> str:
    """Return why the page is not built, and what to do."""
    reason = BUILT / "not_built.txt"  # the installation writes it
    why = f", since {reason.read_text(encoding='utf-8').strip()}" if reason.exists() else ""
    again = f"install it again ({reinstall_command()}), or run `make page` in the source's folder"
    return f"the page and the player were not built when tippetop was installed{why}: {again}"


def player_notices() -> str:
    """Return the licences of the npm packages in the player, which stand at its beginning.

    Raises `Unavailable` if the player is not built.
    """
    notices = _NOTICES.match(built("player.js"))
    assert notices is not None, "the player begins with the licences of what it contains"
    return notices[1]


def packed(content: bytes) -> str:
    """Return bytes as compressed base64, the same text for the same bytes."""
    return base64.b64encode(gzip.compress(content, 9, mtime=0)).decode("ascii")
