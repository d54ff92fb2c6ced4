"""Functions of many launches compiled by LLVM once, and kept between processes."""

import ctypes
from collections.abc import Callable
from pathlib import Path
from typing import TypeAlias

import llvmlite
import llvmlite.binding as llvm

from tippetop.emit.llvm import llvm_source
from tippetop.emit.recording import Recorded
from tippetop.integrators.base import Array
from tippetop.integrators.sealed_folders import digest, kept
from tippetop.interrupts import heard

NAME, OBJECT = "made", "made.o"
"""What functions are called, and the code in a folder of the cache."""

EFFORT = 2
"""How hard the compiler tries."""

Batch: TypeAlias = Callable[[Array, Array, Array], None]
"""A function of rows of the state, of the parameters, and of room for what it makes of them.

The rows have shape (k, n), with n a multiple of `tippetop.emit.llvm.ABREAST`, and lie one after another.
"""


def batch_function(recorded: Recorded) -> Batch:
    """Compile what was recorded, or take it from the cache."""
    source = llvm_source(recorded, NAME)
    cpu, features = llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()
    made = (source, llvmlite.__version__, llvm.get_process_triple(), cpu, features, EFFORT)
    name = digest(repr(made).encode())[:32]
    return _Loaded(heard(lambda: kept(name, lambda folder: _object(source, folder))))


def _object(source: str, folder: Path | None) -> bytes:
    """Compile, or load what is in a folder."""
    path = (folder or Path()) / OBJECT
    if folder is not None and path.exists():
        return path.read_bytes()
    content = _compiled(source)
    if folder is not None:
        path.write_bytes(content)
    return content


def _compiled(source: str) -> bytes:
    return bytes(_machine().emit_object(llvm.parse_assembly(source)))


def _machine() -> llvm.TargetMachine:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    cpu, features = llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()
    target = llvm.Target.from_triple(llvm.get_process_triple())
    return target.create_target_machine(cpu=cpu, features=features, opt=EFFORT, jit=True)


class _Loaded:
    """Compiled code in the memory of this process."""

    def __init__(self, content: bytes) -> None:
        self._engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _machine())
        self._engine.add_object_file(llvm.ObjectFileRef.from_data(content))
        self._engine.finalize_object()
        kind = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 3, ctypes.c_int64)
        self._function = kind(self._engine.get_function_address(NAME))

    def __call__(self, y: Array, p: Array, out: Array) -> None:
        """Compute, for as many launches as the rows have numbers."""
        self._function(*map(_address, (y, p, out)), y.shape[1])


def _address(rows: Array) -> int:
    assert rows.flags.c_contiguous, "rows are passed as they lie in memory"
    # Several times as fast as `rows.ctypes.data`.
    return int(rows.__array_interface__["data"][0])
