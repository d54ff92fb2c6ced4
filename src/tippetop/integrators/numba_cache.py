"""Functions compiled by numba once, and kept between processes."""

import math
import os
import sys
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

import numba

from tippetop.integrators.sealed_folders import kept
from tippetop.support.interrupts import heard

OPTIONS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}}
"""How functions are compiled: a sum and a product may be rounded together, as in what LLVM
compiles.
"""

SOURCE = "source.py"
"""The code in a folder of the cache."""


def compiled(source: str, signatures: Mapping[str, Any]) -> dict[str, Any]:
    """Some functions of a source, compiled for signatures; its other functions are compiled with
    them.

    They are taken from the cache, or else kept there; see `kept`.
    """
    made = (source, str(signatures), str(OPTIONS), numba.__version__, sys.version)
    return heard(lambda: kept(made, lambda folder: _functions(source, signatures, folder)))


def _functions(source: str, signatures: Mapping[str, Any], folder: Path | None) -> dict[str, Any]:
    """Compile, or load what is in a folder."""
    # What is loaded asks for the module by name.
    module = ModuleType(f"tippetop_compiled_{sha256(source.encode()).hexdigest()}")
    sys.modules[module.__name__], place = module, module.__dict__
    place["math"] = math
    path = (folder or Path()) / SOURCE
    # numba takes code only from where it could put some.
    cached = folder is not None and os.access(folder, os.W_OK)
    if folder is not None and not path.exists():
        path.write_text(source, encoding="utf-8")
    exec(compile(source, str(path), "exec"), place)
    for name, made in list(place.items()):
        if isinstance(made, FunctionType) and made.__module__ == module.__name__:
            place[name] = numba.njit(forceinline=True, **OPTIONS)(made)
    for name, signature in signatures.items():
        made = place[name].py_func
        place[name] = numba.njit(signature, cache=cached, **OPTIONS)(made)
    return {name: place[name] for name in signatures}
