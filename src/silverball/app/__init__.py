"""The window: the same world as everywhere, drawn sixty times a second and moved by keys.

controls.py  which key does what, and what is held
clock.py     real time into ticks
session.py   one game: a world, its inputs kept, what to tell the player
inputlog.py  the kept inputs as data, and playing them again
keep.py      where a log is written
startup.py   loading the physics while the table is already on screen
screen.py    the window of the operating system
picture.py   the table in it
overlay.py   everything written on top
window.py    all of it together
"""

from __future__ import annotations

import os

os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")  # pygame greets on the terminal otherwise
