"""The compiled traces of games, against a plain loop that plays them tick by tick."""

from __future__ import annotations

import math

import numpy as np
import pytest

from boards import full_table, place, speed_of
from silverball.metrics.game_traces import (
    CELLS,
    GAME,
    ON_PADDLE,
    REACTION,
    REACTION_JITTER,
    REMEMBERED_TICKS,
    STAY_RADIUS,
    TICK_RATE,
    GameEnd,
    beginner_presses,
    play_games,
)
from silverball.players import make_player
from silverball.world import World, WorldBatch

TABLE = full_table()


def games_of(count: int, seed: int, player: str, **options):
    """Games on the same table."""
    return play_games(WorldBatch(TABLE, count, seed, TICK_RATE), player, **options)


def gap_to_triangle(point: tuple[float, float], corners) -> float:
    """The distance of a point from the sides of a triangle."""

    def to_side(a, b):
        length = math.dist(a, b) ** 2
        along = sum((p - q) * (r - q) for p, q, r in zip(point, a, b, strict=True)) / length
        along = min(1.0, max(0.0, along))
        return math.dist(point, [q + along * (r - q) for q, r in zip(a, b, strict=True)])

    return min(to_side(a, b) for a, b in zip(corners, (*corners[1:], corners[0]), strict=True))


def watched(seed: int, player: str) -> dict[str, float]:
    """The same game, alone, watched from outside."""
    world, chooser = World(TABLE, seed, TICK_RATE), make_player(player)
    world.create_ball()
    anchor = place(world.balls[0])
    seen = {"ticks": 0, "fast": 0, "on_paddle": 0, "longest_stay": 0, "longest_dry": 0, "over": 1}
    stay = dry = 0
    while True:
        score = world.score
        world.step(*chooser.press(world))
        seen["ticks"] += 1
        dry = dry + 1 if world.score == score else 0
        seen["longest_dry"] = max(seen["longest_dry"], dry)
        if not world.balls:
            return seen
        ball = world.balls[0]
        seen["fast"] += math.hypot(*speed_of(ball)) > 0.5 * TABLE.board.speed_cap
        turned = zip(TABLE.paddle, world.paddles, strict=True)
        near = (
            gap_to_triangle(place(ball), paddle.corners(math.degrees(now.angle))) for paddle, now in turned
        )
        seen["on_paddle"] += min(near) - TABLE.board.ball_radius < ON_PADDLE
        if math.dist(place(ball), anchor) > STAY_RADIUS:
            anchor, stay = place(ball), 0
        stay += 1
        seen["longest_stay"] = max(seen["longest_stay"], stay)


@pytest.mark.parametrize("player", ["idle", "reflex"])
def test_the_trace_of_a_game_is_what_one_sees_from_outside(player: str) -> None:
    games = games_of(4, 20, player)
    for index in range(4):
        for name, value in watched(20 + index, player).items():
            assert games.game[name][index] == value, name


def test_the_maps_and_the_gaps_count_every_tick_and_every_hit_once() -> None:
    games = games_of(16, 5, "random")
    assert games.heat.sum() == (games.game["ticks"] - (games.game["over"] == GameEnd.DRAINED)).sum()
    assert games.gaps.sum() == games.hits.sum() > 0
    assert games.stays.max() == games.game["longest_stay"].max()
    longest = games.game["longest_stay"].argmax()
    row = int(CELLS * (games.game["longest_x"][longest] + 10.0))
    column = int(CELLS * (games.game["longest_z"][longest] + 5.0))
    assert games.stays[row, column] == games.stays.max()


def test_a_game_is_the_same_alone_and_among_others() -> None:
    many, one = games_of(8, 0, "beginner"), games_of(1, 5, "beginner")
    assert [many.game[name][5] for name in GAME.names] == [one.game[name][0] for name in GAME.names]
    assert (many.reached[5] == one.reached[0]).all()


def test_a_game_that_does_not_end_is_cut_short() -> None:
    games = games_of(3, 0, "idle", longest=0.5)
    assert (games.game["over"] == GameEnd.CUT_SHORT).all()
    assert (games.game["ticks"] == TICK_RATE // 2).all()


def test_a_part_is_reached_at_most_once_per_strike() -> None:
    games = games_of(32, 0, "reflex")
    strikes = games.game["strikes"]
    assert strikes.sum() > 100
    assert (games.reached <= strikes[:, None]).all()
    assert (games.game["to_top"] <= strikes).all()
    (names,) = WorldBatch(TABLE).boards.names
    cylinders = games.reached[:, [name.startswith("cylinder") for name in names]]
    assert (games.game["to_cylinder"] >= cylinders.max(axis=1)).all()
    assert (games.game["to_cylinder"] <= cylinders.sum(axis=1)).all()


def test_the_beginner_presses_a_reaction_time_after_the_ball_could_be_seen_coming() -> None:
    world = World(TABLE, 3, TICK_RATE)
    decisions = np.zeros((2, REMEMBERED_TICKS), np.bool_)
    decided, pressed = [], []
    world.create_ball((-1.5, -1.2), (-9.0, 0.0))  # falls onto the outer half of the left paddle
    for tick in range(TICK_RATE):
        record, board, colliders = world.records
        buttons = beginner_presses(record, board, colliders, decisions, 1.0 / TICK_RATE)
        decided += [tick] * bool(decisions[0, tick % REMEMBERED_TICKS])
        pressed += [tick] * bool(buttons[0])
        world.step(*(bool(button) for button in buttons))
    late = (pressed[0] - decided[0]) / TICK_RATE
    assert REACTION[0] - REACTION_JITTER - 1.0 / TICK_RATE <= late <= REACTION[1] + REACTION_JITTER


def test_the_worlds_and_their_tallies_are_restored_after_the_games() -> None:
    batch = WorldBatch(TABLE, 4, 7, TICK_RATE)
    before, tallies = batch.digests(), batch.tallies.copy()
    first, second = play_games(batch, "idle"), play_games(batch, "idle")
    assert batch.digests() == before
    assert (batch.tallies == tallies).all()
    assert (first.game["ticks"] == second.game["ticks"]).all()
    assert (first.state["score"] == second.state["score"]).all()
    with pytest.raises(ValueError, match="240 ticks per second"):
        play_games(WorldBatch(TABLE, 1, 0, 60), "idle")
