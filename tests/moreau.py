"""Moreau's time-stepping for a body of revolution on a plane with dry friction: an independent
reference.

It shares no equation with the package: the orientation is a rotation, velocities are those of the
centre of mass and of the body-fixed frame, and each step of size h solves, at its midpoint (Moreau
1988),

    M (u+ - u) = h f + W L,        L_N >= 0, g_N'+ >= 0, L_N g_N'+ = 0,        L_F in mu L_N B,

by projections. B is the unit disc of forces, or the ellipsoid of forces and drilling torques over
rho: first order.
"""

import numpy as np
from scipy.spatial.transform import Rotation

UP = np.array([0.0, 0.0, 1.0])


def cross_matrix(a):
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


class Moreau:
    """A sphere of this radius whose centre lies zeta along the body's axis from its centre of mass.

    Parameters
    ----------
    body
        mass, I1, I3, radius, zeta, gravity.
    mu, rho
        Friction coefficient and semi-axis of the limit surface, m; 0 for Coulomb friction.
    rotation, turning, position, velocity
        Attitude, angular velocity in space, position and velocity of the centre of mass.
    """

    def __init__(self, body, mu, rho, rotation, turning, position, velocity):
        self.mass, self.I1, self.I3, self.radius, self.zeta, self.gravity = body
        self.inertia = np.diag([self.I1, self.I1, self.I3])
        self.mu, self.rho = mu, rho
        self.rotation = Rotation.from_matrix(rotation)
        self.turning = self.rotation.inv().apply(turning)
        self.position, self.velocity = np.array(position, float), np.array(velocity, float)
        self.impulse = np.zeros(4)

    def step(self, h):
        """Half a step of motion, an impulse, and another half."""
        self.rotation = self.rotation * Rotation.from_rotvec(0.5 * h * self.turning)
        self.position = self.position + 0.5 * h * self.velocity
        self.kick(h)
        self.rotation = self.rotation * Rotation.from_rotvec(0.5 * h * self.turning)
        self.position = self.position + 0.5 * h * self.velocity

    def kick(self, h):
        """Change of the velocities in a step, at the midpoint's configuration."""
        R = self.rotation.as_matrix()
        arm = R.T @ (self.zeta * R[:, 2] - self.radius * UP)
        free_velocity = self.velocity - h * self.gravity * UP
        gyroscopic = np.cross(self.turning, self.inertia @ self.turning)
        free_turning = self.turning - h * np.linalg.solve(self.inertia, gyroscopic)
        # contact directions: x, y, drilling over rho, normal; W maps their impulses to the body's
        linear = np.column_stack([np.eye(3)[0], np.eye(3)[1], np.zeros(3), UP])
        angular = cross_matrix(arm) @ R.T @ linear
        angular[:, 2] = self.rho * (R.T @ UP)
        inverse = np.linalg.inv(self.inertia)
        G = linear.T @ linear / self.mass + angular.T @ inverse @ angular
        gap = self.position[2] + self.zeta * R[2, 2] - self.radius
        start = linear.T @ free_velocity + angular.T @ free_turning
        impulse = self.solve(G, start) if gap <= 0.0 else np.zeros(4)
        self.velocity = free_velocity + linear @ impulse / self.mass
        self.turning = free_turning + inverse @ angular @ impulse
        self.impulse = impulse

    def solve(self, G, start):
        """Impulses by Gauss-Seidel between the normal and the ball of friction."""
        impulse = self.impulse.copy()
        count = 3 if self.rho else 2
        weight = 1.0 / np.linalg.eigvalsh(G[:count, :count]).max()
        for _ in range(20000):
            before = impulse.copy()
            impulse[3] = max(0.0, impulse[3] - (start[3] + G[3] @ impulse) / G[3, 3])
            trial = impulse[:count] - weight * (start[:count] + G[:count] @ impulse)
            limit = self.mu * impulse[3]
            impulse[:count] = trial * min(1.0, limit / max(np.linalg.norm(trial), 1e-300))
            if np.abs(impulse - before).max() <= 1e-13 * np.abs(impulse).max():
                break
        return impulse

    @property
    def tilt(self):
        return float(np.arccos(self.rotation.as_matrix()[2, 2]))

    @property
    def spin(self):
        return float(self.turning[2])


def launched(body, mu, rho, tilt, spin, *, rests=False):
    """A body set down at rest in tilt: without slip, or with its centre of mass at rest."""
    _, _, _, radius, zeta, _ = body
    rotation = Rotation.from_euler("y", tilt).as_matrix()
    turning = spin * rotation[:, 2]
    arm = zeta * rotation[:, 2] - radius * UP
    velocity = np.zeros(3) if rests else -np.cross(turning, arm)
    return Moreau(body, mu, rho, rotation, turning, -arm[2] * UP, velocity)


class OnSpheres(Moreau):
    """The same on several spheres, of (radius, zeta) each, with a resistance to rolling of this
    arm.

    Each has a disc of forces of radius mu L_N, and couples up to arm L_N along the horizontal
    direction of the axis: those across it would leave open how several contacts share the weight,
    and do no work.
    """

    def __init__(self, body, spheres, mu, arm, rotation, turning, velocity):
        mass, I1, I3, gravity = body
        height = max(radius - zeta * rotation[2, 2] for radius, zeta in spheres)
        super().__init__(
            (mass, I1, I3, 0.0, 0.0, gravity), mu, 0.0, rotation, turning, height * UP, velocity
        )
        self.spheres, self.arm = spheres, arm
        self.impulse = np.zeros(4 * len(spheres))

    def kick(self, h):
        """Change of the velocities in a step, at the midpoint's configuration."""
        R, inverse = self.rotation.as_matrix(), np.linalg.inv(self.inertia)
        free_velocity = self.velocity - h * self.gravity * UP
        free_turning = self.turning - h * inverse @ np.cross(
            self.turning, self.inertia @ self.turning
        )
        along = np.array([R[0, 2], R[1, 2], 0.0]) / np.hypot(R[0, 2], R[1, 2])
        linear, angular, shut = [], [], []
        for radius, zeta in self.spheres:
            directions = np.column_stack([np.eye(3)[0], np.eye(3)[1], np.zeros(3), UP])
            turn = cross_matrix(R.T @ (zeta * R[:, 2] - radius * UP)) @ R.T @ directions
            turn[:, 2] = R.T @ along
            linear.append(directions)
            angular.append(turn)
            shut.append(self.position[2] + zeta * R[2, 2] - radius <= 0.0)
        linear, angular = np.hstack(linear), np.hstack(angular)
        G = linear.T @ linear / self.mass + angular.T @ inverse @ angular
        impulse = self.shared(G, linear.T @ free_velocity + angular.T @ free_turning, shut)
        self.velocity = free_velocity + linear @ impulse / self.mass
        self.turning = free_turning + inverse @ angular @ impulse
        self.impulse = impulse

    def shared(self, G, start, shut):
        """Impulses by Gauss-Seidel between normals, forces and couples of all contacts that are
        shut.
        """
        impulse = self.impulse * np.repeat(shut, 4)
        for _ in range(20000):
            before = impulse.copy()
            for place in 4 * np.flatnonzero(shut):
                n = place + 3
                impulse[n] = max(0.0, impulse[n] - (start[n] + G[n] @ impulse) / G[n, n])
                for part, limit in (
                    (slice(place, place + 2), self.mu),
                    (slice(place + 2, n), self.arm),
                ):
                    weight = 1.0 / np.linalg.eigvalsh(G[part, part])[-1]
                    trial = impulse[part] - weight * (start[part] + G[part] @ impulse)
                    size = max(np.linalg.norm(trial), 1e-300)
                    impulse[part] = trial * min(1.0, limit * impulse[n] / size)
            if np.abs(impulse - before).max() <= 1e-11 * np.abs(impulse).max():
                break
        return impulse
