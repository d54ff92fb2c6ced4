"""Folders of compiled code, kept between processes, that are whole or not there."""

import contextlib
import hashlib
import json
import os
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import psutil

from tippetop.integrators.cache_folder import cache_folder

Found = TypeVar("Found")

SEAL = "seal.json"
"""The digests of all else in a folder."""

PREFIX, MOST = "code-", 64
"""How the folders are called, and how many there are at most: then the oldest goes."""

MAKING = "making-"
"""How those are called that are not yet whole: with this and the number of the process that makes them."""


def kept(name: str, use: Callable[[Path | None], Found]) -> Found:
    """What comes of a folder of compiled code.

    Parameters
    ----------
    name
        What tells the code from all other: it is compiled once for it.
    use
        Takes the code from a folder, or compiles it and puts it there if it is empty; with no folder it
        compiles only.
    """
    place = cache_folder()
    if place is not None:
        with contextlib.suppress(OSError):
            folder = place / (PREFIX + name)
            if _is_whole(folder):
                return use(folder)
            shutil.rmtree(folder, ignore_errors=True)
            return _made(folder, use)
    return use(None)


def _made(folder: Path, use: Callable[[Path | None], Found]) -> Found:
    """Compile in a folder beside, which takes its name when it is whole."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    for old in sorted(folder.parent.glob(PREFIX + "*"), key=os.path.getmtime)[: -MOST + 1]:
        shutil.rmtree(old, ignore_errors=True)
    _clear(folder.parent)
    beside = Path(tempfile.mkdtemp(prefix=f"{MAKING}{os.getpid()}-", dir=folder.parent))
    try:
        found = use(beside)
        (beside / SEAL).write_text(json.dumps(_digests(beside)), encoding="utf-8")
        with contextlib.suppress(OSError):  # Another process was sooner.
            beside.rename(folder)
    finally:
        shutil.rmtree(beside, ignore_errors=True)
    return found


def _clear(place: Path) -> None:
    """Remove what processes have left that are no more: interrupted, or killed, while they compiled."""
    for left in place.glob(MAKING + "*"):
        process = left.name.split("-")[1]
        if not (process.isdecimal() and psutil.pid_exists(int(process))):
            shutil.rmtree(left, ignore_errors=True)


def _is_whole(folder: Path) -> bool:
    """Whether a folder has what was put there, as it was."""
    try:
        return bool(json.loads((folder / SEAL).read_text(encoding="utf-8")) == _digests(folder))
    except (OSError, ValueError):
        return False


def _digests(folder: Path) -> dict[str, str]:
    files = [path for path in folder.rglob("*") if path.is_file() and path.name != SEAL]
    return {path.relative_to(folder).as_posix(): digest(path.read_bytes()) for path in files}


def digest(content: bytes) -> str:
    """What tells some bytes from all others."""
    return hashlib.sha256(content).hexdigest()
