"""Pictures of the limb bench: `draw.draw_result` draws any result; pictures of single studies are functions of their own."""
