"""What installs the package and its parts: the build hook, and the commands that errors name."""

import importlib.util
import json
import os
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest

from tippetop.support import installation

ROOT = Path(__file__).parents[1]


def test_an_extra_is_installed_from_where_the_package_was(tmp_path, monkeypatch):
    class Installed:
        def read_text(self, name):
            return json.dumps({"url": tmp_path.as_uri(), "dir_info": {}})

    monkeypatch.setattr(metadata, "distribution", lambda name: Installed())
    assert installation.install_command("lab") == "pip install 'tippetop[lab]'", "it has moved"
    (tmp_path / "pyproject.toml").touch()
    assert installation.install_command("lab") == f"pip install '{tmp_path}[lab]'"


def test_an_extra_of_a_release_is_installed_by_name(monkeypatch):
    class Installed:
        def read_text(self, name):
            return None

    monkeypatch.setattr(metadata, "distribution", lambda name: Installed())
    assert installation.install_command("sweep") == "pip install 'tippetop[sweep]'"


@pytest.fixture
def hook(monkeypatch):
    """The build hook's module, without the builder."""
    interface = type(sys)("interface")
    interface.BuildHookInterface = object
    monkeypatch.setitem(sys.modules, "hatchling.builders.hooks.plugin.interface", interface)
    spec = importlib.util.spec_from_file_location("hatch_build", ROOT / "hatch_build.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_page_is_built_again_only_where_a_source_is_newer(hook, tmp_path):
    page = tmp_path / "src/tippetop/export/built/lab.html"
    source, made = tmp_path / "web/src/main.js", tmp_path / "web/node_modules/one.js"
    for path in (page, source, made):
        path.parent.mkdir(parents=True)
    assert not hook.is_current(tmp_path)
    for path, when in ((page, 2), (source, 1), (made, 3)):
        path.touch()
        os.utime(path, (when, when))
    assert hook.is_current(tmp_path)
    os.utime(source, (3, 3))
    assert not hook.is_current(tmp_path)


def test_without_a_network_the_rest_is_built_and_the_warning_says_what_to_do(hook, tmp_path):
    def refused(root):
        raise subprocess.CalledProcessError(1, "npm")

    class App:
        said = ""

        def display_warning(self, text):
            self.said += text

    hook.build_page = refused
    made = hook.BrowserBuildHook()
    made.root, made.app = str(tmp_path), App()
    made.initialize("standard", {})
    assert "was not built" in made.app.said
    assert "npm needs a network" in made.app.said
    made.app.said = ""
    made.initialize("editable", {})
    assert made.app.said == ""


def test_the_engine_is_translated_with_no_more_than_the_build_requires():
    """Neither the compiler nor what draws, reads and writes is imported for it.

    What is imported for the translation is imported at its beginning, so that it need not be made.
    """
    code = (
        "import sys; from tippetop.page_engine import generate; generate.translated = lambda _: '';"
        "generate.generated();"
        "print(*{'llvmlite', 'xarray', 'matplotlib', 'h5py', 'typer', 'rich'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""
