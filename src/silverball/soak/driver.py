"""Random play for the soak: which buttons are held, and when balls are created, kicked and shoved.

As many balls as the table allows are kept on the board. Buttons are held for random times, sometimes for only
a tick or two, that of the plungers too; held gates open and close; balls are shoved; and in *wild* worlds a
ball gets a random velocity about once a second. A *quiet* world presses nothing for `QUIET` seconds, then
plays for `LIVELY` seconds, so that a ball that lies somewhere forever is found.

Everything random is a function of the world's seed and a counter, so one world can be run again alone. What
is done in a tick is an ACTION record, which can be written to a file and replayed without this module.
"""

from __future__ import annotations

from math import pi
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from silverball.physics.balls import create_ball
from silverball.physics.event_log import clear_log
from silverball.physics.for_devices import switches_off
from silverball.physics.kernel import kernel
from silverball.physics.portable_math import sine_cosine, uniform
from silverball.physics.records import (
    JITTER,
    MAX_BALLS,
    NUDGE_LEFT,
    NUDGE_RIGHT,
    NUDGE_UP,
    BoardGeometry,
    BoardRecord,
    Colliders,
    LogRecord,
    Motion,
    Places,
    WorldRecord,
    records,
)
from silverball.physics.switches import set_switch
from silverball.players.simple import launch_bit

SOAK_KEY = 0x50A4  # makes these random numbers independent of the world's
# All of the following are chosen.
HOLDS = (0.02, 0.06, 0.2, 0.8)  # [s] times of a press or a release, equally likely
BOTH_SHARE = 0.2  # share of presses of both buttons at once
KICK_EVERY = 2.0  # [s] longest time between two random velocities of a ball; half of it on average
CAP_SHARE = 0.25  # share of kicks as fast as the cap
SHOVES = (JITTER, NUDGE_LEFT, NUDGE_RIGHT, NUDGE_UP)  # of `action.shove` 1, 2, 3, 4
SHOVE_EVERY = 4.0  # [s] longest time between two shoves
GATES_EVERY = 2.0  # [s] longest time between two moves of the gates
QUIET, LIVELY = 75.0, 25.0  # [s]
RETRY = 0.25  # [s] between two attempts to create a ball: a crowded board may have no free place

ACTION = np.dtype(
    [
        ("left", "i8"), ("right", "i8"), ("shove", "i8"), ("launch", "i8"),  # buttons, 0 or 1
        ("gates", "i8"),  # whether all held gates open, or close if one is open
        ("create", "i8"),  # whether to create a ball
        ("kick", "i8", (MAX_BALLS,)),  # whether the ball in the slot gets this velocity [u/s]
        ("vx", "f8", (MAX_BALLS,)), ("vz", "f8", (MAX_BALLS,)),
    ],
    align=True,
)  # fmt: skip
"""What is done to a world. A shove of 1 is the jitter, one above it a nudge: left, right, up."""

ActionRecord: TypeAlias = Any  # an ACTION record

DRIVER = np.dtype(
    [
        ("draws", "i8"),  # random numbers used
        # The first ticks at which these may change: the buttons (left, right), a shove, a kick, a creation,
        # the launch button, the gates.
        ("press_at", "i8", (2,)), ("shove_at", "i8"), ("kick_at", "i8", (MAX_BALLS,)),
        ("create_at", "i8"), ("launch_at", "i8"), ("gates_at", "i8"),
    ],
    align=True,
)  # fmt: skip
DriverRecord: TypeAlias = Any  # a DRIVER record


class Drivers(NamedTuple):
    """What drives the worlds of a batch.

    Attributes:
        states: DRIVER records [world].
        actions: ACTION records [world]: what was last done to each world.
        wild: Whether balls get random velocities, bool [world].
        places: The squares of all boards in which balls are created.
    """

    states: NDArray[Any]
    actions: NDArray[Any]
    wild: NDArray[np.bool_]
    places: NDArray[Any]

    @classmethod
    def of(cls, wild: NDArray[np.bool_], places: NDArray[Any]) -> Drivers:
        """The drivers of worlds at their beginning, one for each element of `wild`."""
        return cls(records(len(wild), DRIVER), records(len(wild), ACTION), wild, places)


@kernel
def next_random(world: WorldRecord, driver: DriverRecord) -> float:
    """The next of the soak's random numbers of a world, in [0, 1)."""
    driver.draws += 1
    return uniform(world.seed ^ SOAK_KEY, driver.draws)


@kernel
def choose_action(
    world: WorldRecord,
    board: BoardRecord,
    driver: DriverRecord,
    action: ActionRecord,
    tick: float,
    wild: bool,
) -> None:
    """Choose the action of a world before and in its next tick, of length `tick` [s]."""
    now, balls = world.tick, 0
    action.shove = 0
    is_active = wild or now * tick % (QUIET + LIVELY) >= QUIET
    choose_devices(world, board, driver, action, tick, is_active)
    for side in range(2):
        if is_active and now >= driver.press_at[side]:
            down = 1 if next_random(world, driver) < 0.5 else 0
            hold = HOLDS[int(next_random(world, driver) * len(HOLDS))] * (0.5 + next_random(world, driver))
            both = next_random(world, driver) < BOTH_SHARE
            if side == 0 or both:
                action.left, driver.press_at[0] = down, now + 1 + int(hold / tick)
            if side == 1 or both:
                action.right, driver.press_at[1] = down, now + 1 + int(hold / tick)
    if not is_active:
        action.left, action.right = 0, 0
    elif now >= driver.shove_at:
        action.shove = 1 if board.nudge == 0.0 else 1 + int(next_random(world, driver) * len(SHOVES))
        driver.shove_at = now + 1 + int(next_random(world, driver) * SHOVE_EVERY / tick)
    for slot in range(board.max_balls):
        action.kick[slot] = 0
        if world.ball[slot].id == 0:
            continue
        balls += 1
        if world.ball[slot].motion == Motion.CAPTURED:
            continue
        if wild and now >= driver.kick_at[slot]:
            driver.kick_at[slot] = now + 1 + int(next_random(world, driver) * KICK_EVERY / tick)
            speed = board.speed_cap
            if next_random(world, driver) >= CAP_SHARE:
                speed *= next_random(world, driver)
            sine, cosine = sine_cosine(2.0 * pi * next_random(world, driver))
            action.kick[slot], action.vx[slot], action.vz[slot] = 1, speed * sine, speed * cosine
    action.create = 0
    if balls < board.max_balls and now >= driver.create_at:
        action.create = 1
        driver.create_at = now + 1 + int(RETRY / tick)


@kernel
def choose_devices(
    world: WorldRecord,
    board: BoardRecord,
    driver: DriverRecord,
    action: ActionRecord,
    tick: float,
    active: bool,
) -> None:
    """Choose whether the launch button is held in the next tick, and whether gates move before it."""
    now = world.tick
    if not active:
        action.launch = 1 if launch_bit(world, board, tick) != 0 else 0
    elif board.plungers != 0 and now >= driver.launch_at:
        action.launch = 1 if next_random(world, driver) < 0.5 else 0
        hold = HOLDS[int(next_random(world, driver) * len(HOLDS))] * (0.5 + next_random(world, driver))
        driver.launch_at = now + 1 + int(hold / tick)
    action.gates = 0
    if active and now >= driver.gates_at and gate_switches(board) != 0:
        action.gates = 1
        driver.gates_at = now + 1 + int(next_random(world, driver) * GATES_EVERY / tick)


@kernel
def gate_switches(board: BoardRecord) -> int:
    """The switches of the held gates of a board: all but those of drop targets."""
    switches = board.switches
    for bank in range(board.banks):
        switches &= ~board.bank_switches[bank]
    return int(switches)


@kernel
def move_gates(world: WorldRecord, geometry: BoardGeometry, action: ActionRecord) -> None:
    """Open all held gates, or close them if one is open, if the action says so."""
    if action.gates != 0:
        gates = gate_switches(geometry.board)
        set_switch(world, geometry, gates, switches_off(world) & gates == 0)


@kernel
def apply_action(
    world: WorldRecord,
    board: BoardRecord,
    colliders: Colliders,
    places: Places,
    log: LogRecord,
    action: ActionRecord,
) -> None:
    """Apply the part of an action that comes before the tick: new velocities and a new ball."""
    clear_log(log)
    for slot in range(board.max_balls):
        if action.kick[slot] != 0 and world.ball[slot].id != 0:
            world.ball[slot].vx, world.ball[slot].vz = action.vx[slot], action.vz[slot]
    if action.create != 0:
        create_ball(world, board, colliders, places, log)
