"""What commands print with `--json`, field by field; the schemas and the page about them are made of these."""
