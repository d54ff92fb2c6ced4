"""Folders of compiled code, kept between processes, that are whole or not there."""

import contextlib
import hashlib
import json
import os
import re
import shutil
import tempfile
import zlib
from collections.abc import Callable
from itertools import count
from pathlib import Path
from typing import TypeVar

import platformdirs
import psutil

Found = TypeVar("Found")

VARIABLE = "TIPPETOP_CACHE"
"""Environment variable that names another folder for the cache than the user's, or "off" for none.
"""

SEAL, CONTENT = "seal.json", "content.zlib"
"""The digests of all else in a folder, and what is in it where that is one file."""

PREFIX, MOST, LARGEST = "code-", 4096, 2**27
"""How the folders are called, and how many there are at most, and bytes in them, when the cache is
cleared: then those go that were not used for longest.
"""

NEW_BETWEEN_CLEARINGS = 32
"""How many folders a process makes from one clearing of the cache to the next: to look at
thousands of folders takes longer than to compile a small motion.
"""

made_here = count()
"""Counts the folders that this process makes."""

SEALED = re.compile(rf"{PREFIX}[0-9a-f]{{32}}")
"""Names of folders that are whole."""

MAKING = re.compile(rf"{PREFIX}[0-9a-f]{{32}}-([0-9]{{1,9}})-[a-z0-9_]{{8}}")
"""Names of those that are not yet whole: with the number of the process that makes them."""


def cached_folder(made: object, use: Callable[[Path | None], Found]) -> Found:
    """Return what `use` makes of a folder of compiled code.

    What is damaged in it is thrown away, and where none can be kept every process compiles for
    itself.

    Parameters
    ----------
    made
        What is compiled, and with what, as something that is written down: it is compiled once for
        each kind of processor.
    use
        Takes the code from a folder, or compiles it and puts it there if it is empty; with no
        folder it compiles only.
    """
    place = os.environ.get(VARIABLE) or users_folder()
    if place != "off":
        with contextlib.suppress(OSError):
            folder = Path(place) / (PREFIX + _digest(repr((made, *_processor())).encode())[:32])
            if folder.exists() and not _is_own(folder):
                return use(None)
            if _is_whole(folder):
                with contextlib.suppress(OSError):
                    os.utime(folder)
                return use(folder)
            shutil.rmtree(folder, ignore_errors=True)
            return _made(folder, use)
    return use(None)


def users_folder() -> Path:
    """Return the user's own folder for the cache, which holds files of this package only."""
    return platformdirs.user_cache_path("tippetop", appauthor=False)


def kept_content(made: object, make: Callable[[], bytes]) -> bytes:
    """Compiled code that is one file, made or taken from the cache; see `cached_folder`."""

    def use(folder: Path | None) -> bytes:
        path = folder and folder / CONTENT
        if path and path.exists():
            with contextlib.suppress(zlib.error):
                return zlib.decompress(path.read_bytes())
        content = make()
        if path:
            path.write_bytes(zlib.compress(content, 1))
        return content

    # What was kept under another name, by an earlier version, is another thing.
    return cached_folder((CONTENT, made), use)


def _processor() -> tuple[str, ...]:
    """Return the system, the processor and its features, for which code is compiled."""
    import llvmlite.binding as llvm  # noqa: PLC0415 - slow to import

    return (
        llvm.get_process_triple(),
        llvm.get_host_cpu_name(),
        llvm.get_host_cpu_features().flatten(),
    )


def _made(folder: Path, use: Callable[[Path | None], Found]) -> Found:
    """Compile in a folder beside, which takes its name when it is whole."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    if next(made_here) % NEW_BETWEEN_CLEARINGS == 0:
        _clear(folder.parent)
    beside = Path(tempfile.mkdtemp(prefix=f"{folder.name}-{os.getpid()}-", dir=folder.parent))
    try:
        result = use(beside)
        (beside / SEAL).write_text(json.dumps(_digests(beside)), encoding="utf-8")
        with contextlib.suppress(OSError):  # Another process was sooner.
            beside.rename(folder)
    finally:
        shutil.rmtree(beside, ignore_errors=True)
    return result


def _clear(place: Path) -> None:
    """Remove what is too much, and what processes have left that are no more: killed while they
    compiled.
    """
    # A folder that the variable names may hold anything: only what is surely of this package goes.
    folders = [folder for folder in place.iterdir() if folder.is_dir() and _is_own(folder)]
    size, held = 0, [folder for folder in folders if SEALED.fullmatch(folder.name)]
    for number, old in enumerate(sorted(held, key=os.path.getmtime, reverse=True), 1):
        size += _size(old)
        if (number >= MOST or size > LARGEST) and _seal(old) is not None:
            shutil.rmtree(old, ignore_errors=True)
    for folder in folders:
        process = MAKING.fullmatch(folder.name)
        if process and not psutil.pid_exists(int(process[1])):
            shutil.rmtree(folder, ignore_errors=True)


def _size(folder: Path) -> int:
    """Return the bytes in the files of a folder."""
    with os.scandir(folder) as entries:
        return sum(entry.stat().st_size for entry in entries if entry.is_file())


def _is_own(folder: Path) -> bool:
    """Return whether this user made a folder: code of others is not run. Only its maker can write
    to it.
    """
    return not hasattr(os, "getuid") or folder.stat().st_uid == os.getuid()


def _is_whole(folder: Path) -> bool:
    """Return whether a folder has the files that were put into it, as they were."""
    try:
        return _seal(folder) == _digests(folder)
    except OSError:
        return False


def _seal(folder: Path) -> dict[str, str] | None:
    """Return the digests that a folder is sealed with; None if it is not."""
    try:
        seal = json.loads((folder / SEAL).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
    digests = seal.values() if isinstance(seal, dict) else [None]
    return seal if all(re.fullmatch("[0-9a-f]{64}", str(digest)) for digest in digests) else None


def _digests(folder: Path) -> dict[str, str]:
    files = [path for path in folder.rglob("*") if path.is_file() and path.name != SEAL]
    return {path.relative_to(folder).as_posix(): _digest(path.read_bytes()) for path in files}


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
