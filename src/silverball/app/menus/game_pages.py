"""Which pages does one see around a game? The pause, and what comes after the last ball."""

from __future__ import annotations

from collections.abc import Callable

from silverball.app.menus.choice import ChoicePage, Item
from silverball.app.menus.commands import Command, EndGame, Play, Restart, Resume, SaveReplay, WatchLast
from silverball.app.menus.desk import Desk
from silverball.app.menus.front import main_page, settings_page


def pause_page(desk: Desk) -> ChoicePage:
    """The game is paused."""

    def resume() -> Command:
        desk.close()
        return Resume()

    def restart() -> Command:
        desk.close()
        return Restart()

    def end() -> Command:
        desk.close()
        desk.open(main_page(desk))
        return EndGame()

    def items() -> list[Item]:
        return [
            Item("GO ON", "THE GAME IS PAUSED", resume),
            Item(
                "RESTART",
                "THE SAME BOARD FROM THE START",
                lambda: desk.open(_sure(desk, "RESTART?", restart)),
            ),
            Item("SETTINGS", "COLOURS, SOUND, KEYS", lambda: desk.open(settings_page(desk))),
            Item("END GAME", "TO THE MAIN MENU", lambda: desk.open(_sure(desk, "END GAME?", end))),
        ]

    return ChoicePage("pause", "PAUSE", items, back=resume, quiet=False)


def over_page(desk: Desk, score: int) -> ChoicePage:
    """The game is over."""
    saved = False

    def again() -> Command:
        desk.close()
        return Play(desk.mode(), desk.settings.table, desk.seed if desk.table().is_random else None)

    def watch() -> Command:
        desk.leave()
        return WatchLast()

    def save() -> Command:
        nonlocal saved
        saved = True
        return SaveReplay()

    def menu() -> Command:
        desk.close()
        desk.open(main_page(desk))
        return EndGame()

    def items() -> list[Item]:
        return [
            Item("PLAY AGAIN", f"SCORE {score:,}", again),
            Item("WATCH IT", "THE GAME FROM THE START", watch),
            Item("SAVE REPLAY", "SAVED" if saved else "KEEP IT AS A FILE", save),
            Item("MENU", "MODE, TABLE, SCORES, SETTINGS", menu),
        ]

    return ChoicePage("over", "GAME OVER", items, back=menu)


def _sure(desk: Desk, title: str, do: Callable[[], Command]) -> ChoicePage:
    """Ask before a game is given up."""
    items = [
        Item("NO", "GO BACK", desk.back),
        Item("YES", "THIS GAME IS LOST THEN", do),
    ]
    return ChoicePage("sure", title, lambda: items, quiet=False)
