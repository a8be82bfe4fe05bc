"""Pictures of the limb bench: what its results draw themselves by; pictures of single studies are functions of their own."""
