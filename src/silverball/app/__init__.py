"""The game in a window: keys and gamepads in; table, score display and sounds out.

window.py           the main loop: input polls and frames
program.py          the state of the program, and what is asked of it
    machine.py          the board and the session on it; sessions.py: a game, a replay, or a demo
    player_games.py     begins and ends the player's games; watching.py replays and demos
    board.py            the board on screen
    button_handlers.py  what buttons do; command_handlers.py what commands of the menus do
    catalog.py          tables and scores to choose from; table_files.py reads the user's tables
    game_archive.py     saves games, scores and replay files
    demo_players.py     players of a demo; player_warmup.py compiles them in the background
settings.py         the player's settings and their owner
input_handler.py    events of the window: keyboard.py, gamepad.py, bindings.py, controls.py
menus/              the pages on the score display; score_display.py is the display during a game
backglass/          what is beside the table in a wide window; arrangement.py says where
sound/              synthesised sounds
startup.py          loads the physics while the table is already on screen
timing.py           real time into ticks, frame times, latency
screen.py           the window of the operating system (sdl.py); picture.py the table in it
    cabinet_mode.py     a picture that stands otherwise (turned_picture.py), and second_screen.py
overlay.py          text on top of it (widgets.py, scoring.py); debug.py the debug view
"""

from __future__ import annotations

import os

os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")  # pygame prints a greeting otherwise
