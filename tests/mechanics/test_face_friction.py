"""Friction of a flat face against derivatives of its dissipation potential, with many digits, and
against what is known of disks that slide and spin.
"""

import itertools
import math

import mpmath as mp
import numpy as np
import pytest

from tippetop.mechanics.laws.contensou import EllipsoidalLaw
from tippetop.mechanics.laws.contensou_hertz import HertzLaw
from tippetop.mechanics.laws.coulomb import CoulombLaw
from tippetop.mechanics.laws.face_friction import (
    EllipsoidalFaceLaw,
    PointwiseFaceLaw,
    RimLaw,
    UniformAnnulusLaw,
    UniformDiskLaw,
    ViscousFaceLaw,
    face_law_type,
)
from tippetop.mechanics.laws.friction import RegularizedCoulombLaw, ViscousLaw

DIGITS = 90
"""Of the potential: its derivatives lose up to 40 of them at the ends of the range."""

RATIOS = [10.0**power for power in range(-8, 9)] + [
    0.3,
    0.5,
    0.65,
    0.9,
    0.999,
    1.0,
    1.001,
    1.6,
    3.0,
]


def distances(d, a):
    """Integral over a disk of radius a of the distance to a point d from its middle."""
    if a == 0:
        return mp.mpf(0)
    if d <= a:
        m = (d / a) ** 2
        last = 0 if d == a else 4 * (a * a - d * d) * mp.ellipk(m)
        return mp.mpf(4) / 9 * a * ((7 * a * a + d * d) * mp.ellipe(m) - last)
    m = (a / d) ** 2
    last = (d * d + 3 * a * a) * (1 - m) * mp.ellipk(m)
    return mp.mpf(4) / 9 * d * ((7 * a * a + d * d) * mp.ellipe(m) - last)


def mean_distance(d, inner, outer):
    """Mean distance of an annulus from a point, or of a circle where both radii are one."""
    if inner == outer:
        m = 4 * d * outer / (d + outer) ** 2
        return 2 / mp.pi * (d + outer) * mp.ellipe(m)
    area = mp.pi * (mp.mpf(outer) ** 2 - mp.mpf(inner) ** 2)
    return (distances(d, mp.mpf(outer)) - distances(d, mp.mpf(inner))) / area


def exact_traction(slip, drilling, inner, outer):
    """Force and torque per mu N from differences of the potential, with many digits."""
    with mp.workdps(DIGITS):
        v, w = mp.mpf(slip), mp.mpf(drilling)
        d, step = v / w, mp.mpf(10) ** -30 * v / w

        def potential(at):
            return mean_distance(at, inner, outer)

        force = (potential(d + step) - potential(d - step)) / (2 * step)
        return float(force), float(potential(d) - d * force)


@pytest.mark.parametrize(("d", "a"), [(0.3, 1.0), (1.0, 1.0), (2.5, 1.5), (0.02, 0.7)])
def test_the_potential_is_the_mean_distance_from_the_instantaneous_centre(d, a):
    with mp.workdps(25):

        def ring(r):
            return 2 * mp.pi * r * mean_distance(mp.mpf(d), r, r)

        places = sorted({0.0, min(d, a), a})
        assert mp.almosteq(mp.quad(ring, places), distances(mp.mpf(d), mp.mpf(a)), 1e-18)
        m = 4 * mp.mpf(d) * a / (mp.mpf(d) + a) ** 2
        speed = mp.quad(
            lambda phi: mp.sqrt(d * d + a * a - 2 * d * a * mp.cos(phi)), [0, mp.pi / 2, mp.pi]
        )
        assert mp.almosteq(speed / mp.pi, 2 / mp.pi * (d + a) * mp.ellipe(m), 1e-12)


@pytest.mark.parametrize("inner", [0.0, 0.5, 0.9, 1.0])
@pytest.mark.parametrize("ratio", RATIOS)
def test_force_and_torque_are_derivatives_of_the_potential(inner, ratio):
    mu, outer, drilling = 0.4, 0.02, 7.0
    slip = ratio * outer * drilling
    law = (
        RimLaw(mu, outer)
        if inner == 1.0
        else UniformAnnulusLaw(mu, inner * outer, outer)
        if inner
        else UniformDiskLaw(mu, outer)
    )
    (x, y), torque = law.traction((0.6 * slip, -0.8 * slip), drilling)
    force, moment = exact_traction(slip, drilling, inner * outer, outer)
    assert x == pytest.approx(-0.6 * mu * force, rel=1e-9)
    assert y == pytest.approx(0.8 * mu * force, rel=1e-9)
    assert torque == pytest.approx(-mu * moment, rel=1e-9)
    back = law.traction((0.6 * slip, -0.8 * slip), -drilling)
    assert back.torque == -torque
    assert back.force == (x, y)


@pytest.mark.parametrize("inner", [0.0, 0.3, 0.9])
def test_without_drilling_or_slip_one_of_them_has_all(inner):
    outer, speed = 0.02, 0.3
    for law in (
        UniformAnnulusLaw(1.0, inner * outer, outer) if inner else UniformDiskLaw(1.0, outer),
        EllipsoidalFaceLaw(1.0, inner * outer, outer),
    ):
        slips, drills = law.traction((speed, 0.0), 0.0), law.traction((0.0, 0.0), 5.0)
        arm = 2 / 3 * outer * (1 - inner**3) / (1 - inner**2)
        assert slips.force == (pytest.approx(-1.0, rel=1e-14), 0.0)
        assert slips.torque == 0.0
        assert drills.force == (0.0, 0.0)
        assert drills.torque == pytest.approx(-arm, rel=1e-13)


@pytest.mark.parametrize(
    ("inner", "ratio"), [(0.0, 0.6530), (0.5, 0.7745), (0.9, 0.9508), (1.0, 1.0)]
)
def test_a_disk_whose_mass_lies_over_its_face_stops_at_the_known_ratio(inner, ratio):
    """Farkas et al. 2003: there slip and drilling fall at rates in the ratio they have."""
    law = (
        RimLaw(1.0, 1.0)
        if inner == 1.0
        else UniformAnnulusLaw(1.0, inner, 1.0)
        if inner
        else UniformDiskLaw(1.0, 1.0)
    )

    def turning(at):
        (force, _), torque = law.traction((at, 0.0), 1.0)
        return force * 0.5 * (1 + inner**2) - torque * at

    low, high = 0.2, 3.0
    assert turning(low) * turning(high) < 0.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if turning(low) * turning(middle) > 0.0 else (low, middle)
    assert low == pytest.approx(ratio, abs=1e-4)


def test_a_rim_is_the_limit_of_thin_annuli():
    rim = RimLaw(0.3, 0.02)
    for ratio in (0.01, 0.5, 0.97, 1.2, 30.0):
        (force, _), torque = rim.traction((0.02 * ratio, 0.0), 1.0)
        error = []
        for width in (0.02, 0.01, 0.005):
            thin = UniformAnnulusLaw(0.3, 0.02 * (1 - width), 0.02).traction(
                (0.02 * ratio, 0.0), 1.0
            )
            error.append(math.hypot(thin.force[0] - force, (thin.torque - torque) / 0.02))
        assert error[0] > 1.8 * error[1] > 3.2 * error[2]


@pytest.mark.parametrize("inner", [0.0, 0.6])
def test_the_viscous_face_is_exact_and_its_quadrature_too(inner):
    outer, law = 0.02, ViscousLaw(0.5)
    exact = ViscousFaceLaw.of(law, inner * outer, outer)
    by_points = PointwiseFaceLaw.of(law, inner * outer, outer)
    force, torque = exact.traction((0.3, -0.1), 9.0)
    assert force == (-0.5 * 0.3, 0.5 * 0.1)
    assert torque == pytest.approx(-0.5 * 0.5 * (1 + inner**2) * outer**2 * 9.0, rel=1e-15)
    (x, y), moment = by_points.traction((0.3, -0.1), 9.0)
    assert (x, y, moment) == pytest.approx((*force, torque), rel=1e-14)


def test_quadrature_agrees_with_the_law_of_a_face_far_from_the_singular_point():
    law = PointwiseFaceLaw.of(RegularizedCoulombLaw(0.3, 1e-9), 0.0, 0.02)
    exact = UniformDiskLaw(0.3, 0.02).traction((0.1, 0.0), 1.0)
    (x, _), torque = law.traction((0.1, 0.0), 1.0)
    assert x == pytest.approx(exact.force[0], rel=1e-9)
    assert torque == pytest.approx(exact.torque, rel=1e-6)


@pytest.mark.parametrize("pressure", ["uniform", "rim", "ellipsoidal"])
@pytest.mark.parametrize("inner", [0.0, 0.7])
def test_friction_is_dissipative_and_monotone(pressure, inner):
    """A convex potential: friction at one slip dissipates no less there than that at another."""
    law = face_law_type(CoulombLaw(0.3), inner, pressure).of(CoulombLaw(0.3), inner, 1.0)
    random = np.random.default_rng(5)
    motions = random.normal(size=(40, 3)) * 10.0 ** random.uniform(-2, 2, size=(40, 1))
    tractions = [law.traction((p, q), w) for p, q, w in motions.tolist()]
    for i, j in itertools.product(range(len(motions)), repeat=2):
        p, q, w = motions[i]
        powers = [
            one.force[0] * p + one.force[1] * q + one.torque * w
            for one in (tractions[i], tractions[j])
        ]
        assert powers[0] < 0.0
        assert powers[0] <= powers[1] + 1e-12 * abs(powers[0])


def test_which_law_a_face_has():
    assert face_law_type(CoulombLaw(0.3), 0.0, "uniform") is UniformDiskLaw
    assert face_law_type(HertzLaw(0.3, 1e-3), 0.01, "uniform") is UniformAnnulusLaw
    assert face_law_type(EllipsoidalLaw(0.3, 1e-3), 0.0, "ellipsoidal") is EllipsoidalFaceLaw
    assert face_law_type(CoulombLaw(0.3), 0.0, "rim") is RimLaw
    assert face_law_type(ViscousLaw(0.3), 0.0, "rim") is ViscousFaceLaw
    assert face_law_type(RegularizedCoulombLaw(0.3, 1e-3), 0.0, "uniform") is PointwiseFaceLaw


def test_arrays_and_floats_give_the_same():
    law = UniformAnnulusLaw(0.3, 0.4, 1.0)
    slips, drillings = np.array([0.2, 0.7, 2.0]), np.array([1.0, -1.0, 0.1])
    (x, _), torque = law.traction((slips, 0.0 * slips), drillings)
    for number, (slip, drilling) in enumerate(zip(slips.tolist(), drillings.tolist(), strict=True)):
        single = law.traction((slip, 0.0), drilling)
        assert (x[number], torque[number]) == (single.force[0], single.torque)
