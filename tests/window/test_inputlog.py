"""Input logs as data: written, read, played again, and refused when they are damaged."""

from __future__ import annotations

import pytest

from silverball.app.controls import Held
from silverball.app.inputlog import InputLog, replay
from silverball.app.session import Session
from silverball.errors import FaultError, StateError
from silverball.table import Board, Table, load_table

REST = (False, False)


def played() -> Session:
    session = Session(load_table("classic"), 5)
    session.create_ball()
    for round_ in range(12):
        left, right = bool(round_ & 1), bool(round_ & 2)
        session.advance(Held((left, True), (left, right)), 20 + round_)
        if round_ == 4:
            session.create_ball()
        if round_ in (5, 8) and session.world.balls:
            session.jitter()
    return session


def test_a_log_plays_the_same_game_again_bit_for_bit():
    session = played()
    log = InputLog.from_text(session.log.ended(session.world).to_text())
    world = replay(log)
    assert (world.tick, world.score, world.digest()) == (
        session.world.tick,
        session.world.score,
        session.world.digest(),
    )


def test_a_log_grows_with_the_changes_of_input_not_with_time():
    session = Session(load_table("classic"), 5)
    for _ in range(1000):
        session.advance(Held(REST, REST), 4)
    assert session.log.changes == []


def test_a_log_read_back_is_the_same_log():
    session = played()
    log = session.log.ended(session.world)
    assert InputLog.from_text(log.to_text()) == log


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (lambda text: "", "no input log"),
        (lambda text: text[: len(text) // 2], "no input log"),
        (lambda text: text.replace('"format": 1', '"format": 9'), "format must be 1"),
        (lambda text: text.replace('"left"', '"sideways"'), "sideways"),
        (lambda text: text.replace('"seed"', '"sead"'), "seed"),
    ],
)
def test_a_damaged_log_is_refused_with_a_reason(damage, words):
    session = played()
    text = session.log.ended(session.world).to_text()
    with pytest.raises(StateError, match=words):
        InputLog.from_text(damage(text))


def test_a_log_whose_table_was_changed_is_refused():
    session = played()
    log = session.log.ended(session.world)
    log.table_text = log.table_text.replace("radius = 0.65", "radius = 0.66")
    with pytest.raises(StateError, match="table_digest"):
        replay(log)


def test_a_log_of_a_fault_leads_to_the_same_fault_again():
    below_the_board = Table(board=Board(gutter=-12.0))  # no check would let it pass: balls leave the board
    session = Session(below_the_board, 3)
    session.create_ball()
    with pytest.raises(FaultError, match="outside"):
        session.advance(Held(REST, REST), 2000)
    log = InputLog.from_text(session.log.ended(session.world).to_text())
    world = replay(log)
    assert (world.fault, world.tick) == ("outside", session.world.tick)
    assert world.digest() == session.world.digest() == log.digest
