"""The laws by name: their number in the kernels, their equation and its source in one line, and which of them weigh the joints."""

from typing import Final

from .drive import (
    ADMITTANCE,
    HYBRID,
    IMPLICIT_ADMITTANCE,
    IMPLICIT_FORCE,
    JACOBIAN_TRANSPOSE,
    JOINT_PD,
    OPERATIONAL_SPACE,
    RESOLVED_RATE,
    RESOLVED_RATE_PLAIN,
    SCCT,
)

LAWS: Final[dict[str, int]] = {
    "jacobian-transpose": JACOBIAN_TRANSPOSE,
    "operational-space": OPERATIONAL_SPACE,
    "resolved-rate": RESOLVED_RATE,
    "resolved-rate-plain": RESOLVED_RATE_PLAIN,
    "admittance": ADMITTANCE,
    "joint-pd": JOINT_PD,
    "scct": SCCT,
    "implicit-admittance": IMPLICIT_ADMITTANCE,
    "hybrid": HYBRID,
    "implicit-force": IMPLICIT_FORCE,
}
"""Name -> number in `drive`; the command line, the bench and the tests read it."""
LAW_TITLES: Final[dict[str, str]] = {
    "jacobian-transpose": "tau = J^T (Kp e + Kd de): a spring at the tip through statics (Bevly 1997, Eq. 3.2)",
    "operational-space": "tau = H J^-1 (Kp e + Kd de - dJ dq) + h + g: the full model (Khatib 1985; Bevly 1997, Eq. 3.13)",
    "resolved-rate": "tau = W kd (J^-1 (dx_des + Kp/kd e) - dq): joint speeds from the tip's error (Siciliano 1996; Bevly 1997, 3.2.3)",
    "resolved-rate-plain": "joint PD about the integral of J^-1 dx_des: no error at the tip is fed back (Whitney 1969)",
    "admittance": "a felt force moves the aim, resolved rate follows it; needs a force sensor (Whitney 1977; Bevly 1997, 3.2.4)",
    "joint-pd": "tau = W (kp (q_des - q) + kd (dq_des - dq)), q_des by inverse kinematics: each joint by itself",
    "scct": "tau = K' J^-1 (Kp e + Kd de) + J^T F: computed torque with the motors' inertia only (Bevly 1997, Eq. 3.16)",
    "implicit-admittance": "tau = (K'p + K'd s) J^-1 (Kp e + Kd de) + J^T F: SCCT with a derivative (Bevly 1997, Eq. 3.25)",
    "hybrid": "SCCT along the free rows, J^T f along the forced ones (Raibert and Craig 1981; Bevly 1997, 3.5)",
    "implicit-force": "SCCT to a place inside a surface of known stiffness, no force sensor (Bevly 1997, 3.5)",
}
"""Name -> equation and source in one line; e = aim less tip, W = K' or the unit matrix."""
WEIGHTED: Final = frozenset({"scct", "implicit-admittance", "hybrid", "implicit-force", "admittance"})
"""Laws that weigh their joints by K' unless told otherwise."""
FORCING: Final = frozenset({"hybrid", "implicit-force"})
"""Laws that take rows of force."""
