"""Which colours do words, keys and panels have that lie over a table of any theme?"""

from __future__ import annotations

from silverball.drawing.themes import Color

__all__ = ["Color"]

ROOM: Color = (7, 6, 13)  # around the table

PANEL: Color = (10, 8, 20)
PANEL_INNER: Color = (70, 196, 255)
SCORE: Color = (255, 186, 58)
LABEL: Color = (112, 220, 255)
TEXT: Color = (236, 236, 250)
FAINT_TEXT: Color = (150, 142, 190)
KEY_FACE: Color = (52, 46, 86)
KEY_EDGE: Color = (150, 136, 214)
