"""Is a score proven? Its replay, played back, must be that game, on the table of its list, and reach it.

*Proven* means: there are inputs that reach this score with this seed on this table, and no other score that
was proven before it is of the same game. Everything else is *not proven*, with the reason in words:

* the record is damaged, or the replay is missing, cut off, changed, or of a version that is not this one;
* the table is not at hand: its text is not kept with the list, or is not the one of the list's digest. Of a
  recipe the board is made anew, with the seed of the score;
* the list bears the name of a built-in table and is of another one;
* the mode, the seed, the board or the tick rate is another than that of the score in a window;
* the game was not over, or ended by a fault;
* the game has been counted before, be it further or not as far, under other initials, or in another list.

What it cannot show is who or what pressed the buttons, how fast the clock ran meanwhile, and when that was.
"""

from __future__ import annotations

import tomllib
import unicodedata
from array import array
from functools import cache, lru_cache
from typing import TYPE_CHECKING, NamedTuple

from silverball.errors import SilverballError
from silverball.plain import plain
from silverball.table import Table, generate_table, load_table, table_digest, table_names
from silverball.table.file import SIZE_LIMIT

if TYPE_CHECKING:
    from silverball.game.core import GameCore
    from silverball.game.replay.format import Replay
    from silverball.game.scores.store import Score

ENDED = ("over", "stopped")  # the player may stop: to play on would only have brought more points
CONTACTS = ("hit", "ball_hit")
SHOWN = 80  # characters of a name in a reason


class Proof(NamedTuple):
    """What came of trying to prove a score, as `Store.mark` takes it.

    Attributes:
        verified: Whether it is proven.
        why: Why it is not; else empty.
    """

    verified: bool
    why: str = ""


class Counted:
    """Which games have been counted; the same one is not counted twice.

    A game is known by its board, its seed, and all contacts of its balls, each with the time since a ball
    came: so neither a pause before a ball nor a press that moves nothing makes another game of it.
    """

    def __init__(self) -> None:
        self._games: dict[tuple[str, int, str], list[tuple[int, array[int]]]] = {}

    def before(self, id: int, replay: Replay, contacts: array[int]) -> int | None:
        """The number of the score under which a game was counted before; if it was not, it is counted now."""
        games = self._games.setdefault((table_digest(replay.table), replay.seed, str(replay.mode)), [])
        for other, known in games:
            length = min(len(contacts), len(known))
            if contacts[:length] == known[:length] and (length or contacts == known):
                return other
        games.append((id, contacts))
        return None


def prove(score: Score, text: str | None, table_text: str = "", counted: Counted | None = None) -> Proof:
    """Try to prove a score.

    Args:
        score: What is claimed.
        text: Its replay; None if it is not kept.
        table_text: The table of its list as a table file; empty: not kept, so that only a built-in table is
            at hand.
        counted: The games that have been counted; this one is added if it proves the score.
    """
    try:
        _prove(score, text, table_text, Counted() if counted is None else counted)
    except SilverballError as error:  # of the replay, of the recipe, of the game
        return Proof(False, " ".join(plain(str(error), keep="\n").split()))
    return Proof(True)


class _NotProven(SilverballError):
    """A score is not proven; the message says why."""


def _prove(score: Score, text: str | None, table_text: str, counted: Counted) -> None:
    from silverball.game.replay.format import Replay
    from silverball.game.replay.verify import verify

    if score.damage:
        raise _NotProven(score.damage)
    if not text:
        raise _NotProven("its replay is not kept")
    replay = Replay.from_text(text, "its replay")
    _see_that_it_is_the_game(score, replay)
    _see_that_it_is_the_table(score, replay, table_text)
    contacts = _Contacts()
    verdict = verify(replay, on_second=contacts.look)
    if not verdict.ok:
        raise _NotProven(f"its replay goes another way: {verdict.message}")
    if verdict.score != score.score:
        raise _NotProven(f"its replay reaches {verdict.score:,}")
    other = counted.before(score.id, replay, contacts.digests)
    if other is not None:
        raise _NotProven(f"it is the same game as score {other}, which is counted")


def _see_that_it_is_the_game(score: Score, replay: Replay) -> None:
    """Refuse the replay of another game than a window would have kept under this score."""
    from silverball.game.core import TICK_RATE

    if replay.rules:
        raise _NotProven(f"its replay is of a game with rules of its own, {_shown(replay.rules)}")
    pairs = (
        ("mode", score.mode, str(replay.mode)),
        ("seed", score.seed, replay.seed),
        ("tick rate", TICK_RATE, replay.tick_rate),
    )
    for what, claimed, found in pairs:
        if claimed != found:
            expected = plain(str(claimed)[:SHOWN])
            raise _NotProven(f"its replay is of another game: the {what} is {found}, not {expected}")
    if replay.ended not in ENDED:
        raise _NotProven(f"its replay is of a game that was not over: {replay.ended}")


def _see_that_it_is_the_table(score: Score, replay: Replay, table_text: str) -> None:
    """Refuse a table that is not at hand, or bears another's name, and the replay of another board."""
    table = _kept(table_text) if table_text else _built_in(score.table_digest)
    if table is None:
        raise _NotProven(
            "its table is not at hand: it was not kept with the list, as it is now with every new score"
        )
    if table_digest(table) != score.table_digest:
        raise _NotProven("the table that is kept with the list is not the one that its digest names")
    key = _built_in_keys().get(score.table_digest)
    if _read_as(score.table_name) not in {_read_as(table.name), key}:
        names = f"{_shown(score.table_name)}, the table that is kept with it {_shown(table.name)}"
        raise _NotProven(f"its list is called {names}")
    if _read_as(table.name) in _built_in_names() and key is None:
        raise _NotProven(
            f"its table is called {_shown(table.name)}, but is not the built-in table of this name"
        )
    board = table if table.random is None else generate_table(score.seed, table)
    if table_digest(board) != table_digest(replay.table):
        found, wanted = _shown(replay.table.name), _shown(board.name)
        other = f"not {wanted}" if found != wanted else "but another one of this name"
        raise _NotProven(f"its replay is of another game: the table is {found}, {other}")


def is_built_in(digest: str) -> bool:
    """Whether a digest is that of a built-in table."""
    return digest in _built_in_keys()


def _read_as(name: str) -> str:
    """A name as an eye reads it: without capitals, accents, spaces, marks and what cannot be seen."""
    letters = unicodedata.normalize("NFKD", name.casefold())
    return "".join(letter for letter in letters if letter.isalnum()) or name


@cache
def _built_in_names() -> frozenset[str]:
    return frozenset(_read_as(name) for key in table_names() for name in (key, load_table(key).name))


def _built_in(digest: str) -> Table | None:
    """The built-in table of a digest."""
    key = _built_in_keys().get(digest)
    return None if key is None else load_table(key)


@cache
def _built_in_keys() -> dict[str, str]:
    """The names by which built-in tables are loaded, by the digests of the tables."""
    return {table_digest(load_table(key)): key for key in table_names()}


@lru_cache(maxsize=16)
def _kept(text: str) -> Table:
    """The table whose text is kept with a list.

    Raises:
        _NotProven: The text is no table, or needs another file.
    """
    from silverball.game.replay.reader import has_mesh

    why = "the table that is kept with the list cannot be read"
    if len(text) > SIZE_LIMIT:
        raise _NotProven(why)
    try:
        table = Table.model_validate(tomllib.loads(text))
    except (ValueError, TypeError, RecursionError):
        raise _NotProven(why) from None
    if has_mesh(table):
        raise _NotProven("the table that is kept with the list needs the file of a mesh")
    return table


class _Contacts:
    """What the balls of a game met, and how long after a ball had come to the board.

    Attributes:
        digests: Of every contact, in 64 bits; they are equal within a run of the program only.
    """

    def __init__(self) -> None:
        self.digests = array("q")
        self._since = 0  # the tick in which the last ball came

    def look(self, game: GameCore) -> None:
        """The game has gone on."""
        for event in game.take_world_events():
            if event.kind == "created":
                self._since = event.tick
            elif event.kind in CONTACTS:
                self.digests.append(hash((event.tick - self._since, event.kind, event.part)))


def _shown(name: str) -> str:
    return f"'{plain(name if len(name) <= SHOWN else name[:SHOWN] + '…')}'"
