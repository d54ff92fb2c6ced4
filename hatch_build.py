"""Builds what runs in browsers when a package is made or installed from the source."""

import os
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

ROOT = Path(__file__).resolve().parent
sys.path.insert(0, str(ROOT / "web"))

import node_tools  # noqa: E402 - it lies in web/

BUILT = Path("src/tippetop/export/built")
REASON = "not_built.txt"
"""File in the package that says why the page is not built; `tippetop lab` reads it."""


class BrowserBuildHook(BuildHookInterface):
    """Translates the page's engine and bundles `web/` with node and npm.

    Where this fails, for want of a network for npm, the package is made without the page and says
    why.
    """

    PLUGIN_NAME = "custom"

    def dependencies(self) -> list[str]:
        """Return what has to be installed to build: node, where it is needed and missing."""
        if is_current(Path(self.root)) or node_tools.machine_commands():
            return []
        return [node_tools.NODE_WHEEL]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build the page unless it is newer than its sources."""
        root = Path(self.root)
        if is_current(root):
            return
        try:
            build_page(root)
        except node_tools.Failed as error:
            leave_out(root, str(error))
            self.app.display_warning(
                f"What runs in browsers was not built, since {error}: `tippetop lab`, the player"
                " and --html will say so. All else works."
            )


def is_current(root: Path) -> bool:
    """Return whether the page is there and newer than everything that it is built from.

    The page of an sdist was built with it: unpacking need not keep the times of its files.
    """
    page = root / BUILT / "lab.html"
    if not page.exists():
        return False
    if (root / "PKG-INFO").exists():
        return True
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
    """Translate the engine, fetch the packages that `web/package.json` names, and bundle.

    Raises `node_tools.Failed` with the reason if one of these fails.
    """
    # `python -m` finds the package in the folder that it runs in, unless PYTHONSAFEPATH is set.
    # PYTHONPATH cannot name that folder: pip's isolated builds take the folders of installed
    # packages out of it, and an earlier editable installation makes the source one of them.
    translate = [sys.executable, "-m", "tippetop.page_engine"]
    environment = {**os.environ, "TIPPETOP_CACHE": "off"}
    environment.pop("PYTHONSAFEPATH", None)
    node_tools.run("translating the engine", translate, root / "src", environment)
    node_tools.bundle()
    (root / BUILT / REASON).unlink(missing_ok=True)


def leave_out(root: Path, reason: str) -> None:
    """Put the reason why the page is not built into its place."""
    folder = root / BUILT
    folder.mkdir(parents=True, exist_ok=True)
    for path in folder.iterdir():
        path.unlink()
    (folder / REASON).write_text(f"{reason}\n", encoding="utf-8")
