"""Which menus are there, and what do they ask for? Pages of dots, worked with the paddle buttons and Space.

`Menus` is all that a window needs: it passes buttons in, shows the dots that come out, and does what the
commands say (`commands.py`).
"""

from silverball.app.bindings import (
    ACTIONS,
    ActionBinding,
    action_by_key,
    action_by_name,
    action_by_pad,
    capital,
    keys_for,
    pad_buttons_for,
    shown,
)
from silverball.app.menus.commands import Button, Command
from silverball.app.menus.context import JoystickEntry, ScoreRow, TableEntry
from silverball.app.menus.menus import Menus
from silverball.app.menus.transport import ReplayStatus

__all__ = [
    "ACTIONS",
    "ActionBinding",
    "Button",
    "Command",
    "JoystickEntry",
    "Menus",
    "ReplayStatus",
    "ScoreRow",
    "TableEntry",
    "action_by_key",
    "action_by_name",
    "action_by_pad",
    "capital",
    "keys_for",
    "pad_buttons_for",
    "shown",
]
