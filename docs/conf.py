"""The documentation as a site: `make docs`, warnings are errors."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))  # for the generated pages

from api_pages import write_api_pages
from command_pages import write_command_page
from json_pages import write_json_page

from clamber import __version__

project = "Clamber"
author = "The Clamber authors"
copyright = author  # Sphinx's name for it
release = version = __version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["media/**"]
myst_enable_extensions = ["colon_fence", "deflist", "fieldlist"]
myst_heading_anchors = 4
suppress_warnings = ["myst.header", "toc.not_included"]  # studies have a page for each result, reached from their own

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_class_signature = "mixed"
autodoc_default_options = {"members": True, "undoc-members": False, "show-inheritance": False}
napoleon_google_docstring = True
napoleon_numpy_docstring = False

html_theme = "furo"
html_title = f"Clamber {version}"
html_static_path = ["static"]
html_css_files = ["wide-tables.css"]
html_show_sourcelink = False

write_api_pages(Path(__file__).parent)
write_command_page(Path(__file__).parent)
write_json_page(Path(__file__).parent)
