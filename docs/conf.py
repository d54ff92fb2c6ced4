"""How the documentation is built; `make docs` does it."""

import os
import sys
from importlib.metadata import version as installed_version
from pathlib import Path

from jupyter_client.manager import KernelManager

os.environ["MATPLOTLIBRC"] = str(
    Path(__file__).parent / "matplotlibrc"
)  # read by the notebooks' kernels
sys.path.insert(0, str(Path(__file__).parent / "_extensions"))
if encryption := KernelManager.class_traits().get("transport_encryption"):
    encryption.default_value = (
        "auto"  # kernels warn of channels that anyone on the machine can read
    )

project = "tippetop"
author = "The tippetop authors"
project_copyright = author
version = release = installed_version("tippetop")

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "mathml",
    "players",
]
exclude_patterns = ["_build", "jupyter_execute"]
nitpicky = False

html_theme = "pydata_sphinx_theme"
html_title = "tippetop"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_js_files = ["site.js"]
html_favicon = html_logo = "_static/top.svg"
html_baseurl = "https://tippetop.github.io/tippetop/"
html_copy_source = html_show_sourcelink = False
html_context = {"default_mode": "auto"}
html_theme_options = {
    "logo": {"text": "tippetop"},
    "github_url": "https://github.com/tippetop/tippetop",
    "header_links_before_dropdown": 9,
    "navigation_with_keys": True,
    "navbar_persistent": ["search-button"],
    "show_toc_level": 2,
    "footer_start": ["copyright"],
    "footer_end": [],
}
html_sidebars = {page: [] for page in ("index", "start", "gallery", "validation")}

html_math_renderer = "mathml"
math_numfig = False

myst_enable_extensions = [
    "dollarmath",
    "amsmath",
    "deflist",
    "colon_fence",
    "fieldlist",
    "attrs_inline",
]
myst_heading_anchors = 3
nb_execution_mode = "auto"
nb_execution_raise_on_error = True
nb_execution_in_temp = True
nb_execution_timeout = 120
nb_execution_show_tb = True
nb_merge_streams = True
nb_mime_priority_overrides = [("html", "image/svg+xml", 0)]

autodoc_typehints = "none"
autodoc_preserve_defaults = True
autodoc_member_order = "bysource"
napoleon_google_docstring = False
napoleon_use_ivar = True
napoleon_use_rtype = False
