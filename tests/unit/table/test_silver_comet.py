"""The table silver_comet: launch, shots, drains, and the techniques of a player, by scripted buttons.

All at 240 ticks per second. z = MIDDLE is halfway between the left border and the plunger's lane [u].
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

import silverball as sb

RATE = 240
MIDDLE = -0.375
TABLE = sb.load_table("silver_comet")
OUTWARD = {"left": -1.0, "right": 1.0}
CHARGE = 1.2  # [s] of the plunger

Buttons = Callable[[int], NDArray[np.bool_]]


def named_parts(names: tuple[str, ...]) -> list[str]:
    """The names that the file gives to the parts with these names of a board."""
    found = []
    for name in names:
        kind, _, index = name.partition("[")
        found.append(getattr(TABLE, kind)[int(index[:-1])].name if index else name)
    return found


class Crossing(NamedTuple):
    """Which worlds met which parts in a tick: bool [world, part]."""

    tick: int
    met: NDArray[np.bool_]


def batch_of(worlds: sb.World | list[sb.World], count: int) -> sb.WorldBatch:
    """A batch of copies of one world, or of these worlds."""
    batch = sb.WorldBatch(TABLE, count=count, tick_rate=RATE)
    given = worlds if isinstance(worlds, list) else [worlds] * count
    for row, world in enumerate(given):
        batch.state[row] = world.records[0]
    return batch


def played(batch: sb.WorldBatch, ticks: int, buttons: Buttons) -> Iterator[Crossing]:
    """Step tick by tick; `buttons(tick)` is bool [world, 4]."""
    before = batch.tallies.copy()
    for tick in range(ticks):
        batch.step(buttons(tick))
        yield Crossing(tick, batch.tallies > before)
        before = batch.tallies.copy()


def held(left: Any = False, right: Any = False, launch: Any = False, count: int = 1) -> NDArray[np.bool_]:
    """The buttons of all worlds in one tick: each one a truth value, or one for each world."""
    rows = np.zeros((count, 4), np.bool_)
    rows[:, 0], rows[:, 1], rows[:, 3] = left, right, launch
    return rows


def cradled(state: NDArray[Any], side: str) -> NDArray[np.bool_]:
    """Whether the first ball of each world lies on the raised paddle of a side, or in its corner."""
    ball = state["ball"][:, 0]
    away = OUTWARD[side] * (ball["z"] - MIDDLE)
    slow = np.hypot(ball["vx"], ball["vz"]) < 0.3
    return (ball["id"] > 0) & slow & (ball["x"] < -5.9) & (away > 0.6) & (away < 2.6)


def with_a_cradled_ball(side: str) -> sb.World:
    world = sb.World(TABLE, seed=1, tick_rate=RATE)
    hold = {side: True}
    world.step(ticks=72, **hold)
    world.create_ball(position=(-5.6, MIDDLE + 3.0 * OUTWARD[side]), velocity=(-1.0, 0.0))
    world.step(ticks=720, **hold)
    assert cradled(np.array([world.records[0]]), side)[0]
    return world


def falling(x: float, z: float, speed: float) -> sb.World:
    world = sb.World(TABLE, seed=1, tick_rate=RATE)
    world.create_ball(position=(x, z), velocity=(-speed, 0.0))
    return world


# --- The table as a whole


def test_the_table_has_the_size_of_a_real_one():
    rows = len(sb.WorldBatch(TABLE).boards.collider)
    assert 80 < rows < 300  # real tables have 240 to 300 pieces with arcs; most are small posts and pegs
    assert (TABLE.board.length, TABLE.board.width) == (20.0, 10.0)


def test_the_plunger_reaches_every_lane_and_at_full_force_the_spinner():
    charges = np.linspace(0.05, CHARGE, 116)
    batch = sb.WorldBatch(TABLE, count=len(charges), tick_rate=RATE)
    batch.create_balls()
    names = named_parts(batch.boards.names[0])
    aims = [names.index(name) for name in ("lane A", "lane B", "lane C", "spinner")]
    first = np.full(len(charges), -1)
    for tick, met in played(
        batch, 5 * RATE, lambda tick: held(launch=tick < charges * RATE, count=len(charges))
    ):
        for aim in aims:
            first[(first < 0) & met[:, aim] & (tick > charges * RATE)] = aim
    reached = [int((first == aim).sum()) for aim in aims]
    assert min(reached) >= 5, reached  # of 116 charges, 10 ms apart
    assert first[-1] == names.index("spinner")


class Drains(NamedTuple):
    """How balls ended.

    Attributes:
        seconds: From the launch to the end [s], [game].
        outlane: Whether it was lost through an outlane, [game].
        longest_stay: The longest time that any ball stayed within 0.5 u [s].
    """

    seconds: NDArray[np.float64]
    outlane: NDArray[np.bool_]
    longest_stay: float


def drains(is_random: bool, count: int = 300) -> Drains:
    """Launch a ball in each world at some force, and play it without a press or at random."""
    batch = sb.WorldBatch(TABLE, count=count, tick_rate=RATE)
    batch.create_balls()
    names, rng = named_parts(batch.boards.names[0]), np.random.default_rng(0)
    lanes = [names.index("left outlane"), names.index("right outlane")]
    charge = rng.uniform(0.1, CHARGE, count)
    seconds, outlane = np.full(count, np.nan), np.zeros(count, np.bool_)
    place, since, longest = np.zeros((count, 2)), np.zeros(count), 0.0
    presses, block = held(count=count), 12
    for start in range(0, 120 * RATE, block):
        if is_random and start % 36 == 0:
            presses[:, :2] = rng.random((count, 2)) < 0.5
        rows = np.repeat(presses[None], block, axis=0)
        rows[:, :, 3] = (start + np.arange(block))[:, None] < charge * RATE
        before = batch.tallies[:, lanes].copy()
        batch.step(rows, ticks=block)
        ball, now = batch.state["ball"][:, 0], (start + block) / RATE
        outlane |= (batch.tallies[:, lanes] > before).any(axis=1)
        outlane[(ball["id"] > 0) & (ball["x"] > -4.2)] = False  # a ball may come up again
        seconds[(ball["id"] == 0) & np.isnan(seconds)] = now
        at = np.stack([ball["x"], ball["z"]], axis=1)
        moved = (np.hypot(*(at - place).T) > 0.5) | (now < charge + 0.1) | (ball["id"] == 0)
        place[moved], since[moved] = at[moved], now
        longest = max(longest, float((now - since).max()))
        if not np.isnan(seconds).any():
            break
    return Drains(seconds - charge, outlane, longest)


def test_an_unplayed_ball_lasts_for_8_to_15_s_and_nothing_holds_it():
    idle = drains(is_random=False)
    assert 8.0 < idle.seconds.mean() < 15.0
    assert 0.2 < idle.outlane.mean() < 0.6
    assert idle.longest_stay < 5.0


def test_balls_of_random_play_are_lost_in_the_middle_and_in_the_outlanes():
    random = drains(is_random=True)  # by the rules of the table: tests/unit/metrics/test_game_marks.py
    assert not np.isnan(random.seconds).any()
    assert 0.4 < random.outlane.mean() < 0.7


# --- Where the table brings a ball by itself


@pytest.mark.parametrize("side", ["left", "right"])
def test_an_inlane_feeds_its_paddle(side: str):
    world = falling(-4.0, MIDDLE + 3.25 * OUTWARD[side], 1.0)
    seen = events_until(world, lambda name: name.startswith("paddle"))
    assert f"{side} inlane" in seen
    assert seen[-1] == f"paddle.{side}"


def test_a_ball_from_the_ramp_comes_down_the_left_inlane_to_the_paddle():
    world = sb.World(TABLE, seed=1, tick_rate=RATE)
    world.create_ball(position=(-1.0, -2.0), velocity=(28.0, -3.0))
    seen = events_until(world, lambda name: name.startswith("paddle"))
    stations = [
        "mouth of the ramp",
        "ramp",
        "top of the ramp",
        "end of the ramp",
        "left inlane",
        "paddle.left",
    ]
    met = [name for name in seen if name in stations]
    assert list(dict.fromkeys(met)) == stations  # its end catches a ball and lets it go


@pytest.mark.parametrize("seed", range(10))
def test_the_saucer_sends_a_ball_to_the_left_paddle(seed: int):
    world = sb.World(TABLE, seed=seed, tick_rate=RATE)
    world.create_ball(position=(0.8, 1.02), velocity=(9.0, 0.0))
    seen = events_until(world, lambda name: name.startswith("paddle"))
    assert seen == ["saucer", "saucer", "paddle.left"]  # caught, released, on the paddle


def events_until(world: sb.World, is_last: Callable[[str], bool]) -> list[str]:
    """The parts that a ball meets without a press, up to one that is the last."""
    seen: list[str] = []
    for _ in range(20 * RATE):
        world.step()
        for event in world.events:
            is_met = event.kind in ("hit", "pass", "captured", "released")
            if is_met or (event.kind == "touch" and event.part.startswith("paddle")):
                seen += named_parts((event.part,))
                if is_last(seen[-1]):
                    return seen
    raise AssertionError(seen)


# --- Shots from a ball that was held on a raised paddle, which is dropped


SHOTS = {
    "left": [
        "right orbit",
        "side target",
        "saucer",
        "left drop target",
        "middle drop target",
        "right drop target",
    ],
    "right": ["left orbit", "spinner", "ramp", "left target"],
}


@pytest.mark.parametrize("side", ["left", "right"])
def test_every_shot_is_made_and_forgives_a_tick_early_or_late(side: str):
    world, count = with_a_cradled_ball(side), 250
    batch = batch_of(world, count)
    names, press = named_parts(batch.boards.names[0]), np.arange(count)
    column = {name: number for number, name in enumerate(names)}
    paddles = [column["paddle.left"], column["paddle.right"]]
    when = {name: np.full(count, 10**6) for name in column}
    struck, over = np.zeros(count, np.bool_), np.zeros(count, np.bool_)

    def buttons(tick: int) -> NDArray[np.bool_]:
        return held(**{side: (tick >= press) & (tick < press + 84)}, count=count)

    for tick, met in played(batch, count + 3 * RATE, buttons):
        ball = batch.state["ball"][:, 0]
        over |= struck & met[:, paddles].any(axis=1)
        struck |= (tick >= press) & (ball["x"] > -4.5) & (ball["vx"] > 5.0)
        for name, number in column.items():
            new = met[:, number] & struck & ~over
            when[name][new] = np.minimum(when[name][new], tick)
    round_left, round_right = when["left orbit switch"], when["right orbit switch"]
    made = {name: at < 10**6 for name, at in when.items()}
    made["left orbit"] = made["right orbit switch"] & (round_left < round_right)
    made["right orbit"] = made["left orbit switch"] & (round_right < round_left)
    for shot in SHOTS[side]:
        safe = made[shot][:-2] & made[shot][1:-1] & made[shot][2:]
        assert safe.any(), (shot, int(made[shot].sum()))


# --- Techniques


def test_live_catch():
    """A button pressed 80 ms before a ball arrives: the paddle has just stopped, and the ball stays on it."""
    catches = [caught(falling(-3.0, -1.88, 6.0), "left", press) for press in range(74, 80)]
    assert all(is_cradled for is_cradled, _ in catches)
    assert max(rebound for _, rebound in catches) < 5.0
    is_cradled, rebound = caught(falling(-3.0, -1.88, 6.0), "left", 108)  # too late: it is a shot
    assert not is_cradled
    assert rebound > 30.0


def caught(world: sb.World, side: str, press: int, release: int = 0, again: int = 0) -> tuple[bool, float]:
    """Press a button in tick `press` and hold it, but between `release` and `again`.

    Returns:
        Whether the ball is cradled after 5 s, and its greatest speed up the table within 0.2 s of meeting the
        paddle [u/s].
    """
    met, rebound = 0, 0.0
    for tick in range(5 * RATE):
        world.step(**{side: tick >= press and not release <= tick < again})
        met = met or tick * any(event.part == f"paddle.{side}" for event in world.events)
        if met and tick < met + 48 and world.balls:
            rebound = max(rebound, world.balls[0].velocity[0])
    return bool(cradled(np.array([world.records[0]]), side)[0]), rebound


def test_drop_catch():
    """A paddle that is let go as the ball arrives takes its speed."""
    for release in range(54, 59):
        is_cradled, rebound = caught(raised(), "left", 0, release, release + 40)
        assert is_cradled
        assert rebound < 3.6
    assert caught(raised(), "left", 0)[1] > 5.0  # a paddle that is held throws it back


def raised() -> sb.World:
    """A world with a raised left paddle and a fast ball that falls on it."""
    world = sb.World(TABLE, seed=1, tick_rate=RATE)
    world.step(left=True, ticks=72)
    world.create_ball(position=(-3.0, -1.68), velocity=(-12.0, 0.0))
    return world


def test_dead_bounce():
    """A ball that falls on a resting paddle bounces across, and the other paddle holds it."""
    worlds = [falling(-3.0, z, 2.0) for z in np.linspace(0.025, 0.525, 6).tolist()]
    batch, count = batch_of(worlds, len(worlds)), len(worlds)
    names = batch.boards.names[0]
    left, right = names.index("paddle.left"), names.index("paddle.right")
    bounced = np.full(count, 10**6)

    def buttons(tick: int) -> NDArray[np.bool_]:
        return held(left=tick >= bounced + 96, count=count)  # 0.4 s after the bounce

    for tick, met in played(batch, 5 * RATE, buttons):
        bounced[(bounced == 10**6) & met[:, right]] = tick
    assert cradled(batch.state, "left").all()
    assert (batch.tallies[:, right] == 1).all()
    assert (batch.tallies[:, left] > 0).all()


def test_tip_pass():
    """A short press while the ball rolls down a dropped paddle tips it over to the other one."""
    world, press = with_a_cradled_ball("left"), np.arange(78, 83, 2)
    batch, count = batch_of(world, len(press)), len(press)

    def buttons(tick: int) -> NDArray[np.bool_]:
        left = (tick >= press) & (tick < press + 10)  # 42 ms of a stroke of 67 ms
        return held(left=left, right=tick >= press + 10, count=count)

    highest = max(float(batch.state["ball"]["x"][:, 0].max()) for _ in played(batch, 4 * RATE, buttons))
    assert cradled(batch.state, "right").all()
    assert highest < -5.0  # it stays between the paddles


def test_post_pass():
    """A tap of 25 ms sends a ball low across, to the end of the other slingshot and onto the other paddle."""
    world, press = with_a_cradled_ball("left"), np.arange(129, 134)
    batch, count = batch_of(world, len(press)), len(press)
    slingshot = named_parts(batch.boards.names[0]).index("right slingshot")
    before = batch.tallies[:, slingshot].copy()

    def buttons(tick: int) -> NDArray[np.bool_]:
        left = (tick >= press) & (tick < press + 6)
        return held(left=left, right=tick >= press + 60, count=count)

    for crossing in played(batch, 5 * RATE, buttons):
        if crossing.tick > press[-1]:
            assert batch.state["ball"]["x"][:, 0].max() < -5.0  # it stays between the paddles
    assert (batch.tallies[:, slingshot] > before).all()
    assert cradled(batch.state, "right").all()
