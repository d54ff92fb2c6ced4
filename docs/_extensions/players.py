"""Runs that play in the page: ``{player}`` with lines of Python that state a `problem`, made at build."""

from typing import Any, ClassVar

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.util.docutils import SphinxDirective

import tippetop as tt

FOLDER = "_players"


class Player(SphinxDirective):
    """A frame that plays the run of the `problem` that its lines of Python state."""

    required_arguments = 1
    final_argument_whitespace = True
    has_content = True
    option_spec: ClassVar = {"name": directives.unchanged_required, "duration": float}

    def run(self) -> list[nodes.Node]:
        """Simulate, write the page, and show it in a frame."""
        name = self.options["name"]
        folder = self.env.app.outdir / FOLDER
        folder.mkdir(parents=True, exist_ok=True)
        namespace: dict[str, Any] = {"tt": tt}
        exec("\n".join(self.content), namespace)
        run = tt.simulate(namespace["problem"], duration=self.options.get("duration", 10.0), samples=4001)
        tt.write_html(run, folder / f"{name}.html", overwrite=True)
        depth = self.env.docname.count("/")
        title = self.arguments[0]
        where = "../" * depth + f"{FOLDER}/{name}.html"
        frame = (
            f'<figure class="player"><iframe src="{where}" title="{title}" loading="lazy" '
            f'allowfullscreen></iframe><figcaption>{title} <a href="{where}">Alone on a page</a></figcaption>'
            "</figure>"
        )
        return [nodes.raw("", frame, format="html")]


def setup(app: Any) -> dict[str, Any]:
    """Register the directive."""
    app.add_directive("player", Player)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
