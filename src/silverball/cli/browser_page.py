"""Writes pages for a browser, for `page` and `replay`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from silverball.cli.console import baking, print_lines, progress_bar
from silverball.cli.shared_options import theme_named
from silverball.plain import plain

if TYPE_CHECKING:
    from silverball.game.replay.format import Replay
    from silverball.table import Table

ENDING = ".html"


def make_replay_page(out: Path, replay: Replay, size: int | None, theme: str) -> None:
    """Write a page of a replay, and say what Python finds of it.

    Raises:
        SilverballError: The replay needs custom rules, or the file cannot be written.
    """
    from silverball.web.page import replay_page, write_page
    from silverball.web.replay_inputs import recording_of

    with progress_bar() as bar:
        task = bar.add_task("playing", total=replay.ticks)
        recording = recording_of(replay, lambda ticks: bar.update(task, completed=ticks))
    with baking() as progress:
        text = replay_page(replay, recording, theme_named(theme), size, progress=progress)
    write_page(out, text)
    if recording.differs:
        print_lines(f"{plain(str(out))}: it differs in Python too: {recording.differs}", err=True)
    _report(out, text)


def make_game_page(out: Path, board: Table, seed: int, size: int | None, theme: str) -> None:
    """Write a page in which a table is played."""
    from silverball.web.page import game_page, write_page

    with baking() as progress:
        text = game_page(board, seed, theme_named(theme), size, progress=progress)
    write_page(out, text)
    _report(out, text)


def _report(out: Path, text: str) -> None:
    print_lines(f"{plain(str(out))}: {len(text.encode()) / 1e6:.2f} MB, opens in any browser")
