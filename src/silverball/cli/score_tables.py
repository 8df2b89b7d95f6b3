"""Score lists as text and as JSON: places, players, missions, medals and days."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import typer

from silverball.game.scores.daily import day_of
from silverball.game.scores.medals import medal_of, next_medal
from silverball.game.view import Mode
from silverball.plain import plain

if TYPE_CHECKING:
    from silverball.game.scores.store import Score, ScoreList, Store
    from silverball.table import Table

NAME_LENGTH = 60  # printed characters of a name
NOTES = "notes"
RIGHT = ("place", "score", "seed", "ID")  # columns whose texts end at the right


class ShownList:
    """A score list with what can be said about its scores.

    Args:
        store: The store.
        one: The list.

    Attributes:
        heading: Its list.
        rank: The missions that all its games have finished.
    """

    def __init__(self, store: Store, one: ScoreList) -> None:
        from silverball.game.scores.verify_score import table_of_list

        self.heading = one
        self.rank = store.rank(one.mode, one.table_digest)
        self._table: Table | None = table_of_list(one.table_digest, store.table_text(one.id))
        best = store.scores(list_id=one.id, limit=1)
        self._best = best[0].score if best and not best[0].is_rejected else 0

    def medal(self, points: int) -> str:
        """Return the medal that points take in this list; empty if there is none."""
        if self._table is None or self.heading.mode != Mode.ARCADE:
            return ""
        return medal_of(self._table, points) or ""

    @property
    def standing(self) -> str:
        """The rank, the best medal and what the next one takes, as a line; empty if there are none."""
        words = []
        if self.rank:
            words.append(f"rank {self.rank}: so many missions are finished")
        best = self.medal(self._best)
        if best:
            words.append(f"medal: {best}")
        goal = None if self._table is None else next_medal(self._table, self._best)
        if goal is not None and self.heading.mode == Mode.ARCADE:
            words.append(f"{goal[0]} at {goal[1]:,}")
        return ", ".join(words)

    def as_object(self, place: int, score: Score) -> dict[str, Any]:
        """Return a score for JSON."""
        day = day_of(score.seed)
        values = score._asdict() | {
            "when": score.when.isoformat(),
            "day": None if day is None else day.isoformat(),
            "medal": self.medal(score.score) or None,
            "table_rank": self.rank,
        }
        del values["damage"]  # `why` contains it
        return {"place": place} | values

    def print(self, rows: list[tuple[int, Score]], *, is_one_of_several: bool, is_verified: bool) -> None:
        """Print the scores with their places.

        Args:
            rows: Places and scores.
            is_one_of_several: Whether the digest of the table must tell lists of one name apart.
            is_verified: Whether the scores were verified just now.
        """
        from rich import box
        from rich.console import Console
        from rich.table import Table as Grid
        from rich.text import Text

        title = Text(self._title(is_one_of_several))
        if self.standing:
            title.append(f"\n{self.standing}", style="not italic dim")
        grid = Grid(title=title, title_justify="left", box=box.SIMPLE_HEAD)
        columns = self._columns(rows, is_verified)
        for head in columns:
            grid.add_column(head, justify="right" if head in RIGHT else "left", no_wrap=head == "score")
        for cells, (_, score) in zip(zip(*columns.values(), strict=True), rows, strict=True):
            grid.add_row(*map(Text, cells), style="red" if score.is_rejected else None)
        Console().print(grid)

    def _title(self, is_one_of_several: bool) -> str:
        from silverball.game.scores.verify_score import is_built_in

        one = self.heading
        words = [short_name(one.table_name), short_name(one.mode)]
        words += ["built-in"] * is_built_in(one.table_digest)
        words += [f"version {short_name(one.table_digest[:8])}"] * is_one_of_several
        return " · ".join(words)

    def _columns(self, rows: list[tuple[int, Score]], is_verified: bool) -> dict[str, list[str]]:
        """The columns by their heads, without notes if there are none."""
        scores = [score for _, score in rows]
        notes = [self._notes(score) for score in scores]
        return {
            "place": [str(place) for place, _ in rows],
            "score": [f"{score.score:,}" for score in scores],
            "by": [short_name(score.initials) for score in scores],
            "seed": [str(score.seed) for score in scores],
            "when": [score.played("%Y-%m-%d %H:%M") for score in scores],
            "proof": [proof_words(score, is_verified) for score in scores],
            "ID": [str(score.id) for score in scores],
            **({NOTES: notes} if any(notes) else {}),
        }

    def _notes(self, score: Score) -> str:
        """The medal of a score, the missions finished in its game, and what kind of game it was."""
        day = day_of(score.seed)
        words = [self.medal(score.score)]
        words += [f"{score.rank:,} mission{'s' * (score.rank > 1)}"] * (score.rank > 0)
        words += [f"player {score.player} of a match"] * (score.player > 1)
        words += ["" if day is None else f"daily board of {day.isoformat()}"]
        return ", ".join(filter(None, words))


def proof_words(score: Score, is_verified: bool) -> str:
    """The state of the proof in words; that of an earlier verification is in the past tense."""
    if score.verified is None:
        return "not verified" if score.has_replay else "no replay"
    words = "proven" if score.verified else "not proven"
    return words if is_verified or score.damage else f"was {words}"


def short_name(text: str) -> str:
    """Text from a file or the command line, escaped and shortened to be printed on one line."""
    return plain(text if len(text) <= NAME_LENGTH else f"{text[:NAME_LENGTH]}…")


def print_rest(count: int) -> None:
    """Print how many scores of a list are not shown."""
    typer.echo(f"  and {count} more (see --limit)")
