"""Functions compiled by numba once, and kept between processes."""

import math
import sys
from collections.abc import Mapping
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any, NamedTuple

import llvmlite.binding as llvm
import numba

from tippetop.integrators.sealed_folders import digest, kept
from tippetop.interrupts import heard

SOURCE = "source.py"
"""The code in a folder of the cache."""


def compiled(source: str, signatures: Mapping[str, Any]) -> dict[str, Any]:
    """Some functions of a source, compiled for signatures; its other functions are compiled with them.

    They are taken from the cache, or else kept there. What is damaged in it is thrown away, and where none
    can be kept every process compiles for itself.
    """
    code = _Code(source, signatures)
    return heard(lambda: kept(code.name, code.functions))


class _Code(NamedTuple):
    """A source, and the signatures of the functions in it that are wanted."""

    source: str
    signatures: Mapping[str, Any]

    @property
    def name(self) -> str:
        """What it is, and what it is compiled with, and for."""
        processor = (llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten())
        made = (self.source, str(self.signatures), numba.__version__, sys.version, *processor)
        return digest(repr(made).encode())[:32]

    def functions(self, folder: Path | None) -> dict[str, Any]:
        """Compile, or load what is in a folder."""
        # What is loaded asks for the module by name.
        module = ModuleType(f"tippetop_compiled_{self.name}")
        sys.modules[module.__name__], place = module, module.__dict__
        place["math"] = math
        path = (folder or Path()) / SOURCE
        if folder is not None and not path.exists():
            path.write_text(self.source, encoding="utf-8")
        exec(compile(self.source, str(path), "exec"), place)
        for name, made in list(place.items()):
            if isinstance(made, FunctionType) and made.__module__ == module.__name__:
                place[name] = numba.njit(error_model="numpy")(made)
        for name, signature in self.signatures.items():
            made = place[name].py_func
            place[name] = numba.njit(signature, error_model="numpy", cache=folder is not None)(made)
        return {name: place[name] for name in self.signatures}
