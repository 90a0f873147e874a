"""What the site needs besides MkDocs: equations as MathML, notebooks as pages, links out of this folder as plain names."""

import json
import re
from pathlib import Path

from latex2mathml.converter import convert
from mkdocs.structure.files import File

DOCS = Path(__file__).parent


def fence(source, language, css_class, options, md, **kwargs):
    """A fence of the language `math`."""
    return f'<div class="{css_class}">{convert(source, display="block")}</div>'


def on_config(config):
    math = {"name": "math", "class": "math", "format": fence}
    config.mdx_configs["pymdownx.superfences"] = {"custom_fences": [math]}
    return config


def page_of(notebook):
    """A notebook as Markdown: its cells without outputs."""
    cells = []
    for cell in json.loads(notebook.read_text(encoding="utf-8"))["cells"]:
        text = "".join(cell["source"])
        if cell["cell_type"] == "code":
            cells.append(f"```python\n{text}\n```")
        else:
            cells.append(re.sub(r"\$([^$]+)\$", lambda m: convert(m[1]), text))
    cells.append(f"*The notebook itself: `docs/notebooks/{notebook.name}`; the tests run it.*")
    return "\n\n".join(cells)


def on_files(files, config):
    for notebook in sorted((DOCS / "notebooks").glob("*.ipynb")):
        name = f"notebooks/{notebook.name}"
        if files.get_file_from_path(name):
            files.remove(files.get_file_from_path(name))
        page = f"notebooks/{notebook.stem}.md"
        files.append(File.generated(config, page, content=page_of(notebook)))
    return files


def on_page_markdown(markdown, page, config, files):
    # links to files that only a clone has
    return re.sub(r"\[([^\]]+)\]\(\.\./([^)]+)\)", r"\1 (`\2`)", markdown)
