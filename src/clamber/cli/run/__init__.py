"""`clamber run`: climbs and walks carried out once, and what is told of them."""
