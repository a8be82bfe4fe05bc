"""The chain from the world to the tool: place, Jacobian for Euler rates, and its derivative, as kernels.

The chain's freedoms are q = [x, y, z, alpha, beta, gamma, theta_0 .. theta_n], the pose of the plate in the world and the arm's joints
(equations 8 to 11 of Hoshino, Fukuda, Adachi and Muro). The columns of the Jacobian belong to the rates of these coordinates: the three
for the angles are not those of an angular velocity.
"""

from .....compiled import kernel

POSE = 6
"""How many freedoms the plate has; the arm's follow."""


@kernel
def tool_place(q, w):
    """The point r = t + R a, world [m], from freedoms [m, rad], shape (6 + joints,), and a `Scratch`."""
    turn, a = w.turn, w.a
    for i in range(3):
        w.place[i] = q[i] + turn[i, 0] * a[0] + turn[i, 1] * a[1] + turn[i, 2] * a[2]


@kernel
def tool_jacobian(w):
    """J = [I | dR/dalpha a, dR/dbeta a, dR/dgamma a | R da/dtheta_i] of `tool_place`, from a `Scratch`."""
    turn, turn_1, a, da, jacobian = w.turn, w.turn_1, w.a, w.da, w.jacobian
    for i in range(3):
        for k in range(3):
            jacobian[i, k] = 1.0 if i == k else 0.0
            jacobian[i, 3 + k] = turn_1[k, i, 0] * a[0] + turn_1[k, i, 1] * a[1] + turn_1[k, i, 2] * a[2]
        for k in range(da.shape[0]):
            jacobian[i, POSE + k] = turn[i, 0] * da[k, 0] + turn[i, 1] * da[k, 1] + turn[i, 2] * da[k, 2]


@kernel
def tool_curvature(w):
    """dJ/dq_k, symmetric in k and the column, from a `Scratch`: d^2 r_i / dq_k dq_j at [k, i, j]."""
    turn, turn_1, turn_2, a, da, dda, curvature = w.turn, w.turn_1, w.turn_2, w.a, w.da, w.dda, w.curvature
    n = da.shape[0]
    for i in range(3):
        for j in range(POSE + n):
            for k in range(3):
                curvature[k, i, j] = 0.0
                curvature[j, i, k] = 0.0
        for j in range(3):
            for k in range(3):
                curvature[3 + k, i, 3 + j] = (
                    turn_2[j, k, i, 0] * a[0] + turn_2[j, k, i, 1] * a[1] + turn_2[j, k, i, 2] * a[2]
                )
            for k in range(n):
                value = turn_1[j, i, 0] * da[k, 0] + turn_1[j, i, 1] * da[k, 1] + turn_1[j, i, 2] * da[k, 2]
                curvature[POSE + k, i, 3 + j] = value
                curvature[3 + j, i, POSE + k] = value
        for j in range(n):
            for k in range(n):
                curvature[POSE + k, i, POSE + j] = (
                    turn[i, 0] * dda[j, k, 0] + turn[i, 1] * dda[j, k, 1] + turn[i, 2] * dda[j, k, 2]
                )
