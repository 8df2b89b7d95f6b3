"""What a page must know of the rules of a table: their compiled rows, and where the fields of games are."""

from __future__ import annotations

from typing import Any

import numpy as np

from silverball.game.builtin_rules import BUILTIN
from silverball.game.match import MAX_PLAYERS
from silverball.game.mechanisms import plungers, points_by_part
from silverball.game.referee_state import TABLE_FIELDS
from silverball.game.replay.format import Replay
from silverball.game.replay.reader import PLAY, TABLE
from silverball.game.view import Mode
from silverball.physics.records import MAX_BALLS, Device, Fault, records
from silverball.referee.compile_rules import compile_rules
from silverball.referee.game_records import (
    FOREVER,
    GAME,
    IN_PLAY,
    NOT_RUNNING,
    REPORT,
    REPORTED,
    REST,
    SETUP,
    Said,
)
from silverball.referee.single_judge import ARRAYS, JUDGE_ADDRESSES
from silverball.web.pack import ArrayPack
from silverball.web.world_meta import record_meta
from silverball.world import World, WorldBatch
from silverball.world.compile import part_numbers
from silverball.world.single_step import addresses_of


def put_rules(batch: WorldBatch, mode: Mode, pack: ArrayPack) -> dict[str, Any]:
    """Pack the rules of a mode on the table of a batch's first world; return what `page/judge.js` reads."""
    table, boards, rate = batch.tables[0], batch.boards, batch.tick_rate
    books = compile_rules([table], [boards.collider], [BUILTIN[mode].configure(table, rate)], rate)
    games, reports = records(1, GAME), records(1, REPORT)
    games[0] = books.blank[0]
    arrays = dict(zip(ARRAYS, (games, reports, books.setups, *books.book[1:]), strict=False))
    for name, array in arrays.items():
        pack.put(f"{mode} {name}", array)
    heads, text = _replay_heads(World(table, int(batch.state["seed"][0]), rate), mode)
    return {
        "arrays": {name: pack.at[f"{mode} {name}"] for name in arrays},
        "mode": str(mode),
        "isOwn": bool(books.is_own[0]),
        "texts": books.texts[0],
        "modes": books.modes[0],
        "replayHeads": heads,
        "replayTable": text,
    }


def _replay_heads(world: World, mode: Mode) -> tuple[list[str], str]:
    """What replays begin with, for each number of players; and the table, with the line before it."""
    most = MAX_PLAYERS if mode is Mode.ARCADE else 1
    heads, text = [], ""
    for players in range(1, most + 1):
        replay = Replay.of(
            world, mode, lines=(), tail="", score=0, ended="running", digest="", players=players
        )
        head, line, text = replay.to_text().partition(f"\n{PLAY}\n")[0].partition(f"\n{TABLE}\n")
        heads.append(head)
    return heads, f"{line.strip()}\n{text}"


def game_meta(batch: WorldBatch) -> dict[str, Any]:
    """What `page/game.js` and `page/judge.js` read about games of any mode."""
    table = batch.tables[0]
    numbers, points = part_numbers(table), points_by_part(table)
    return {
        "points": [points.get(name, 0) for name in sorted(numbers, key=numbers.__getitem__)],
        "plungers": [numbers[name] for name in plungers(table)],
        "plungerRows": np.flatnonzero(batch.boards.collider["role"] == Device.PLUNGER).tolist(),
        "faults": [fault.name.lower() for fault in Fault],
        "layout": {
            "game": record_meta(GAME) | {"maxBalls": MAX_BALLS}, "forever": str(FOREVER),
            "notRunning": NOT_RUNNING, "bankBits": (1 << int(batch.boards.board["banks"][0])) - 1,
            "setup": record_meta(SETUP), "report": record_meta(REPORT),
            "reported": record_meta(REPORTED), "inPlay": record_meta(IN_PLAY), "rest": record_meta(REST),
            "said": [said.name for said in Said], "tableFields": TABLE_FIELDS,
            "addresses": list(addresses_of(batch.boards.layout, JUDGE_ADDRESSES).names or ()),
        },
    }  # fmt: skip
