"""The window: the same world as everywhere, drawn as often as the screen shows it, and moved by buttons.

settings.py  what a player can choose
controls.py  which key and which gamepad button (gamepad.py) asks for what, and what is held
keyboard.py  which key that is on the layout in use
program.py   what is going on, and what a button means: games begin, pause, end
             sessions.py   play, a replay, or the program playing by itself
             command_handlers.py   what the commands of the menus bring about
             game_archive.py  what is kept of a game, and when
             catalog.py  which tables and scores can be chosen
menus/       the pages of the score display; score_display.py what it shows during a game
sound/       from recipes to what is heard
clock.py     real time into ticks; latency.py, framerate.py what is measured of it
startup.py   loading the physics while the table is already on screen
input_handler.py  what an event of the window asks for
screen.py    the window of the operating system (pointer.py, sdl.py); picture.py the table in it
overlay.py   what is written on top (layout.py, messages.py); debug.py what the physics sees
window.py    all of it together, in beats and frames
"""

from __future__ import annotations

import os

os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")  # pygame greets on the terminal otherwise
