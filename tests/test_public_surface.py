"""The public names, their parameters and attributes change only on purpose.

`public_surface.txt` lists them. Run ``python tests/test_public_surface.py`` to write it anew, and
mention in the changelog what its difference shows; a name that goes is deprecated first (see the
documentation of `tippetop.extend`).
"""

import enum
import inspect
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any, get_origin

import tippetop as tt
from tippetop.problem import presets

SURFACE = Path(__file__).with_name("public_surface.txt")


def public_surface() -> list[str]:
    """Return a line for every public name, and for every public attribute of a public class."""
    lines = [f"{name} {BODY}" for name in sorted(presets.BODIES)]
    lines += [line for name in tt.__all__ for line in _lines(f"tt.{name}", getattr(tt, name))]
    lines += [
        line
        for name in tt.extend.__all__
        for line in _lines(f"tt.extend.{name}", getattr(tt.extend, name))
    ]
    return sorted(set(lines))


BODY = "(preset of a body)"


def _lines(name: str, value: Any) -> Iterator[str]:
    if isinstance(value, ModuleType):
        yield f"{name} (module)"
    elif isinstance(value, type):
        yield f"{name}{_parameters(value)}"
        yield from (f"{name}.{attribute}" for attribute in _attributes(value))
    elif get_origin(value) is not None:
        yield name  # what it can be called with differs by the version of Python
    elif callable(value):
        yield f"{name}{_parameters(value)}"
    else:
        yield f"{name} (constant)"


def _parameters(value: Any) -> str:
    """Return the names of parameters in brackets, with "=" where there is a default."""
    if isinstance(value, type) and issubclass(value, enum.Enum | Exception):
        return ""
    try:
        parameters = inspect.signature(value).parameters.values()
    except (TypeError, ValueError):
        return ""
    texts, has_star = [], False
    for one in parameters:
        if one.name.startswith("_"):
            continue
        if one.kind is one.KEYWORD_ONLY and not has_star:
            texts.append("*")
        has_star |= one.kind in (one.KEYWORD_ONLY, one.VAR_POSITIONAL)
        star = {one.VAR_POSITIONAL: "*", one.VAR_KEYWORD: "**"}.get(one.kind, "")
        texts.append(f"{star}{one.name}{'=' * (one.default is not one.empty)}")
    return f"({', '.join(texts)})"


def _attributes(kind: type) -> list[str]:
    """Return the public attributes that classes of this package define."""
    ours = [base for base in kind.__mro__ if base.__module__.startswith("tippetop.")]
    names = {
        name for base in ours for name in (*vars(base), *vars(base).get("__annotations__", ()))
    }
    return sorted(name for name in names if not name.startswith(("_", "model_")))


def test_the_public_surface_is_the_listed_one() -> None:
    listed, present = SURFACE.read_text(encoding="utf-8").splitlines(), public_surface()
    gone, new = sorted(set(listed) - set(present)), sorted(set(present) - set(listed))
    assert not gone, f"no longer public, or changed: {gone}; deprecate it, or write the list anew"
    assert not new, f"newly public, or changed: {new}; write the list anew"


def test_names_of_extend_are_those_it_defines() -> None:
    present = {
        name
        for name, value in vars(tt.extend).items()
        if not name.startswith("_") and not isinstance(value, ModuleType)
    }
    assert present - set(tt.extend.__all__) <= {"Any", "Node", "power"}
    assert set(tt.extend.__all__) <= present


if __name__ == "__main__":
    SURFACE.write_text("\n".join(public_surface()) + "\n", encoding="utf-8")
