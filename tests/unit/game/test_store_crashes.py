"""Is all that was shown as kept still there after `kill -9`, and with two programs at once?"""

from __future__ import annotations

import multiprocessing
import random
import sqlite3
import time
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from killed_player import BOARD, add_scores, initials, play
from silverball.game.store import FILE, REPLAYS, Store

HOW = "forkserver" if "forkserver" in multiprocessing.get_all_start_methods() else "spawn"
LONGEST = 0.12  # [s] that a player plays before he is killed: some twenty games


@pytest.fixture(scope="module")
def players() -> Any:
    """Where players come from."""
    context = multiprocessing.get_context(HOW)
    context.set_forkserver_preload(["killed_player"])
    return context


def what_was_shown_until_it_was_killed(players: Any, folder: Path, seed: int, after: float) -> list[Any]:
    """Let a player play, kill him, and return what he has been shown."""
    ours, theirs = players.Pipe(duplex=False)
    player = players.Process(target=play, args=(folder, seed, theirs))
    player.start()
    theirs.close()
    time.sleep(after)
    player.kill()
    player.join()
    shown = []
    with closing(ours):
        while True:
            try:
                shown.append(ours.recv())
            except EOFError:
                return shown


class Expected:
    """What must be there, and what may be because it was being written at the end."""

    def __init__(self) -> None:
        self.scores: dict[int, tuple[int, int]] = {}
        self.initials: dict[int, str] = {}
        self.last_game = self.settings = -1

    def learn(self, shown: list[Any]) -> None:
        for what, *values in shown:
            if what == "score":
                id, score, seed = values
                self.scores[id] = (score, seed)
                self.initials[id] = "OLD"
            elif what == "renamed":
                self.initials[values[0]] = initials(values[0])
            elif what == "last game":
                self.last_game = values[0]
            elif what == "settings":
                self.settings = values[0]

    def check(self, folder: Path, shown: list[Any]) -> None:
        """See that it is there."""
        with closing(sqlite3.connect(folder / FILE)) as connection:
            assert connection.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        last = shown[-1] if shown else ("",)
        with Store(folder) as store:
            assert (store.trouble, store.keeps) == ("", True)
            there = {score.id: score for score in store.scores(limit=-1)}
            unseen = set(there) - set(self.scores)
            assert len(unseen) <= (last[0] == "last game")
            for id, (points, seed) in self.scores.items():
                score = there[id]
                assert (score.score, score.seed) == (points, seed)
                entered = {initials(id)} if last == ("score", id, points, seed) else set()
                assert score.initials in {self.initials[id]} | entered
            best = store.scores("arcade", BOARD[2], limit=REPLAYS)
            assert all(score.has_replay and store.replay(score.id) for score in best)
            self.check_the_single_ones(store, last, shown)
            # What was not shown may stay; from now on it must.
            self.learn([("score", id, there[id].score, there[id].seed) for id in unseen])
            self.initials |= {id: score.initials for id, score in there.items()}

    def check_the_single_ones(self, store: Store, last: tuple[Any, ...], shown: list[Any]) -> None:
        game = store.last_game()
        number = int(game.splitlines()[0]) if game is not None else -1
        written = [values[0] for what, *values in shown if what == "last game"]
        coming = (written[-1] + 1 if written else 0) if last[0] in ("settings", "opened", "") else number
        assert number in (self.last_game, coming)
        self.last_game = number
        settings = store.settings()
        count = settings.get("count", -1)
        assert count == settings.get("again", -1)  # all or none
        assert count in (self.settings, self.last_game if last[0] == "renamed" else self.settings)
        self.settings = count


def kill_and_look(players: Any, folder: Path, kills: int, seed: int) -> int:
    """Kill so many players, on one file and on new ones; how many things they were shown."""
    draw = random.Random(seed)
    things = 0
    old = Expected()
    for kill in range(kills):
        is_new = kill % 4 == 3
        expected, place = (Expected(), folder / str(kill)) if is_new else (old, folder)
        after = draw.uniform(0, LONGEST / 4 if is_new else LONGEST)
        shown = what_was_shown_until_it_was_killed(players, place, kill, after)
        expected.learn(shown)
        if place.exists():
            expected.check(place, shown)
        things += len(shown)
    return things


def test_nothing_that_was_shown_is_lost_when_the_program_is_killed(players, tmp_path):
    assert kill_and_look(players, tmp_path, kills=12, seed=1) > 12


@pytest.mark.slow
def test_nothing_that_was_shown_is_lost_when_the_program_is_killed_a_hundred_times(players, tmp_path):
    assert kill_and_look(players, tmp_path, kills=100, seed=2) > 100


def test_two_programs_at_once_lose_no_score(players, tmp_path):
    both = [players.Process(target=add_scores, args=(tmp_path, first, 200)) for first in (1000, 2000)]
    for one in both:
        one.start()
    for one in both:
        one.join(60)
    assert [one.exitcode for one in both] == [0, 0]
    with Store(tmp_path) as store:
        there = {score.score: score.initials for score in store.scores(limit=-1)}
    assert there == {score: initials(score) for first in (1000, 2000) for score in range(first, first + 200)}
