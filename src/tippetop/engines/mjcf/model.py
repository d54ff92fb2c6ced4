"""What an MJCF file has: one free body, what is fixed, and what touches what."""

import math
from collections.abc import Mapping
from typing import NamedTuple
from xml.etree import ElementTree as Xml

import numpy as np

from tippetop.engines.mjcf.document import (
    MAIN,
    Document,
    element_name,
    is_true,
    number,
    numbers,
)
from tippetop.engines.mjcf.geoms import Geom, Mass, condim_of, geom_of, mass_of, total
from tippetop.engines.mjcf.poses import ORIGIN, AngleUnits, Pose, matrix, pose_of
from tippetop.support.errors import MISSING, Described, InvalidInput

IGNORED_SECTIONS = {
    "asset",
    "visual",
    "statistic",
    "size",
    "sensor",
    "custom",
    "compiler",
    "option",
}
"""Sections that say nothing of the motion, or are read by name."""

IGNORED_IN_BODIES = {"site", "camera", "light", "inertial", "joint", "freejoint"}
"""Elements of bodies that say nothing of the motion, or are read by name."""


class Members(NamedTuple):
    """The geoms and masses of a body and of the bodies fixed to it, in its frame."""

    name: str
    geoms: list[Geom]
    masses: list[Mass]


class Pair(NamedTuple):
    """Friction between two geoms: dimension of the contact, sliding, drilling and rolling."""

    condim: int
    friction: tuple[float, ...]


class MjcfModel:
    """Bodies, geoms and contacts of a document."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self.compiler = document.settings("compiler")
        self.angles = AngleUnits.of(self.compiler)
        self._refuse_settings()
        self.world = Members("world", [], [])
        self.free: list[tuple[Xml.Element, Pose, str]] = []
        for section in document.root.iterfind("worldbody"):
            self._collect(section, ORIGIN, MAIN, self.world, "world")

    def top(self) -> tuple[Members, Pose]:
        """Return the one free body, and its pose in the model."""
        if len(self.free) != 1:
            names = ", ".join(element_name(element) for element, *_ in self.free)
            raise InvalidInput(
                "worldbody",
                Described(names or "no body with a free joint"),
                "one body with a <freejoint/>",
            )
        element, pose, child_class = self.free[0]
        self._refuse_joint(element, child_class)
        members = Members(element.get("name", ""), [], [])
        self._collect(element, ORIGIN, child_class, members, element_name(element))
        return members, pose

    def mass(self, top: Members) -> Mass:
        """Return mass, centre of mass and inertia of the free body, in its frame."""
        if not top.masses or not sum(mass.mass for mass in top.masses) > 0.0:
            hint = "state the body's <inertial>, or give a geom in it a mass or a density"
            raise InvalidInput(f"mass of body '{top.name}'", MISSING, "", hint=hint)
        together = total(top.masses)
        wanted_total = number(self.compiler, "settotalmass", "compiler", -1.0)
        return together.scaled(wanted_total / together.mass) if wanted_total > 0.0 else together

    def table(self, top: Members) -> tuple[Geom, list[tuple[Geom, Pair]]]:
        """Return the plane that the body touches, and its geoms that do with their friction."""
        pairs = self._pairs()
        touching: list[tuple[Geom, Geom, Pair]] = []
        for inner in top.geoms:
            for outer in self.world.geoms:
                pair = pairs.get(frozenset((inner.name, outer.name))) if inner.name else None
                pair = pair or _mixed(inner, outer)
                if pair is not None:
                    touching.append((inner, outer, pair))
        tables = {id(outer): outer for _, outer, _ in touching}
        for outer in tables.values():
            if outer.kind != "plane":
                raise InvalidInput(
                    f"{outer.field}.type",
                    outer.kind,
                    "",
                    "touches the body, and is no plane",
                    'write type="plane", or contype="0" conaffinity="0"',
                )
        if len(tables) != 1:
            listed = ", ".join(outer.field for outer in tables.values())
            raise InvalidInput(
                "worldbody",
                Described(listed or "no plane that the body touches"),
                'one geom of type="plane" that the body touches',
            )
        (table,) = tables.values()
        return table, [(inner, pair) for inner, _, pair in touching]

    def _pairs(self) -> dict[frozenset[str], Pair]:
        """Return the friction of the pairs that the file lists."""
        pairs = {}
        names_of_geoms = {element.get("name") for element in self.document.root.iter("geom")}
        for element in self.document.parts("contact"):
            if element.tag != "pair":
                if element.tag == "exclude" and "world" not in element.attrib.values():
                    continue
                hint = "leave it out, and let contype and conaffinity say what touches"
                raise InvalidInput(
                    f"contact.{element.tag}", _shown(element), "", "is not read", hint
                )
            attributes = self.document.attributes(element, MAIN)
            field = f"pair of {attributes.get('geom1')} and {attributes.get('geom2')}"
            for name in ("geom1", "geom2"):
                if attributes.get(name) not in names_of_geoms:
                    value = attributes.get(name, MISSING)
                    raise InvalidInput(f"{field}.{name}", value, "the name of a geom of the file")
            values = numbers(attributes, "friction", field, (1, 2, 3, 4, 5)) or ()
            values = (*values, *PAIR_FRICTION[len(values) :])
            if values[0] != values[1] or values[3] != values[4]:
                raise InvalidInput(
                    f"{field}.friction",
                    attributes["friction"],
                    "",
                    "differs in two directions",
                    "write equal numbers",
                )
            _refuse_margin(attributes, field)
            names = frozenset(attributes.get(name, "") for name in ("geom1", "geom2"))
            pairs[names] = Pair(condim_of(attributes, field), (values[0], values[2], values[3]))
        return pairs

    def _collect(
        self, outer: Xml.Element, frame: Pose, child_class: str, members: Members, name: str
    ) -> None:
        """Add what is in a body, or in a frame in it, to its members."""
        count = 0
        explicit = self._inertial(outer, frame, members)
        for element in outer:
            tag = str(element.tag)
            match tag:
                case "geom":
                    field = element_name(element, f" {count} of {name}")
                    count += 1
                    self._add_geom(element, field, frame, child_class, members, explicit)
                case "body" | "frame":
                    self._enter(element, frame, child_class, members, name)
                case _ if tag not in IGNORED_IN_BODIES:
                    raise InvalidInput(name, f"<{tag}>", "", "is not read")

    def _enter(
        self, element: Xml.Element, frame: Pose, child_class: str, members: Members, name: str
    ) -> None:
        """Add what is in an inner body or frame to the members, unless it moves by itself."""
        field = element_name(element, f" in {name}")
        for attribute in ("mocap", "gravcomp"):
            if element.get(attribute, "false") not in ("false", "0"):
                raise InvalidInput(
                    f"{field}.{attribute}", element.get(attribute), "", "is not read"
                )
        inner_class = element.get("childclass", child_class)
        pose = frame.of(pose_of(element.attrib, field, self.angles))
        if element.tag == "body" and any(child.tag in ("joint", "freejoint") for child in element):
            if members is not self.world or name != "world":
                fault = "lets it move against the body around it, and one rigid body is read"
                raise InvalidInput(field, "<joint>", "", fault, "leave the joint out")
            self.free.append((element, pose, inner_class))
            return
        inner_name = name if element.tag == "frame" else field
        self._collect(element, pose, inner_class, members, inner_name)

    def _add_geom(
        self,
        element: Xml.Element,
        field: str,
        frame: Pose,
        child_class: str,
        members: Members,
        explicit: bool,
    ) -> None:
        attributes = self.document.attributes(element, child_class)
        geom = geom_of(attributes, field, frame, self.angles)
        members.geoms.append(geom)
        low, high = numbers(self.compiler, "inertiagrouprange", "compiler", (2,)) or (0.0, 5.0)
        counts = low <= number(attributes, "group", field, 0.0) <= high
        if not explicit and counts and members is not self.world:
            mass = mass_of(geom)
            if mass is not None:
                members.masses.append(mass)

    def _inertial(self, element: Xml.Element, frame: Pose, members: Members) -> bool:
        """Add the mass that a body states; return whether its geoms add none."""
        source = self.compiler.get("inertiafromgeom", "auto")
        inertial = element.find("inertial")
        if element.tag != "body" or source == "true" or (source == "auto" and inertial is None):
            return False
        if inertial is None:
            raise InvalidInput(f"{element_name(element)}.inertial", MISSING, "")
        field, attributes = f"{element_name(element)}.inertial", inertial.attrib
        pose = frame.of(pose_of(attributes, field, self.angles))
        diagonal = numbers(attributes, "diaginertia", field, (3,))
        full = numbers(attributes, "fullinertia", field, (6,))
        mass = number(attributes, "mass", field, math.nan)
        if not mass >= 0.0 or (diagonal is None) == (full is None):
            raise InvalidInput(
                field, _shown(inertial), "a mass beside one of diaginertia and fullinertia"
            )
        if diagonal is not None:
            inner = np.diag(diagonal)
        else:
            xx, yy, zz, xy, xz, yz = full or ()
            inner = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        rotation = matrix(pose.orientation)
        members.masses.append(Mass(mass, pose.position, rotation @ inner @ rotation.T))
        return True

    def _refuse_joint(self, body: Xml.Element, child_class: str) -> None:
        """Raise `InvalidInput` unless a body's one joint is free, and nothing acts in it."""
        joints = [child for child in body if child.tag in ("joint", "freejoint")]
        if len(joints) > 1:
            raise InvalidInput(element_name(body), f"{len(joints)} joints", "one <freejoint/>")
        (joint,) = joints
        attributes = self.document.attributes(joint, child_class)
        field = element_name(joint, f" of {element_name(body)}")
        kind = attributes.get("type", "hinge" if joint.tag == "joint" else "free")
        if kind != "free":
            raise InvalidInput(f"{field}.type", kind, 'free, as in type="free" or <freejoint/>')
        for name in ("damping", "armature", "frictionloss", "stiffness"):
            if any(numbers(attributes, name, field, (1, 2, 3)) or ()):
                raise InvalidInput(f"{field}.{name}", attributes[name], "0")
        aligned = attributes.get("align", "auto")
        if aligned == "true" or (aligned == "auto" and is_true(self.compiler, "alignfree")):
            raise InvalidInput(f"{field}.align", "true", "false")

    def _refuse_settings(self) -> None:
        """Raise `InvalidInput` for sections and settings that a problem cannot state."""
        for section in self.document.root:
            tag = str(section.tag)
            read = {"worldbody", "default", "contact", "keyframe"}
            if tag not in IGNORED_SECTIONS | read and len(section):
                raise InvalidInput(tag, f"<{section[0].tag}>", "", "is not read", "leave it out")
        option, flags = self.document.settings("option"), self.document.settings("option", "flag")
        for name in ("density", "viscosity", "wind", "magnetic"):
            count = (3,) if name in ("wind", "magnetic") else (1,)
            if name != "magnetic" and any(numbers(option, name, "option", count) or ()):
                raise InvalidInput(f"option.{name}", option[name], "0")
        for name in ("contact", "gravity", "constraint"):
            if flags.get(name) == "disable":
                raise InvalidInput(f"option.flag.{name}", "disable", "enable")
        if flags.get("override") == "enable":
            raise InvalidInput("option.flag.override", "enable", "disable")
        refused = {"coordinate": "global", "balanceinertia": "true"}
        for name, value in refused.items():
            if self.compiler.get(name) == value:
                raise InvalidInput(f"compiler.{name}", value, "", "is not read", "leave it out")
        for name in ("boundmass", "boundinertia"):
            if number(self.compiler, name, "compiler", 0.0):
                raise InvalidInput(f"compiler.{name}", self.compiler[name], "0")


PAIR_FRICTION = (1.0, 1.0, 0.005, 0.0001, 0.0001)
"""Friction of a pair that states none."""


def _shown(element: Xml.Element) -> str:
    """Return an element's attributes as a refusal shows them."""
    return " ".join(f'{name}="{value}"' for name, value in element.attrib.items())


def _refuse_margin(attributes: Mapping[str, str], field: str) -> None:
    if number(attributes, "margin", field, 0.0):
        raise InvalidInput(f"{field}.margin", attributes["margin"], "0: contact is rigid")


def _mixed(inner: Geom, outer: Geom) -> Pair | None:
    """Return the friction of two geoms by their masks; None if they do not touch."""
    one, two = inner.touch, outer.touch
    if not (one.contype & two.conaffinity or two.contype & one.conaffinity):
        return None
    for geom in (inner, outer):
        _refuse_margin(geom.attributes, geom.field)
    if one.priority != two.priority:
        first = one if one.priority > two.priority else two
        return Pair(first.condim, first.friction)
    friction = tuple(map(max, one.friction, two.friction))
    return Pair(max(one.condim, two.condim), friction)
