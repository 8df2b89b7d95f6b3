"""What is kept of the games that were played? Scores with their replays, the last game and the settings.

One SQLite file, `silverball.sqlite3` in the data folder. What a method has written when it returns survives
a killed program and a power failure. Several programs may use the file at once; a `Store` belongs to the
thread that made it. Playing never depends on the file: where it cannot be written, the store goes on in
memory with a copy of what can be read, and `trouble` says so in one sentence. While another program holds the
file, what is to be kept waits in a file beside it (see `waiting`) and comes to the others later.

A **list** is what scores are ranked in: one for each mode and table as it was chosen. All boards of a recipe
share the list of the recipe, since hardly anybody plays the same random board twice and a list of one score
is none; the seed beside each score says which board it was and brings it back. A table that was changed is
another table (its digest tells), so its list begins anew; the old one stays. The text of the table is kept
with its list, so that a score can be proven when the file of the table is gone.

A score that somebody tried to prove in vain stands below all others of its list. One that nobody has tried is
ranked by its points.

Size: a score is never dropped, nor is its replay, for a score without one can never be proven: a minute of
play takes about 3 kB. A write waits for the disk, a few milliseconds: write when a game is over or a menu is
open, not while a ball rolls.
"""

from __future__ import annotations

import json
import sqlite3
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Self, TypeVar

from silverball.errors import SilverballError
from silverball.game.replay.reader import has_own_rules
from silverball.game.scores import database
from silverball.game.scores import rows as records
from silverball.game.scores.database import Database, Held
from silverball.game.scores.pending import NewScore, Waiting, WaitingRoom
from silverball.game.scores.rows import SCHEMA
from silverball.game.scores.score import COLUMNS, DOUBTFUL, WHOLE_NUMBERS, Score, ScoreList, score_of, text_of
from silverball.game.user_folder import data_folder

__all__ = ["FILE", "PLACES", "SCHEMA", "Score", "ScoreList", "Store"]

FILE = "silverball.sqlite3"
PLACES = 10  # of a list that is shown; who comes into it has a high score
REMEMBERED = 64  # answers that are given again while the file cannot even be read
_Result = TypeVar("_Result")

_LOOK = f"SELECT {COLUMNS} FROM score JOIN list ON list.id = score.list WHERE"


class Store:
    """What is kept of the games that were played.

    Args:
        folder: Where the file is or will be; None: the user's data folder.
        at_once: Never wait for another program that holds the file, as in a window, where that would be seen:
            answer with what was read last. Else it is waited for, and reading fails in the end.
    """

    def __init__(self, folder: Path | None = None, *, at_once: bool = False) -> None:
        self._folder = folder or data_folder()
        self._at_once = at_once
        self._database = Database(self._folder / FILE, SCHEMA, at_once=at_once)
        self._room = WaitingRoom(self._folder)
        self._has_taken_in = False  # what other programs have left behind
        self._numbers: dict[str, int] = {}  # of scores that waited, by token, as they were given out
        self._ids: dict[int, int] = {}  # the numbers that they got at last
        self._remembered: dict[Any, list[tuple[Any, ...]]] = {}
        self._has_missed = False  # whether something was asked for that could not be read
        self._trouble = ""
        self._is_closed = False
        self.try_again()

    @property
    def path(self) -> Path:
        """The file."""
        return self._database.path

    @property
    def trouble(self) -> str:
        """What the player should know, one line for each thing that went wrong; empty if nothing did."""
        held = ""
        if not self._database.is_open:
            held = f"{self.path}: another program holds it; what is to be kept waits beside it"
        return "\n".join(filter(None, (self._database.trouble, self._trouble, held)))

    @property
    def keeps(self) -> bool:
        """Whether what is written now will be there after this run."""
        return self._database.keeps and self._room.is_safe

    @property
    def is_held(self) -> bool:
        """Whether something waits because another program holds the file: `try_again` now and then."""
        return not self._has_taken_in or self._has_missed or not self._room.waiting.is_nothing

    @property
    def is_blind(self) -> bool:
        """Whether another program has held the file since the beginning so that it cannot even be read."""
        if self._database.is_open:
            return False
        try:
            self._database.read("SELECT 1 FROM setting LIMIT 1")
        except Held:
            return True
        return False

    @property
    def has_read(self) -> bool:
        """Whether what was kept before could be read."""
        return self._database.has_read and not self.is_blind

    @property
    def is_safe(self) -> bool:
        """Whether all that waits is on the disk, in a file beside that of the scores."""
        return self._room.is_safe

    @property
    def farewell(self) -> str:
        """What to say of what still waits when the program ends; empty if nothing does."""
        if self._room.waiting.is_nothing:
            return ""
        held = f"{self.path}: another program holds it"
        if self._room.is_safe:
            return f"{held}; what was played waits in {self._room.path.name} for the next start"
        return f"{held}, and nothing can be written beside it: what was played last is lost"

    def try_again(self) -> bool:
        """Bring what waits into the file, if no other program holds it any more.

        Returns:
            Whether nothing waits now.
        """
        if not self.is_held:
            return True
        try:
            if not self._has_taken_in:
                self._take_in_what_others_left()
            if not self._room.waiting.is_nothing:
                numbers = self._database.write(
                    lambda connection: records.take_in(connection, self._room.waiting)
                )
                self._ids |= {self._numbers[token]: id for token, id in numbers.items()}
                self._room.clear(keep_file=not self._database.keeps)
            self._database.read("SELECT 1 FROM setting LIMIT 1")
        except Held:
            if not self._room.is_safe:
                self._room.keep()
            return False
        self._has_missed = False
        return True

    def __enter__(self) -> Self:
        """The store itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close it."""
        self.close()

    def close(self) -> None:
        """Close the file.

        What still waits stays in its file for the next start; what could not be written even there is tried
        again for some seconds.
        """
        if self._is_closed:
            return
        self._is_closed = True
        deadline = time.monotonic() + database.BUSY_SECONDS
        while not self.try_again():
            if self._room.is_safe or time.monotonic() > deadline:
                break
            time.sleep(0.05)
        self._database.close()

    # ── scores ──────────────────────────────────────────────────────────────────────────────────────────

    def add_score(
        self,
        initials: str,
        score: int,
        mode: str,
        table_name: str,
        table_digest: str,
        seed: int,
        replay_text: str,
        when: datetime | None = None,
        table_text: str = "",
    ) -> int:
        """Keep a score with its replay; returns when it is safe on the disk.

        Save it under the last initials before asking for new ones, then `rename` it: so it is there
        whatever happens meanwhile.

        Args:
            initials: Of the player.
            score: Points.
            mode: Which game.
            table_name: The name of the table as it was chosen; the list goes by the last one it was given.
            table_digest: Its digest; of a recipe that of the recipe, so that all its boards share a list.
            seed: Of the world and, if the table is a recipe, of the board.
            replay_text: The replay.
            when: When the game ended; None: now.
            table_text: The table as a table file; without it no score on it can be proven, but on built-in
                tables.

        Returns:
            Its number; one beyond 63 bits if it waits because another program holds the file.

        Raises:
            SilverballError: The game was scored by rules of its own, so its score cannot be compared.
        """
        if has_own_rules(replay_text):
            raise SilverballError("a game with rules of its own has no place in the score lists")
        played = int((when or datetime.now(UTC)).timestamp())
        name = table_name.encode("utf-8", "replace").decode("utf-8")  # a path may have bytes that are no text

        one = NewScore.model_construct(
            initials=initials, score=score, mode=str(mode), table_name=name, table_digest=table_digest,
            table_text=table_text, seed=seed, replay=replay_text, played=played,
        )  # fmt: skip
        return self._write(lambda connection: records.add(connection, one), lambda: self._let_wait(one))

    def rename(self, id: int, initials: str) -> None:
        """Put other initials to a score.

        Raises:
            SilverballError: There is no score of that number.
        """
        self.try_again()
        one = self._waiting_score(id)
        if one is not None:
            one.initials = initials
            self._room.keep()
        else:
            statement = "UPDATE score SET initials = ? WHERE id = ?"
            self._change(id, statement, (initials,), lambda: self._let_wait_for(id, initials))

    def mark(self, proofs: dict[int, tuple[bool | None, str]]) -> None:
        """Write down of some scores, by number, whether they were proven, and why not.

        Scores that have been removed meanwhile are left out.

        Raises:
            SilverballError: Another program holds the file.
        """
        rows = [(verified, why, self._id(id)) for id, (verified, why) in proofs.items()]
        statement = "UPDATE score SET verified = ?, why = ? WHERE id = ?"
        self._write(lambda connection: connection.executemany(statement, rows))

    def remove(self, id: int) -> None:
        """Remove a score and its replay.

        Raises:
            SilverballError: There is no score of that number, or another program holds the file.
        """
        self._change(id, "DELETE FROM score WHERE id = ?", ())

    def lists(self) -> list[ScoreList]:
        """All lists, those with the most scores first."""
        rows = self._read(
            "SELECT mode, table_name, table_digest, count(*), list.id"
            " FROM score JOIN list ON list.id = score.list GROUP BY list.id ORDER BY count(*) DESC, list.id"
        )
        return [
            ScoreList(text_of(mode), text_of(name), text_of(digest), length, id)
            for mode, name, digest, length, id in rows
        ]

    def table_text(self, list_id: int) -> str:
        """The table of a list as a table file; empty if it is not kept."""
        rows = self._read("SELECT table_text FROM list WHERE id = ?", (list_id,))
        return text_of(rows[0][0]) if rows else ""

    def scores(
        self,
        mode: str | None = None,
        table_digest: str | None = None,
        table_name: str | None = None,
        limit: int = PLACES,
        list_id: int | None = None,
    ) -> list[Score]:
        """The best scores, best first; of equal ones the earlier is the better.

        Those that somebody tried to prove in vain come last.

        Args:
            mode: Of this mode only.
            table_digest: Of this table only: this is the one that says which list.
            table_name: Of tables of this name only, whatever they contain.
            limit: How many at most; -1: all.
            list_id: Of the list of this number only.
        """
        wanted = {"mode": mode, "table_digest": table_digest, "table_name": table_name}
        words = {column: str(value) for column, value in wanted.items() if value is not None}
        which = " AND ".join([f"{column} = ?" for column in words] + ["list.id = ?"] * (list_id is not None))
        rows = self._read(
            f"{_LOOK} {which or 'true'} ORDER BY {DOUBTFUL}, score DESC, score.id LIMIT ?",
            (*words.values(), *([] if list_id is None else [list_id]), limit),
        )
        found = [self._renamed(score_of(row)) for row in rows]
        if list_id is None:
            found += [one for one in self._waiting_scores() if words.items() <= one._asdict().items()]
        found.sort(key=lambda one: one.order)
        return found[:limit] if limit >= 0 else found

    def score(self, id: int) -> Score:
        """One score.

        Raises:
            SilverballError: There is no score of that number.
        """
        for one in self._waiting_scores():
            if one.id == id:
                return one
        rows = self._read(f"{_LOOK} score.id = ?", (self._id(id),), must=True)
        if not rows:
            raise _no_such(id)
        return self._renamed(score_of(rows[0]))

    def is_high(self, score: int, mode: str, table_digest: str) -> int | None:
        """The place, from 1, that a score would have in the list that is shown; None if it is not in it.

        No points are no high score; scores that are not proven are in nobody's way.
        """
        shown = self.scores(mode, table_digest)
        better = sum(one.score >= score and not one.is_doubtful for one in shown)
        return better + 1 if score > 0 and better < PLACES else None

    def replay(self, id: int) -> str:
        """The replay of a score.

        Raises:
            SilverballError: There is no score of that number, or its replay was not kept.
        """
        one = self._waiting_score(id)
        if one is not None:
            return one.replay
        rows = self._read("SELECT replay FROM score WHERE id = ?", (self._id(id),), must=True)
        if not rows:
            raise _no_such(id)
        if rows[0][0] is None:
            raise SilverballError(f"score {id}: its replay was not kept")
        return text_of(rows[0][0])

    # ── the last game, settings ─────────────────────────────────────────────────────────────────────────

    def keep_last_game(self, replay_text: str) -> None:
        """Keep the replay of the game that was played last, in place of the one before."""

        def wait() -> None:
            self._room.waiting.last_game = replay_text
            self._room.keep()

        self._write(lambda connection: records.keep_last_game(connection, replay_text), wait)

    def last_game(self) -> str | None:
        """The replay of the game that was played last; None if there was none."""
        if self._room.waiting.last_game is not None:
            return self._room.waiting.last_game
        rows = self._read("SELECT replay FROM last_game")
        return text_of(rows[0][0]) if rows else None

    def settings(self) -> dict[str, Any]:
        """What was kept of the settings; values that are damaged are left out."""
        values = {}
        for name, value in self._read("SELECT name, value FROM setting ORDER BY name"):
            with suppress(ValueError, RecursionError, TypeError):
                values[text_of(name)] = json.loads(value)
        return values | self._room.waiting.settings

    def keep_settings(self, values: dict[str, Any]) -> None:
        """Keep settings, all of them or none; those that are not named stay as they are.

        Args:
            values: By name; anything that JSON can hold.
        """

        def wait() -> None:
            self._room.waiting.settings |= json.loads(json.dumps(values))
            self._room.keep()

        self._write(lambda connection: records.keep_settings(connection, values), wait)

    # ── while another program holds the file ────────────────────────────────────────────────────────────

    def _write(
        self,
        work: Callable[[sqlite3.Connection], _Result],
        otherwise: Callable[[], _Result] | None = None,
    ) -> _Result:
        """Do something in the file; while another program holds it, something else.

        Without anything else it fails.
        """
        try:
            if not self.try_again():  # in the order in which it came
                raise Held(self.path)
            return self._database.write(work)
        except Held as held:
            if otherwise is None:
                raise _is_held(held) from None
            return otherwise()

    def _read(self, query: str, values: tuple[Any, ...] = (), *, must: bool = False) -> list[tuple[Any, ...]]:
        """All rows that a query gives; what it gave last while nothing can be read.

        Args:
            query: In SQL.
            values: For its question marks.
            must: Whether it fails rather than give nothing for not knowing.
        """
        key = (query, values)
        try:
            rows = self._database.read(query, values)
        except Held as held:
            self._has_missed = True
            if not self._at_once or (must and key not in self._remembered):
                raise _is_held(held) from None
            return self._remembered.get(key, [])
        if self._at_once:
            self._remembered.pop(key, None)
            self._remembered[key] = rows
            if len(self._remembered) > REMEMBERED:
                del self._remembered[next(iter(self._remembered))]
        return rows

    def _let_wait(self, one: NewScore) -> int:
        """Let a score wait; its number until it has one in the file."""
        number = WHOLE_NUMBERS + len(self._numbers)
        self._numbers[one.token] = number
        self._room.waiting.scores.append(one)
        self._room.keep()
        return number

    def _let_wait_for(self, id: int, initials: str) -> int:
        """Let the initials of a score wait."""
        self._room.waiting.initials[self._id(id)] = initials
        self._room.keep()
        return 1

    def _renamed(self, score: Score) -> Score:
        """A score with the initials that wait for it."""
        initials = self._room.waiting.initials.get(score.id)
        return score if initials is None else score._replace(initials=initials)

    def _waiting_score(self, id: int) -> NewScore | None:
        scores = self._room.waiting.scores
        return next((one for one in scores if self._numbers[one.token] == id), None)

    def _waiting_scores(self) -> Iterable[Score]:
        return [
            Score(
                self._numbers[one.token], one.initials, one.score, one.mode, one.table_name, one.table_digest,
                one.seed, datetime.fromtimestamp(one.played, UTC), None, "", True,
            )
            for one in self._room.waiting.scores
        ]  # fmt: skip

    def _take_in_what_others_left(self) -> None:
        """Bring what waits in files of other programs into the file.

        Raises:
            Held: Another program holds the file.
        """
        if not self._database.is_open:
            self._database.write(lambda connection: None)
        for path, waiting in self._room.others() if self._database.keeps else ():
            if waiting is None:
                aside = path.with_name(path.name.replace("waiting", "set-aside"))
                path.rename(aside)
                self._trouble = f"{aside}: this cannot be read, so the scores that waited in it are not shown"
                continue
            self._take_in(waiting)
            if self._database.keeps:
                with suppress(OSError):
                    path.unlink()
        self._has_taken_in = True

    def _take_in(self, waiting: Waiting) -> dict[str, int]:
        return self._database.write(lambda connection: records.take_in(connection, waiting))

    def _id(self, id: int) -> int:
        """The number of a score in the file.

        Raises:
            SilverballError: No score can have this number.
        """
        id = self._ids.get(id, id)
        if not -WHOLE_NUMBERS <= id < WHOLE_NUMBERS:
            raise _no_such(id)
        return id

    def _change(
        self, id: int, statement: str, values: tuple[Any, ...], otherwise: Callable[[], int] | None = None
    ) -> None:
        row = (*values, self._id(id))
        if self._write(lambda connection: connection.execute(statement, row).rowcount, otherwise) == 0:
            raise _no_such(id)


def _is_held(held: Held) -> SilverballError:
    return SilverballError(f"{held}; try again when it has ended")


def _no_such(id: int) -> SilverballError:
    return SilverballError(f"there is no score {id}; `silverball scores` lists them with their numbers")
