"""The viewer in the browser: robots and their worlds in three dimensions, plans and runs played back, boards edited."""
