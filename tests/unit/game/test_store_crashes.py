"""Everything that was shown as saved survives `kill -9`, and two programs at once."""

from __future__ import annotations

import os
import random
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

import killed_player
from killed_player import initials
from silverball.game.replay.format import Replay
from silverball.game.scores.score_records import Score
from silverball.game.scores.store import FILE, Store
from silverball.table import table_digest

MOST_THINGS = 12  # that are shown to a player before he is killed: three games
LONGEST = {"write": 0.003, "game": 0.04}  # [s] that he lives on then; what takes about so long
KILLABLE = pytest.mark.skipif(not hasattr(os, "fork"), reason="players are forked")


class Players:
    """Where players come from."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self.process = process
        assert self.heard() == ["ready"]

    def heard(self) -> list[str]:
        assert self.process.stdout is not None
        return self.process.stdout.readline().split()

    def what_was_shown_until_killed(
        self, folder: Path, seed: int, things: int, after: float
    ) -> list[tuple[Any, ...]]:
        """Start a player, kill it some seconds after some events, and return what it had shown."""
        assert self.process.stdin is not None
        print(seed, folder, file=self.process.stdin, flush=True)
        what, player = self.heard()
        assert what == "pid"
        heard = [self.heard() for _ in range(things)]
        time.sleep(after)
        os.kill(int(player), signal.SIGKILL)
        heard += iter(self.heard, ["dead"])
        return [(what, *map(int, values)) for what, *values in heard]


@pytest.fixture(scope="module")
def players() -> Iterator[Players]:
    command = [sys.executable, killed_player.__file__]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        yield Players(process)


class Expected:
    """What must be there, and what may be because it was being written at the end."""

    def __init__(self) -> None:
        self.scores: dict[int, tuple[int, ...]] = {}
        self.initials: dict[int, str] = {}
        self.last_game = self.settings = -1
        self.proven: set[int] = set()  # seeds of games whose replays were played again
        self.with_rules = 0  # of these, games on a table with rules

    def learn(self, shown: list[Any]) -> None:
        for what, *values in shown:
            if what == "score":
                id, *score = values
                self.scores[id] = tuple(score)
                self.initials[id] = "OLD"
            elif what == "renamed":
                self.initials[values[0]] = initials(values[0])
            elif what == "last_game":
                self.last_game = values[0]
            elif what == "settings":
                self.settings = values[0]

    def check(self, folder: Path, shown: list[Any]) -> None:
        """See that it is there."""
        with closing(sqlite3.connect(folder / FILE)) as connection:
            assert connection.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        last = shown[-1] if shown else ("",)
        with Store(folder) as store:
            assert (store.warning, store.is_persistent) == ("", True)
            there = {score.id: score for score in store.scores(limit=-1)}
            unseen = set(there) - set(self.scores)
            assert len(unseen) <= (last[0] == "last_game")
            for id, shown_score in self.scores.items():
                score = there[id]
                assert (score.score, score.seed, score.player, score.rank) == shown_score
                entered = {initials(id)} if last == ("score", id, *shown_score) else set()
                assert score.initials in {self.initials[id]} | entered
            for score in there.values():
                assert score.has_replay
                self.check_the_replay(score, store.replay(score.id))
            self.check_the_single_ones(store, last, shown)
            # What was not shown may stay; from now on it must.
            new = [there[id] for id in unseen]
            self.learn([("score", one.id, one.score, one.seed, one.player, one.rank) for one in new])
            ranks = sum(store.rank("arcade", table_digest(table)) for table in killed_player.TABLES)
            assert ranks == sum(one.rank for one in there.values())
            self.initials |= {id: score.initials for id, score in there.items()}

    def check_the_replay(self, score: Score, text: str | None) -> None:
        """See that a score has the whole replay of its game; once for each game, it is played again too."""
        assert text is not None
        replay = Replay.from_text(text)
        assert replay.seed == score.seed
        assert replay.score == score.score or (replay.score > score.score and replay.players > 1)
        if score.seed not in self.proven:
            assert replay.verify().ok
            self.proven.add(score.seed)
            self.with_rules += bool(replay.table.rule)

    def check_the_single_ones(self, store: Store, last: tuple[Any, ...], shown: list[Any]) -> None:
        game = store.last_game()
        number = int(game.splitlines()[0]) if game is not None else -1
        written = [values[0] for what, *values in shown if what == "last_game"]
        coming = (written[-1] + 1 if written else 0) if last[0] in ("settings", "opened", "") else number
        assert number in (self.last_game, coming)
        self.last_game = number
        settings = store.settings()
        count = settings.get("count", -1)
        assert count == settings.get("again", -1)  # all or none
        assert count in (self.settings, self.last_game if last[0] == "renamed" else self.settings)
        self.settings = count


def kill_and_look(players: Players, folder: Path, kills: int, seed: int) -> None:
    """Kill players, on one file and on new ones, and check after each that everything is there.

    More are killed where all the first ones died at the same few places.
    """
    draw = random.Random(seed)
    old = Expected()
    ends: set[str] = set()
    for kill in range(10 * kills):
        if kill >= kills and len(ends) > 3:
            break
        is_new = kill % 4 == 3
        expected, place = (Expected(), folder / str(kill)) if is_new else (old, folder)
        things = draw.randrange(1 if is_new else MOST_THINGS)
        after = draw.uniform(0, LONGEST[draw.choice(["write", "game"])])
        shown = players.what_was_shown_until_killed(place, kill, things, after)
        expected.learn(shown)
        if place.exists():
            expected.check(place, shown)
        ends.add(shown[-1][0] if shown else "")
    assert len(old.scores) > kills / 2  # otherwise no player had time to play
    assert kills / 5 < old.with_rules < len(old.scores)  # and games of both kinds
    assert len(ends) > 3


@KILLABLE
def test_nothing_that_was_shown_is_lost_when_the_program_is_killed(players, tmp_path):
    kill_and_look(players, tmp_path, kills=12, seed=1)


@KILLABLE
@pytest.mark.slow
def test_nothing_that_was_shown_is_lost_when_the_program_is_killed_a_hundred_times(players, tmp_path):
    kill_and_look(players, tmp_path, kills=100, seed=2)


def test_two_programs_at_once_lose_no_score(tmp_path):
    code = (
        "import sys; from pathlib import Path; from killed_player import add_scores;"
        "add_scores(Path(sys.argv[1]), int(sys.argv[2]), 200)"
    )
    paths = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    both = [
        subprocess.Popen([sys.executable, "-c", code, str(tmp_path), first], env=paths)
        for first in ("1000", "2000")
    ]
    assert [one.wait(60) for one in both] == [0, 0]
    with Store(tmp_path) as store:
        there = {score.score: score.initials for score in store.scores(limit=-1)}
    assert there == {score: initials(score) for first in (1000, 2000) for score in range(first, first + 200)}
