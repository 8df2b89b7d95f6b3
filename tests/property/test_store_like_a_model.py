"""Whatever is done to a store, and wherever it is cut short: it holds what a model in memory holds."""

from __future__ import annotations

import copy
import os
import shutil
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from hypothesis import settings, strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, precondition, rule

from silverball.game.scores.store import FILE, PLACES, Store

MEMORY = "/dev/shm"  # a disk that need not be waited for, where there is one
MODES, TABLES = ("arcade", "free"), ("digest a", "digest b")
POINTS = st.integers(0, 12) | st.integers(-(2**63), 2**63 - 1)
TEXT = st.text(max_size=40)
JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | TEXT,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(TEXT, inner, max_size=3),
    max_leaves=5,
)


@dataclass
class Model:
    """What a store must hold, in the plainest way."""

    scores: dict[int, dict[str, Any]] = field(default_factory=dict)
    names: dict[tuple[str, str], str] = field(default_factory=dict)
    settings: dict[str, Any] = field(default_factory=dict)
    last_game: str | None = None

    def ranked(self, mode: str, digest: str) -> list[int]:
        mine = [id for id, score in self.scores.items() if score["list"] == (mode, digest)]
        scores = self.scores
        return sorted(mine, key=lambda id: (scores[id]["verified"] is False, -scores[id]["score"], id))

    def add(self, id: int, **score: Any) -> None:
        self.scores[id] = score


def assert_equal(store: Store, model: Model) -> None:
    """All that can be asked of the store is as the model has it."""
    assert (store.warning, store.is_persistent) == ("", True)
    for mode in MODES:
        for digest in TABLES:
            ranked = model.ranked(mode, digest)
            assert [score.id for score in store.scores(mode, digest, limit=-1)] == ranked
            assert [score.id for score in store.scores(mode, digest)] == ranked[:PLACES]
            for points in (0, 1, 5, 12, 2**62):
                in_the_way = (model.scores[id] for id in ranked if model.scores[id]["verified"] is not False)
                better = sum(score["score"] >= points for score in in_the_way)
                place = better + 1 if points > 0 and better < PLACES else None
                assert store.high_score_rank(points, mode, digest) == place
    lists = {(one.mode, one.table_digest): (one.table_name, one.length) for one in store.lists()}
    filled = {score["list"] for score in model.scores.values()}
    assert lists == {key: (model.names[key], len(model.ranked(*key))) for key in filled}
    for id, score in model.scores.items():
        got = store.score(id)
        assert (got.mode, got.table_digest) == score["list"]
        assert got.table_name == model.names[score["list"]]
        for name in ("initials", "score", "seed", "when", "verified", "why"):
            assert getattr(got, name) == score[name]
        assert got.has_replay
        assert store.replay(id) == score["replay"]
    assert store.settings() == model.settings
    assert store.last_game() == model.last_game


class Stores(RuleBasedStateMachine):
    """A store and its model side by side."""

    def __init__(self) -> None:
        super().__init__()
        self.home = Path(tempfile.mkdtemp(dir=MEMORY if os.path.isdir(MEMORY) else None))
        self.folder = self.home / "0"
        self.copies = 0
        self.model = Model()
        self.store = Store(self.folder)

    def teardown(self) -> None:
        assert_equal(self.store, self.model)
        self.store.close()
        shutil.rmtree(self.home)

    @property
    def log(self) -> Path:
        return self.folder / f"{FILE}-wal"

    def copied(self, log: bytes) -> Path:
        """A folder as a crash would leave it: the file, and the log as far as it was written."""
        self.copies += 1
        folder = self.home / str(self.copies)
        folder.mkdir()
        shutil.copyfile(self.folder / FILE, folder / FILE)
        (folder / self.log.name).write_bytes(log)
        return folder

    def do(self, work: Callable[[Store], Any], then: Callable[[Model, Any], None], cut: float) -> None:
        """Write something, and see what would be there if the power had failed before the log was whole."""
        before, log = copy.deepcopy(self.model), self.log.read_bytes()
        then(self.model, work(self.store))
        longer = self.log.read_bytes()
        if not longer.startswith(log):
            return  # the log was begun anew
        length = len(log) + round(cut * (len(longer) - len(log)))
        folder = self.copied(longer[:length])
        with Store(folder) as store:
            assert_equal(store, self.model if length == len(longer) else before)
        shutil.rmtree(folder)

    @initialize(count=st.integers(0, 25), data=st.data())
    def begin(self, count: int, data: st.DataObject) -> None:
        for _ in range(count):
            self.add(
                data.draw(POINTS),
                "ABC",
                "arcade",
                "digest a",
                "Name",
                0,
                "replay",
                datetime(2026, 1, 1, tzinfo=UTC),
                1.0,
            )

    @rule(
        points=POINTS,
        initials=TEXT,
        mode=st.sampled_from(MODES),
        digest=st.sampled_from(TABLES),
        name=TEXT,
        seed=st.integers(0, 2**63 - 1),
        replay=TEXT,
        when=st.datetimes(datetime(1970, 1, 1), timezones=st.just(UTC)),
        cut=st.floats(0, 1),
    )
    def add(
        self,
        points: int,
        initials: str,
        mode: str,
        digest: str,
        name: str,
        seed: int,
        replay: str,
        when: datetime,
        cut: float,
    ) -> None:
        def then(model: Model, id: int) -> None:
            assert id not in model.scores
            model.names[(mode, digest)] = name
            model.add(
                id,
                list=(mode, digest),
                initials=initials,
                score=points,
                seed=seed,
                when=when.replace(microsecond=0),
                replay=replay,
                verified=None,
                why="",
            )

        self.do(
            lambda store: store.add_score(initials, points, mode, name, digest, seed, replay, when), then, cut
        )

    @precondition(lambda self: self.model.scores)
    @rule(data=st.data(), initials=TEXT, cut=st.floats(0, 1))
    def rename(self, data: st.DataObject, initials: str, cut: float) -> None:
        id = data.draw(st.sampled_from(sorted(self.model.scores)))
        self.do(
            lambda store: store.rename(id, initials),
            lambda model, _: model.scores[id].update(initials=initials),
            cut,
        )

    @precondition(lambda self: self.model.scores)
    @rule(data=st.data(), verified=st.none() | st.booleans(), why=TEXT, cut=st.floats(0, 1))
    def mark(self, data: st.DataObject, verified: bool | None, why: str, cut: float) -> None:
        id = data.draw(st.sampled_from(sorted(self.model.scores)))
        self.do(
            lambda store: store.save_verdicts({id: (verified, why)}),
            lambda model, _: model.scores[id].update(verified=verified, why=why),
            cut,
        )

    @precondition(lambda self: self.model.scores)
    @rule(data=st.data(), cut=st.floats(0, 1))
    def remove(self, data: st.DataObject, cut: float) -> None:
        id = data.draw(st.sampled_from(sorted(self.model.scores)))

        def then(model: Model, _: object) -> None:
            del model.scores[id]

        self.do(lambda store: store.remove(id), then, cut)

    @rule(values=st.dictionaries(TEXT, JSON, max_size=4), cut=st.floats(0, 1))
    def keep_settings(self, values: dict[str, Any], cut: float) -> None:
        self.do(
            lambda store: store.save_settings(values), lambda model, _: model.settings.update(values), cut
        )

    @rule(text=TEXT, cut=st.floats(0, 1))
    def keep_last_game(self, text: str, cut: float) -> None:
        def then(model: Model, _: object) -> None:
            model.last_game = text

        self.do(lambda store: store.save_last_game(text), then, cut)

    @rule()
    def open_again(self) -> None:
        self.store.close()
        self.store = Store(self.folder)

    @rule()
    def crash(self) -> None:
        folder = self.copied(self.log.read_bytes())
        self.store.close()
        self.folder = folder
        self.store = Store(folder)
        assert_equal(self.store, self.model)


TestStores = Stores.TestCase
TestStores.settings = settings(max_examples=15, stateful_step_count=15)
