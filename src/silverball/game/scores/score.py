"""What is a score, and how is it read from a row that may hold anything?

The file of the scores can be changed by other programs, and SQLite keeps a text where a number should be.
So nothing here trusts a type: what does not fit is replaced by something harmless, and `damage` says what it
was.
"""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any, NamedTuple

WHOLE_NUMBERS = 2**63  # SQLite's are below it, and from minus it on

COLUMNS = (
    "score.id, initials, score, mode, table_name, table_digest, seed, played, verified, why,"
    " replay IS NOT NULL"
)
DOUBTFUL = (
    "(verified IS 0 OR typeof(score) != 'integer' OR typeof(seed) != 'integer'"
    " OR typeof(played) != 'integer' OR typeof(initials) != 'text')"
)
"""In SQL: whether a row stands below all others, for it was tried and not proven, or is damaged."""

_EPOCH = datetime.fromtimestamp(0, UTC)
_TYPES = {int: "a whole number", float: "a broken number", str: "text", bytes: "bytes", type(None): "nothing"}


class Score(NamedTuple):
    """One line of a list.

    Attributes:
        id: Its number, which no other score ever has.
        initials: Of the player.
        score: Points.
        mode: Which game, see `silverball.game.view.Mode`.
        table_name: The name of the table as it was chosen; of a random board that of its recipe.
        table_digest: The digest of that table.
        seed: Of the world and, if the table is a recipe, of the board.
        when: When the game ended, UTC.
        verified: Whether it was proven when somebody tried last, see `proof.py`; None if nobody has. That
        is a note in the file, which others can write too: only trying again proves a score.
        why: Why it was not proven.
        has_replay: Whether its replay is kept.
        damage: What is wrong with its record; empty if nothing is.
    """

    id: int
    initials: str
    score: int
    mode: str
    table_name: str
    table_digest: str
    seed: int
    when: datetime
    verified: bool | None
    why: str
    has_replay: bool
    damage: str = ""

    @property
    def is_doubtful(self) -> bool:
        """Whether it stands below all others: it was tried and not proven, or is damaged."""
        return self.verified is False

    @property
    def order(self) -> tuple[bool, int, int]:
        """The smaller, the better its place; of equal scores the earlier is the better."""
        return self.is_doubtful, -self.score, self.id

    def played(self, form: str) -> str:
        """When it was played, in local time where the calendar reaches so far.

        Args:
            form: As `strftime` takes it.
        """
        try:
            return f"{self.when.astimezone():{form}}"
        except (OverflowError, ValueError, OSError):
            return f"{self.when:{form}}"


class ScoreList(NamedTuple):
    """One list of scores: its mode, its table, how many scores there are, and its number in the file."""

    mode: str
    table_name: str
    table_digest: str
    length: int
    id: int


def score_of(row: tuple[Any, ...]) -> Score:
    """The score of a row of `COLUMNS`."""
    id, initials, score, mode, table_name, table_digest, seed, played, verified, why, has_replay = row
    damage = [
        f"its {name} is {_TYPES[type(value)]}"
        for name, value, kind in (
            ("score", score, int),
            ("seed", seed, int),
            ("date", played, int),
            ("player", initials, str),
            ("mode", mode, str),
            ("table's name", table_name, str),
            ("table's digest", table_digest, str),
        )
        if type(value) is not kind
    ]
    when = _EPOCH
    if type(played) is int:
        try:
            when = datetime.fromtimestamp(played, UTC)
        except (OverflowError, ValueError, OSError):
            damage.append("its date is beyond the calendar")
    mark = None if verified is None or verified not in (0, 1) else bool(verified)
    words = f"its record is damaged: {', '.join(damage)}" if damage else ""
    return Score(
        id,
        text_of(initials),
        score if type(score) is int else 0,
        text_of(mode),
        text_of(table_name),
        text_of(table_digest),
        seed if type(seed) is int else 0,
        when,
        False if words else mark,
        words or text_of(why),
        bool(has_replay),
        words,
    )


def text_of(value: Any) -> str:
    """A value that should be text, as text."""
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    return "" if value is None else str(value)
