"""What each law is, in a line: for lists and pages."""

from typing import Final

LAW_TITLES: Final[dict[str, str]] = {
    "jacobian-transpose": "spring and damper at the tip, J^T F (Bevly 1997, 3.2)",
    "operational-space": "computed torque of the tip's motion (Khatib 1985; 3.13)",
    "resolved-rate": "joint speeds that the error asks for (Whitney 1969; 3.2.3)",
    "resolved-rate-plain": "joint speeds of the aim summed up, no error of the tip",
    "admittance": "a felt force moves the aim (Whitney 1977; 3.2.4)",
    "joint-pd": "each joint held at the angle of inverse kinematics",
    "scct": "simplified Cartesian computed torque, K' J^-1 F (3.16)",
    "implicit-admittance": "SCCT as a speed for a joint servo (3.25)",
    "hybrid": "force by J^T in some directions, SCCT in the others (3.5)",
    "implicit-force": "force by a place inside a surface of known stiffness (3.5)",
}
"""Law -> what it does, with where Bevly's thesis has it."""
