"""What a store needs of the file system: one holder at a time, and results that last."""

import os
import re
import shutil
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from pathlib import Path

from tippetop.support.errors import FileTrouble
from tippetop.support.files import in_words

SYNCS = 32
"""Files that are brought to disk side by side, which costs hardly more than one."""


def identity(path: Path) -> tuple[int, int]:
    """Return device and inode of a folder, which another folder at its path does not have."""
    status = path.stat()
    return status.st_dev, status.st_ino


@contextmanager
def locked(path: Path) -> Iterator[None]:
    """Hold a store, or what is to become one, alone."""
    from filelock import FileLock, Timeout  # noqa: PLC0415 - optional

    lock = FileLock(path / ".lock", blocking=False)
    with in_words(path, "written"):
        try:
            lock.acquire()
        except Timeout:
            raise FileTrouble(f"{path} is being filled by another process") from None
    try:
        yield
    finally:
        lock.release()


def clear_away(path: Path) -> None:
    """Remove what programs left that were killed while they made this store."""
    for folder in path.parent.iterdir():
        if (
            re.fullmatch(rf"\.{re.escape(path.name)}\.\w{{8}}", folder.name)
            and (folder / ".lock").exists()
        ):
            with suppress(FileTrouble), locked(folder):
                shutil.rmtree(folder, ignore_errors=True)


def bring_to_disk(paths: Iterable[Path]) -> None:
    """Wait until files and folders are on disk."""
    with ThreadPoolExecutor(SYNCS) as threads:
        list(threads.map(_sync, paths))


def _sync(path: Path) -> None:
    if os.name == "nt" and path.is_dir():
        return
    handle = os.open(path, os.O_RDWR if os.name == "nt" else os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
