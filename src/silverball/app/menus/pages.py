"""The choice pages: main menu, table, board, what to watch, settings, and pause."""

from __future__ import annotations

from collections.abc import Callable

from silverball.app.cabinet_mode import CabinetMode
from silverball.app.demo_players import demo_players
from silverball.app.menus.challenges import challenges_page
from silverball.app.menus.choice import ChoicePage, Item, Value
from silverball.app.menus.commands import (
    Command,
    EndGame,
    Play,
    Quit,
    Restart,
    Resume,
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
INVALID_PREFIX = "!"  # before the name of a table that cannot be played
MAX_PROBLEM_LENGTH = 120  # letters of a problem in the list; choosing the table shows all of it

MODE = Value(
    "mode",
    ("arcade", "free"),
    ("ARCADE", "FREE PLAY"),
    hints=("3 BALLS, TILT, HIGH SCORES", "AS MANY BALLS AS YOU LIKE"),
)


def play(context: MenuContext) -> Play:
    """Close the menu and begin a game by the settings."""
    context.close()
    seed = context.seed if context.table.is_random else None
    return Play(context.mode, context.settings.current.table, seed)


def main_page(context: MenuContext) -> ChoicePage:
    """The main menu."""

    def items() -> list[Item]:
        title = _title(context.table)
        return [
            Item("PLAY", f"{MODE.labels[MODE.current_index(context)]} · {title}", lambda: play(context)),
            Item("MODE", MODE.hints[MODE.current_index(context)], value=MODE),
            Item("TABLE", f"IS {title}", lambda: context.open(table_page(context))),
            Item("WATCH", "YOUR GAMES, OR A DEMO", lambda: context.open(watch_page(context))),
            Item("SCORES", "THE BEST OF EVERY TABLE", lambda: context.open(ScoresPage())),
            Item(
                "CHALLENGES",
                "TODAY'S BOARD, RIVALS, 2 TO 4 PLAYERS",
                lambda: context.open(challenges_page(context, context.challenges())),
            ),
            Item("SETTINGS", "COLOURS, SOUND, KEYS", lambda: context.open(settings_page(context))),
            Item("QUIT", "GOOD BYE", Quit),
        ]

    def leave() -> Command | None:
        # The first "back" only selects QUIT, so that one press too many does not end the program.
        last = len(items()) - 1
        if page.index == last:
            return Quit()
        page.index = last
        return None

    page = ChoicePage("main", "SILVERBALL", items, back=leave)
    return page


def table_page(context: MenuContext) -> ChoicePage:
    """All tables, and the seed of random boards."""

    def choose(entry: TableEntry) -> None:
        context.back()
        context.settings.change(table=entry.name)

    def table_item(entry: TableEntry) -> Item:
        if entry.problem:
            hint = f"CANNOT BE PLAYED: {entry.problem[:MAX_PROBLEM_LENGTH].upper()}"
            show_problem = ShowTableProblem(entry.name, entry.problem)
            return Item(_title(entry), hint, lambda: show_problem, key=entry.name, verb="DETAILS")
        hint = "CURRENT TABLE" if entry.name == context.settings.current.table else entry.description.upper()
        return Item(_title(entry), hint, lambda: choose(entry), key=entry.name)

    def items() -> list[Item]:
        all_items = [table_item(entry) for entry in context.tables]
        if any(entry.is_random for entry in context.tables):
            seed = Item(
                "BOARD SEED", _seed_text(context), lambda: context.open(seed_page(context)), key="seed"
            )
            all_items.append(seed)
        return [*all_items, _back_item(context)._replace(key="back")]

    names = [entry.name for entry in context.tables]
    start = names.index(context.settings.current.table) if context.settings.current.table in names else 0
    return ChoicePage("table", "TABLE", items, start)


def seed_page(context: MenuContext) -> ChoicePage:
    """The seed of random boards."""

    def choose(seed: int | None) -> Command | None:
        context.seed = seed
        context.back()
        return ShowBoard(seed) if context.table.is_random else None

    def enter() -> None:
        context.open(LettersPage("seed", "BOARD SEED", "0123456789", SEED_DIGITS, entered, min_length=1))

    def entered(text: str) -> Command | None:
        context.back()
        return choose(int(text))

    def items() -> list[Item]:
        all_items = [Item("NEW", "ANOTHER BOARD EVERY GAME", lambda: choose(None))]
        if context.last_seed is not None:
            seed = context.last_seed
            all_items.append(Item("THE SAME", f"SEED {seed} AGAIN", lambda: choose(seed)))
        return [*all_items, Item("NUMBER", "ENTER A SEED", enter), _back_item(context)]

    return ChoicePage("board", lambda: f"BOARD: {_seed_text(context)}", items)


def watch_page(context: MenuContext) -> ChoicePage:
    """The games to watch."""

    def last() -> Command:
        context.suspend()
        return WatchLast()

    def watch_demo(player: str) -> Command:
        context.suspend()
        return WatchDemo(player)

    def items() -> list[Item]:
        all_items = []
        if context.has_last_game:
            all_items.append(Item("LAST GAME", "AS YOU PLAYED IT", last))
        if any(row.key for _, _, rows in context.score_lists for row in rows):
            all_items.append(
                Item("HIGH SCORES", "HOW THEY WERE MADE", lambda: context.open(high_scores_page(context)))
            )
        for player, label, hint, *_ in demo_players():
            text = f"{hint} ON {context.table.title.upper()}"
            all_items.append(Item(label, text, lambda player=player: watch_demo(player)))  # type: ignore[misc]
        return [*all_items, _back_item(context)]

    return ChoicePage("watch", "WATCH", items)


def high_scores_page(context: MenuContext) -> ChoicePage:
    """The games of the high scores."""

    def watch(key: str) -> Command:
        context.suspend()
        return WatchScore(key)

    def items() -> list[Item]:
        all_items = [
            Item(
                f"{place} {row.initials} {row.score:,}",
                f"{entry.title.upper()} · {MODE.labels[MODE.choices.index(mode)]}",
                lambda key=row.key: watch(key),  # type: ignore[misc]  # bind the key of this row
            )
            for entry, mode, rows in context.score_lists
            for place, row in enumerate(rows, 1)
            if row.key
        ]
        return [*all_items, _back_item(context)]

    return ChoicePage("high_scores", "WATCH A HIGH SCORE", items)


def settings_page(context: MenuContext) -> ChoicePage:
    """The settings."""
    themes = tuple(context.themes)
    values = [
        ("COLOURS", Value("theme", themes, tuple(theme.upper().replace("_", " ") for theme in themes))),
        ("VOLUME", Value("volume", tuple(range(11)), tuple(str(step) for step in range(11)), wraps=False)),
        (
            "MUSIC",
            Value("music", tuple(range(11)), ("OFF", *(str(step) for step in range(1, 11))), wraps=False),
        ),
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
        ("FULL SCREEN", Value("full_screen", (False, True), ("OFF", "ON"))),
        (
            "CABINET",
            Value(
                "cabinet",
                tuple(CabinetMode),
                ("OFF", "UPRIGHT", "TURNED LEFT", "TURNED RIGHT"),
                hints=("", *3 * ("BACKGLASS ON A SECOND SCREEN",)),
            ),
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
    """Return the displayed name of a table."""
    title = entry.title.upper()
    return f"{INVALID_PREFIX} {title}" if entry.problem else title


def _back_item(context: MenuContext) -> Item:
    return Item("BACK", "ALSO: HOLD BOTH PADDLES", context.back)


def _seed_text(context: MenuContext) -> str:
    return "NEW EVERY GAME" if context.seed is None else str(context.seed)


def pause_page(context: MenuContext) -> ChoicePage:
    """The pause menu."""

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
            Item("RESUME", "THE GAME IS PAUSED", resume),
            Item(
                "RESTART",
                "THE SAME BOARD FROM THE START",
                lambda: context.open(_confirm_page(context, "RESTART?", restart)),
            ),
            Item("SETTINGS", "COLOURS, SOUND, KEYS", lambda: context.open(settings_page(context))),
            Item(
                "END GAME", "TO THE MAIN MENU", lambda: context.open(_confirm_page(context, "END GAME?", end))
            ),
        ]

    return ChoicePage("pause", "PAUSE", items, back=resume, allows_attract=False)


def _confirm_page(context: MenuContext, title: str, do: Callable[[], Command]) -> ChoicePage:
    """Ask for confirmation before a game is abandoned."""
    items = [
        Item("NO", "GO BACK", context.back),
        Item("YES", "THIS GAME WILL BE LOST", do),
    ]
    return ChoicePage("sure", title, lambda: items, allows_attract=False)
