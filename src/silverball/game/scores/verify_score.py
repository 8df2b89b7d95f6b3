"""Verification of scores: a score is proven if its replay, played again, reaches it.

*Proven* means: there are inputs that reach this score with this seed on this table, and no other score that
was proven before is of the same game. Every other score is *not proven*, with a reason:

* the record is damaged, or the replay is missing, cut off, changed, or of another version;
* the table is not available: its text is not kept with the list, or does not have the digest of the list. The
  board of a recipe is made again from the seed of the score;
* the list has the name of a built-in table but is of another table;
* the mode, seed, board or tick rate is not that of a score in a window, or the game has custom rules;
* its rank, the missions finished in the game, or its place in a match is another one;
* the game was not over, or ended by a fault;
* the game was counted before, played further or less far, under other initials, or in another list. A match
  counts once for each of its players.

Verification cannot show who or what pressed the buttons, how fast the clock ran, or when the game was played.
"""

from __future__ import annotations

import tomllib
import unicodedata
from array import array
from functools import cache, lru_cache
from typing import TYPE_CHECKING, NamedTuple

from silverball.errors import SilverballError
from silverball.game.mechanisms import SCORING
from silverball.plain import plain
from silverball.table import Table, generate_table, load_table, table_digest, table_names
from silverball.table.file import SIZE_LIMIT

if TYPE_CHECKING:
    from silverball.game.core import GameCore
    from silverball.game.replay.format import Replay
    from silverball.game.scores.score_records import Score

COMPLETE = ("over", "stopped")  # a player may stop: playing on could only have brought more points
CONTACTS = SCORING | {"ball_hit"}
NAME_LIMIT = 80  # characters of a name that are shown in a reason


class ScoreVerdict(NamedTuple):
    """The result of verifying a score, as `Store.save_verdicts` takes it.

    Attributes:
        verified: Whether the score is proven.
        why: The reason why it is not; otherwise empty.
    """

    verified: bool
    why: str = ""


class CountedGames:
    """The games that have been counted; the same game is not counted twice.

    A game is identified by its board, its seed and all contacts of its balls, each with the time since the
    last ball was created: neither a pause before a ball nor a press that moves nothing makes another game.
    """

    def __init__(self) -> None:
        self._games: dict[tuple[str, int, str], list[tuple[int, int, array[int]]]] = {}

    def duplicate_of(self, id: int, replay: Replay, contacts: array[int], player: int = 1) -> int | None:
        """The number of the score with the same game, or None; in that case the game is counted.

        Args:
            id: The number of the score.
            replay: Its replay.
            contacts: The contacts of its balls.
            player: Which player of a match has the score, from 1.
        """
        games = self._games.setdefault((table_digest(replay.table), replay.seed, str(replay.mode)), [])
        for other, its_player, known in games:
            length = min(len(contacts), len(known))
            if replay.players > 1 and player != its_player and contacts == known:
                continue  # another player of the same match
            if contacts[:length] == known[:length] and (length or contacts == known):
                return other
        games.append((id, player, contacts))
        return None


def verify_score(
    score: Score, text: str | None, table_text: str = "", counted: CountedGames | None = None
) -> ScoreVerdict:
    """Verify a score.

    Args:
        score: The score that is claimed.
        text: Its replay; None if it is missing.
        table_text: The table of its list as a table file; empty: only built-in tables are available.
        counted: The games that have been counted; the game of a proven score is added.

    Returns:
        The verdict; no error is raised for a score that cannot be proven.
    """
    try:
        _verify(score, text, table_text, CountedGames() if counted is None else counted)
    except SilverballError as error:  # raised by the replay, the recipe or the game
        return ScoreVerdict(False, " ".join(plain(str(error), keep="\n").split()))
    return ScoreVerdict(True)


class _NotProven(SilverballError):
    """A score is not proven; the message says why."""


def _verify(score: Score, text: str | None, table_text: str, counted: CountedGames) -> None:
    from silverball.game.replay.format import Replay
    from silverball.game.replay.verify import verify

    if score.damage:
        raise _NotProven(score.damage)
    if not text:
        raise _NotProven("its replay is missing")
    replay = Replay.from_text(text, "its replay")
    _check_game(score, replay)
    _check_table(score, replay, table_text)
    contacts = _Contacts()
    verdict = verify(replay, on_second=contacts.collect)
    if not verdict.ok:
        raise _NotProven(f"its replay differs: {verdict.message}")
    points, rank = contacts.scores[score.player - 1], contacts.ranks[score.player - 1]
    if points != score.score:
        raise _NotProven(f"its replay reaches {points:,}")
    if rank != score.rank:
        raise _NotProven(f"its replay finishes {rank} missions, not {score.rank}")
    other = counted.duplicate_of(score.id, replay, contacts.digests, score.player)
    if other is not None:
        raise _NotProven(f"it is the same game as score {other}, which is counted")


def _check_game(score: Score, replay: Replay) -> None:
    """Refuse a replay that does not belong to this score, or not to a complete game in a window."""
    from silverball.game.core import TICK_RATE

    if replay.rules:
        raise _NotProven(f"its replay is of a game with custom rules, {_shown(replay.rules)}")
    pairs = (
        ("mode", score.mode, str(replay.mode)),
        ("seed", score.seed, replay.seed),
        ("tick rate", TICK_RATE, replay.tick_rate),
    )
    for what, claimed, found in pairs:
        if claimed != found:
            expected = plain(str(claimed)[:NAME_LIMIT])
            raise _NotProven(f"its replay is of another game: the {what} is {found}, not {expected}")
    if not 1 <= score.player <= replay.players:
        raise _NotProven(f"its replay has {replay.players} players, the score is of player {score.player}")
    if replay.ended not in COMPLETE:
        raise _NotProven(f"its replay is of a game that was not over: {replay.ended}")


def _check_table(score: Score, replay: Replay, table_text: str) -> None:
    """Refuse a table that is not available or has the name of another, and a replay of another board."""
    table = _parsed_table(table_text) if table_text else _built_in(score.table_digest)
    if table is None:
        raise _NotProven(
            "its table is not available: it was not kept with the list, as it is now with every new score"
        )
    if table_digest(table) != score.table_digest:
        raise _NotProven("the table that is kept with the list is not the one that its digest names")
    key = _built_in_keys().get(score.table_digest)
    if _as_read(score.table_name) not in {_as_read(table.name), key}:
        names = f"{_shown(score.table_name)}, the table that is kept with it {_shown(table.name)}"
        raise _NotProven(f"its list is called {names}")
    if _as_read(table.name) in _built_in_names() and key is None:
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


def _as_read(name: str) -> str:
    """A name as a human reads it: without case, accents, spaces, punctuation and invisible characters."""
    letters = unicodedata.normalize("NFKD", name.casefold())
    return "".join(letter for letter in letters if letter.isalnum()) or name


@cache
def _built_in_names() -> frozenset[str]:
    return frozenset(_as_read(name) for key in table_names() for name in (key, load_table(key).name))


def table_of_list(digest: str, table_text: str) -> Table | None:
    """The table of a list by its digest; None if it was not kept with the list, or another one was."""
    try:
        table = _parsed_table(table_text) if table_text else _built_in(digest)
    except SilverballError:
        return None
    return table if table is not None and table_digest(table) == digest else None


def _built_in(digest: str) -> Table | None:
    """The built-in table with a digest, or None."""
    key = _built_in_keys().get(digest)
    return None if key is None else load_table(key)


@cache
def _built_in_keys() -> dict[str, str]:
    """The names by which built-in tables are loaded, by the digests of the tables."""
    return {table_digest(load_table(key)): key for key in table_names()}


@lru_cache(maxsize=16)
def _parsed_table(text: str) -> Table:
    """The table whose text is kept with a list.

    Raises:
        _NotProven: The text is not a table, or needs another file.
    """
    why = "the table that is kept with the list cannot be read"
    if len(text) > SIZE_LIMIT:
        raise _NotProven(why)
    try:
        table = Table.model_validate(tomllib.loads(text))
    except (ValueError, TypeError, RecursionError):
        raise _NotProven(why) from None
    if table.has_mesh:
        raise _NotProven("the table that is kept with the list needs the file of a mesh")
    return table


class _Contacts:
    """The contacts of the balls of a game, each with the time since the last ball was created.

    Attributes:
        digests: A hash of every contact, 64 bits; comparable within a run of the program only.
        scores: The points of every player.
        ranks: The missions that every player has finished.
    """

    def __init__(self) -> None:
        self.digests = array("q")
        self.scores: tuple[int, ...] = ()
        self.ranks: tuple[int, ...] = ()
        self._created = 0  # the tick in which the last ball was created

    def collect(self, game: GameCore) -> None:
        """Add the contacts since the last call, and note what the game has come to."""
        self.scores, self.ranks = game.scores, game.ranks
        for event in game.take_world_events():
            if event.kind == "created":
                self._created = event.tick
            elif event.kind in CONTACTS:
                self.digests.append(hash((event.tick - self._created, event.kind, event.part)))


def _shown(name: str) -> str:
    return f"'{plain(name if len(name) <= NAME_LIMIT else name[:NAME_LIMIT] + '…')}'"
