"""The menus: pages of dots on the score display, operated with the paddle buttons and Space.

`Menus` is the interface for the program: it takes buttons, draws dots and returns commands (`commands.py`).
"""

from silverball.app.menus.commands import Button, Command
from silverball.app.menus.context import JoystickEntry, MenuContext, ScoreRow, TableEntry
from silverball.app.menus.menus import Menus
from silverball.app.menus.transport import ReplayStatus

__all__ = [
    "Button",
    "Command",
    "JoystickEntry",
    "MenuContext",
    "Menus",
    "ReplayStatus",
    "ScoreRow",
    "TableEntry",
]
