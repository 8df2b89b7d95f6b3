"""`silverball scores --verify` proves scores that were played, and none that was written into the file.

Every forgery changes a copy of a file with honest scores on built-in tables and on custom tables. The forged
scores must be found, and the honest ones must stay proven.
"""

from __future__ import annotations

import dataclasses
import json
import re
import shutil
import sqlite3
from collections.abc import Callable
from contextlib import closing
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from silverball.cli.app import run
from silverball.game.game import TICK_RATE, Game
from silverball.game.replay.format import Replay
from silverball.game.replay.reader import checksum
from silverball.game.replay.recording import format_input, parse_inputs
from silverball.game.scores.store import FILE, Store
from silverball.table import Table, dump_table, generate_table, load_table, table_digest

SEED = 5
CLASSIC, RANDOM = load_table("classic"), load_table("random")


def with_points(table: Table, points: int, name: str) -> Table:
    """The table under another name, with other points for its cylinders."""
    cylinders = tuple(one.model_copy(update={"points": points}) for one in table.cylinder)
    return table.model_copy(update={"cylinder": cylinders, "name": name})


MINE = with_points(CLASSIC, 70, "Mine")
MY_BOARDS = RANDOM.model_copy(update={"name": "My boards"})
EASIER_RECIPE = RANDOM.model_copy(update={"arcade": RANDOM.arcade.model_copy(update={"balls": 5})})
HONEST = {"classic": CLASSIC, "random": RANDOM, "mine": MINE, "my boards": MY_BOARDS}


def played(
    table: Table, *, wait: int = 0, tap: bool = False, seconds: float = 20.0, end: bool = True, **how: Any
) -> Game:
    """A game in which the paddles go up and down at fixed times after the first ball.

    Args:
        table: What is played on.
        wait: Ticks before the first ball.
        tap: Whether somebody presses in vain meanwhile.
        seconds: How long, if it is not over before.
        end: Whether the player ends it then.
        how: Seed, mode and tick rate.
    """
    game = Game(table, **{"seed": SEED, "mode": "arcade"} | how)
    for tick in range(0, wait, 10):
        game.step(left=tap and tick < wait // 2, ticks=10)
    while not game.is_over and game.tick < wait + seconds * game.tick_rate:
        if not game.view.on_board:
            game.create_ball()
        phase = (game.tick - wait) % 100
        game.step(left=phase < 50, right=phase > 50, ticks=10)
    if end:
        game.end()
    return game


@cache
def honest_game(name: str) -> Game:
    return played(HONEST[name])


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with an honest score on every table, on built-in ones with and without the table's text."""
    folder = tmp_path_factory.mktemp("honest")
    with Store(folder) as store:
        for name, table in HONEST.items():
            game = honest_game(name)
            assert game.score > 0
            store.add_score(
                "ABC",
                game.score,
                "arcade",
                table.name,
                table_digest(table),
                SEED,
                game.replay.to_text(),
                table_text="" if name == "classic" else dump_table(table),
            )
    return folder


class Forger:
    """Somebody who can write to the file."""

    def __init__(self, db: sqlite3.Connection) -> None:
        self.db = db
        self.ids = {
            name: db.execute(
                "SELECT score.id FROM score JOIN list ON list.id = list WHERE table_digest = ?",
                (table_digest(table),),
            ).fetchone()[0]
            for name, table in HONEST.items()
        }

    def set(self, which: str, **values: Any) -> set[int]:
        """Change columns of a score; its number is returned, as of all that are forged."""
        columns = ", ".join(f"{column} = ?" for column in values)
        self.db.execute(f"UPDATE score SET {columns} WHERE id = ?", (*values.values(), self.ids[which]))
        return {self.ids[which]}

    def set_list(self, which: str, **values: Any) -> set[int]:
        """Change columns of the list of a score."""
        columns = ", ".join(f"{column} = ?" for column in values)
        self.db.execute(f"UPDATE list SET {columns} WHERE id = ?", (*values.values(), self.list(which)))
        return {self.ids[which]}

    def list(self, which: str) -> int:
        return self.db.execute("SELECT list FROM score WHERE id = ?", (self.ids[which],)).fetchone()[0]

    def text(self, which: str) -> str:
        return self.db.execute("SELECT replay FROM score WHERE id = ?", (self.ids[which],)).fetchone()[0]

    def put(self, which: str, game: Game) -> set[int]:
        """Put the score of another game in the place of this one."""
        return self.set(which, score=game.score, replay=game.replay.to_text())

    def add(self, list_id: int, game_or_text: Game | str, score: int = 0, seed: int = SEED) -> set[int]:
        """Add a score to a list."""
        text = game_or_text
        if isinstance(game_or_text, Game):
            score, text = game_or_text.score, game_or_text.replay.to_text()
        cursor = self.db.execute(
            "INSERT INTO score (list, initials, score, seed, played, replay) VALUES (?, 'XYZ', ?, ?, 0, ?)",
            (list_id, score, seed, text),
        )
        return {int(cursor.lastrowid or 0)}

    def add_list(self, table: Table, text: str | None = None) -> int:
        """Add a list for a table."""
        cursor = self.db.execute(
            "INSERT INTO list (mode, table_digest, table_name, table_text) VALUES ('arcade', ?, ?, ?)",
            (table_digest(table), table.name, dump_table(table) if text is None else text),
        )
        return int(cursor.lastrowid or 0)

    def without_constraints(self) -> None:
        """Let the table of scores take whatever is written."""
        rows = self.db.execute("SELECT * FROM score").fetchall()
        self.db.execute("DROP TABLE score")
        self.db.execute(
            "CREATE TABLE score"
            " (id INTEGER PRIMARY KEY, list, initials, score, seed, played, verified, why, replay, player,"
            " rank)"
        )
        self.db.executemany(f"INSERT INTO score VALUES ({', '.join('?' * 11)})", rows)


def signed(text: str) -> str:
    """A replay whose text was changed, with the checksum that belongs to it."""
    body = text[: text.index("checksum = ")]
    return f"{body}checksum = {checksum(body)}\n"


def again(text: str, **changes: Any) -> str:
    """The replay with other parts, written as the program writes it."""
    return dataclasses.replace(Replay.from_text(text), **changes).to_text()


def with_vain_presses_after_the_end(text: str) -> str:
    replay = Replay.from_text(text)
    last = max((one.tick for one in parse_inputs(replay.tail)), default=0)
    rest = replay.ticks % TICK_RATE
    return again(text, tail=replay.tail + format_input("R", rest - last) + format_input("R", 0))


def rich(name: str = "Classic") -> Table:
    return with_points(CLASSIC, 1_000_000, name)


@cache
def rich_game(name: str = "Classic") -> Game:
    return played(rich(name))


def on_an_easier_table(forger: Forger, which: str) -> set[int]:
    """The replay of a table of that name with dearer cylinders."""
    table = HONEST[which]
    board = table if table.random is None else generate_table(SEED, table)
    return forger.put(which, played(with_points(board, 1_000_000, board.name)))


FORGERIES: dict[str, Callable[[Forger], set[int]]] = {}

# ── another table ──
for key in list(HONEST):
    FORGERIES[f"easier table on {key}"] = lambda forger, key=key: on_an_easier_table(forger, key)
    FORGERIES[f"easier table on {key}, the list's digest unknown"] = lambda forger, key=key: (
        forger.set_list(key, table_digest="0") and on_an_easier_table(forger, key)
    )
    FORGERIES[f"the list's digest on {key} is bytes"] = lambda forger, key=key: forger.set_list(
        key, table_digest=table_digest(HONEST[key]).encode()
    )
FORGERIES |= {
    "a list called Classic, wholly of an easier table": lambda forger: (
        forger.set_list("classic", table_digest=table_digest(rich()), table_text=dump_table(rich()))
        and forger.put("classic", rich_game())
    ),
    "a list called Random, of an easier recipe": lambda forger: forger.add(
        forger.add_list(EASIER_RECIPE), played(EASIER_RECIPE)
    ),
    "the table of the list edited": lambda forger: forger.set_list(
        "mine", table_text=dump_table(with_points(CLASSIC, 71, "Mine"))
    ),
    "the table of the list edited, the digest too, but not the replay": lambda forger: forger.set_list(
        "mine",
        table_text=dump_table(with_points(CLASSIC, 71, "Mine")),
        table_digest=table_digest(with_points(CLASSIC, 71, "Mine")),
    ),
    "the recipe of the list edited": lambda forger: forger.set_list(
        "my boards", table_text=dump_table(RANDOM)
    ),
    "the table of a built-in list edited": lambda forger: forger.set_list(
        "classic", table_text=dump_table(rich())
    ),
    "the board of another seed": lambda forger: forger.put("random", played(RANDOM, seed=SEED + 1)),
    "the board of another recipe": lambda forger: forger.put("random", honest_game("my boards")),
    "a finished board instead of the one that its seed makes": lambda forger: forger.put(
        "random", played(generate_table(SEED + 1, RANDOM))
    ),
    "moved to another list": lambda forger: forger.set("mine", list=forger.list("random")),
    "moved from one list of a recipe to another": lambda forger: forger.set(
        "my boards", list=forger.list("random")
    ),
}
for text in ("", "nothing", "name = 1", "[" * 100_000, b"\xff\x00", 12, "x = 1\n" * 400_000):
    FORGERIES[f"the table of a list of one's own is {str(text)[:12]!r}"] = lambda forger, text=text: (
        forger.set_list("mine", table_text=text)
    )
FORGERIES["the table of a list needs a mesh"] = lambda forger: forger.set_list(
    "mine", table_text='format = 1\nname = "Mine"\n[[cylinder]]\nmesh = "/etc/passwd"\n'
)
for name in (
    "Classic",
    "classic",
    "CLASSIC",
    " Classic ",
    "Cl\u00e1ssic",
    "C\u200blassic",
    "Ｃlassic",
    "rolling",
):
    FORGERIES[f"an easier table's list renamed {name!r}"] = lambda forger, name=name: forger.set_list(
        "mine", table_name=name
    )
    FORGERIES[f"an easier table named {name!r}"] = lambda forger, name=name: forger.add(
        forger.add_list(rich(name)), rich_game(name)
    )
for key, easier in {
    "mine": with_points(CLASSIC, 71, "Mine"),
    "classic": rich(),
    "my boards": EASIER_RECIPE,
}.items():
    FORGERIES[f"the table of {key} edited and played on, under the digest of before"] = (
        lambda forger, key=key, easier=easier: (
            forger.set_list(key, table_text=dump_table(easier), table_name=easier.name)
            and forger.put(key, played(easier))
        )
    )
FORGERIES["the list of one built-in table renamed to another"] = lambda forger: forger.set_list(
    "classic", table_name="Random"
)

FORGERIES |= {
    "another mode in the list": lambda forger: forger.set_list("classic", mode="free"),
    "a mode that there is not": lambda forger: forger.set_list("classic", mode="x\x1b[31m"),
    "a replay of free play": lambda forger: forger.put("classic", played(CLASSIC, mode="free")),
    "another seed": lambda forger: forger.set("classic", seed=SEED + 1),
    "another seed on random boards": lambda forger: forger.set("random", seed=SEED + 1),
    "a negative seed": lambda forger: forger.set("random", seed=-1),
    "another tick rate": lambda forger: forger.put("classic", played(CLASSIC, tick_rate=120)),
    "a game that is not over": lambda forger: forger.put("classic", played(CLASSIC, end=False)),
}
for points in (1, -1, 10**9, -(10**9)):
    FORGERIES[f"{points:+} points"] = lambda forger, points=points: forger.set(
        "classic", score=honest_game("classic").score + points
    )
for points in (0, -5, 2**63 - 1, -(2**63)):
    FORGERIES[f"{points} points, whatever was played"] = lambda forger, points=points: forger.set(
        "classic", score=points
    )

# ── no whole replay ──
for key in list(HONEST):
    FORGERIES[f"no replay on {key}, in first place, marked as proven"] = lambda forger, key=key: forger.set(
        key, replay=None, score=10**9, verified=1
    )
for text in ("", " ", "nothing", b"\x00\xff", 7, "silverball replay 1\n", "\0" * 1000, "x" * 6_000_000):
    FORGERIES[f"the replay is {str(text)[:12]!r}"] = lambda forger, text=text: forger.set(
        "classic", replay=text, verified=1
    )
for key in ("physics", "rules"):
    for version in (0, 1, 9, 99, 10**8, 10**30):
        FORGERIES[f"{key} {version}"] = lambda forger, key=key, version=version: forger.set(
            "classic",
            score=999_999_999,
            replay=signed(re.sub(rf"{key} = \d+", f"{key} = {version}", forger.text("classic"))),
        )
    FORGERIES[f"nothing but the claim of another {key}"] = lambda forger, key=key: forger.set(
        "classic", replay=f"silverball replay 1\n{key} = 99\n"
    )
FORGERIES["another format"] = lambda forger: forger.set(
    "classic", replay=forger.text("classic").replace("replay 1", "replay 2", 1)
)
for share in (0.1, 0.5, 0.9, 0.99):
    FORGERIES[f"the first {share:.0%} of the replay"] = lambda forger, share=share: forger.set(
        "classic", replay=forger.text("classic")[: int(len(forger.text("classic")) * share)]
    )
FORGERIES |= {
    "more behind the replay": lambda forger: forger.set("classic", replay=forger.text("classic") + "more\n"),
    "two replays": lambda forger: forger.set("classic", replay=forger.text("classic") * 2),
    "bytes behind a zero": lambda forger: forger.set("classic", replay=forger.text("classic") + "\0more"),
    "another score in the replay": lambda forger: forger.set(
        "classic", score=10**6, replay=again(forger.text("classic"), score=10**6)
    ),
    "a line of play taken out": lambda forger: forger.set(
        "classic",
        replay=again(
            forger.text("classic"), lines=Replay.from_text(forger.text("classic")).lines[1:],
            ticks=Replay.from_text(forger.text("classic")).ticks - TICK_RATE,
        ),
    ),
    "the inputs taken out": lambda forger: forger.set(
        "classic",
        replay=again(
            forger.text("classic"),
            lines=tuple(line[:12] for line in Replay.from_text(forger.text("classic")).lines),
        ),
    ),
    "stopped, but called over": lambda forger: forger.set(
        "classic",
        replay=again(forger.text("classic"), ended="over"),
    ),
    "ended by a fault": lambda forger: forger.set(
        "classic", replay=again(forger.text("classic"), ended="not_finite")
    ),
}  # fmt: skip

# ── counted before ──
for key in list(HONEST):
    FORGERIES[f"the same game again on {key}"] = lambda forger, key=key: forger.add(
        forger.list(key), honest_game(key)
    )
    FORGERIES[f"the same game not as far on {key}"] = lambda forger, key=key: forger.add(
        forger.list(key), played(HONEST[key], seconds=15.0)
    )
    FORGERIES[f"the same game after a pause on {key}"] = lambda forger, key=key: forger.add(
        forger.list(key), played(HONEST[key], wait=TICK_RATE)
    )
    FORGERIES[f"the same game with vain presses on {key}"] = lambda forger, key=key: forger.add(
        forger.list(key), played(HONEST[key], wait=TICK_RATE, tap=True)
    )
for what, change in {
    "other line ends": lambda text: text.replace("\n", "\r\n"),
    "a mark at the beginning": lambda text: "\ufeff" + text,
    "presses after the end": with_vain_presses_after_the_end,
    "another program": lambda text: again(text, program="9.9"),
}.items():
    FORGERIES[f"the same game with {what}"] = lambda forger, change=change: forger.add(
        forger.list("classic"), change(forger.text("classic")), honest_game("classic").score
    )
FORGERIES["the same game in the list of its board"] = lambda forger: forger.add(
    forger.add_list(generate_table(SEED, RANDOM)), forger.text("random"), honest_game("random").score
)
FORGERIES["the same game with a number below the first"] = lambda forger: (
    forger.db.execute(
        "INSERT INTO score SELECT -7, list, 'XYZ', score, seed, played, 1, why, replay, player, rank"
        " FROM score WHERE id = ?",
        (forger.ids["classic"],),
    )
    and {forger.ids["classic"]}  # of two equal ones the earlier counts
)


def of_another_type(forger: Forger, column: str, value: Any) -> set[int]:
    forger.without_constraints()
    return forger.set("mine", **{column: value})


for name in ("classic", "random"):
    FORGERIES[f"a rank that was not earned, on {name}"] = lambda forger, name=name: forger.set(name, rank=1)
    FORGERIES[f"a player who was not there, on {name}"] = lambda forger, name=name: forger.set(name, player=2)


@cache
def honest_match() -> Game:
    return played(CLASSIC, players=2)


def put_match(forger: Forger, player: int) -> set[int]:
    """The points of the first player of a match, as those of a player."""
    return forger.set(
        "classic", score=honest_match().scores[0], replay=honest_match().replay.to_text(), player=player
    )


FORGERIES["the score of another player of a match"] = lambda forger: put_match(forger, 2)
FORGERIES["one score of a match twice"] = lambda forger: (
    put_match(forger, 1)
    and forger.db.execute(
        "INSERT INTO score SELECT 7000, list, 'XYZ', score, seed, played, 1, why, replay, player, rank"
        " FROM score WHERE id = ?",
        (forger.ids["classic"],),
    )
    and {7000}
)

VALUES = (None, "text", "7\x1b[31m", b"\x00\xff", 1.5, float("nan"), float("inf"), -1, 2**63 - 1, -(2**63))
for column in ("initials", "score", "seed", "played", "player", "rank"):
    for value in VALUES:
        if not (column == "initials" and isinstance(value, str)) and not (
            column == "played" and value == -1  # a day before the calendar of computers is a day
        ):
            FORGERIES[f"{column} is {value!r}"] = lambda forger, column=column, value=value: of_another_type(
                forger, column, value
            )


def marked_by_a_trigger(forger: Forger) -> set[int]:
    """Whatever is written down of a proof, the file says that it went well."""
    forger.db.execute(
        "CREATE TRIGGER good AFTER UPDATE OF verified ON score WHEN new.verified IS NOT 1"
        " BEGIN UPDATE score SET verified = 1, why = '' WHERE id = new.id; END"
    )
    return forger.set("classic", score=10**9)


FORGERIES["a trigger that marks all as proven"] = marked_by_a_trigger


@pytest.fixture
def folder(base: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the honest folder, which is the data folder of this test."""
    path = tmp_path / "data"
    shutil.copytree(base, path)
    monkeypatch.setenv("SILVERBALL_DATA", str(path))
    monkeypatch.setenv("COLUMNS", "200")
    return path


def forge(folder: Path, forgery: Callable[[Forger], set[int]]) -> set[int]:
    with closing(sqlite3.connect(folder / FILE)) as db, db:
        return forgery(Forger(db))


def controls(text: str) -> set[str]:
    """The characters of a text that a terminal would obey."""
    return {character for character in text if ord(character) < 32 or 127 <= ord(character) < 160} - {"\n"}


def rows_of(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, list[dict[str, Any]]]:
    capsys.readouterr()
    code = run(["scores", "--json", "--limit", "1000", *arguments])
    return code, json.loads(capsys.readouterr().out)


def test_honest_scores_are_proven_on_built_in_random_and_custom_tables(folder, capsys):
    code, rows = rows_of(capsys, "--verify")
    assert code == 0
    assert {row["table_name"] for row in rows} == {table.name for table in HONEST.values()}
    assert all((row["verified"], row["why"]) == (True, "") for row in rows)


@pytest.mark.parametrize("forgery", FORGERIES.values(), ids=FORGERIES)
def test_a_forged_score_is_not_proven_ranks_below_others_and_can_be_removed(folder, capsys, forgery):
    forged = forge(folder, forgery)
    code, rows = rows_of(capsys, "--verify")
    assert code == 1
    assert {row["id"] for row in rows if not row["verified"]} == forged
    assert all(bool(row["why"]) == (row["id"] in forged) for row in rows)
    best: dict[str, int] = {}
    for row in rows:
        best.setdefault(row["table_digest"] + row["mode"], row["id"])
    beside = {row["table_digest"] + row["mode"] for row in rows if row["id"] not in forged}
    assert all(best[key] not in forged for key in beside)
    capsys.readouterr()
    assert run(["scores", "--verify"]) == 1
    shown = capsys.readouterr().out
    for number in forged:
        (line,) = [line for line in shown.splitlines() if line.startswith(f"score {number}, ")]
        assert ": not proven: " in line
    assert f"{len(rows) - len(forged)} are proven and {len(forged)} are not" in shown
    assert run(["scores"]) == 0
    for number in forged:
        assert run(["scores", "--remove", str(number)]) == 0
    assert not controls(shown + capsys.readouterr().out)
    assert run(["scores", "--verify"]) == 0  # what is honest is left
