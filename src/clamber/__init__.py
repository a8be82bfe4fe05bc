"""Plan and control robots that climb and walk on several limbs."""

__version__ = "0.1.0"
