"""A game whose record somebody has meddled with, in any place, is found by its replay."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any

import silverball as sb
from rule_tables import comet
from silverball.physics.records import JITTER
from silverball.referee.game_records import GAME
from unit.game.test_table_rules_bits import RATE, play

SEED, FORGED, END = 4, 5 * RATE, 7 * RATE  # [ticks] when somebody meddles with the game, and its length
AT_ONCE = 10  # ticks a call
COUNTED = {"lamp": "lamps", "counter": "counters", "mode_end": "modes"}  # rows that a table uses
# What the referee only remembers until it looks at the balls again, a quarter of a second later.
FORGOTTEN = ("rest", "released", "next_end")


def places(game: sb.Game) -> Iterator[tuple[str, Any]]:
    """All numbers in the record of a game that are in use at the moment: their names, and views of them."""
    record, setup = game._keeper.record, game._keeper.books.setups[0]
    for name in GAME.names or ():
        value = record[name]
        if name in ("ball", "rest"):
            for row in range(int(record["balls" if name == "ball" else "rests"])):
                for field in value.dtype.names:
                    yield f"{name}[{row}].{field}", value[field][row : row + 1]
        elif name in COUNTED:
            for row in range(int(setup[COUNTED[name]])):
                yield f"{name}[{row}]", value[row : row + 1]
        else:
            at = (GAME.fields or {})[name][1] // 8
            yield name, game._keeper._words[at : at + 1]


def meddled_with(number: int) -> sb.Game:
    """A game whose record somebody has changed in one place."""
    game = play(sb.Game(comet(), SEED), FORGED, AT_ONCE)
    name, value = list(places(game))[number]
    if name == "shove":
        value[0] = JITTER  # other numbers are no shoves of this table
    else:
        value[0] = 1 - value[0] if name in ("over", "tilted") or name.startswith("lamp") else value[0] + 1
    return play(game, END - game.tick, AT_ONCE)


@cache
def names_of_places() -> tuple[str, ...]:
    return tuple(name for name, _ in places(play(sb.Game(comet(), SEED), FORGED, AT_ONCE)))


def test_the_record_has_everything_that_a_forger_could_want():
    names = names_of_places()
    assert {"score", "ball[0].saves", "lamp[16]", "counter[7]", "mode_end[9]", "locked"} <= set(names)
    assert len(names) > 60


def test_whatever_is_changed_in_a_running_game_its_replay_says_when():
    honest = play(sb.Game(comet(), SEED), END, AT_ONCE)
    assert honest.replay.verify().ok
    missed = []
    for number, name in enumerate(names_of_places()):
        game = meddled_with(number)
        verdict = game.replay.verify()
        if verdict.ok:
            assert game.digest() == honest.digest(), f"{name} made another game, and nobody has seen it"
            missed.append(name)
        else:
            assert (verdict.tick, verdict.seen <= FORGED + RATE) == (FORGED, True), (name, verdict.message)
            assert verdict.field, name
    assert [name for name in missed if not name.startswith(FORGOTTEN)] == []
