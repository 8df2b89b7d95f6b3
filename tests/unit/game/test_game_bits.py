"""Games have the same bits however their ticks are played, and after they were saved and restored."""

from __future__ import annotations

import random

import pytest
from games import IN_POCKET, POCKET, bare, bring, bumper, put, ruled

from boards import PADDLES, full_table, table_of
from silverball.errors import NoRoom, SilverballError, StateError
from silverball.game.game import Game
from silverball.game.view import GameEventKind, Mode
from silverball.table import Cylinder, SlantWall, Table
from silverball.world import BallState, World

QUICK = {
    "ball_save": 8.0,
    "combo_window": 0.5,
    "combo_step": 1,
    "un_stick": 0.5,
    "stall": 2.0,
    "tilt_limit": 1.8,
}
LONG = {"balls": 99}
TABLES = {
    "crowded": ruled(full_table(), **QUICK, **LONG),
    "empty": ruled(table_of(*PADDLES), **QUICK, **LONG),
    "pocket": ruled(table_of(*PADDLES, *POCKET, Cylinder(center=(5.0, 0.0), radius=0.6)), **QUICK, **LONG),
    "fast": ruled(full_table(boost=3.0, gravity=60.0), **QUICK, **LONG),
}


def script(seed: int, length: int) -> list[tuple[str, bool, bool, int]]:
    """What a wild player does: (act, left, right, ticks)."""
    draw = random.Random(seed)
    acts = ["", "", "", "ball", "ball", "shove"]
    return [
        (draw.choice(acts), draw.random() < 0.4, draw.random() < 0.4, draw.choice((1, 3, 17, 60, 150, 400)))
        for _ in range(length)
    ]


def act(game: Game, what: str) -> None:
    if what == "ball":
        bring(game)
    elif what == "shove" and game.view.on_board:
        game.jitter()


def settle(game: Game) -> None:
    """Begin with a ball; where there is a pocket, in it."""
    game.create_ball()
    if game.table.slant_wall == POCKET:
        put(game, *IN_POCKET)


@pytest.mark.parametrize("mode", list(Mode))
@pytest.mark.parametrize("name", TABLES)
def test_many_ticks_at_once_give_the_same_bits_and_events_as_single_ticks(name: str, mode: Mode):
    seen = set()
    for seed in range(4):
        at_once, singly = Game(TABLES[name], seed, mode), Game(TABLES[name], seed, mode)
        settle(at_once)
        settle(singly)
        for what, left, right, ticks in script(seed, 60):
            act(at_once, what)
            act(singly, what)
            at_once.step(left, right, ticks)
            for _ in range(ticks):
                singly.step(left, right)
            assert at_once.rules_text == singly.rules_text
            assert at_once.digest() == singly.digest()
            events = at_once.take_game_events()
            seen |= {one.kind for one in events}
            assert events == singly.take_game_events()
            assert at_once.take_world_events() == singly.take_world_events()
        assert at_once.replay == singly.replay
    if mode is Mode.ARCADE:
        special = GameEventKind.UNSTUCK if name == "pocket" else GameEventKind.BALL_SAVED
        assert {GameEventKind.BALL_LOST, GameEventKind.TILT, special} <= seen


def test_skipped_ticks_that_lose_events_are_played_again_one_by_one(monkeypatch):
    # In a shaft that is hardly wider than itself a ball hits the walls more often than a log holds.
    half = 0.25 + 0.1 + 0.01  # radius, thickness, half of the room
    shaft = [SlantWall(start=(-3.0, z), end=(9.0, z), restitution=1.0, points=10) for z in (-half, half)]
    table = bare(*shaft, combo_step=1, combo_limit=100)
    at_once, singly = Game(table), Game(table)
    for game in (at_once, singly):
        game.create_ball()
        put(game, 8.0, 0.0, vz=10.0)
    probe = singly.world.copy()
    probe.step(ticks=59)
    assert probe.events_lost > 0
    for _ in range(5):
        at_once.step(ticks=59)
        for _ in range(59):
            singly.step()
        assert at_once.digest() == singly.digest()
        assert at_once.take_world_events() == singly.take_world_events()
    assert at_once.score == singly.score > 0

    # Hits that were played twice are not counted twice when events of a single tick are lost, too.
    before = at_once.score
    monkeypatch.setattr(World, "events", ())
    monkeypatch.setattr(World, "events_lost", 1)
    restored = Game(table)
    restored.restore(singly.save())
    for game in (at_once, singly, restored):
        game.step()
    assert before < at_once.score == singly.score == restored.score


def test_a_saved_ball_without_a_free_place_returns_at_the_same_tick_however_ticks_are_played(monkeypatch):
    create = World.create_ball

    def create_later(world: World) -> BallState:
        if 0 < world.tick < 310:
            raise NoRoom("not yet")
        return create(world)

    monkeypatch.setattr(World, "create_ball", create_later)
    at_once, singly = Game(bare(ball_save=9.0)), Game(bare(ball_save=9.0))
    for game in (at_once, singly):
        game.create_ball()
        put(game, -8.9, 0.0)
        game.step(ticks=200)
        assert game.view.on_board == 0
        with pytest.raises(SilverballError, match="not yet"):
            game.create_ball()
    at_once.step(ticks=150)
    for _ in range(150):
        singly.step()
    assert at_once.view.on_board == 1
    assert [event.tick for event in singly.take_world_events() if event.kind == "created"] == [0, 310]
    assert at_once.digest() == singly.digest()


@pytest.mark.parametrize("name", TABLES)
def test_a_restored_game_continues_with_the_same_bits(name: str):
    game = Game(TABLES[name], 11)
    settle(game)
    other = Game(TABLES[name], 99)
    for what, left, right, ticks in script(5, 40):
        act(game, what)
        state = game.save()
        other = Game(TABLES[name], 3)
        other.restore(state)
        assert other.digest() == game.digest()
        assert other.view == game.view
        game.take_game_events()
        for one in (game, other):
            one.step(left, right, ticks)
        assert other.digest() == game.digest()
        assert other.save() == game.save()
        assert other.take_game_events() == game.take_game_events()


def test_a_game_that_is_over_is_over_after_it_was_restored():
    game = Game(bare(balls=1, ball_save=0.0))
    game.create_ball()
    game.end()
    other = Game(bare(balls=1, ball_save=0.0))
    other.restore(game.save())
    assert (other.is_over, other.ended) == (True, "stopped")


def test_a_state_of_another_mode_table_or_kind_is_refused_and_changes_nothing():
    game = Game(bare())
    game.create_ball()
    before = game.digest()
    states = {
        "free play": Game(bare(), mode=Mode.FREE).save(),
        "another table": Game(bare(bumper())).save(),
        "60 ticks a second": Game(bare(), tick_rate=60).save(),
        "not a saved state": game.world.save(),
        "damaged": game.save()[:-1] + b"x",
        "cut off": game.save()[:20],
    }
    for message, state in states.items():
        with pytest.raises(StateError, match=message):
            game.restore(state)
        assert game.digest() == before


def test_a_restored_game_has_no_replay():
    game = Game(bare())
    game.restore(game.save())
    with pytest.raises(SilverballError, match="no replay"):
        _ = game.replay


def test_other_seeds_give_other_games():
    def played(seed: int, table: Table) -> str:
        game = Game(table, seed)
        game.create_ball()
        game.step(ticks=200)
        return game.digest()

    table = TABLES["crowded"]
    assert len({played(seed, table) for seed in range(5)}) == 5
    assert played(3, table) == played(3, table)
