"""Hoshino, Fukuda, Adachi, Muro, *Posture Control of Six-legged Integrated Locomotion and Manipulation Robot*, 1995."""

from typing import Final

CALIBRATED: Final = (
    "The paper prints no sizes of the frames. Ours, attachments on two circles of 238.4 mm and 50 mm for a drawn-in actuator, are "
    "fitted to its range of angles and its longest step: three data, two fitted numbers. They are very likely, not proven; other "
    "sizes fit as well (`clamber calibrate` lists them)."
)
SIGNS: Final = (
    "Theta is the Y-frame's angle in the Delta-frame, -18 to 48 deg, with which the regions of figure 4 grow. The paper prints -48 to "
    "18 deg: that must be the body's angle in the Y-frame, which has the other sign, and is shown as printed where it is compared."
)
CAPTIONS: Final = (
    "The captions of figures 8 and 9 are exchanged: the text has the walk in figure 8 and the steepest direction in figure 9, the "
    "caption of the walk says figure 9. Results go by the text's numbers."
)
SIMULATED: Final = (
    "Ours is a robot in contact dynamics, not the prototype: masses, stiffness, friction and legs are assumed (docs/walks.md says "
    "which). The paper prints neither how far its robot went nor what it stood on."
)
