"""Where compiled equations are kept between processes."""

import contextlib
import os
from functools import cache
from pathlib import Path

import heyoka as hy
import platformdirs

VARIABLE = "TIPPETOP_CACHE"
"""Environment variable that names another folder for the cache, or "off" for none."""

DATABASE = "cache.db"
"""The compiler's file in that folder."""

LIMIT = 512 * 2**20
"""Size in bytes past which the oldest compiled code is dropped."""


@cache
def use_compile_cache() -> Path | None:
    """Keep compiled code under the user's cache folder; return the folder, or None where it is turned off.

    A cache that is damaged is thrown away; where none can be kept (a read-only folder), every process
    compiles for itself, which costs about a second.
    """
    # Without this the compiler complains on the terminal about a cache that it then does without.
    hy.set_logger_level_critical()
    place = os.environ.get(VARIABLE, "")
    if place == "off":
        hy.llvm_state.set_diskcache_enabled(False)
        return None
    folder = Path(place) if place else platformdirs.user_cache_path("tippetop", appauthor=False)
    for _ in range(2):
        with contextlib.suppress(OSError):
            discard_if_damaged(folder / DATABASE)
        try:
            hy.llvm_state.set_diskcache_path(folder)
            hy.llvm_state.set_diskcache_limit(LIMIT)
        except RuntimeError:
            with contextlib.suppress(OSError):
                (folder / DATABASE).unlink()
        else:
            return folder
    hy.llvm_state.set_diskcache_enabled(False)
    return None


def discard_if_damaged(database: Path) -> None:
    """Remove a cache that does not begin as a database does."""
    if database.exists():
        with database.open("rb") as file:
            head = file.read(16)
        if head != b"SQLite format 3\0":
            database.unlink()
