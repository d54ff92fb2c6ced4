"""Every consistent answer of two contacts is reported, and every reported one is consistent."""

import numpy as np
import pytest

from campaigns import seeds
from independent_answers import Case, Found, Law, can_hold_slip, enumerate_answers, unit
from tippetop.mechanics.contacts.consistent_answers import Answer, answers
from tippetop.mechanics.contacts.contact_point import contact_points
from tippetop.mechanics.contacts.wrench import Wrench
from tippetop.mechanics.laws.contensou import EllipsoidalLaw
from tippetop.mechanics.laws.contensou_hertz import HertzLaw
from tippetop.mechanics.laws.coulomb import CoulombLaw, RollingResistance
from tippetop.mechanics.surfaces.hull import Hull
from tippetop.mechanics.surfaces.surface import SphereSurface
from tippetop.mechanics.top import Top

LAWS = {"coulomb": CoulombLaw, "ellipsoidal": EllipsoidalLaw, "hertz": HertzLaw}
ENDED = [(False, False), (True, False), (True, True)]
EXACT = 1e-12


def drawn(seed: int) -> Case:
    """Two spheres of a body, slender or not, with friction of 0 to 3: the laws, what has ended, and
    rolling resistance in turn.
    """
    random = np.random.default_rng(seed)
    kind = ("coulomb", "coulomb", "ellipsoidal", "hertz")[seed % 4]
    ended = ENDED[(seed // 4) % 3]
    resists = (seed // 12) % 2 == 1
    stopped = resists and (seed // 24) % 2 == 0
    if kind != "coulomb" and ended == (True, False):
        ended = (True, True)
    while True:
        r, zeta = random.uniform(0.2, 1.0, 2), random.uniform(-1.0, 1.0, 2)
        if abs(r[0] - r[1]) < 0.95 * abs(zeta[0] - zeta[1]):
            c = (r[0] - r[1]) / (zeta[0] - zeta[1])
            if r[0] - zeta[0] * c > 0.1:
                break
    across = 10.0 ** random.uniform(-2.5, -0.3)
    along = across * random.uniform(0.05, 1.8)
    law = Law(kind, float(random.uniform(0.0, 3.0)), float(10.0 ** random.uniform(-2.0, -0.5)))
    turn = random.uniform(0.0, 2.0 * np.pi)
    e = np.array([np.cos(turn), np.sin(turn), 0.0])
    n = np.array([0.0, 0.0, c]) + (1.0 - c * c) ** 0.5 * e
    speeds = random.normal(size=2) * 10.0 ** random.uniform(-0.5, 0.7)
    rolls = 0.0 if stopped else speeds[0]
    spins = 0.0 if all(ended) else speeds[1]
    omega = rolls * e + np.array([0.0, 0.0, spins])
    velocity = random.normal(size=2)
    if ended[0]:
        velocity = -np.cross(omega, zeta[0] * n - np.array([0.0, 0.0, r[0]]))[:2]
    eps = float(10.0 ** random.uniform(-2.5, -0.5)) if resists else None
    u = np.array([*velocity, 0.0])
    return Case(across, along, r, zeta, law, eps, n, u, omega, ended, stopped)


def reported(case: Case) -> list[Answer]:
    """What the resolver says."""
    hull = Hull.of(tuple(SphereSurface(r, z) for r, z in zip(case.r, case.zeta, strict=True)))
    law, numbers = case.law, (case.law.mu, case.law.radius)
    friction = LAWS[law.kind](*numbers[: 2 if law.drills else 1])
    resistance = None if case.eps is None else RollingResistance(case.eps)
    top = Top.of(1.0, case.across, case.along, hull, friction, 1.0, resistance)
    momentum = case.inertia @ case.omega
    points = contact_points(tuple(case.n.tolist()), tuple(momentum.tolist()), top.body.contacts)
    drilling = (friction.slip_length * case.omega[2],) if law.drills else ()
    slips = [
        None if ended else (*case.slip(i).tolist(), *drilling) for i, ended in enumerate(case.ended)
    ]
    return answers(points, slips, None if case.stopped else tuple(case.omega[:2].tolist()))


def wrenches_of(answer: Answer) -> list[Wrench]:
    if answer.onset is not None:
        return [answer.onset.wrench]
    return [] if answer.resolution is None else [*answer.resolution.motion.wrenches]


def sticks_of(case: Case, answer: Answer) -> tuple[bool, ...]:
    if answer.resolution is not None:
        return answer.resolution.sticks
    return tuple(case.ended[i] and not answer.begins[0] for i in answer.closed)


def is_held(case: Case, answer: Answer) -> bool:
    if not case.stopped or not answer.closed:
        return False
    return not answer.begins[1] if answer.onset is not None else not answer.resolution.rolls


def as_found(case: Case, answer: Answer) -> Found:
    normal = tuple(wrench.force[2] for wrench in wrenches_of(answer))
    return Found(answer.closed, sticks_of(case, answer), is_held(case, answer), normal)


def slip_directions(case: Case, answer: Answer) -> list[tuple[np.ndarray, float] | None]:
    """Slip and drilling of each closed contact, or their direction; None where it sticks."""
    sticks, result = sticks_of(case, answer), []
    scale = {"coulomb": 1.0, "hertz": case.law.radius}.get(
        case.law.kind, 3.0 * np.pi / 16.0 * case.law.radius
    )
    for k, i in enumerate(answer.closed):
        if sticks[k]:
            result.append(None)
        elif not case.ended[i]:
            result.append((case.slip(i), case.omega[2]))
        elif answer.onset is not None:
            slip = np.array(answer.onset.slip)
            result.append((slip[:2], slip[2] / scale if case.law.drills else 0.0))
        else:
            begins = np.array([*answer.resolution.begins, 0.0][:3])
            distance = (case.arms[1] - case.arms[0]) @ case.e
            w = begins[2] / distance
            if not case.ended[1 - i]:
                w = 0.0
            result.append((begins[:2] + k * w * case.lever(), w))
    return result


def check(case: Case, answer: Answer) -> None:
    """Assert that an answer satisfies all conditions."""
    wrenches = wrenches_of(answer)
    forces = [np.array(wrench.force) for wrench in wrenches]
    torques = [np.array(wrench.torque) for wrench in wrenches]
    normal = np.array([force[2] for force in forces])
    total = sum(
        (
            case.contact_wrench(i, f, t)
            for i, f, t in zip(answer.closed, forces, torques, strict=True)
        ),
        np.zeros(6),
    )
    q = case.free + case.mobility @ total
    parts = np.abs(case.free).max() + np.abs(case.mobility).max() * np.abs(total).max()
    size = parts * (1.0 + np.abs(case.arms).max()) + max(np.abs(case.bias(i)).max() for i in (0, 1))
    tiny, light = EXACT * size, EXACT * (1.0 + np.abs(total).max())
    for i in (0, 1):
        gap = case.accelerations(i, q)[2]
        assert abs(gap) <= tiny if i in answer.closed else gap >= -tiny
    assert (normal > 0.0).all()
    # Rolling.
    couple, held = np.zeros(2), is_held(case, answer)
    if case.eps is not None and answer.closed:
        axes = np.eye(3)[:2] if answer.onset is not None else np.array([case.e])
        if held:
            assert np.abs(axes @ q[3:]).max() <= tiny
        else:
            way = case.omega[:2]
            if case.stopped and answer.onset is not None:
                way = np.array(answer.onset.rolling)
            elif case.stopped:
                way = answer.resolution.rolls * case.e[:2]
            couple = -case.eps * unit(way)
            if case.stopped:
                rate = axes @ q[3:]
                along = rate @ (axes[:, :2] @ way)
                assert along >= -tiny
                assert np.abs(rate - along * (axes[:, :2] @ way)).max() <= tiny * 10.0
    # Slip.
    pairs = zip(slip_directions(case, answer), forces, torques, strict=True)
    for k, (slip, force, torque) in enumerate(pairs):
        i = answer.closed[k]
        if slip is None:
            assert np.abs(case.accelerations(i, q)[:2]).max() <= tiny
            assert not case.law.drills or abs(q[5]) <= tiny
            continue
        pull, moment = case.law.traction(*slip)
        assert np.abs(force[:2] - force[2] * pull).max() <= light
        assert abs(torque[2] - force[2] * moment) <= light
        if not held:
            assert np.abs(torque[:2] - force[2] * couple).max() <= light
        if case.ended[i]:
            way = np.array([*slip[0], slip[1]])
            rate = np.array([*case.accelerations(i, q)[:2], q[5]])
            if (not case.law.drills and len(answer.closed) == 1) or not all(case.ended):
                way, rate = way[:2], rate[:2]
            along = rate @ way / (way @ way)
            assert along >= -tiny
            assert np.abs(rate - along * way).max() <= tiny * max(1.0, np.abs(way).max())
    sticks = sticks_of(case, answer)
    if any(sticks):
        p = np.concatenate([f[:2] for f, s in zip(forces, sticks, strict=True) if s])
        p = np.array([*p, sum(torque[2] for torque in torques)])
        assert can_hold_slip(case, answer.closed, sticks, normal, p)
    if held:
        holding = sum(torque[:2] for torque in torques)
        assert np.linalg.norm(holding) <= case.eps * normal.sum() + light


@pytest.mark.parametrize("seed", seeds(0, 24, 500, always=(1, 5), sampled=(8, 43, 45, 95)))
def test_every_consistent_answer_is_reported(seed: int) -> None:
    case = drawn(seed)
    told = reported(case)
    for answer in told:
        check(case, answer)
    names = [as_found(case, answer) for answer in told]
    for found in enumerate_answers(case):
        alike = [
            name
            for name in names
            if (name.closed, name.sticks, name.held) == (found.closed, found.sticks, found.held)
            and np.allclose(name.normal, found.normal, rtol=1e-7, atol=1e-9)
        ]
        assert len(alike) == 1, (found, names)


def test_a_contact_may_stick_slip_or_open():
    """Friction jams the body: each of the three answers of its second contact is consistent."""
    case = drawn(1160)
    told = reported(case)
    for answer in told:
        check(case, answer)
    ends = [(answer.closed, sticks_of(case, answer)) for answer in told]
    assert ends == [((1,), (True,)), ((1,), (False,)), ((), ())]
