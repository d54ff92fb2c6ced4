"""Frames in pages: ``{player}`` plays the run of a `problem` that its lines state, ``{laboratory}``
is the laboratory, and ``{torque}`` its picture of the torque that lifts the stem. ``{launch}`` is a
link to the laboratory without a frame.
"""

import shutil
from html import escape
from pathlib import Path
from typing import Any, ClassVar

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.util.docutils import SphinxDirective

import tippetop as tt
from tippetop.lab.serve import page_path

FOLDER = "_players"


class Frame(SphinxDirective):
    """A frame that shows a page of its own, with a caption."""

    required_arguments = 1
    final_argument_whitespace = True

    @property
    def folder(self) -> Path:
        """Where such pages are."""
        found: Path = self.env.app.outdir / FOLDER
        found.mkdir(parents=True, exist_ok=True)
        return found

    def place(self, name: str, link: str = "") -> str:
        """The address of the page of a name, opened at a link."""
        return "../" * self.env.docname.count("/") + f"{FOLDER}/{name}.html{link}"

    def frame(self, name: str, kind: str, link: str = "") -> list[nodes.Node]:
        """The frame with the page of a name, opened at a link."""
        title, where = self.arguments[0], self.place(name, link)
        frame = (
            f'<figure class="{kind}"><iframe src="{where}" title="{title}" loading="lazy"'
            f' allowfullscreen></iframe><figcaption>{title} <a href="{where}">Alone on a'
            " page</a></figcaption></figure>"
        )
        return [nodes.raw("", frame, format="html")]


class Laboratory(Frame):
    """The laboratory, as `tippetop lab` opens it, or at what a link says."""

    option_spec: ClassVar = {"link": directives.unchanged_required}

    def run(self) -> list[nodes.Node]:
        """Copy its page, and show it in a frame."""
        shutil.copyfile(page_path(), self.folder / "lab.html")
        link = self.options.get("link", "")
        return self.frame("lab", "player laboratory", f"#{escape(link)}" if link else "")


class Launch(Frame):
    """A link to the laboratory at a launch."""

    option_spec: ClassVar = {"link": directives.unchanged_required}

    def run(self) -> list[nodes.Node]:
        """Copy its page, and link to it."""
        shutil.copyfile(page_path(), self.folder / "lab.html")
        where = self.place("lab", f"#{escape(self.options['link'])}")
        text = f'<p class="launch"><a href="{where}">{self.arguments[0]}</a></p>'
        return [nodes.raw("", text, format="html")]


class Torque(Frame):
    """The laboratory's picture of the torque that lifts the stem."""

    def run(self) -> list[nodes.Node]:
        """Copy the laboratory's page, and show its picture in a frame."""
        shutil.copyfile(page_path(), self.folder / "lab.html")
        return self.frame("lab", "player picture", "#picture=torque&amp;lang=en")


class Player(Frame):
    """A frame that plays the run of the `problem` that its lines of Python state."""

    has_content = True
    option_spec: ClassVar = {"name": directives.unchanged_required, "duration": float}

    def run(self) -> list[nodes.Node]:
        """Simulate, write the page, and show it in a frame."""
        name = self.options["name"]
        namespace: dict[str, Any] = {"tt": tt}
        exec("\n".join(self.content), namespace)
        run = tt.simulate(
            namespace["problem"], duration=self.options.get("duration", 10.0), samples=4001
        )
        tt.write_html(run, self.folder / f"{name}.html", overwrite=True)
        return self.frame(name, "player")


def setup(app: Any) -> dict[str, Any]:
    """Register the directives."""
    app.add_directive("player", Player)
    app.add_directive("laboratory", Laboratory)
    app.add_directive("launch", Launch)
    app.add_directive("torque", Torque)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
