"""Files that are either whole or not there, and never overwritten unasked."""

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tippetop.errors import FileTrouble


def refuse_overwriting(path: Path, overwrite: bool) -> None:
    """Raise `FileTrouble` if the file exists and may not be overwritten."""
    if path.exists() and not overwrite:
        raise FileTrouble(f"{path} exists; it is overwritten only when asked for (--force)")


@contextmanager
def written_beside(path: Path | str) -> Iterator[Path]:
    """A temporary file beside `path`, with its suffix, that takes its place once all is written.

    Raises
    ------
    FileTrouble
        If the file cannot be written; nothing is then left of it.
    """
    path = Path(path)
    try:
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.stem}.", suffix=path.suffix)
        os.close(handle)
        beside = Path(name)
        try:
            yield beside
            beside.chmod(0o666 & ~_umask())
            beside.replace(path)
        finally:
            beside.unlink(missing_ok=True)
    except OSError as error:
        raise FileTrouble(f"{path} cannot be written: {error.strerror or error}") from None


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
