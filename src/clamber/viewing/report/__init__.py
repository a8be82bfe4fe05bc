"""Reports as folders of plain pages that open in any browser from a disk: what was claimed, run or measured, and what came of it."""
