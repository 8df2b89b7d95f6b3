"""Handlers for the buttons: what a key or gamepad button does in a menu, in a game, or in a demo."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from silverball.app.controls import MENU_BUTTONS, NUDGES, PADDLES, Action
from silverball.app.menus import Button
from silverball.app.sessions import GameSession
from silverball.errors import BoardFull, NoRoom, SilverballError
from silverball.game.mechanisms import paddle_buttons, plungers

if TYPE_CHECKING:
    from silverball.app.program import Program


def press(program: Program, action: Action, *, same_board: bool = False) -> None:
    """Handle a key or gamepad button that went down.

    Args:
        program: The program.
        action: The action of the button; the window handles full screen, help, debug view and mute.
        same_board: Whether Shift is held, which asks for the same board instead of a new one.
    """
    session = program.session
    if action is Action.SLOWER or action is Action.FASTER:
        program.change_speed(-1 if action is Action.SLOWER else 1)
    elif program.menus.is_open:
        _press_in_menu(program, action, same_board)
    elif session is None:
        _press_while_loading(program, action)
    elif isinstance(session, GameSession):
        _press_in_game(program, session, action, same_board)
    else:
        program.watching.stop()  # any button ends a demo


def release(program: Program, action: Action) -> None:
    """Handle a key or gamepad button that came up."""
    if action in MENU_BUTTONS:
        program.menus.release(MENU_BUTTONS[action])
    program.dot_game.release(action)


def _press_in_menu(program: Program, action: Action, same_board: bool) -> None:
    if action in MENU_BUTTONS:
        program.press_menu(MENU_BUTTONS[action])
    elif program.menus.page == "attract":
        program.press_menu(Button.BACK)  # any button ends the attract mode
    elif action is Action.NEW_BOARD and isinstance(program.session, GameSession):
        program.start_new_board(same_board)
    elif action in NUDGES and program.is_paused:
        program.show_message("the game is paused")


def _press_while_loading(program: Program, action: Action) -> None:
    """Cancel the pending game, play on the dots, or show that the physics is still loading."""
    if action is Action.BACK:
        program.cancel_pending()
    elif program.is_compiling_for_game and action in (*PADDLES, Action.CREATE, Action.LAUNCH):
        program.dot_game.press(action)
    else:
        program.show_loading_message()


def _press_in_game(program: Program, session: GameSession, action: Action, same_board: bool) -> None:
    if session.has_ended and action in (Action.CREATE, Action.BACK, Action.PAUSE):
        program.games.skip_game_over()
    elif action is Action.CREATE:
        _try(program, lambda: program.games.create_ball(session))
    elif action in NUDGES:
        _try(program, lambda: session.game.nudge(NUDGES[action]))
    elif action is Action.PAUSE or action is Action.BACK:
        program.menus.open_pause()
    elif action is Action.NEW_BOARD:
        program.start_new_board(same_board)
    elif action in PADDLES and str(action) not in paddle_buttons(program.board.table):
        program.show_message(f"this table has no {action} paddle")
    elif action is Action.LAUNCH and not plungers(program.board.table):
        program.show_message("this table has no plunger: balls start by themselves")


def _try(program: Program, request: Callable[[], object]) -> None:
    """Run a request of the player; show a message if it is impossible now."""
    try:
        request()
    except BoardFull:
        count = program.board.table.board.max_balls
        program.show_message("only one ball at a time" if count == 1 else f"at most {count} balls at a time")
    except NoRoom:
        is_on_plunger = bool(plungers(program.board.table))
        where = "on the plunger" if is_on_plunger else "for a ball right now"
        program.show_message(f"there is no space {where}")
    except SilverballError as error:
        program.show_message(str(error))
