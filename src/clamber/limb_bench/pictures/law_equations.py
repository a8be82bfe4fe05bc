"""The equation of each law, as Matplotlib writes mathematics."""

from typing import Final

LAW_EQUATIONS: Final[dict[str, str]] = {
    "jacobian-transpose": r"$\tau = J^T (K_p e + K_d \dot e)$",
    "operational-space": r"$\tau = H J^{-1} (K_p e + K_d \dot e - \dot J \dot\theta) + h + g$",
    "resolved-rate": r"$\tau = k_d\,\{J^{-1} (\dot x_{des} + K_p e \,/\, k_d) - \dot\theta\}$",
    "resolved-rate-plain": r"$\tau = k_p (\theta_{des} - \theta) + k_d (\dot\theta_{des} - \dot\theta),"
    r"\;\; \theta_{des} = \int J^{-1} \dot x_{des}\, dt$",
    "admittance": r"$\tau = k_d K' \{J^{-1} (\dot x_{des} + \dot z + K_p (e + z) / k_d) - \dot\theta\},"
    r"\;\; m \ddot z + d \dot z + k z = f_{des} - f$",
    "joint-pd": r"$\tau = k_p (\theta_{des} - \theta) + k_d (\dot\theta_{des} - \dot\theta),"
    r"\;\; x(\theta_{des}) = x_{des}$",
    "scct": r"$\tau = K' J^{-1} (K_p e + K_d \dot e)$",
    "implicit-admittance": r"$\tau = (K'_p + K'_d s)\, J^{-1} (K_p e + K_d \dot e)$",
    "hybrid": r"$\tau = K' J^{-1} S (K_p e + K_d \dot e) + J^T (E - S)(f_{des} + f_I + d\,\dot e)$",
    "implicit-force": r"$\tau = K' J^{-1} (K_p (e + f_{des} / k_e) + K_d \dot e) + J^T f_{des}$",
}
"""Name of a law -> its torques."""
