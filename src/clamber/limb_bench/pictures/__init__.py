"""Pictures of the limb bench."""
