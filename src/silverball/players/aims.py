"""What it is worth to hit each part now: for players that aim at what is lit.

A hit sets off rules. Those whose conditions hold now are asked what they would pay, and what they lead to:
a counter on its way to a value, a lamp on the way to a complete group, a mode that starts. Nothing is
changed or played, so this is an estimate: conditions are taken as they are before the hit.

A rule that lights a lamp or brings a ball pays nothing yet, but leads on: that is worth a unit, the mean of
all awards of the table's rules.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.physics.kernel import as_int, internal, kernel
from silverball.physics.records import records
from silverball.referee.compile_rules import RuleBooks
from silverball.referee.game_records import REPORT, Book, Light, Op, OpRecord, Play
from silverball.referee.numbers import value_of
from silverball.referee.run_games import book_of
from silverball.referee.triggers import holds

QUEUE = 32  # triggers that follow one hit; further ones are not looked at
FOLLOWING = np.dtype([("trigger", "i8", (QUEUE,)), ("share", "f8", (QUEUE,)), ("count", "i8")])
"""Triggers that a hit leads to, and how much of the way to each the hit is."""


class AimRows(NamedTuple):
    """What `weigh_parts` reads and writes beside the games.

    Attributes:
        setups: SETUP records [board].
        book: The rules of all boards.
        units: What a lamp or a ball is worth [board].
        report: A REPORT record: scratch.
        following: A FOLLOWING record: scratch.
    """

    setups: Any
    book: Book
    units: NDArray[np.float64]
    report: Any
    following: Any


def aim_rows(books: RuleBooks) -> AimRows:
    """The rows for games by these rules; on tables without rules of their own nothing is worth an aim."""
    units = [_mean_award(books, table) if own else 0.0 for table, own in enumerate(books.is_own)]
    return AimRows(books.setups, books.book, np.array(units), records(1, REPORT)[0], records(1, FOLLOWING)[0])


def _mean_award(books: RuleBooks, table: int) -> float:
    """The mean award of the rules of a table, at least 1."""
    book, setup = books.book, books.setups[table]
    end = books.setups[table + 1]["trigger_first"] if table + 1 < len(books.setups) else len(book.triggers)
    triggers = book.triggers[setup["trigger_first"] : end]
    rules = {int(rule) for rule in book.listed[triggers[0] : triggers[-1]].tolist()}
    awards = [
        int(op["value"])
        for rule in rules
        for op in book.ops[book.rules[rule]["first_effect"] : book.rules[rule]["end_effect"]]
        if op["op"] == Op.AWARD
    ]
    return max(float(np.mean(awards)), 1.0) if awards else 1.0


@kernel
def weigh_parts(games: Any, board_of: Any, rows: AimRows, worths: Any) -> None:
    """Write what a hit of each part is worth in each game, in units, into `worths`, f8 [game, part]."""
    for index in range(len(games)):
        setup, unit = rows.setups[board_of[index]], rows.units[board_of[index]]
        for part in range(worths.shape[1]):
            worths[index, part] = 0.0
        if unit == 0.0 or games[index].over != 0 or games[index].tilted != 0:
            continue
        play, book = Play(games[index], rows.report), book_of(rows.book, setup)
        for part in range(setup.parts):
            worths[index, part] = worth_of(play, book, rows.following, part, unit) / unit


@internal
def worth_of(play: Play, book: Book, following: Any, part: int, unit: float) -> float:
    """What a hit of a part is worth in points, without the points of the part itself."""
    setup = book.setup
    following.count = 0
    follow(book, following, setup.hit_first + part, 1.0)
    row = book.parts[setup.part_first + part]
    if row.bank >= 0 and play.game.fallen & row.switch == 0:
        standing = book.banks[setup.bank_first + row.bank].switches & ~play.game.fallen
        follow(book, following, setup.down_first + row.bank, 1.0 / bits_of(standing))
    total, done = 0.0, 0
    while done < following.count:
        place, share = setup.trigger_first + following.trigger[done], following.share[done]
        for listed in range(book.triggers[place], book.triggers[place + 1]):
            rule = book.listed[listed]
            if holds(play, book, rule):
                total += share * worth_of_rule(play, book, following, rule, share, unit)
        done += 1
    return total


@internal
def bits_of(mask: int) -> float:
    """The number of bits, at least 1."""
    count = 0
    for bit in range(62):
        count += mask >> bit & 1
    return float(max(count, 1))


@internal
def follow(book: Book, following: Any, trigger: int, share: float) -> None:
    """Look at a trigger later, if any rule listens to it."""
    place = book.setup.trigger_first + trigger
    if book.triggers[place] != book.triggers[place + 1] and following.count < QUEUE:
        following.trigger[following.count], following.share[following.count] = trigger, share
        following.count += 1


@internal
def worth_of_rule(play: Play, book: Book, following: Any, rule: int, share: float, unit: float) -> float:
    """What a rule pays, and a unit each if it lights lamps or brings balls; notes what follows."""
    total, award, lights, brings = 0.0, 0.0, False, False
    for row in range(book.rules[rule].first_effect, book.rules[rule].end_effect):
        op = book.ops[row]
        if op.op == Op.AWARD:
            award = float(op.value)
        elif op.op == Op.TIMES:
            award *= float(value_of(play, book, op.target))
        elif op.op == Op.GIVE:
            total, award = total + award, 0.0
        elif op.op in (Op.LIGHT, Op.BLINK):
            lights = follow_lamp(play, book, following, op, share) or lights
        elif op.op == Op.LIGHT_NEXT:
            lights = True
        elif op.op in (Op.EXTRA_BALL, Op.LOCK, Op.MULTIBALL):
            brings = True
        elif op.op == Op.ADD and op.value > 0:
            follow_counter(play, book, following, op, share)
        elif op.op == Op.START and play.game.mode_end[op.target] < 0:
            follow(book, following, book.setup.start_first + op.target, share)
    return total + (unit if lights else 0.0) + (unit if brings else 0.0)


@internal
def follow_lamp(play: Play, book: Book, following: Any, op: OpRecord, share: float) -> bool:
    """Whether an effect lights a lamp that leads on; of a group it is what all of its lamps lead to."""
    if play.game.lamp[op.target] != Light.OFF:
        return False
    row = book.lamps[book.setup.lamp_first + op.target]
    if op.op == Op.LIGHT and row.group >= 0:
        missing = 0
        for place in range(row.first, row.end):
            missing += play.game.lamp[book.listed[place]] != Light.ON
        follow(book, following, book.setup.complete_first + row.group, share / max(missing, 1))
        return False  # one of many, as a letter
    return True


@internal
def follow_counter(play: Play, book: Book, following: Any, op: OpRecord, share: float) -> None:
    """Note what a counter leads to: the less, the further it still has to go."""
    value = value_of(play, book, as_int(op.target))
    for row in range(book.setup.reach_first, book.setup.reach_end):
        reach = book.reaches[row]
        if reach.counter == op.target and reach.value > value:
            part = min(1.0, op.value / (reach.value - value))
            follow(book, following, reach.trigger, share * part)
