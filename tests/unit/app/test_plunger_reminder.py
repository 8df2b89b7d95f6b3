"""A ball that waits on the plunger is told of, in any game and at any time of it."""

from __future__ import annotations

from silverball.app.guide import AGAIN, WAIT, PlungerReminder
from silverball.game.game import Game

TEXT = "HOLD SPACE, THEN LET GO"


def wait(game: Game, reminder: PlungerReminder, seconds: float, *, launch: bool = False) -> list[str]:
    """The hints within some seconds, asked for 60 times a second."""
    hints = []
    for _ in range(round(60 * seconds)):
        hints.append(reminder.hint())
        game.step(ticks=4, launch=launch)
    return [hint for hint in hints if hint]


def test_a_ball_that_waits_is_told_of_again_and_again():
    game = Game("silver_comet", 7)
    reminder = PlungerReminder(game, {"create": "SPACE"}.__getitem__)
    assert wait(game, reminder, 1.0) == []  # there is no ball yet
    game.create_ball()
    assert wait(game, reminder, WAIT) == []
    assert wait(game, reminder, 0.1) == [TEXT]
    assert wait(game, reminder, AGAIN - 0.2) == []
    assert wait(game, reminder, 0.2) == [TEXT]
    assert wait(game, reminder, AGAIN + 1.0, launch=True) == []
    assert wait(game, reminder, 1.0) == []  # it is launched


def test_a_table_without_a_plunger_has_no_reminder():
    game = Game("classic", 7)
    reminder = PlungerReminder(game, {"create": "SPACE"}.__getitem__)
    game.create_ball()
    assert wait(game, reminder, WAIT + AGAIN) == []
