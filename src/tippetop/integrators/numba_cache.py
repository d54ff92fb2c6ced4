"""Functions compiled by numba once, and kept between processes in folders that are whole or not there."""

import contextlib
import hashlib
import json
import math
import os
import shutil
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any, NamedTuple

import llvmlite.binding as llvm
import numba

from tippetop.integrators.cache_folder import cache_folder

SOURCE, SEAL = "source.py", "seal.json"
"""The code in a folder of the cache, and the digests of all else in it."""

PREFIX, MOST = "numba-", 64
"""How the folders are called, and how many there are at most: then the oldest goes."""


def compiled(source: str, signatures: Mapping[str, Any]) -> dict[str, Any]:
    """Some functions of a source, compiled for signatures; its other functions are compiled with them.

    They are taken from the cache, or else kept there. What is damaged in it is thrown away, and where none
    can be kept every process compiles for itself.
    """
    code, kept = _Code(source, signatures), cache_folder()
    if kept is not None:
        with contextlib.suppress(OSError):
            folder = kept / (PREFIX + code.name)
            if _is_whole(folder):
                return code.functions(folder)
            shutil.rmtree(folder, ignore_errors=True)
            return _kept(code, folder)
    return code.functions(None)


class _Code(NamedTuple):
    """A source, and the signatures of the functions in it that are wanted."""

    source: str
    signatures: Mapping[str, Any]

    @property
    def name(self) -> str:
        """What it is, and what it is compiled with, and for."""
        processor = (llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten())
        made = (self.source, str(self.signatures), numba.__version__, sys.version, *processor)
        return _digest(repr(made).encode())[:32]

    def functions(self, folder: Path | None) -> dict[str, Any]:
        """Compile, or load what is in a folder."""
        # What is loaded asks for the module by name.
        module = ModuleType(f"tippetop_compiled_{self.name}")
        sys.modules[module.__name__], place = module, module.__dict__
        place["math"] = math
        exec(compile(self.source, str((folder or Path()) / SOURCE), "exec"), place)
        for name, made in list(place.items()):
            if isinstance(made, FunctionType) and made.__module__ == module.__name__:
                place[name] = numba.njit(error_model="numpy")(made)
        for name, signature in self.signatures.items():
            made = place[name].py_func
            place[name] = numba.njit(signature, error_model="numpy", cache=folder is not None)(made)
        return {name: place[name] for name in self.signatures}


def _kept(code: _Code, folder: Path) -> dict[str, Any]:
    """Compile in a folder beside, which takes its name when it is whole."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    for old in sorted(folder.parent.glob(PREFIX + "*"), key=os.path.getmtime)[: -MOST + 1]:
        shutil.rmtree(old, ignore_errors=True)
    beside = Path(tempfile.mkdtemp(prefix="making-", dir=folder.parent))
    try:
        (beside / SOURCE).write_text(code.source, encoding="utf-8")
        found = code.functions(beside)
        (beside / SEAL).write_text(json.dumps(_digests(beside)), encoding="utf-8")
        with contextlib.suppress(OSError):  # Another process was sooner.
            beside.rename(folder)
    finally:
        shutil.rmtree(beside, ignore_errors=True)
    return found


def _is_whole(folder: Path) -> bool:
    """Whether a folder has what was put there, as it was."""
    try:
        return bool(json.loads((folder / SEAL).read_text(encoding="utf-8")) == _digests(folder))
    except (OSError, ValueError):
        return False


def _digests(folder: Path) -> dict[str, str]:
    files = [path for path in folder.rglob("*") if path.is_file() and path.name != SEAL]
    return {path.relative_to(folder).as_posix(): _digest(path.read_bytes()) for path in files}


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
