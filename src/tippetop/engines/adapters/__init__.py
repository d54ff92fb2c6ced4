"""One file for each program: how a case is set in it, stepped and read.

`base` says what an adapter is. To compare a program that is not here, write a file with one class
that has `name`, `settings`, `refusal` and `start` as `base.Adapter` describes them, and name it:
``tippetop engines --engine my_engine.py``. `moreau.py` is the shortest example. A program is added
to the package by such a file here and a line in `ADAPTERS`.
"""

from collections.abc import Mapping
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import Any

from tippetop.engines.adapters.base import Adapter, Setting, refusals
from tippetop.engines.cases import CASES
from tippetop.support.errors import InvalidInput
from tippetop.support.files import read_text
from tippetop.support.suggestions import not_one_of

ADAPTERS: Mapping[str, str] = {
    "moreau": "Moreau",
    "mujoco": "MuJoCo",
    "pybullet": "PyBullet",
    "drake": "Drake",
    "exudyn": "Exudyn",
    "rapier": "Rapier",
    "newton": "Newton",
}
"""The classes of the adapters by their names and files."""

FILE_ENDING = ".py"

PARTS = ("name", "settings", "refusal", "start")
"""What the class of an adapter has."""


def adapter(name: str) -> Adapter:
    """Return the adapter of a name, or of a file; raise `InvalidInput` if there is none."""
    if name.endswith(FILE_ENDING):
        return _adapter_in(name)
    if name not in ADAPTERS:
        raise not_one_of("engine", name, [*ADAPTERS, "a file such as my_engine.py"])
    module: Any = import_module(f"{__name__}.{name}")
    made: Adapter = getattr(module, ADAPTERS[name])()
    return made


def results_name(name: str) -> str:
    """Return what the results of an adapter are called, which may be in a file."""
    return Path(name).stem if name.endswith(FILE_ENDING) else name


def _adapter_in(path: str) -> Adapter:
    """Return the adapter in a file."""
    read_text(path, "a Python file with an adapter")
    specification = spec_from_file_location(Path(path).stem, path)
    if specification is None or specification.loader is None:
        raise InvalidInput("engine", path, "a Python file with an adapter")
    module = module_from_spec(specification)
    try:
        specification.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        raise _failure(path, error) from error
    classes = [
        one
        for one in vars(module).values()
        if isinstance(one, type)
        and one.__module__ == module.__name__
        and hasattr(one, "start")
        and hasattr(one, "settings")
    ]
    if len(classes) != 1:
        raise InvalidInput(
            "engine",
            path,
            "a file with one class that has name, settings, refusal and start",
            f"has {len(classes)} classes with settings and start",
        )
    missing = [part for part in PARTS if not hasattr(classes[0], part)]
    if missing:
        raise InvalidInput("engine", path, "", f"has a class without {', '.join(missing)}")
    try:
        made: Adapter = classes[0]()
        if not made.settings or not all(isinstance(one, Setting) for one in made.settings):
            raise TypeError("settings are no tuple of tippetop.engines.adapters.base.Setting")
        refusals(made, CASES)
    except (Exception, SystemExit) as error:
        raise _failure(path, error) from error
    for optional in ("package", "module"):
        if not hasattr(made, optional):
            setattr(made, optional, None)
    made.file = path  # type: ignore[attr-defined]
    return made


def _failure(path: str, error: BaseException) -> InvalidInput:
    """Return the refusal of a file that raises an error, with the line where it does."""
    place = error.__traceback__
    lines = []
    while place is not None:
        if place.tb_frame.f_code.co_filename == path:
            lines.append(place.tb_lineno)
        place = place.tb_next
    where = f" in line {lines[-1]}" if lines else ""
    message = " ".join(str(error).split())[:200]
    return InvalidInput("engine", path, "", f"raises {type(error).__name__}{where}: {message}")
