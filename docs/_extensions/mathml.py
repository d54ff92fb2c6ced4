"""Equations as MathML, which browsers draw themselves: nothing is loaded, and screen readers read them."""

import re
from typing import Any

from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml

SPELLED: list[tuple[re.Pattern[str], str]] = [
    (re.compile(r"(frac)(\d)(\d)"), r"\1{\2}{\3}"),
    (re.compile(r"\\boldsymbol(\\[A-Za-z]+)"), r"\\boldsymbol{\1}"),
    (re.compile(r"\|([^|]{1,30})\|"), r"\\lvert \1\\rvert "),
]
"""What TeX understands and the converter does not, spelled out."""


def mathml(tex: str, as_block: bool = False) -> str:
    """The MathML of an equation; an index stands beside what bears a dot, not under it."""
    for short, full in SPELLED:
        tex = short.sub(full, tex)
    found = str(tex2mathml(tex, as_block=as_block))
    return found.replace("<munder>", "<msub>").replace("</munder>", "</msub>")


def inline(self: Any, node: nodes.math) -> None:
    """An equation within a line."""
    self.body.append(mathml(node.astext()))
    raise nodes.SkipNode


def block(self: Any, node: nodes.math_block) -> None:
    """An equation on its own, with its number where it has a label."""
    tex = node.astext()
    if "\\\\" in tex and r"\begin" not in tex:
        tex = rf"\begin{{aligned}}{tex}\end{{aligned}}"
    self.body.append(self.starttag(node, "div", CLASS="math notranslate", tabindex="0"))
    if node.get("number"):
        self.body.append(f'<span class="eqno">({node["number"]})')
        self.add_permalink_ref(node, "Link to this equation")
        self.body.append("</span>")
    self.body.append(mathml(tex, as_block=True) + "</div>\n")
    raise nodes.SkipNode


def setup(app: Any) -> dict[str, Any]:
    """Register the renderer."""
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
