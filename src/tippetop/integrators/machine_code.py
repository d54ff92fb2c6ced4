"""Recorded functions compiled by LLVM once, and kept between processes."""

import ctypes
from collections.abc import Callable, Mapping
from typing import Any, cast

import llvmlite
import llvmlite.binding as llvm

from tippetop.graph.llvm import llvm_source
from tippetop.graph.recording import Recorded
from tippetop.integrators.base import Array
from tippetop.integrators.sealed_folders import kept_content
from tippetop.support.interrupts import run_interruptibly

EFFORT = 1
"""How hard the compiler tries, of 3: with 2 it takes an eighth longer, and its code runs no faster;
with 0 it takes a third of the time, and its code a third longer, and rounds products before sums.
"""

FORMATS = (b"\x7fELF", b"\xcf\xfa\xed\xfe", b"\x64\x86", b"\x64\xaa")
"""First bytes of object files on Linux, macOS and Windows. LLVM crashes on what is none."""


def machine_code(
    functions: Mapping[str, Recorded], abreast: int = 1, effort: int | None = None
) -> "dict[str, Compiled]":
    """Compile what was recorded, for so many launches an instruction, or take it from the cache."""
    engine = loaded(llvm_source(functions, abreast), effort)
    return {name: Compiled(engine, name, bool(one.optional)) for name, one in functions.items()}


def iteration(function: Recorded, abreast: int, effort: int | None = None) -> Callable[..., int]:
    """Compile a function that is iterated, of arrays of `ctypes`; see `llvm_source`."""
    engine = loaded(llvm_source({"made": function}, abreast, again=True), effort)
    kind = ctypes.CFUNCTYPE(ctypes.c_int64, *[ctypes.c_void_p] * 3, ctypes.c_double, ctypes.c_int64)
    compiled: Any = kind(engine.get_function_address("made"))
    compiled.engine = engine
    return cast(Callable[..., int], compiled)


def loaded(source: str, effort: int | None = None) -> llvm.ExecutionEngine:
    """Return the machine code of a source, compiled with an effort or taken from the cache."""
    effort = EFFORT if effort is None else effort
    made = (source, llvmlite.__version__, effort)
    content = run_interruptibly(lambda: kept_content(made, lambda: _compiled(source, effort)))
    if not content.startswith(FORMATS):
        content = run_interruptibly(lambda: _compiled(source, effort))
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _machine())
    engine.add_object_file(llvm.ObjectFileRef.from_data(content))
    engine.finalize_object()
    return engine


def _compiled(source: str, effort: int) -> bytes:
    return bytes(_machine(effort).emit_object(llvm.parse_assembly(source)))


def _machine(effort: int = EFFORT) -> llvm.TargetMachine:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    cpu, features = llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()
    target = llvm.Target.from_triple(llvm.get_process_triple())
    return target.create_target_machine(cpu=cpu, features=features, opt=effort, jit=True)


class Compiled:
    """A compiled function of rows of the state, of the parameters, and of room for what it makes of
    them.

    A row is a number, or has one for each of n launches, n a multiple of how many the code takes
    an instruction; they lie one after another.
    """

    def __init__(self, engine: llvm.ExecutionEngine, name: str, gives_more: bool) -> None:
        self.engine, self.address = engine, engine.get_function_address(name)
        self._gives_more = gives_more
        places = [ctypes.c_void_p] * 3, [ctypes.c_void_p] * gives_more
        self._function = ctypes.CFUNCTYPE(None, *places[0], ctypes.c_int64, *places[1])(
            self.address
        )

    def __call__(self, y: Array, p: Array, out: Array, optional: Array | None = None) -> None:
        """Compute, for as many launches as the rows have numbers, and give more if that is asked
        for.
        """
        asked = [None if optional is None else _address(optional)] * self._gives_more
        self._function(*map(_address, (y, p, out)), y.shape[1] if y.ndim > 1 else 1, *asked)


def _address(rows: Array) -> int:
    """Return the address of rows that lie one after another, in a quarter of the time that
    `rows.ctypes.data` takes.
    """
    return ctypes.addressof(ctypes.c_char.from_buffer(rows.data)) if rows.size else 0
