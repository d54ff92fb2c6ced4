"""Bodies and problems in the formats of other programs: MJCF and URDF.

Spheres are exact; so are spheroids in MJCF, and pairs of equal sharp rings, which are cylinders. A
mesh stands for any other surface, with its error stated. The inertia is explicit.
"""

import math
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree as Xml

import tippetop as tt
from tippetop.engines.outline import FACETS, ConvexMesh, revolved
from tippetop.mechanics.laws.contensou import ELLIPSOIDAL_RADIUS
from tippetop.problem.problem import require_problem
from tippetop.support.errors import require
from tippetop.support.files import path_of, place_for, require_ending, written_beside

MESH_ENDING = ".obj"


class Primitive(NamedTuple):
    """A shape that other programs have, centred on the axis: its kind, sizes and height, m.

    The sizes are: of a sphere its radius; of a cylinder its radius and half its length; of an
    ellipsoid its semi-axes along x, y and z.
    """

    kind: str
    sizes: tuple[float, ...]
    center: float


class Written(NamedTuple):
    """What was written, and what other programs cannot be told."""

    files: tuple[Path, ...]
    remarks: tuple[str, ...]
    """Sentences: the error of a mesh, and what of the problem has no place in the format."""


def primitives(body: tt.Body, ellipsoids: bool) -> tuple[Primitive, ...] | None:
    """Return the shapes whose hull is the body; None where only a mesh is."""
    shapes = body.shapes
    primitives = []
    for shape in shapes:
        match shape:
            case tt.EccentricSphere(radius=radius, eccentricity=part):
                primitives.append(Primitive("sphere", (radius,), part * radius))
            case tt.Sphere(radius=radius, center=center):
                primitives.append(Primitive("sphere", (radius,), center))
            case tt.Spheroid(across=across, along=along, center=center) if ellipsoids:
                primitives.append(Primitive("ellipsoid", (across, across, along), center))
    if len(primitives) == len(shapes):
        return tuple(primitives)
    match shapes:
        case (
            tt.Ring(radius=one, center=low, tube=0.0),
            tt.Ring(radius=two, center=high, tube=0.0),
        ) if one == two:
            size = (one, abs(high - low) / 2)
            return (Primitive("cylinder", size, (low + high) / 2),)
    return None


class FrictionNumbers(NamedTuple):
    """Friction as other programs take it: sliding, drilling and rolling, and what is lost."""

    sliding: float
    torsional: float
    """Arm of the drilling torque over the normal force, m."""
    rolling: float
    """Arm of the rolling torque over the normal force, m."""
    remarks: tuple[str, ...]


def friction_numbers(problem: tt.Problem) -> FrictionNumbers:
    """Return the friction of a problem as coefficients, and what they cannot say."""
    friction, rolling, lost = problem.friction, problem.rolling_resistance, []
    sliding, torsional = 0.0, 0.0
    match friction:
        case tt.CoulombFriction(mu=mu):
            sliding = mu
        case tt.StaticCoulombFriction(mu=mu, static_mu=holding):
            sliding = mu
            lost.append(
                f"The static coefficient {holding:g} is not mapped: sliding friction holds."
            )
        case tt.ContensouFriction(mu=mu, patch_radius=radius, pressure=pressure):
            sliding, torsional = mu, mu * ELLIPSOIDAL_RADIUS * radius
            if pressure == "hertz":
                lost.append(
                    "The pressure of Hertz is not mapped: drilling has its ellipsoidal limit"
                    " surface."
                )
        case tt.RegularizedCoulombFriction(mu=mu, eps=eps):
            sliding = mu
            lost.append(f"The slip speed eps = {eps:g} m/s is not mapped: others have their own.")
        case _ if not friction.vanishes:
            lost.append(
                f"Friction of the kind {friction.kind} is not mapped: the table is smooth there."
            )
    if problem.contact.restitution:
        lost.append(
            f"The restitution {problem.contact.restitution:g} is not mapped: others make rebounds"
            " by stiffness and damping."
        )
    for field, value in problem.contact:
        if field != "restitution" and value != getattr(tt.Contact(), field, value):
            lost.append(f"contact.{field} = {value!r} is not mapped: it is a rule of this program.")
    if problem.air != tt.Air():
        lost.append("The air is not mapped: others have drag of their own, or none.")
    return FrictionNumbers(sliding, torsional, rolling, tuple(lost))


class LaunchState(NamedTuple):
    """A launch as other programs take it: table frame, SI."""

    position: tuple[float, float, float]
    quaternion: tuple[float, float, float, float]
    """Orientation, scalar first."""
    velocity: tuple[float, float, float]
    omega: tuple[float, float, float]
    """Angular velocity in the table's frame."""
    omega_body: tuple[float, float, float]
    """Angular velocity in the body's frame."""


def launch_state(problem: tt.Problem) -> LaunchState:
    """Return position, orientation and velocities at launch."""
    launch, start = problem.launch, problem.start()
    half, turn = 0.5 * launch.tilt, launch.azimuth
    # The body's axis is tilted towards its azimuth about a horizontal axis.
    x, y = -math.sin(half) * math.sin(turn), math.sin(half) * math.cos(turn)
    omega = launch.angular_velocity()
    # That rotation turns the axes 1 and 2 of the launch by the azimuth, about axis 3.
    first, second, spin = launch.angular_velocity("body")
    c, s = math.cos(turn), math.sin(turn)
    inside = (c * first - s * second, s * first + c * second, spin)
    velocity = tuple(float(number) for number in start.velocity)
    return LaunchState(
        (0.0, 0.0, float(start.height)),
        (math.cos(half), x, y, 0.0),
        (velocity[0], velocity[1], velocity[2]),
        omega,
        inside,
    )


def _numbers(values: Sequence[float]) -> str:
    return " ".join(f"{value + 0.0:.17g}" for value in values)


def _add(parent: Xml.Element, tag: str, **attributes: str) -> Xml.Element:
    return Xml.SubElement(parent, tag, attributes)


def mjcf(problem: tt.Problem, timestep: float = 1e-3, facets: int = FACETS) -> tuple[str, Written]:
    """Return a problem as MJCF, MuJoCo's XML, and what it cannot say.

    The launch is the keyframe "launch". Contact is elliptic, with drilling and rolling friction
    where the problem has them.
    """
    body, friction, state = problem.body, friction_numbers(problem), launch_state(problem)
    remarks = list(friction.remarks)
    root = Xml.Element("mujoco", model="top")
    _add(root, "compiler", angle="radian", inertiafromgeom="false", autolimits="true")
    _add(
        root,
        "option",
        timestep=f"{timestep:.17g}",
        gravity=_numbers(problem.gravity_vector),
        cone="elliptic",
    )
    shapes = primitives(body, ellipsoids=True)
    if shapes is None:
        mesh = revolved(body, facets)
        asset = _add(root, "asset")
        _add(asset, "mesh", name="outline", vertex=_numbers(mesh.points.ravel().tolist()))
        remarks.append(_mesh_remark(mesh))
    world = _add(root, "worldbody")
    _add(world, "geom", name="table", type="plane", size="0 0 1")
    top = _add(world, "body", name="top", pos=_numbers(state.position))
    _add(top, "freejoint", name="free")
    _add(
        top,
        "inertial",
        pos="0 0 0",
        mass=f"{body.mass:.17g}",
        diaginertia=_numbers((body.I1, body.I1, body.I3)),
    )
    names = []
    for number, shape in enumerate(shapes or ()):
        names.append(f"surface{number}")
        place = _numbers((0.0, 0.0, shape.center))
        _add(top, "geom", name=names[-1], type=shape.kind, size=_numbers(shape.sizes), pos=place)
    if shapes is None:
        names.append("surface")
        # The program moves the mesh's own centre to pos: that the corners stay, refpos is 0.
        _add(top, "geom", name="surface", type="mesh", mesh="outline")
    pairs = _add(root, "contact")
    dimensions = 6 if friction.rolling else 4 if friction.torsional else 3
    if friction.rolling and not friction.torsional:
        remarks.append("MuJoCo has no rolling friction without drilling: its least is 1e-5 m.")
    if friction.rolling:
        remarks.append("MuJoCo has one limit for sliding, drilling and rolling together.")
    arms = (friction.sliding, friction.sliding, friction.torsional, *2 * (friction.rolling,))
    for name in names:
        _add(
            pairs,
            "pair",
            geom1=name,
            geom2="table",
            condim=str(dimensions if friction.sliding else 1),
            friction=_numbers(arms),
        )
    keys = _add(root, "keyframe")
    _add(
        keys,
        "key",
        name="launch",
        qpos=_numbers((*state.position, *state.quaternion)),
        qvel=_numbers((*state.velocity, *state.omega_body)),
    )
    Xml.indent(root)
    return Xml.tostring(root, encoding="unicode") + "\n", Written((), tuple(remarks))


def _mesh_remark(mesh: ConvexMesh) -> str:
    return (
        f"A mesh of {len(mesh.points)} corners stands for the surface, inside it by at most"
        f" {1e6 * mesh.error:.2g} micrometres."
    )


def urdf(
    problem: tt.Problem, mesh_name: str = "top.obj", facets: int = FACETS
) -> tuple[str, ConvexMesh | None, Written]:
    """Return the body of a problem as URDF, its mesh if it needs one, and what it cannot say.

    URDF itself has no friction and no launch: the element `drake:proximity_properties` has the
    sliding coefficient for Drake.
    """
    body, friction = problem.body, friction_numbers(problem)
    remarks = [
        *friction.remarks,
        "URDF has no launch: set position, orientation and velocities in the program.",
        "URDF has no friction: Drake finds the sliding coefficient in the file, others must be"
        f" told mu = {friction.sliding:g}.",
    ]
    if not problem.table.is_level:
        gravity = " ".join(f"{part:.6g}" for part in problem.gravity_vector)
        remarks.append(f"URDF has no gravity: set {gravity} m/s^2 for the slope of the table.")
    if friction.torsional or friction.rolling:
        remarks.append(
            f"Set where the program has them: drilling {friction.torsional:.4g} m and rolling"
            f" {friction.rolling:.4g} m, torque over normal force."
        )
    Xml.register_namespace("drake", DRAKE)
    root = Xml.Element("robot", name="top")
    link = _add(root, "link", name="top")
    inertial = _add(link, "inertial")
    _add(inertial, "origin", xyz="0 0 0", rpy="0 0 0")
    _add(inertial, "mass", value=f"{body.mass:.17g}")
    I1, I3 = f"{body.I1:.17g}", f"{body.I3:.17g}"
    _add(inertial, "inertia", ixx=I1, ixy="0", ixz="0", iyy=I1, iyz="0", izz=I3)
    shapes = primitives(body, ellipsoids=False)
    mesh = None
    for number, shape in enumerate(shapes or (Primitive("mesh", (), 0.0),)):
        for role in ("visual", "collision"):
            part = _add(link, role, name=f"{role}{number}")
            _add(part, "origin", xyz=_numbers((0.0, 0.0, shape.center)), rpy="0 0 0")
            geometry = _add(part, "geometry")
            if shape.kind == "sphere":
                _add(geometry, "sphere", radius=f"{shape.sizes[0]:.17g}")
            elif shape.kind == "cylinder":
                radius, half = shape.sizes
                _add(geometry, "cylinder", radius=f"{radius:.17g}", length=f"{2 * half:.17g}")
            else:
                outline = _add(geometry, "mesh", filename=mesh_name)
                Xml.SubElement(outline, f"{{{DRAKE}}}declare_convex")
            if role == "collision":
                contact = Xml.SubElement(part, f"{{{DRAKE}}}proximity_properties")
                for kind in ("mu_dynamic", "mu_static"):
                    Xml.SubElement(contact, f"{{{DRAKE}}}{kind}", value=f"{friction.sliding:.17g}")
    if shapes is None:
        mesh = revolved(body, facets)
        remarks.append(_mesh_remark(mesh))
    Xml.indent(root)
    return Xml.tostring(root, encoding="unicode") + "\n", mesh, Written((), tuple(remarks))


DRAKE = "http://drake.mit.edu"
"""Name of Drake's elements in URDF."""


def obj(mesh: ConvexMesh) -> str:
    """Return a mesh as OBJ text."""
    corners = [f"v {_numbers(point)}" for point in mesh.points.tolist()]
    faces = [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in mesh.triangles.tolist()]
    return "\n".join([*corners, *faces]) + "\n"


def write_mjcf(problem: tt.Problem, path: Path | str, overwrite: bool = False) -> Path:
    """Write a problem as MJCF, the XML of MuJoCo, with its launch as a keyframe; return the path.

    A warning says what of the problem has no place in the format.

    Raises
    ------
    InvalidInput
        If the name does not end in .xml.
    FileTrouble
        If the file exists and `overwrite` is false, or cannot be written.

    Examples
    --------
    >>> import tippetop as tt
    >>> problem = tt.presets.report_problem().replace({"friction.kind": "coulomb"})
    >>> tt.write_mjcf(problem, "top.xml").name
    'top.xml'
    """
    return _path_of(save_mjcf(problem, path, overwrite))


def save_mjcf(problem: tt.Problem, path: Path | str, overwrite: bool) -> Written:
    """Write a problem as MJCF; return the files and the remarks on them."""
    path = _checked(problem, path, overwrite, ".xml")
    text, written = mjcf(problem)
    return _write_texts({path: text}, overwrite, written)


def write_urdf(problem: tt.Problem, path: Path | str, overwrite: bool = False) -> Path:
    """Write the body of a problem as URDF, and its mesh as OBJ beside it where it needs one.

    Return the path of the URDF. A warning says what of the problem has no place in the format.

    Raises
    ------
    InvalidInput
        If the name does not end in .urdf.
    FileTrouble
        If a file exists and `overwrite` is false, or cannot be written.

    Examples
    --------
    >>> import warnings
    >>> import tippetop as tt
    >>> problem = tt.presets.report_problem().replace({"friction.kind": "coulomb"})
    >>> with warnings.catch_warnings(action="ignore"):  # of what a URDF file leaves out
    ...     tt.write_urdf(problem, "top.urdf").name
    'top.urdf'
    """
    return _path_of(save_urdf(problem, path, overwrite))


def _path_of(written: Written) -> Path:
    """Return the path of what was written, with a warning for each remark."""
    for remark in written.remarks:
        warnings.warn(remark, UserWarning, stacklevel=3)
    return written.files[0]


def save_urdf(problem: tt.Problem, path: Path | str, overwrite: bool) -> Written:
    """Write the body of a problem as URDF; return the files and the remarks on them."""
    path = _checked(problem, path, overwrite, ".urdf")
    outline = path.with_suffix(MESH_ENDING)
    text, mesh, written = urdf(problem, outline.name)
    return _write_texts({path: text, **({outline: obj(mesh)} if mesh else {})}, overwrite, written)


def _checked(problem: object, path: object, overwrite: object, ending: str) -> Path:
    """Return the path; raises `InvalidInput` where an argument is none."""
    require_problem(problem)
    require("overwrite", overwrite, bool, "True or False")
    checked = path_of(path)
    require_ending("path", checked, (ending,))
    return checked


def _write_texts(texts: dict[Path, str], overwrite: bool, written: Written) -> Written:
    """Write files, of which the first refers to the others and comes last."""
    for path in texts:
        place_for(path, overwrite)
    for path, text in reversed(texts.items()):
        with written_beside(path, overwrite) as beside:
            beside.write_text(text, encoding="utf-8")
    return written._replace(files=tuple(texts))
