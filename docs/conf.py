# The manual: Sphinx with MyST, Furo and Breathe, as Debian has them. docs/run builds it.
import pathlib
import re

root = pathlib.Path(__file__).resolve().parent.parent
header = (root / "include/grainlaw/grainlaw.h").read_text()
numbers = dict(re.findall(r"define GRAINLAW_VERSION_(\w+) (\d+)", header))

project = "grainlaw"
author = "the authors of grainlaw"
copyright = "the authors of grainlaw, BSD-3-Clause"
version = release = ".".join(numbers[part] for part in ("MAJOR", "MINOR", "PATCH"))

extensions = ["myst_parser", "breathe", "sphinx.ext.mathjax"]
myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 4
myst_dmath_allow_labels = True
# The source is the whole checkout, so that links between pages are those of the files.
root_doc = "docs/index"
exclude_patterns = ["build", "install", "src", "include", "tests", "README.md", "verification/scenes/reference"]
math_number_all = False
numfig = False

# Doxygen's XML, written by docs/run.
breathe_projects = {"grainlaw": str(root / "build/docs/doxygen/xml")}
breathe_default_project = "grainlaw"
breathe_domain_by_extension = {"h": "c", "hpp": "cpp"}

html_theme = "furo"
html_title = f"grainlaw {version}"
html_copy_source = False
html_show_sourcelink = False
# docs/run puts Debian's MathJax there, so that pages need no network.
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_SVG"
mathjax2_config = {"messageStyle": "none"}
# Else MyST marks every page to be left out by MathJax 2, and sets up MathJax 3, which Debian does not have.
myst_update_mathjax = False
