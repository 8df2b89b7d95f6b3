"""Handlers for the commands of the menus: one function per kind of command."""

from __future__ import annotations

from functools import singledispatch
from typing import TYPE_CHECKING

from silverball.app.catalog import table_problem_text
from silverball.app.menus import commands
from silverball.app.sessions import GameSession
from silverball.errors import SilverballError

if TYPE_CHECKING:
    from silverball.app.program import Program


@singledispatch
def execute(command: object, program: Program) -> None:
    """Execute a command; None does nothing."""
    if command is not None:
        raise TypeError(f"expected a command of the menus, got {command!r}")


@execute.register(commands.Play)
def _(command: commands.Play, program: Program) -> None:
    program.play(command.mode, command.table, command.seed, players=command.players, rival=command.rival)


@execute.register(commands.WatchLast)
def _(command: commands.WatchLast, program: Program) -> None:
    watch_replay_text(program, program.store.last_game() or "", "the last game")


@execute.register(commands.WatchScore)
def _(command: commands.WatchScore, program: Program) -> None:
    number = int(command.key)
    try:
        text = program.store.replay(number)
    except SilverballError as error:
        _reject_replay(program, error)
    else:
        watch_replay_text(program, text, f"score {number}")


@execute.register(commands.WatchDemo)
def _(command: commands.WatchDemo, program: Program) -> None:
    program.start_demo(command.player)


@execute.register(commands.Attract)
def _(command: commands.Attract, program: Program) -> None:
    if command.on and program.is_ready and not program.has_game:
        program.start_demo(is_attract=True)


@execute.register(commands.ShowBoard)
def _(command: commands.ShowBoard, program: Program) -> None:
    program.show_board(command.seed)


@execute.register(commands.ShowTableProblem)
def _(command: commands.ShowTableProblem, program: Program) -> None:
    program.show_message(table_problem_text(command.table, command.problem))


@execute.register(commands.Quit)
def _(command: commands.Quit, program: Program) -> None:
    program.should_quit = True


@execute.register(commands.Resume)
def _(command: commands.Resume, program: Program) -> None:
    """Do nothing: the menu has closed itself, so the game continues."""


@execute.register(commands.Restart)
def _(command: commands.Restart, program: Program) -> None:
    if isinstance(program.session, GameSession):
        program.games.begin_again(program.session)


@execute.register(commands.EndGame)
def _(command: commands.EndGame, program: Program) -> None:
    program.games.end()


@execute.register(commands.SaveReplay)
def _(command: commands.SaveReplay, program: Program) -> None:
    path = program.games.save_replay_file("game")
    program.menus.show_message("saved" if path else "could not be saved")
    program.show_message(f"the replay is at {path}" if path else "the data folder cannot be written")


@execute.register(commands.Initials)
def _(command: commands.Initials, program: Program) -> None:
    program.games.archive.rename(program.games.result, command.text, command.player)


@execute.register(commands.ReplaySpeed)
def _(command: commands.ReplaySpeed, program: Program) -> None:
    program.change_speed(command.step)


@execute.register(commands.ReplayPause)
def _(command: commands.ReplayPause, program: Program) -> None:
    program.machine.is_replay_paused = not program.machine.is_replay_paused


@execute.register(commands.ReplayJump)
def _(command: commands.ReplayJump, program: Program) -> None:
    program.watching.jump(command.seconds)


@execute.register(commands.EndReplay)
def _(command: commands.EndReplay, program: Program) -> None:
    program.watching.end()


def watch_replay_text(program: Program, text: str, source: str) -> None:
    """Show a replay given as text, or show why it cannot be played."""
    from silverball.game.replay.format import Replay

    try:
        program.watch(Replay.from_text(text, source))
    except SilverballError as error:
        _reject_replay(program, error)


def _reject_replay(program: Program, error: SilverballError) -> None:
    program.show_message(str(error))
    program.menus.reopen()
