"""The source as a whole: no circular imports, no class name used twice, and a map that is true."""

import ast
import importlib.util
import json
import re
import subprocess
import sys
from collections import Counter
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from types import ModuleType

import grimp
import pytest

import tippetop

SOURCE = Path(tippetop.__file__).parent
ROOT = Path(__file__).parents[1]
GUIDE = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
FIRST_CALLS = """
import json, sys
import tippetop as tt
problem, calls = tt.presets.report_problem(), {}
def note(frame, event, argument):
    if event == "call":
        calls.setdefault((frame.f_code.co_filename, frame.f_code.co_qualname))
tt.simulate
sys.setprofile(note)
tt.simulate(problem, 0.5)
sys.setprofile(None)
print(json.dumps(list(calls)))
"""


@pytest.fixture(scope="module")
def house() -> ModuleType:
    spec = importlib.util.spec_from_file_location("house", ROOT / "docs" / "house.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_no_module_imports_itself_by_way_of_others() -> None:
    graph = grimp.build_graph("tippetop", exclude_type_checking_imports=True, cache_dir=None)
    imports = {module: graph.find_modules_directly_imported_by(module) for module in graph.modules}
    assert sum(map(len, imports.values())) > len(imports), "they do import each other"
    try:
        TopologicalSorter(imports).prepare()
    except CycleError as error:
        pytest.fail(" imports ".join(error.args[1][::-1]))


def test_no_two_classes_share_a_name() -> None:
    names = Counter(
        node.name
        for path in SOURCE.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.ClassDef)
    )
    assert {name for name, count in names.items() if count > 1} == set()


def test_the_map_shows_the_imports_that_there_are(house: ModuleType) -> None:
    assert house.PICTURE.read_text(encoding="utf-8") == house.picture(), "run `make map`"


def test_the_map_leaves_out_what_is_reached_through_another_room(house: ModuleType) -> None:
    imports = {"a": {"b", "c", "d"}, "b": {"c"}, "c": set(), "d": {"c"}}
    assert house.reduced(imports) == {"a": {"b", "d"}, "b": {"c"}, "c": set(), "d": {"c"}}
    assert house.ranks(imports) == {"c": 0, "b": 1, "d": 1, "a": 2}


def test_every_path_in_the_guide_exists() -> None:
    paths = re.findall(r"`((?:[\w.-]+/)+[\w.-]*|\w+\.(?:md|py|toml))`|\]\((.+?)\)", GUIDE)
    named = [quoted or linked for quoted, linked in paths]
    assert len(named) > 40
    assert [path for path in named if not any((at / path).exists() for at in (ROOT, SOURCE))] == []


ROOMS = ("contact", "fit", "lathe", "mechanics", "mechanics/contacts", "results", "theory")


@pytest.mark.parametrize("room", ROOMS)
def test_the_modules_that_a_room_names_exist(room: str) -> None:
    guide = ast.get_docstring(ast.parse((SOURCE / room / "__init__.py").read_text("utf-8")))
    named = set(re.findall(r"`([a-z_]+)`", guide or ""))
    assert len(named) > 5
    assert named <= {path.stem for path in (SOURCE / room).iterdir()}


def test_every_target_in_the_guide_exists() -> None:
    quoted = re.findall(r"`make ([^`]+)`", GUIDE)
    named = {target for targets in quoted for target in targets.split()}
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    lines = re.findall(r"^([\w-]+(?: [\w-]+)*):(?!=)", makefile, re.MULTILINE)
    assert len(named) > 10
    assert named - {target for line in lines for target in line.split()} == set()


@pytest.fixture(scope="module")
def calls() -> list[tuple[str, str]]:
    """Functions in the order in which a launch first calls them: file and name."""
    done = subprocess.run(
        [sys.executable, "-c", FIRST_CALLS], capture_output=True, text=True, check=True
    )
    return [tuple(call) for call in json.loads(done.stdout)]


def test_a_launch_calls_what_the_guide_tells(calls: list[tuple[str, str]]) -> None:
    told = re.findall(r"^\d+\. `src/tippetop/([\w/]+\.py)`, `([\w.]+)`", GUIDE, re.MULTILINE)
    assert len(told) > 10
    assert {(str(SOURCE / path), name) for path, name in told} <= set(calls)


def test_an_equation_becomes_a_number_as_the_guide_tells(calls: list[tuple[str, str]]) -> None:
    step = r"^(\d+)\. [\w ]+: `src/tippetop/([\w/]+\.py)`, `([\w.]+)`"
    told = re.findall(step, GUIDE, re.MULTILINE)
    assert [int(number) for number, *_ in told] == list(range(1, 9))
    called = {int(number) for number, path, name in told if (str(SOURCE / path), name) in calls}
    assert called == set(range(1, 7))
    _, path, name = told[-1]
    assert f"def {name}(" in (SOURCE / path).read_text(encoding="utf-8")
