"""Which pages does one see from the main menu? Main, mode, table, board, what to watch, and the settings."""

from __future__ import annotations

from silverball.app.demo_players import performers
from silverball.app.menus.choice import ChoicePage, Item, Value
from silverball.app.menus.commands import (
    Change,
    Command,
    Play,
    Quit,
    SeeBoard,
    TellTrouble,
    WatchLast,
    WatchMachine,
    WatchScore,
)
from silverball.app.menus.desk import Desk, TableEntry
from silverball.app.menus.entry import LettersPage
from silverball.app.menus.high_scores import ScoresPage
from silverball.app.menus.remap import remap_page

SEED_DIGITS = 9
BROKEN = "!"  # before the name of a table that cannot be played
SHOWN_OF_TROUBLE = 120  # letters of a problem that scroll by; choosing the table tells all of it

MODE = Value(
    "mode",
    ("arcade", "free"),
    ("ARCADE", "FREE PLAY"),
    hints=("3 BALLS, TILT, HIGH SCORES", "AS MANY BALLS AS YOU LIKE"),
)


def main_page(desk: Desk) -> ChoicePage:
    """The main menu."""

    def play() -> Command:
        desk.close()
        return Play(desk.mode(), desk.settings.table, desk.seed if desk.table().is_random else None)

    def items() -> list[Item]:
        title = _title(desk.table())
        return [
            Item("PLAY", f"{MODE.shown[MODE.place(desk)]} · {title}", play),
            Item("MODE", MODE.hints[MODE.place(desk)], value=MODE),
            Item("TABLE", f"IS {title}", lambda: desk.open(table_page(desk))),
            Item("WATCH", "GAMES PLAYED BY YOU OR BY ME", lambda: desk.open(watch_page(desk))),
            Item("SCORES", "THE BEST OF EVERY TABLE", lambda: desk.open(ScoresPage())),
            Item("SETTINGS", "COLOURS, SOUND, KEYS", lambda: desk.open(settings_page(desk))),
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


def table_page(desk: Desk) -> ChoicePage:
    """All tables, and the board of the random ones."""

    def take(entry: TableEntry) -> Change:
        desk.back()
        return desk.change(table=entry.name)

    def table_item(entry: TableEntry) -> Item:
        if entry.problem:
            hint = f"CANNOT BE PLAYED: {entry.problem[:SHOWN_OF_TROUBLE].upper()}"
            tell = TellTrouble(entry.name, entry.problem)
            return Item(_title(entry), hint, lambda: tell, key=entry.name, does="SAY MORE")
        hint = "THIS ONE IS CHOSEN" if entry.name == desk.settings.table else entry.about.upper()
        return Item(_title(entry), hint, lambda: take(entry), key=entry.name)

    def items() -> list[Item]:
        listed = [table_item(entry) for entry in desk.tables]
        if any(entry.is_random for entry in desk.tables):
            seed = Item("BOARD SEED", _seed_text(desk), lambda: desk.open(seed_page(desk)), key="seed")
            listed.append(seed)
        return [*listed, _back_item(desk)._replace(key="back")]

    names = [entry.name for entry in desk.tables]
    start = names.index(desk.settings.table) if desk.settings.table in names else 0
    return ChoicePage("table", "TABLE", items, start)


def seed_page(desk: Desk) -> ChoicePage:
    """Which board a random table makes."""

    def take(seed: int | None) -> Command | None:
        desk.seed = seed
        desk.back()
        return SeeBoard(seed) if desk.table().is_random else None

    def enter() -> None:
        desk.open(LettersPage("seed", "BOARD SEED", "0123456789", SEED_DIGITS, entered, least=1))

    def entered(text: str) -> Command | None:
        desk.back()
        return take(int(text))

    def items() -> list[Item]:
        listed = [Item("NEW", "ANOTHER BOARD EVERY GAME", lambda: take(None))]
        if desk.last_seed is not None:
            seed = desk.last_seed
            listed.append(Item("THE SAME", f"SEED {seed} AGAIN", lambda: take(seed)))
        return [*listed, Item("NUMBER", "ENTER A SEED BY DIGITS", enter), _back_item(desk)]

    return ChoicePage("board", lambda: f"BOARD: {_seed_text(desk)}", items)


def watch_page(desk: Desk) -> ChoicePage:
    """Which game to watch."""

    def last() -> Command:
        desk.leave()
        return WatchLast()

    def machine(player: str) -> Command:
        desk.leave()
        return WatchMachine(player)

    def items() -> list[Item]:
        listed = []
        if desk.has_last_game:
            listed.append(Item("LAST GAME", "AS YOU PLAYED IT", last))
        if any(row.key for _, _, rows in desk.boards() for row in rows):
            listed.append(Item("HIGH SCORES", "HOW THEY WERE MADE", lambda: desk.open(champions_page(desk))))
        for player, label, hint, *_ in performers():
            place = f"{hint} ON {desk.table().title.upper()}"
            listed.append(Item(label, place, lambda player=player: machine(player)))  # type: ignore[misc]
        return [*listed, _back_item(desk)]

    return ChoicePage("watch", "WATCH", items)


def champions_page(desk: Desk) -> ChoicePage:
    """The games of the high scores."""

    def watch(key: str) -> Command:
        desk.leave()
        return WatchScore(key)

    def items() -> list[Item]:
        listed = [
            Item(
                f"{place} {row.initials} {row.score:,}",
                f"{entry.title.upper()} · {MODE.shown[MODE.choices.index(mode)]}",
                lambda key=row.key: watch(key),  # type: ignore[misc]  # the key of this row, not of the last one
            )
            for entry, mode, rows in desk.boards()
            for place, row in enumerate(rows, 1)
            if row.key
        ]
        return [*listed, _back_item(desk)]

    return ChoicePage("champions", "WATCH A HIGH SCORE", items)


def settings_page(desk: Desk) -> ChoicePage:
    """What can be set."""
    themes = tuple(desk.themes)
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
            Item("KEYS", "CHOOSE OTHER KEYS", lambda: desk.open(remap_page(desk, "keys"))),
            Item("GAMEPAD", "CHOOSE OTHER BUTTONS", lambda: desk.open(remap_page(desk, "pad"))),
            _back_item(desk),
        ]

    return ChoicePage("settings", "SETTINGS", items)


def _title(entry: TableEntry) -> str:
    """A table as the display names it."""
    title = entry.title.upper()
    return f"{BROKEN} {title}" if entry.problem else title


def _back_item(desk: Desk) -> Item:
    return Item("BACK", "ALSO: HOLD BOTH PADDLES", desk.back)


def _seed_text(desk: Desk) -> str:
    return "NEW EVERY GAME" if desk.seed is None else str(desk.seed)
