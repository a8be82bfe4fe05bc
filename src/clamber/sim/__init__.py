"""Plants: robots and limbs in simulation. The only folder that imports MuJoCo."""
