"""Equations as MathML, which browsers draw themselves: nothing is loaded, and screen readers read
them.
"""

import re
from html import unescape
from typing import Any
from xml.etree import ElementTree

from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml

MATHML = "http://www.w3.org/1998/Math/MathML"

BOLD = {"omega": "\U0001d74e", "beta": "\U0001d737", "zeta": "\U0001d73b", "vartheta": "\U0001d751"}
"""Greek vectors: bold italic letters."""

SPELLED: list[tuple[re.Pattern[str], Any]] = [
    (re.compile(r"(frac)(\d)(\d)"), r"\1{\2}{\3}"),
    (
        re.compile(r"\\boldsymbol(?:\{\\([a-z]+)\}|\\([a-z]+))"),
        lambda found: BOLD[found[1] or found[2]],
    ),
    (re.compile(r"\|([^|]{1,30})\|"), r"\\lvert \1\\rvert "),
]
"""What TeX understands and the converter does not, spelled out."""


NAMED = re.compile(r"&(?!amp;|lt;|gt;)[a-zA-Z]+;")
"""Characters by names that XML does not know."""


def mathml(tex: str, as_block: bool = False) -> str:
    """The MathML of an equation; an index stands beside what bears a dot, and bars stand close."""
    for short, full in SPELLED:
        tex = short.sub(full, tex)
    ElementTree.register_namespace("", MATHML)
    plain = NAMED.sub(lambda found: unescape(found[0]), tex2mathml(tex, as_block=as_block))
    tree = ElementTree.fromstring(plain)
    for found in tree.iter(f"{{{MATHML}}}munderover"):
        base, index, accent = list(found)
        found.tag = f"{{{MATHML}}}msub"
        found[:] = [ElementTree.Element(f"{{{MATHML}}}mover", accent="true"), index]
        found[0].extend([base, accent])
    for bar in tree.iter(f"{{{MATHML}}}mo"):
        if bar.text == "|":
            bar.set("form", "prefix" if bar.get("class") == "mathopen" else "postfix")
            # The closing one may bear an exponent, alone, and would not stretch as the other does.
            bar.set("stretchy", "false")
    return ElementTree.tostring(tree, encoding="unicode")


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
