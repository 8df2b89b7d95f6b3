"""The choice pages: main menu, table, board, what to watch, settings, pause, and game over."""

from __future__ import annotations

from collections.abc import Callable

from silverball.app.demo_players import DEMO_PLAYERS
from silverball.app.menus.choice import ChoicePage, Item, Value
from silverball.app.menus.commands import (
    Change,
    Command,
    EndGame,
    Play,
    Quit,
    Restart,
    Resume,
    SaveReplay,
    ShowBoard,
    ShowTableProblem,
    WatchDemo,
    WatchLast,
    WatchScore,
)
from silverball.app.menus.context import MenuContext, TableEntry
from silverball.app.menus.entry import LettersPage
from silverball.app.menus.high_scores import ScoresPage
from silverball.app.menus.remap import remap_page

SEED_DIGITS = 9
BROKEN = "!"  # before the name of a table that cannot be played
MAX_PROBLEM_LENGTH = 120  # letters of a problem that scroll by; choosing the table tells all of it

MODE = Value(
    "mode",
    ("arcade", "free"),
    ("ARCADE", "FREE PLAY"),
    hints=("3 BALLS, TILT, HIGH SCORES", "AS MANY BALLS AS YOU LIKE"),
)


def main_page(context: MenuContext) -> ChoicePage:
    """The main menu."""

    def play() -> Command:
        context.close()
        return Play(
            context.mode(), context.settings.table, context.seed if context.table().is_random else None
        )

    def items() -> list[Item]:
        title = _title(context.table())
        return [
            Item("PLAY", f"{MODE.shown[MODE.place(context)]} · {title}", play),
            Item("MODE", MODE.hints[MODE.place(context)], value=MODE),
            Item("TABLE", f"IS {title}", lambda: context.open(table_page(context))),
            Item("WATCH", "GAMES PLAYED BY YOU OR BY ME", lambda: context.open(watch_page(context))),
            Item("SCORES", "THE BEST OF EVERY TABLE", lambda: context.open(ScoresPage())),
            Item("SETTINGS", "COLOURS, SOUND, KEYS", lambda: context.open(settings_page(context))),
            Item("QUIT", "GOOD BYE", Quit),
        ]

    def leave() -> Command | None:
        # Who goes back once too often must not lose the program: the second time is meant.
        last = len(items()) - 1
        if page.index == last:
            return Quit()
        page.index = last
        return None

    page = ChoicePage("main", "SILVERBALL", items, back=leave)
    return page


def table_page(context: MenuContext) -> ChoicePage:
    """All tables, and the board of the random ones."""

    def take(entry: TableEntry) -> Change:
        context.back()
        return context.change(table=entry.name)

    def table_item(entry: TableEntry) -> Item:
        if entry.problem:
            hint = f"CANNOT BE PLAYED: {entry.problem[:MAX_PROBLEM_LENGTH].upper()}"
            tell = ShowTableProblem(entry.name, entry.problem)
            return Item(_title(entry), hint, lambda: tell, key=entry.name, does="SAY MORE")
        hint = "THIS ONE IS CHOSEN" if entry.name == context.settings.table else entry.about.upper()
        return Item(_title(entry), hint, lambda: take(entry), key=entry.name)

    def items() -> list[Item]:
        listed = [table_item(entry) for entry in context.tables]
        if any(entry.is_random for entry in context.tables):
            seed = Item(
                "BOARD SEED", _seed_text(context), lambda: context.open(seed_page(context)), key="seed"
            )
            listed.append(seed)
        return [*listed, _back_item(context)._replace(key="back")]

    names = [entry.name for entry in context.tables]
    start = names.index(context.settings.table) if context.settings.table in names else 0
    return ChoicePage("table", "TABLE", items, start)


def seed_page(context: MenuContext) -> ChoicePage:
    """Which board a random table makes."""

    def take(seed: int | None) -> Command | None:
        context.seed = seed
        context.back()
        return ShowBoard(seed) if context.table().is_random else None

    def enter() -> None:
        context.open(LettersPage("seed", "BOARD SEED", "0123456789", SEED_DIGITS, entered, least=1))

    def entered(text: str) -> Command | None:
        context.back()
        return take(int(text))

    def items() -> list[Item]:
        listed = [Item("NEW", "ANOTHER BOARD EVERY GAME", lambda: take(None))]
        if context.last_seed is not None:
            seed = context.last_seed
            listed.append(Item("THE SAME", f"SEED {seed} AGAIN", lambda: take(seed)))
        return [*listed, Item("NUMBER", "ENTER A SEED BY DIGITS", enter), _back_item(context)]

    return ChoicePage("board", lambda: f"BOARD: {_seed_text(context)}", items)


def watch_page(context: MenuContext) -> ChoicePage:
    """Which game to watch."""

    def last() -> Command:
        context.leave()
        return WatchLast()

    def machine(player: str) -> Command:
        context.leave()
        return WatchDemo(player)

    def items() -> list[Item]:
        listed = []
        if context.has_last_game:
            listed.append(Item("LAST GAME", "AS YOU PLAYED IT", last))
        if any(row.key for _, _, rows in context.boards() for row in rows):
            listed.append(
                Item("HIGH SCORES", "HOW THEY WERE MADE", lambda: context.open(champions_page(context)))
            )
        for player, label, hint, *_ in DEMO_PLAYERS:
            place = f"{hint} ON {context.table().title.upper()}"
            listed.append(Item(label, place, lambda player=player: machine(player)))  # type: ignore[misc]
        return [*listed, _back_item(context)]

    return ChoicePage("watch", "WATCH", items)


def champions_page(context: MenuContext) -> ChoicePage:
    """The games of the high scores."""

    def watch(key: str) -> Command:
        context.leave()
        return WatchScore(key)

    def items() -> list[Item]:
        listed = [
            Item(
                f"{place} {row.initials} {row.score:,}",
                f"{entry.title.upper()} · {MODE.shown[MODE.choices.index(mode)]}",
                lambda key=row.key: watch(key),  # type: ignore[misc]  # the key of this row, not of the last one
            )
            for entry, mode, rows in context.boards()
            for place, row in enumerate(rows, 1)
            if row.key
        ]
        return [*listed, _back_item(context)]

    return ChoicePage("champions", "WATCH A HIGH SCORE", items)


def settings_page(context: MenuContext) -> ChoicePage:
    """What can be set."""
    themes = tuple(context.themes)
    values = [
        ("COLOURS", Value("theme", themes, tuple(theme.upper().replace("_", " ") for theme in themes))),
        ("VOLUME", Value("volume", tuple(range(11)), tuple(str(step) for step in range(11)), wraps=False)),
        ("SOUND", Value("muted", (False, True), ("ON", "OFF"))),
        (
            "EFFECTS",
            Value(
                "effects", ("full", "less"), ("FULL", "LESS"), hints=("SPARKS AND TRAILS", "CALMER, FASTER")
            ),
        ),
        (
            "PICTURES/S",
            Value(
                "frame_rate",
                ("screen", "60", "120", "144"),
                ("AS SCREEN", "60", "120", "144"),
                hints=("AS MANY AS IT SHOWS", "", "", ""),
            ),
        ),
        (
            "FULL SCREEN",
            Value("full_screen", (False, True), ("OFF", "ON")),
        ),
    ]

    def items() -> list[Item]:
        return [
            *(Item(label, value=value) for label, value in values),
            Item("KEYS", "CHOOSE OTHER KEYS", lambda: context.open(remap_page(context, "keys"))),
            Item("GAMEPAD", "CHOOSE OTHER BUTTONS", lambda: context.open(remap_page(context, "pad"))),
            _back_item(context),
        ]

    return ChoicePage("settings", "SETTINGS", items)


def _title(entry: TableEntry) -> str:
    """A table as the display names it."""
    title = entry.title.upper()
    return f"{BROKEN} {title}" if entry.problem else title


def _back_item(context: MenuContext) -> Item:
    return Item("BACK", "ALSO: HOLD BOTH PADDLES", context.back)


def _seed_text(context: MenuContext) -> str:
    return "NEW EVERY GAME" if context.seed is None else str(context.seed)


def pause_page(context: MenuContext) -> ChoicePage:
    """The game is paused."""

    def resume() -> Command:
        context.close()
        return Resume()

    def restart() -> Command:
        context.close()
        return Restart()

    def end() -> Command:
        context.close()
        context.open(main_page(context))
        return EndGame()

    def items() -> list[Item]:
        return [
            Item("GO ON", "THE GAME IS PAUSED", resume),
            Item(
                "RESTART",
                "THE SAME BOARD FROM THE START",
                lambda: context.open(_sure(context, "RESTART?", restart)),
            ),
            Item("SETTINGS", "COLOURS, SOUND, KEYS", lambda: context.open(settings_page(context))),
            Item("END GAME", "TO THE MAIN MENU", lambda: context.open(_sure(context, "END GAME?", end))),
        ]

    return ChoicePage("pause", "PAUSE", items, back=resume, quiet=False)


def over_page(context: MenuContext, score: int) -> ChoicePage:
    """The game is over."""
    saved = False

    def again() -> Command:
        context.close()
        return Play(
            context.mode(), context.settings.table, context.seed if context.table().is_random else None
        )

    def watch() -> Command:
        context.leave()
        return WatchLast()

    def save() -> Command:
        nonlocal saved
        saved = True
        return SaveReplay()

    def menu() -> Command:
        context.close()
        context.open(main_page(context))
        return EndGame()

    def items() -> list[Item]:
        return [
            Item("PLAY AGAIN", f"SCORE {score:,}", again),
            Item("WATCH IT", "THE GAME FROM THE START", watch),
            Item("SAVE REPLAY", "SAVED" if saved else "KEEP IT AS A FILE", save),
            Item("MENU", "MODE, TABLE, SCORES, SETTINGS", menu),
        ]

    return ChoicePage("over", "GAME OVER", items, back=menu)


def _sure(context: MenuContext, title: str, do: Callable[[], Command]) -> ChoicePage:
    """Ask before a game is given up."""
    items = [
        Item("NO", "GO BACK", context.back),
        Item("YES", "THIS GAME IS LOST THEN", do),
    ]
    return ChoicePage("sure", title, lambda: items, quiet=False)
