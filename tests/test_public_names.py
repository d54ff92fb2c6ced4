"""The names users see, and what is loaded to show them."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

import tippetop as tt

NEVER_NEEDED = {"matplotlib", "h5py", "scipy", "sympy", "dask"}
HEAVY = sorted({"xarray", "llvmlite", "numpy", "pydantic", "pandas"} | NEVER_NEEDED)


def in_new_process(code):
    """Run code in a process of its own, with warnings as errors; return what it prints."""
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.stderr, done.returncode) == ("", 0)
    return done.stdout.strip()


def loaded_after(code):
    """Which heavy libraries some code loads."""
    return in_new_process(
        f"{code}\nimport sys\nprint(*[name for name in {HEAVY} if sys.modules.get(name)])"
    ).split()


def test_import_loads_no_library():
    assert loaded_after("import tippetop") == []


def test_looking_at_the_names_loads_no_library():
    assert (
        loaded_after("import tippetop; dir(tippetop); tippetop.__version__; tippetop.__doc__") == []
    )


def test_stating_a_problem_loads_no_library_that_only_running_it_needs():
    code = "import tippetop as tt; tt.Problem; tt.InvalidInput; tt.presets.REPORT"
    assert set(loaded_after(code)) & {"matplotlib", "xarray", "llvmlite", "h5py", "scipy"} == set()


def test_simulating_loads_neither_matplotlib_nor_the_laboratory():
    assert (
        set(loaded_after("import tippetop as tt; tt.simulate")) & {"matplotlib", "anywidget"}
        == set()
    )


def test_the_usual_run_at_the_command_line_loads_only_what_it_needs():
    """Where the extra `sweep` is not installed: where it is, xarray loads dask."""
    code = """
import contextlib, io, sys
sys.modules["dask"] = None
from tippetop.cli.main import main
sys.argv = ["tippetop", "simulate", "--duration", "0.1"]
with contextlib.redirect_stdout(io.StringIO()), contextlib.suppress(SystemExit):
    main()
"""
    assert set(loaded_after(code)) & NEVER_NEEDED == set()


AFRESH = """
import sys

def afresh(code):
    'Run code as if the package had not been imported yet.'
    for name in [name for name in sys.modules if name.partition(".")[0] == "tippetop"]:
        del sys.modules[name]
    dataset = getattr(sys.modules.get("xarray"), "Dataset", None)
    if "tippetop" in vars(dataset or object):  # the accessor of the package imported before
        del dataset.tippetop
    names = {}
    exec(code, names)
    return names
"""


def one_name_of_each_room():
    """Return a public name of every folder of the package; each name's file tells its folder."""
    stub = Path(tt.__file__).with_suffix(".pyi").read_text(encoding="utf-8")
    rooms = re.findall(r"^from \.(\w+)(?:\.\w+)* import (\w+) as", stub, re.MULTILINE)
    return sorted(dict(rooms).values())


EACH_FIRST = """
for name in NAMES:
    value = afresh(f"from tippetop import {name}")[name]
    assert value is not None
    assert value is getattr(sys.modules["tippetop"], name)
    home = getattr(value, "__module__", "tippetop")
    assert home.startswith("tippetop"), (name, home)
"""

ALL_AT_ONCE = """
from tippetop import *
assert set(ALL) <= set(dir()), set(ALL) - set(dir())
import pkgutil
from contextlib import suppress
from importlib import import_module
from types import ModuleType
import tippetop
before = {name: getattr(tippetop, name) for name in ALL}
for module in pkgutil.walk_packages(tippetop.__path__, "tippetop."):
    with suppress(ImportError):  # of what is optional
        import_module(module.name)
for name, value in before.items():
    assert getattr(tippetop, name) is value, name
    assert name in ("presets", "extend") or not isinstance(value, ModuleType), name
"""


def test_names_can_be_imported_in_any_order_and_no_module_hides_one():
    """Each room's name first, and then all at once. A module that is imported becomes an attribute
    of its package: none may be called as a public name. One process loads the libraries once.
    """
    names = one_name_of_each_room()
    assert len(names) > 10
    in_new_process(
        f"{AFRESH}\nNAMES = {names}\n{EACH_FIRST}\nafresh({f'ALL = {tt.__all__}{ALL_AT_ONCE}'!r})"
    )


def test_dir_lists_the_public_names_in_order():
    assert dir(tt) == sorted(tt.__all__)
    assert len(set(tt.__all__)) == len(tt.__all__)


def test_what_users_are_shown_is_public():
    shown = """Problem Body EccentricSphere Sphere Ring Spheroid ViscousFriction Launch Contact
        presets simulate summarize plot view sweep predict critical_spins steady_states read_run
        to_dataframe write_run write_csv write_parquet write_glb write_html write_movie
        write_solid
        Workpiece Insert design_insert design_bowl"""
    assert set(shown.split()) <= set(tt.__all__)
    assert callable(tt.simulate)
    assert tt.presets.REPORT_TABLE_1.I1 == tt.presets.REPORT.I3


def test_unknown_name_is_an_attribute_error_that_names_it():
    with pytest.raises(AttributeError, match="simulation"):
        tt.simulation  # noqa: B018
    with pytest.raises(ImportError):
        from tippetop import simulation  # noqa: F401, PLC0415


def test_errors_are_what_their_kind_suggests():
    for error, kinds in {
        tt.InvalidInput: (tt.TippetopError, ValueError),
        tt.FileTrouble: (tt.TippetopError, OSError),
        tt.Unavailable: (tt.TippetopError, RuntimeError),
    }.items():
        assert issubclass(error, kinds[0])
        assert issubclass(error, kinds[1])
