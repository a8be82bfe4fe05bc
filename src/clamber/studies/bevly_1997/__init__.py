"""Bevly, *Action Module Planning and Cartesian Based Control of an Experimental Climbing Robot*, MIT, 1997: chapter 2."""

PAPER = "bevly-1997"
