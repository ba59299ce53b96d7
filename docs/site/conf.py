"""Settings of the documentation site; scripts/build-site.sh gathers its pages and calls Sphinx."""

import os
import re

project = "Feldspar"
author = "Feldspar developers"
extensions = ["myst_parser"]
source_suffix = {".md": "markdown"}
myst_enable_extensions = ["dollarmath", "amsmath", "html_image"]
myst_heading_anchors = 4
html_theme = "furo"
html_title = "Feldspar"
html_show_copyright = False
pygments_style = "friendly"

# KaTeX from the distribution, so that formulas need no network. Sphinx marks them for MathJax, in whose place it stands.
html_extra_path = ["beside"]
html_static_path = ["/usr/share/javascript/katex"]
html_css_files = ["katex.css"]
html_js_files = [("katex.js", {"defer": "defer", "priority": 100})]
mathjax_path = "contrib/auto-render.js"
mathjax_options = {"defer": "defer", "onload": "renderMathInElement(document.body)"}


def without_links_to_files(app, name, source):
    """Pages link to folders, inputs and programs of the tree, which are no pages of the site: their words stay."""
    here = os.path.dirname(os.path.join(app.srcdir, name))

    def shown(link):
        target = link[2].split("#")[0]
        is_page = target.endswith(".md") or target.startswith("http") or not target
        is_picture = link[0].startswith("!")
        if is_picture or is_page and (not target or target.startswith("http") or os.path.exists(os.path.join(here, target))):
            return link[0]
        return link[1]

    source[0] = re.sub(r"!?\[([^\]]*)\]\(([^)\s]+)\)", shown, source[0])


def setup(app):
    app.connect("source-read", without_links_to_files)
