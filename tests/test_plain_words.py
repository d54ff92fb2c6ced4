"""What the check of plain words finds, and that the package passes it."""

import ast
import importlib.util
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

TOOL = Path(__file__).parents[1] / "tools" / "plain_words.py"


@pytest.fixture(scope="module")
def tool() -> ModuleType:
    spec = importlib.util.spec_from_file_location("plain_words", TOOL)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize(
    ("code", "faults"),
    [
        ('def speed(v):\n    "Return the speed."\n    length = v\n    return length', 0),
        ('def speed(v):\n    "The speed."', 1),
        ('def speed(given):\n    "Return the speed."\n    found = given', 2),
        ('class A:\n    @property\n    def speed(self):\n        "The speed."', 0),
        ("def speed(self):\n    self._kept = 1", 1),
        ("for thing in range(3):\n    pass", 1),
        ("def width(ends):\n    left, right = ends\n    return right - left", 0),
        ("def width(ends):\n    left = ends\n    return left", 1),
    ],
)
def test_names_and_docstrings_that_say_nothing_are_found(
    tool: ModuleType, code: str, faults: int
) -> None:
    assert len(list(tool.faults_of(Path("a.py"), ast.parse(code)))) == faults


@pytest.mark.parametrize(
    "second",
    [
        "LOOKS = 4",
        "FEW, LOOKS = 1, 4",
        "LOOKS: int = 4",
        "(FEW, LOOKS), MANY = (1, 4), 9",
    ],
)
def test_constants_with_several_values_in_a_folder_are_found(tool: ModuleType, second: str) -> None:
    texts = {"a/b.py": "LOOKS, FEW = 3, 1", "a/c.py": second, "d/e.py": "LOOKS = 5\nFEW = 1"}
    trees = {Path(path): ast.parse(text) for path, text in texts.items()}
    assert list(tool.clashes(trees)) == ["a: LOOKS is 3 and 4"]


@pytest.mark.slow  # of every day it is a part of `make lint`
def test_the_package_passes() -> None:
    done = subprocess.run([sys.executable, TOOL], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
