"""Climbing: actions of a plan carried out by a climber whose limbs hold the body and reach for holds."""
