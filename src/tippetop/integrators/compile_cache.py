"""Where compiled equations are kept between processes."""

import contextlib
import os
import sqlite3
from functools import cache
from pathlib import Path

import heyoka as hy
import platformdirs

VARIABLE = "TIPPETOP_CACHE"
"""Environment variable that names another folder for the cache, or "off" for none."""

DATABASE = "cache.db"
"""The compiler's file in that folder."""

PATIENCE = 1.0
"""How long to wait for another process that holds the cache, s; compiling takes no longer."""

LIMIT = 512 * 2**20
"""Size in bytes past which the oldest compiled code is dropped."""


@cache
def use_compile_cache() -> Path | None:
    """Keep compiled code under the user's cache folder; return the folder, or None where it is turned off.

    A cache that is damaged is thrown away. One that another process holds is left alone; without it, or
    where none can be kept (a read-only folder), every process compiles for itself, in about a second.
    """
    # Without this the compiler complains on the terminal about a cache that it then does without.
    hy.set_logger_level_critical()
    place = os.environ.get(VARIABLE, "")
    if place == "off":
        hy.llvm_state.set_diskcache_enabled(False)
        return None
    folder = Path(place) if place else platformdirs.user_cache_path("tippetop", appauthor=False)
    for _ in range(2):
        if is_held(folder / DATABASE):
            break
        with contextlib.suppress(OSError):
            discard_if_damaged(folder / DATABASE)
        try:
            hy.llvm_state.set_diskcache_path(folder)
            hy.llvm_state.set_diskcache_limit(LIMIT)
        except RuntimeError:
            if is_held(folder / DATABASE):
                break
            with contextlib.suppress(OSError):
                (folder / DATABASE).unlink()
        else:
            return folder
    hy.llvm_state.set_diskcache_enabled(False)
    return None


def is_held(database: Path) -> bool:
    """Whether another process holds a cache for longer than `PATIENCE`."""
    try:
        address = f"{database.absolute().as_uri()}?mode=rw"
        with contextlib.closing(sqlite3.connect(address, PATIENCE, uri=True)) as cache:
            cache.execute("BEGIN IMMEDIATE")
            cache.rollback()
    except sqlite3.Error as error:
        return getattr(error, "sqlite_errorcode", None) == sqlite3.SQLITE_BUSY
    return False


def discard_if_damaged(database: Path) -> None:
    """Remove a cache that does not begin as a database does."""
    if database.exists():
        with database.open("rb") as file:
            head = file.read(16)
        if head != b"SQLite format 3\0":
            database.unlink()
