"""What `make page` builds from `web/` for browsers: the player of runs, and the laboratory's
page.
"""

import base64
import gzip
from functools import cache
from pathlib import Path

from tippetop.support.errors import Unavailable

BUILT = Path(__file__).parent / "built"
"""Where the built files are; a released package brings them."""

LOADER = Path(__file__).with_name("loader.js").read_text(encoding="utf-8")
"""JavaScript that takes the player out of a page that has it, packed, in an element called
"player-code".
"""


@cache
def built(name: str) -> str:
    """Return a built file; `Unavailable` if it is not built."""
    try:
        return (BUILT / name).read_text(encoding="utf-8")
    except FileNotFoundError:
        raise Unavailable(
            "what runs in browsers is not built here: run `make page` in the folder of the source "
            "(packages that are released bring it)"
        ) from None


@cache
def player_packed() -> str:
    """Return the player, compressed, as base64; `Unavailable` if it is not built."""
    return packed(built("player.js").encode())


def packed(content: bytes) -> str:
    """Return bytes compressed, as base64: the same for the same bytes."""
    return base64.b64encode(gzip.compress(content, 9, mtime=0)).decode("ascii")
