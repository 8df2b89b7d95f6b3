"""Writes a page: one HTML file in which a table is played, or a replay watched, with the same bits as here.

replay or table → its world, compiled          (world_meta.py)
→ its pictures, baked          (look.py)
→ what moved the world         (script.py)
→ all packed into one file     (pack.py, bundle.py), with the module (module.py)
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

from silverball.app.sound.sound_sets import sound_set
from silverball.drawing.camera import Camera, best_size
from silverball.drawing.layout import Layout
from silverball.drawing.themes import THEMES, Theme
from silverball.errors import OutputError
from silverball.game.replay.format import Replay
from silverball.game.scores.medals import medal_points
from silverball.game.view import Mode
from silverball.plain import plain
from silverball.table import Table, table_digest
from silverball.web.bundle import page_text
from silverball.web.card_words import card_words
from silverball.web.display_words import display_words
from silverball.web.look import look_of
from silverball.web.module import read_module
from silverball.web.pack import ArrayPack, compress
from silverball.web.replay_inputs import Recording
from silverball.web.rules_meta import game_meta, put_rules
from silverball.web.waves import packed_sounds
from silverball.web.world_meta import put_world
from silverball.wholefile import write_whole
from silverball.world import WorldBatch
from silverball.world.compile import part_numbers

PLAIN_HEIGHT, RICH_HEIGHT = 720, 540  # [pixel] for pages of less than 1.5 MB
TICK_RATE = 240  # of games that are played in a page

Progress = Callable[[float], None]


def game_page(
    table: Table, seed: int, theme: Theme, height: int | None = None, *,
    mode: Mode = Mode.ARCADE, has_sounds: bool = True, progress: Progress = lambda share: None,
) -> str:  # fmt: skip
    """The text of a page in which a table is played, in arcade or free play.

    Args:
        table: A table; a recipe makes a board with the seed.
        seed: The seed of everything random.
        theme: Its colours.
        height: Of the picture [pixel]; None: `default_height`.
        mode: The mode with which it begins.
        has_sounds: Whether it has sounds.
        progress: Called with the share of the work that is done, 0 to 1.
    """
    batch = WorldBatch(table, 1, seed, TICK_RATE, threads=1)
    modes = (mode, *(other for other in Mode if other != mode))
    finished = batch.tables[0]
    medals = [[medal.value, points] for medal, points in medal_points(finished).items()]
    what = {"fileName": _file_name(finished), "tableKey": table_digest(finished)[:16], "medals": medals}
    return _page(batch, theme, height, what, progress, modes=modes, has_sounds=has_sounds)


def replay_page(
    replay: Replay, recording: Recording, theme: Theme, height: int | None = None, *,
    has_sounds: bool = True, progress: Progress = lambda share: None,
) -> str:  # fmt: skip
    """The text of a page in which a replay is watched.

    Args:
        replay: The replay.
        recording: What `recording_of` says about it.
        theme: Its colours.
        height: Of the picture [pixel]; None: `default_height`.
        has_sounds: Whether it has sounds.
        progress: Called with the share of the work that is done, 0 to 1.
    """
    batch = WorldBatch(replay.table, 1, replay.seed, replay.tick_rate, threads=1)
    what = {"replay": recording._asdict()}
    return _page(batch, theme, height, what, progress, modes=(replay.mode,), has_sounds=has_sounds)


def default_height(table: Table) -> int:
    """The height of the picture [pixel] with which a page is less than 1.5 MB.

    A table with lamps or upper levels carries many more pictures than one without.
    """
    layout = Layout.of(table)
    return RICH_HEIGHT if layout.inserts or len(layout.levels) > 1 else PLAIN_HEIGHT


def write_page(path: Path, text: str) -> None:
    """Write a page to a file, whole or not at all.

    Raises:
        OutputError: The file cannot be written.
    """
    try:
        write_whole(path, lambda place: place.write_text(text, encoding="utf-8", newline="\n"))
    except OSError as error:
        raise OutputError(f"{path}: cannot be written ({error.strerror or error})") from None


def _page(
    batch: WorldBatch, theme: Theme, height: int | None, what: dict[str, Any], progress: Progress, *,
    modes: tuple[Mode, ...], has_sounds: bool,
) -> str:  # fmt: skip
    table, pack = batch.tables[0], ArrayPack()
    numbers = part_numbers(table)
    world = put_world(batch, pack)
    rules = {str(mode): put_rules(batch, mode, pack) for mode in modes}
    camera = Camera(table.board, best_size(table.board, height or default_height(table)))
    look = look_of(table, camera, theme, numbers, pack, progress)
    meta = {
        "title": plain(table.name), "world": world, "look": look.meta, "sounds": None,
        "game": game_meta(batch), "rules": rules, "words": display_words(table, numbers),
        "card": card_words(table, modes), **what,
    }  # fmt: skip
    blocks = {**look.pictures}
    if has_sounds:
        name = next((name for name, one in THEMES.items() if one == theme), "")
        sounds = packed_sounds(table, numbers, sound_set(name))
        meta["sounds"], blocks["sounds"] = sounds.meta, sounds.waves
    blocks |= {
        "meta": compress(json.dumps(meta, separators=(",", ":"), allow_nan=False).encode()),
        "module": compress(read_module()),
        "arrays": pack.to_text(),
    }
    room = "rgb({} {} {})".format(*look.room)
    return page_text(f"{table.name} – Silverball", f"Pinball table {table.name}", room, blocks)


def _file_name(table: Table) -> str:
    """A name for the files of a table's games."""
    return re.sub(r"[^a-z0-9]+", "-", table.name.lower()).strip("-") or "table"
