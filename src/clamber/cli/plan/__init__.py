"""`clamber plan`: searching, and what is told of plans, fronts and boards that have none."""
