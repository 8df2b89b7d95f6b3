"""Where is the log of the last game kept? In the data folder, see `silverball.game.folder`."""

from __future__ import annotations

from silverball.game.folder import data_folder, keep

LAST_GAME = "last-game.jsonl"

__all__ = ["LAST_GAME", "data_folder", "keep"]
