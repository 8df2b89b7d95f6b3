"""What MkDocs cannot do: formulas as MathML, documents of the root, links into the source, playable pages."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

from latex2mathml.converter import convert

DOCS = Path(__file__).parent
ROOT = DOCS.parent
SEED = 7  # of all tables and games
PLAYED = "silver_comet"
WATCHED = {"watch": ("silver_comet", "planner", 60), "rolling-balls": ("rolling", "reflex", 40)}
"""The pages with a game that is watched: its table, its player, and for how long [s]."""

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


def on_post_build(config: Any) -> None:
    """Write the table that is played on the site, and the games that are watched."""
    from silverball.drawing.themes import THEMES
    from silverball.table import load_table
    from silverball.web.page import game_page, replay_page, write_page
    from silverball.web.replay_inputs import recording_of

    site = Path(config.site_dir)
    write_page(site / "play.html", game_page(load_table(PLAYED), SEED, THEMES["neon"]))
    for name, (table, player, seconds) in WATCHED.items():
        replay = _played(load_table(table), player, seconds)
        write_page(site / f"{name}.html", replay_page(replay, recording_of(replay), THEMES["neon"]))


def _played(table: Any, player: str, seconds: int) -> Any:
    """The replay of a game that a player plays."""
    from silverball.app.controls import PaddleInput
    from silverball.app.sessions import DemoSession
    from silverball.players import make_player

    session = DemoSession(table, SEED, make_player(player, SEED))
    session.advance(PaddleInput((False, False), (False, False)), seconds * session.game.tick_rate)
    return session.game.replay


def _formula(source: str, *_: Any, **__: Any) -> str:
    """One formula a line."""
    lines = (convert(line, display="block") for line in source.splitlines() if line.strip())
    return f'<div class="formula">{"".join(lines)}</div>'
