"""What MkDocs cannot do by itself: formulas as MathML, the documents of the root, links into the source."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

from latex2mathml.converter import convert

DOCS = Path(__file__).parent
ROOT = DOCS.parent
PAGES = {"README.md": "index.md", "ARCHITECTURE.md": "architecture.md", "CHANGELOG.md": "changelog.md"}


def on_config(config: Any) -> Any:
    """Turn ```math blocks into MathML, which browsers draw without a script, and find the command tree."""
    sys.path.insert(0, str(DOCS))  # where command_tree.py is
    fences = config["mdx_configs"].setdefault("pymdownx.superfences", {}).setdefault("custom_fences", [])
    fences.append({"name": "math", "class": "math", "format": _formula})
    return config


def on_page_markdown(markdown: str, page: Any, config: Any, **_: Any) -> str:
    """Include the documents of the root, and point every link to a page of the site or to the source."""
    folder = (DOCS / page.file.src_uri).parent
    included = re.fullmatch(r"\s*<!-- include: (\w+\.md) -->\s*", markdown)
    if included:
        markdown, folder = (ROOT / included[1]).read_text(encoding="utf-8"), ROOT

    def link(match: re.Match[str]) -> str:
        target, _, anchor = match[1].partition("#")
        there = (folder / target).resolve()
        if not target or not there.exists():
            return match[0]  # within the page, or broken, which MkDocs reports
        place = there.relative_to(ROOT).as_posix()
        if place in PAGES:
            place = f"docs/{PAGES[place]}"
        if not place.startswith("docs/") or place.endswith(".py"):
            return f"]({config.repo_url}/blob/main/{place})"
        here = (DOCS / page.file.src_uri).parent.relative_to(DOCS)
        target = "../" * len(here.parts) + place.removeprefix("docs/")
        return f"]({target}{'#' if anchor else ''}{anchor})"

    return re.sub(r"\]\((?!\w+:)([^)\s]+)\)", link, markdown)


def _formula(source: str, *_: Any, **__: Any) -> str:
    """One formula a line."""
    lines = (convert(line, display="block") for line in source.splitlines() if line.strip())
    return f'<div class="formula">{"".join(lines)}</div>'
