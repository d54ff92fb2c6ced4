"""One file for each program: how a case is set in it, stepped and read.

`base` says what an adapter is. To add a program, write a file with a class that has `name`,
`package`, `settings`, `refusal` and `start` as `base.Adapter` describes them, and add it to
`ADAPTERS` here; `moreau.py` is the shortest example.
"""

from collections.abc import Mapping
from importlib import import_module
from typing import Any

from tippetop.engines.adapters.base import Adapter

ADAPTERS: Mapping[str, str] = {
    "moreau": "Moreau",
    "mujoco": "MuJoCo",
    "pybullet": "PyBullet",
    "drake": "Drake",
    "exudyn": "Exudyn",
}
"""The classes of the adapters by their names and files."""


def adapter(name: str) -> Adapter:
    """Return the adapter of this name."""
    module: Any = import_module(f"{__name__}.{name}")
    made: Adapter = getattr(module, ADAPTERS[name])()
    return made
