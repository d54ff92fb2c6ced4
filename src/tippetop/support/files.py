"""Writing files at once and only if wished, reading texts, and messages about files."""

# translate module: skip

import contextlib
import os
import secrets
import stat
import sys
from collections.abc import Callable, Container, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from tippetop.support.errors import OVERWRITE, FileTrouble, InvalidInput, in_file, require
from tippetop.support.interrupts import deferred

if sys.platform != "win32":
    import fcntl

MARK = ".tippetop-"
"""Beginning of the names of files that are still being written."""

LONGEST_TEXT = 2**24
"""Largest text file that is read, bytes; larger ones are no problem or sweep."""

CONTROL_CHARACTERS = {chr(code) for code in range(32)} - set("\t\n\r\f\x1a")
"""Characters that texts do not have; \x1a ended them in DOS."""

LONGEST_NAME = 300
"""Letters of a path that a sentence shows at most."""


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
        ".xlsx",
        ".xls",
        ".ods",
        ".txt",
        ".tsv",
    ),
    *(".stl", ".3mf"),
}
"""Endings of the names of files that are not NetCDF."""


def require_ending(field: str, path: Path, endings: Sequence[str]) -> str:
    """Return the ending of a file's name; raise `InvalidInput` if it is none of these."""
    ending = path.suffix.lower()
    if ending not in endings:
        raise InvalidInput(field, str(path), f"a file name that ends in {' or '.join(endings)}")
    return ending


def refuse_ending_of_others(field: str, path: Path) -> None:
    """Raise `InvalidInput` if the name of a NetCDF file has the ending of another kind of file."""
    if path.suffix.lower() in _OF_OTHERS:
        require_ending(field, path, (".nc",))


def refuse_overwriting(path: Path, overwrite: bool, otherwise: str = "") -> None:
    """Raise `FileTrouble` if the path exists, even as a broken link, and may not be overwritten.

    `otherwise` is what else the message says may be done: "it is <otherwise>overwritten only with
    ...".
    """
    require("overwrite", overwrite, bool, "True or False")
    if os.path.lexists(path) and not overwrite:
        raise FileTrouble(
            f"{named(path)} exists; it is {otherwise}overwritten only with {OVERWRITE}"
        )


def place_for(path: Path | str, overwrite: bool) -> Path:
    """Return the file that writing to a path makes or replaces: the end of its links.

    Raises `FileTrouble` if the path exists and `overwrite` is false or it is no regular file, or if
    its folder does not exist.
    """
    with in_words(path, "written"):
        target = Path(os.path.realpath(path))
        status = _status(target)
        if status is not None and not stat.S_ISREG(status.st_mode):
            kind = "a folder" if stat.S_ISDIR(status.st_mode) else "a device, pipe or socket"
            raise FileTrouble(f"{named(path)} is {kind}, and not replaced by a file")
        refuse_overwriting(Path(path), overwrite)
        target.parent.stat()
    return target


def make_folder(field: str, path: Path) -> None:
    """Make a folder and the folders around it, where they are missing.

    Raises `InvalidInput` if `path`, the value of a field, is a file, and `FileTrouble` if the
    folder cannot be made.
    """
    if path.exists() and not path.is_dir():
        raise InvalidInput(field, str(path), "a folder")
    with in_words(path, "written"):
        path.mkdir(parents=True, exist_ok=True)


@contextmanager
def written_beside(path: Path | str, overwrite: bool = False) -> Iterator[Path]:
    """Yield a temporary file that is moved to `path` once the block has written it.

    The temporary file is in the same folder, has the suffix of `path` and the permissions of the
    file it replaces, is locked, and is on the disk before it is moved. Temporary files of writers
    that were killed are removed. Raises `FileTrouble` if the file exists and `overwrite` is false,
    or cannot be written; the temporary file is then removed.
    """
    target = place_for(path, overwrite)
    file = None
    with in_words(path, "written"):
        try:
            with deferred():
                _remove_abandoned(target.parent)
                file = _new_file(target)
            beside = Path(file.name)
            yield beside
            os.fsync(file.fileno())
            if sys.platform == "win32":
                file.close()  # Windows moves no open file.
            put_in_place(beside, path, overwrite)
        finally:
            with deferred():
                if file is not None:
                    Path(file.name).unlink(missing_ok=True)
                    file.close()


def put_in_place(beside: Path, path: Path | str, overwrite: bool) -> None:
    """Move a finished file to its place atomically; of several writers of a new file, one succeeds.

    Raises `FileTrouble` as `place_for` does, by the state of the folder at this moment.
    """
    target = place_for(path, overwrite)
    with in_words(path, "written"):
        status = _status(target)
        if status is not None:
            with contextlib.suppress(PermissionError):
                os.chown(beside, status.st_uid, status.st_gid)
            beside.chmod(stat.S_IMODE(status.st_mode))
        if not overwrite:
            _claim(beside, target, path)
        beside.replace(target)
        beside.unlink(missing_ok=True)  # replacing does not remove a second name of the same file


def read_text(
    path: Path | str, accepted: str, decode: Callable[[bytes], str | None] | None = None
) -> str:
    """Return the text of a file; refusals say that the file is not `accepted`.

    `decode` returns the text of its bytes, or None if they are none; by default they are UTF-8, or
    the code page that Windows has in western countries.
    Raises `FileTrouble` if the file cannot be read, is no text, or is longer than `LONGEST_TEXT`.
    """
    with in_words(path, "read"), Path(path).open("rb") as file:
        content = file.read(LONGEST_TEXT + 1)
    if len(content) > LONGEST_TEXT:
        raise FileTrouble(
            f"{named(path)} has more than {LONGEST_TEXT:,} bytes, and is not {accepted}"
        )
    text = _utf8_or_cp1252(content) if decode is None else decode(content)
    if text is None:
        raise FileTrouble(f"{named(path)} is not a text file, and not {accepted}")
    return text


def _utf8_or_cp1252(content: bytes) -> str | None:
    """Return a text in UTF-8, or else in the code page 1252 of Windows, which contains the letters
    of Latin-1; None of bytes that no text has.
    """
    for encoding in ("utf-8-sig", "cp1252"):
        with contextlib.suppress(UnicodeDecodeError):
            text = content.decode(encoding)
            if encoding == "utf-8-sig" or not set(text) & CONTROL_CHARACTERS:
                return text
    return None


@contextmanager
def made_of(path: Path | str, replaced: Container[str] = (), part: str = "") -> Iterator[None]:
    """Name the file in every refusal that the block raises.

    Refusals of `replaced` fields, whose values are not from the file, and refusals that name
    another file stay as they are. If only a part was read from the file, so do those of fields
    outside this part.
    """
    try:
        yield
    except InvalidInput as error:
        elsewhere = part and not f"{error.field}.".startswith(f"{part}.")
        if error.file or elsewhere or error.field.partition(".")[0] in replaced:
            raise
        raise in_file(error, named(Path(path).name)) from None


def named(path: Path | str) -> str:
    """Return a path as sentences show it: on one line, cut to `LONGEST_NAME` letters."""
    text = str(path) if str(path).isprintable() else repr(str(path))
    return text if len(text) <= LONGEST_NAME else f"...{text[-LONGEST_NAME:]}"


def path_of(path: object) -> Path:
    """Return the path of a file or folder by its name; raise `InvalidInput` for no name."""
    if not isinstance(path, str | os.PathLike):
        raise InvalidInput("path", path, "the name of a file or folder")
    return Path(path)


@contextmanager
def in_words(path: Path | str, done: str) -> Iterator[None]:
    """Turn errors of the file system into `FileTrouble`: "<path> cannot be <done>: ..."."""
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
    """Return whether the system could have a file of this name."""
    try:
        return b"\0" not in os.fsencode(path)
    except UnicodeEncodeError:
        return False


def _status(path: Path) -> os.stat_result | None:
    try:
        return path.stat()
    except FileNotFoundError:
        return None


def _new_file(target: Path) -> BinaryIO:
    """Return a new, locked file beside the target, with no wider permissions than the target's."""
    status = _status(target)
    permissions = 0o666 if status is None else stat.S_IMODE(status.st_mode) & 0o666 | 0o600

    def opener(name: str, flags: int) -> int:
        return os.open(name, flags, permissions)

    while True:
        beside = target.with_name(f"{MARK}{secrets.token_hex(6)}{target.suffix[:16]}")
        file = open(beside, "xb", opener=opener)  # noqa: SIM115 - the caller closes it
        # Before it was locked, another writer may have removed it as abandoned.
        if _lock(file.fileno()) is not False and os.fstat(file.fileno()).st_nlink:
            return file
        file.close()


def _remove_abandoned(folder: Path) -> None:
    """Remove the temporary files of writers that have ended: those that nobody has locked."""
    for abandoned in folder.glob(f"{MARK}*"):
        with contextlib.suppress(OSError):
            handle = os.open(abandoned, os.O_RDWR | getattr(os, "O_NOFOLLOW", 0))
            try:
                if stat.S_ISREG(os.fstat(handle).st_mode) and _lock(handle):
                    abandoned.unlink()
            finally:
                os.close(handle)


def _lock(handle: int) -> bool | None:
    """Lock an open file until it is closed; return False if it is locked, None without locks."""
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
    """Make the new target a second name of a file, or an empty file without support for links.

    Raises `FileTrouble` if the target exists.
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
