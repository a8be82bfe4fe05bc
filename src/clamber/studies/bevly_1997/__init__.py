"""Bevly, *Action Module Planning and Cartesian Based Control of an Experimental Climbing Robot*, MIT, 1997: chapters 2 to 4."""

MILLI = 1e3
"""Millimetres in a metre, mrad in a radian [-]."""
