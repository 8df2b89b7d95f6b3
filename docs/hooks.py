"""What MkDocs cannot do by itself: formulas as MathML, and links of the documents in the root."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

from latex2mathml.converter import convert


def on_config(config: Any) -> Any:
    """Turn ```math blocks into MathML, which browsers draw without a script, and find the command tree."""
    sys.path.insert(0, str(Path(__file__).parent))  # where command_tree.py is
    fences = config["mdx_configs"].setdefault("pymdownx.superfences", {}).setdefault("custom_fences", [])
    fences.append({"name": "math", "class": "math", "format": _formula})
    return config


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Point links from documents in the root, which the site includes, to its own pages."""
    if page.file.src_uri == "architecture.md" or page.file.src_uri == "changelog.md":
        return markdown  # a snippet; see on_page_content
    return re.sub(r"\]\(\.\./(?:README|CHANGELOG|ARCHITECTURE)\.md", _root_page, markdown)


def on_page_content(html: str, page: Any, **_: Any) -> str:
    """The same in included documents, whose links lead to docs/NAME.md."""
    return re.sub(r'href="docs/([a-z_/]+)\.md(#[^"]*)?"', r'href="../\1/\2"', html)


def _root_page(match: re.Match[str]) -> str:
    name = re.search(r"[A-Z]+", match[0])
    return (
        "](" + {"README": "index", "CHANGELOG": "changelog", "ARCHITECTURE": "architecture"}[name[0]] + ".md"
    )  # type: ignore[index]


def _formula(source: str, *_: Any, **__: Any) -> str:
    """One formula per line."""
    lines = (convert(line, display="block") for line in source.splitlines() if line.strip())
    return f'<div class="formula">{"".join(lines)}</div>'
