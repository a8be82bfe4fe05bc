"""Hoshino, Fukuda, Adachi, Muro, *Posture Control of Six-legged Integrated Locomotion and Manipulation Robot*, 1995."""

from typing import Final

PAPER: Final = "hoshino-1995"
CALIBRATED: Final = (
    "The paper prints no sizes of the frames. Ours, attachments on two circles of 238.4 mm and 50 mm for a drawn-in actuator, are "
    "fitted to its range of angles and its longest step: three data, two fitted numbers. They are very likely, not proven; other "
    "sizes fit as well (`clamber calibrate` lists them)."
)
SIGNS: Final = (
    "Theta is the Y-frame's angle in the Delta-frame, -18 to 48 deg, with which the regions of figure 4 grow. The paper prints -48 to "
    "18 deg: that must be the body's angle in the Y-frame, which has the other sign, and is shown as printed where it is compared."
)
