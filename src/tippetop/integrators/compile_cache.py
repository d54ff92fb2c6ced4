"""Where compiled equations are kept between processes, with digests: what is damaged there is not run."""

import contextlib
import hashlib
import sqlite3
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import heyoka as hy

from tippetop.integrators.cache_folder import cache_folder

DATABASE = "cache.db"
"""The compiler's file in that folder."""

PATIENCE = 1.0
"""How long to wait for another process that holds the cache, s; compiling takes no longer."""

LIMIT = 32 * 2**20
"""Size in bytes past which the oldest compiled code is dropped; a process that begins reads all of it."""

_CODE = "SELECT hash, bitcode, comp_flag, env_fingerprint, opt_bc, opt_ir, obj FROM cache"
_DIGESTS = """
CREATE TABLE IF NOT EXISTS digest (hash INTEGER PRIMARY KEY, sha256 BLOB NOT NULL);
CREATE TRIGGER IF NOT EXISTS added AFTER INSERT ON cache
BEGIN DELETE FROM digest WHERE hash = new.hash; END;
CREATE TRIGGER IF NOT EXISTS dropped AFTER DELETE ON cache
BEGIN DELETE FROM digest WHERE hash = old.hash; END;
"""
"""A table beside the compiler's own, of what it compiled; what has been added since has no digest in it."""

_ONE_AT_A_TIME = threading.Lock()


@contextmanager
def compiling() -> Iterator[None]:
    """A block in which what is compiled is taken from the cache, or else kept there with its digest."""
    with _ONE_AT_A_TIME:
        folder = use_compile_cache()
        yield
        if folder is not None:
            # The compiler has an SQLite of its own; both with the file open would undo each other's locks.
            hy.llvm_state.set_diskcache_path(folder)
            # Code without a digest is dropped by the next process, and compiled again.
            with contextlib.suppress(sqlite3.Error), _opened(folder / DATABASE) as database:
                _note_digests(database)


@cache
def use_compile_cache() -> Path | None:
    """Keep compiled code under the user's cache folder; return the folder, or None where it is turned off.

    What is damaged in a cache is thrown away. One that another process holds is left alone; without it, or
    where none can be kept (a read-only folder), every process compiles for itself, in about a second.
    """
    # Without this the compiler complains on the terminal about a cache that it then does without.
    hy.set_logger_level_critical()
    folder = cache_folder()
    if folder is None:
        hy.llvm_state.set_diskcache_enabled(False)
        return None
    with contextlib.suppress(OSError, RuntimeError):
        if drop_damaged(folder / DATABASE):
            hy.llvm_state.set_diskcache_path(folder)
            hy.llvm_state.set_diskcache_limit(LIMIT)
            return folder
    hy.llvm_state.set_diskcache_enabled(False)
    return None


def drop_damaged(path: Path) -> bool:
    """Drop from a cache what is not as it was compiled, and all of it where that cannot be told.

    Returns
    -------
    bool
        Whether the cache may be used: no other process holds it for longer than `PATIENCE`.
    """
    if not path.exists():
        return True
    try:
        with _opened(path) as database:
            database.execute("BEGIN IMMEDIATE")
            database.rollback()
            _drop_damaged(database)
    except sqlite3.Error as error:
        if getattr(error, "sqlite_errorcode", 0) & 0xFF == sqlite3.SQLITE_BUSY:
            return False
        for part in ("", "-wal", "-shm"):
            path.with_name(path.name + part).unlink(missing_ok=True)
    return True


@contextmanager
def _opened(path: Path) -> Iterator[sqlite3.Connection]:
    """A cache that is there already."""
    address = f"{path.absolute().as_uri()}?mode=rw"
    with contextlib.closing(sqlite3.connect(address, timeout=PATIENCE, uri=True)) as database:
        database.text_factory = bytes
        yield database


def _drop_damaged(database: sqlite3.Connection) -> None:
    if database.execute("PRAGMA integrity_check(1)").fetchone() != (b"ok",):
        raise sqlite3.DatabaseError("damaged")
    digests = dict(database.execute("SELECT hash, sha256 FROM digest"))
    wrong = [(row[0],) for row in database.execute(_CODE) if digests.get(row[0]) != _digest(row)]
    if wrong:
        with database:
            database.executemany("DELETE FROM cache WHERE hash = ?", wrong)
            database.execute(
                "UPDATE config SET value = (SELECT TOTAL(size) FROM cache) WHERE key = 'total_size'"
            )


def _note_digests(database: sqlite3.Connection) -> None:
    new = f"{_CODE} WHERE hash NOT IN (SELECT hash FROM digest)"
    if not database.execute("SELECT 1 FROM sqlite_master WHERE name = 'digest'").fetchone():
        database.executescript(_DIGESTS)
    added = [(row[0], _digest(row)) for row in database.execute(new)]
    if added:
        with database:
            database.executemany("INSERT OR REPLACE INTO digest VALUES (?, ?)", added)


def _digest(row: tuple[Any, ...]) -> bytes:
    """The digest of an entry, with every field's length, so that none passes for part of its neighbour."""
    digest = hashlib.sha256()
    for field in row:
        content = field if isinstance(field, bytes) else str(field).encode()
        digest.update(b"%d:" % len(content))
        digest.update(content)
    return digest.digest()
