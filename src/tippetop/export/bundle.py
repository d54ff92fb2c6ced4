"""The player as one piece of JavaScript, with three.js beside it, for pages that may load nothing.

three.js comes from NiceGUI's own copy, so that there is one of it.
"""

import base64
import gzip
import re
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from tippetop.errors import Unavailable

PLAYER = Path(__file__).parent / "player"
"""Where the player's modules are."""

_MODULES = ("track.js", "toy.js", "scene.js", "strip.js", "style.js", "player.js", "unpack.js")
_THREE = Path("elements", "scene", "dist", "index.js")


@cache
def player_code() -> str:
    """The player's modules as one: their imports of each other and their exports left out."""
    pieces = []
    for name in _MODULES:
        text = (PLAYER / name).read_text(encoding="utf-8")
        text = re.sub(r'^import \{[^}]*\} from "\./[^"]+";\n', "", text, flags=re.MULTILINE)
        pieces.append(re.sub(r"^export (?=(async )?(class|const|function))", "", text, flags=re.MULTILINE))
    return "\n".join(pieces)


@cache
def three_packed() -> str:
    """three.js with its orbit controls, compressed, as base64.

    Raises
    ------
    Unavailable
        If NiceGUI is not installed, or keeps three.js elsewhere.
    """
    package = find_spec("nicegui")
    if package is None or not package.submodule_search_locations:
        raise Unavailable("three.js comes with NiceGUI, which is not installed: pip install 'tippetop[lab]'")
    path = Path(package.submodule_search_locations[0]) / _THREE
    try:
        return packed(path.read_bytes())
    except OSError:
        raise Unavailable(f"three.js is not where this version of NiceGUI should keep it: {path}") from None


def packed(content: bytes) -> str:
    """Bytes compressed, as base64: the same for the same bytes."""
    return base64.b64encode(gzip.compress(content, 9, mtime=0)).decode("ascii")
