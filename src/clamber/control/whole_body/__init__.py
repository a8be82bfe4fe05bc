"""Laws of a robot whose base floats and whose limbs hold on to something."""
