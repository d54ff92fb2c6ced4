"""The text of an MJCF file: elements with their defaults, and numbers in attributes."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple
from xml.etree import ElementTree as Xml

from tippetop.support.errors import InvalidInput
from tippetop.support.suggestions import not_one_of

MAIN = "main"
"""Name of the default class that every element has."""


class _Builder(Xml.TreeBuilder):
    """Builder of a tree that takes no document type: entities in it could grow without bound."""

    def doctype(self, name: str, pubid: str | None, system: str | None) -> None:
        """Refuse a document type."""
        raise InvalidInput("text", f"<!DOCTYPE {name}>", "", "is not read", "leave it out")


class Document(NamedTuple):
    """An MJCF text: its root and its default classes."""

    root: Xml.Element
    defaults: Mapping[str, Mapping[str, Mapping[str, str]]]
    """Attributes by class and element."""

    @classmethod
    def of(cls, text: str) -> "Document":
        """Return the document of a text; raise `InvalidInput` if it is no MJCF."""
        try:
            root = Xml.fromstring(text, Xml.XMLParser(target=_Builder()))
        except Xml.ParseError as error:
            raise InvalidInput("text", text.strip(), "", "is not XML", str(error)) from None
        if root.tag != "mujoco":
            raise InvalidInput(
                "text", f"<{root.tag}>", "MJCF, whose first element is <mujoco>", hint=_OTHERS
            )
        for element in root.iter():
            if element.tag == "include":
                raise InvalidInput(
                    "include",
                    element.get("file", ""),
                    "",
                    "is another file, which is not read",
                    "put its elements into this one",
                )
        return cls(root, _classes(root))

    def parts(self, tag: str) -> Iterator[Xml.Element]:
        """Yield the elements in all sections of a name, which may be written several times."""
        for section in self.root.iterfind(tag):
            yield from section

    def settings(self, *tags: str) -> dict[str, str]:
        """Return the attributes of a section, such as `compiler`, or of a section in it."""
        merged = dict[str, str]()
        for section in self.root.iterfind("/".join(tags)):
            merged.update(section.attrib)
        return merged

    def attributes(self, element: Xml.Element, child_class: str) -> dict[str, str]:
        """Return the attributes of an element with those of its class.

        `child_class` is the class that the bodies around it state for elements without their own.
        """
        name = element.get("class", child_class)
        if name not in self.defaults:
            raise not_one_of(f"{element_name(element)}.class", name, list(self.defaults))
        return {**self.defaults[name].get(str(element.tag), {}), **element.attrib}


_OTHERS = "URDF and SDF are other formats; MuJoCo's mj_saveLastXML turns URDF into MJCF"


def _classes(root: Xml.Element) -> dict[str, dict[str, dict[str, str]]]:
    """Return the default classes: each has the attributes of the class around it, and its own."""
    classes: dict[str, dict[str, dict[str, str]]] = {MAIN: {}}

    def add(section: Xml.Element, name: str, outer: Mapping[str, Mapping[str, str]]) -> None:
        attributes = {tag: dict(values) for tag, values in outer.items()}
        for element in section:
            if element.tag != "default":
                attributes.setdefault(str(element.tag), {}).update(element.attrib)
        classes[name] = attributes
        for element in section.iterfind("default"):
            if "class" not in element.attrib:
                raise InvalidInput("default", "<default>", "", "in another has no class")
            add(element, element.attrib["class"], attributes)

    for section in root.iterfind("default"):
        name = section.get("class", MAIN)
        add(section, name, classes.get(name, classes[MAIN]))
        classes.setdefault(MAIN, classes[name])
        if not classes[MAIN]:
            classes[MAIN] = classes[name]
    return classes


def element_name(element: Xml.Element, place: str = "") -> str:
    """Return how refusals call an element: "geom 'ball'", or by its place if it has no name."""
    name = element.get("name")
    return f"{element.tag} '{name}'" if name else f"{element.tag}{place}"


def numbers(
    attributes: Mapping[str, str], name: str, field: str, counts: Sequence[int]
) -> tuple[float, ...] | None:
    """Return the numbers of an attribute; None without it.

    `counts` are the accepted counts of numbers. Raises `InvalidInput` for anything else.
    """
    text = attributes.get(name)
    if text is None:
        return None
    try:
        values = tuple(map(float, text.split()))
    except ValueError:
        values = (math.nan,)
    if len(values) not in counts or not all(map(math.isfinite, values)):
        wanted_counts = " or ".join(map(str, counts))
        plural = "s" if tuple(counts) != (1,) else ""
        raise InvalidInput(f"{field}.{name}", text, f"{wanted_counts} finite number{plural}")
    return values


def number(attributes: Mapping[str, str], name: str, field: str, default: float) -> float:
    """Return the number of an attribute, or the default without it."""
    values = numbers(attributes, name, field, (1,))
    return default if values is None else values[0]


def is_true(attributes: Mapping[str, str], name: str) -> bool:
    """Return whether an attribute is "true"."""
    return attributes.get(name) == "true"
