"""Files that are either whole or not there, and never overwritten unasked."""

# translate module: skip

import contextlib
import os
import secrets
import stat
import sys
from collections.abc import Container, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from tippetop.support.errors import OVERWRITE, FileTrouble, InvalidInput, require
from tippetop.support.interrupts import deferred

if sys.platform != "win32":
    import fcntl

MARK = ".tippetop-"
"""How the names of files begin that are not yet whole."""

LONGEST_TEXT = 2**24
"""Largest file of text that is read, bytes: no problem and no sweep comes near it."""

LONGEST_NAME = 300
"""How much of a path a sentence shows, letters."""


_OF_OTHERS = {
    *(
        ".png",
        ".svg",
        ".pdf",
        ".html",
        ".htm",
        ".csv",
        ".parquet",
        ".glb",
        ".mp4",
        ".gif",
        ".json",
        ".toml",
        ".zarr",
    ),
    *(".stl", ".3mf"),
}
"""How the names of files of other kinds than NetCDF end."""


def require_ending(field: str, path: Path, endings: Sequence[str]) -> str:
    """The ending of a file's name; raises `InvalidInput` if it is none of these."""
    ending = path.suffix.lower()
    if ending not in endings:
        raise InvalidInput(field, str(path), f"a file name that ends in {' or '.join(endings)}")
    return ending


def refuse_ending_of_others(field: str, path: Path) -> None:
    """Raise `InvalidInput` if the name of a NetCDF file, which needs no ending, ends as others."""
    if path.suffix.lower() in _OF_OTHERS:
        require_ending(field, path, (".nc",))


def refuse_overwriting(path: Path, overwrite: bool, otherwise: str = "") -> None:
    """Raise `FileTrouble` if something is there, even a link to nothing, and may not be
    overwritten.

    What else may be done with it is told, if anything: "it is <otherwise>overwritten only with
    ...".
    """
    require("overwrite", overwrite, bool, "True or False")
    if os.path.lexists(path) and not overwrite:
        raise FileTrouble(
            f"{named(path)} exists; it is {otherwise}overwritten only with {OVERWRITE}"
        )


def place_for(path: Path | str, overwrite: bool) -> Path:
    """The file that writing to a path makes or replaces: the end of its links.

    Raises `FileTrouble` if something is there and `overwrite` is false or it is no regular file, or
    there is no such folder.
    """
    with in_words(path, "written"):
        target = Path(os.path.realpath(path))
        there = _status(target)
        if there is not None and not stat.S_ISREG(there.st_mode):
            kind = "a folder" if stat.S_ISDIR(there.st_mode) else "a device, pipe or socket"
            raise FileTrouble(f"{named(path)} is {kind}, and not replaced by a file")
        refuse_overwriting(Path(path), overwrite)
        target.parent.stat()
    return target


@contextmanager
def written_beside(path: Path | str, overwrite: bool = False) -> Iterator[Path]:
    """A temporary file beside `path`, with its suffix, that takes its place once all is written.

    It is on the disk before it does, has the permissions of the file it replaces, and is nobody
    else's. What writers that were killed have left in the folder is removed. Raises `FileTrouble`
    if the file exists and `overwrite` is false, or cannot be written; nothing is then left of it.
    """
    target = place_for(path, overwrite)
    file = None
    with in_words(path, "written"):
        try:
            with deferred():
                _clear(target.parent)
                file = _begin(target)
            beside = Path(file.name)
            yield beside
            os.fsync(file.fileno())
            if sys.platform == "win32":
                file.close()  # No open file is moved there.
            put_in_place(beside, path, overwrite)
        finally:
            with deferred():
                if file is not None:
                    Path(file.name).unlink(missing_ok=True)
                    file.close()


def put_in_place(beside: Path, path: Path | str, overwrite: bool) -> None:
    """Move a finished file to its place, at once; of several that make the same new file, one
    succeeds.

    Raises `FileTrouble` as `place_for` does, at this very moment.
    """
    target = place_for(path, overwrite)
    with in_words(path, "written"):
        there = _status(target)
        if there is not None:
            with contextlib.suppress(PermissionError):
                os.chown(beside, there.st_uid, there.st_gid)
            beside.chmod(stat.S_IMODE(there.st_mode))
        if not overwrite:
            _claim(beside, target, path)
        beside.replace(target)
        # Two names of one file are left alone by that.
        beside.unlink(missing_ok=True)


def read_text(path: Path | str, accepted: str) -> str:
    """The text of a file, which is `accepted`, as the end of a sentence.

    Raises `FileTrouble` if the file cannot be read, is no text, or is longer than `LONGEST_TEXT`.
    """
    with in_words(path, "read"), Path(path).open("rb") as file:
        content = file.read(LONGEST_TEXT + 1)
    if len(content) > LONGEST_TEXT:
        raise FileTrouble(
            f"{named(path)} has more than {LONGEST_TEXT:,} bytes, and is not {accepted}"
        )
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise FileTrouble(f"{named(path)} is not a text file, and not {accepted}") from None


@contextmanager
def made_of(path: Path | str, given: Container[str] = (), part: str = "") -> Iterator[None]:
    """Say of what cannot be that it is in this file, unless it is in another, or a field that is
    given.

    If only a part is in the file, it is said of fields of that alone.
    """
    try:
        yield
    except InvalidInput as error:
        elsewhere = part and not f"{error.field}.".startswith(f"{part}.")
        if error.file or elsewhere or error.field.partition(".")[0] in given:
            raise
        raise error.in_file(named(Path(path).name)) from None


def named(path: Path | str) -> str:
    """A path as it stands in a sentence: on one line, and no longer than one reads."""
    text = str(path) if str(path).isprintable() else repr(str(path))
    return text if len(text) <= LONGEST_NAME else f"...{text[-LONGEST_NAME:]}"


def path_of(path: object) -> Path:
    """The path of a file or folder by its name; raises `InvalidInput` if that is none."""
    if not isinstance(path, str | os.PathLike):
        raise InvalidInput("path", path, "the name of a file or folder")
    return Path(path)


@contextmanager
def in_words(path: Path | str, done: str) -> Iterator[None]:
    """Turn what the file system says into one sentence."""
    path_of(path)
    try:
        yield
    except FileTrouble:
        raise
    except OSError as error:
        raise FileTrouble(f"{named(path)} cannot be {done}: {error.strerror or error}") from None
    except ValueError:
        if _may_be(path):
            raise
        raise FileTrouble(f"{named(path)} cannot be {done}: no file has such a name") from None


def _may_be(path: Path | str) -> bool:
    """Whether the system could have a file of this name."""
    try:
        return b"\0" not in os.fsencode(path)
    except UnicodeEncodeError:
        return False


def _status(path: Path) -> os.stat_result | None:
    try:
        return path.stat()
    except FileNotFoundError:
        return None


def _begin(target: Path) -> BinaryIO:
    """A new file beside another, held, which nobody else may read who may not read that."""
    there = _status(target)
    permissions = 0o666 if there is None else stat.S_IMODE(there.st_mode) & 0o666 | 0o600

    def opener(name: str, flags: int) -> int:
        return os.open(name, flags, permissions)

    while True:
        beside = target.with_name(f"{MARK}{secrets.token_hex(6)}{target.suffix[:16]}")
        file = open(beside, "xb", opener=opener)  # noqa: SIM115 - the caller closes it
        # Another writer may have taken it for one that was left.
        if _holds(file.fileno()) is not False and os.fstat(file.fileno()).st_nlink:
            return file
        file.close()


def _clear(folder: Path) -> None:
    """Remove what is left in a folder of writers that are no more: what nobody holds."""
    for left in folder.glob(f"{MARK}*"):
        with contextlib.suppress(OSError):
            handle = os.open(left, os.O_RDWR | getattr(os, "O_NOFOLLOW", 0))
            try:
                if stat.S_ISREG(os.fstat(handle).st_mode) and _holds(handle):
                    left.unlink()
            finally:
                os.close(handle)


def _holds(handle: int) -> bool | None:
    """Take hold of an open file for as long as it is open; None where files cannot be held."""
    if sys.platform == "win32":
        return None
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return None
    return True


def _claim(beside: Path, target: Path, path: Path | str) -> None:
    """Make the target, which is to be new, out of a file; where a file has one name only, make it
    empty.
    """
    try:
        try:
            os.link(beside, target)
        except FileExistsError:
            raise
        except OSError:
            os.close(os.open(target, os.O_WRONLY | os.O_CREAT | os.O_EXCL))
    except FileExistsError:
        raise FileTrouble(
            f"{named(path)} exists; it is overwritten only with {OVERWRITE}"
        ) from None
