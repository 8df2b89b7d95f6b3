"""The pages after a game: what it came to, line by line; one more with one press; what made the points."""

from __future__ import annotations

from typing import NamedTuple

from silverball.app.menus.choice import ChoicePage, Item
from silverball.app.menus.commands import Command, EndGame, Play, SaveReplay, WatchLast
from silverball.app.menus.context import MenuContext
from silverball.app.menus.pages import main_page, play

LINE_TIME = 1.8  # [s] for each line of the title
MAX_CAUSES = 8


class Signing(NamedTuple):
    """A score that asks for initials.

    Attributes:
        score: Points.
        rank: Its rank in the high scores, from 1.
        player: Whose it is, from 1; 0 with one player.
    """

    score: int
    rank: int
    player: int = 0


class GameOver(NamedTuple):
    """What a game came to.

    Attributes:
        lines: Sentences in capitals, the most important first: "1,200 TO BEAT AAA".
        causes: What made the points, and how many, the most first.
        signings: The scores that ask for initials, in the order of the players.
        again: The game that "play again" begins; None: another one by the settings.
    """

    lines: tuple[str, ...] = ()
    causes: tuple[tuple[str, int], ...] = ()
    signings: tuple[Signing, ...] = ()
    again: Play | None = None


def over_page(context: MenuContext, score: int, what: GameOver = GameOver()) -> ChoicePage:  # noqa: B008
    """The menu after a game."""
    saved = False

    def again() -> Command:
        if what.again is None:
            return play(context)
        context.close()
        return what.again

    def watch() -> Command:
        context.suspend()
        return WatchLast()

    def save() -> Command:
        nonlocal saved
        saved = True
        return SaveReplay()

    def menu() -> Command:
        context.close()
        context.open(main_page(context))
        return EndGame()

    def title() -> str:
        lines = ("GAME OVER", *what.lines)
        return lines[int((context.now - opened_at) / LINE_TIME) % len(lines)]

    def items() -> list[Item]:
        hint = "   ".join((f"SCORE {score:,}", *what.lines[:1]))
        points = [
            Item("POINTS", "WHAT MADE THEM", lambda: context.open(points_page(context, what.causes)))
        ] * bool(what.causes)
        return [
            Item("PLAY AGAIN", hint, again),
            *points,
            Item("WATCH IT", "THE GAME FROM THE START", watch),
            Item("SAVE REPLAY", "SAVED" if saved else "KEEP IT AS A FILE", save),
            Item("MENU", "MODE, TABLE, SCORES, SETTINGS", menu),
        ]

    opened_at = context.now
    return ChoicePage("over", title, items, back=menu)


def points_page(context: MenuContext, causes: tuple[tuple[str, int], ...]) -> ChoicePage:
    """What made the points of a game."""
    total = max(sum(points for _, points in causes), 1)

    def items() -> list[Item]:
        rows = [
            Item(name.upper(), f"{points:,}   {round(100 * points / total)} %")
            for name, points in causes[:MAX_CAUSES]
        ]
        return [*rows, Item("BACK", "ALSO: HOLD BOTH PADDLES", context.back)]

    return ChoicePage("points", "WHAT MADE THE POINTS", items)
