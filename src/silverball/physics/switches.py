"""Colliders that come and go: drop targets, which fall and come back as a bank, and gates."""

from __future__ import annotations

from silverball.physics.due_times import later
from silverball.physics.event_log import log_part_event
from silverball.physics.flight import state_at
from silverball.physics.for_devices import for_devices
from silverball.physics.kernel import as_int, internal, kernel
from silverball.physics.motion import search_from
from silverball.physics.records import (
    BoardGeometry,
    BoardRecord,
    ColliderRecord,
    EventKind,
    Lane,
    Motion,
    WorldRecord,
)
from silverball.physics.shapes import distance
from silverball.physics.tolerances import FREE_GAP


@for_devices(lambda lane, geometry, c, time, tick: None)
@internal
def drop_target(lane: Lane, geometry: BoardGeometry, c: ColliderRecord, time: float, tick: float) -> None:
    """Let a drop target fall, and set the clock of its bank if it was the last one."""
    world, board = lane.world, geometry.board
    change_switches(world, board, world.off | c.switch, time)
    mask = board.bank_switches[c.number]
    if world.off & mask == mask:
        world.banks_due |= 1 << c.number
        due, offset = later(world.tick, time + board.bank_time[c.number], tick)
        world.bank_tick[c.number], world.bank_offset[c.number] = due, offset


@internal
def reset_bank(lane: Lane, geometry: BoardGeometry, number: int, time: float) -> None:
    """Let a bank come back; if a ball is in the way, it is tried again in the next tick."""
    world, board = lane.world, geometry.board
    mask = board.bank_switches[number]
    if not is_free_of_balls(world, geometry, mask, time):
        world.bank_tick[number], world.bank_offset[number] = world.tick + 1, 0.0
        return
    world.banks_due &= ~(1 << number)
    change_switches(world, board, world.off & ~mask, time)
    for index in range(board.collider_first + board.shape_first, board.collider_end):
        c = geometry.colliders[index]
        if c.switch & mask != 0:
            log_part_event(lane.log, as_int(EventKind.RESET), c, world.tick, time)


@for_devices(lambda world, geometry, switches, is_away: False)
@kernel
def set_switch(world: WorldRecord, geometry: BoardGeometry, switches: int, is_away: bool) -> bool:
    """Open or close gates between two ticks.

    Returns:
        Whether they are open or closed now as wanted; they do not close on a ball.
    """
    if is_away:
        change_switches(world, geometry.board, world.off | switches, 0.0)
        return True
    if not is_free_of_balls(world, geometry, switches, 0.0):
        return False
    change_switches(world, geometry.board, world.off & ~switches, 0.0)
    return True


@internal
def change_switches(world: WorldRecord, board: BoardRecord, off: int, time: float) -> None:
    """Set which colliders are away, from a time of the tick [s] on."""
    world.off = off
    for slot in range(board.max_balls):
        ball = world.ball[slot]
        if ball.id != 0 and ball.motion != Motion.CAPTURED:
            search_from(ball, ball.age + time)


@kernel
def is_free_of_balls(world: WorldRecord, geometry: BoardGeometry, switches: int, time: float) -> bool:
    """Whether no ball overlaps a collider with one of these switches at a time of the tick [s]."""
    board = geometry.board
    for index in range(board.collider_first + board.shape_first, board.collider_end):
        c = geometry.colliders[index]
        if c.switch & switches == 0:
            continue
        for slot in range(board.max_balls):
            ball = world.ball[slot]
            if ball.id != 0 and c.levels >> ball.level & 1 != 0:
                at = state_at(ball, ball.age + time)
                gap, _, _ = distance(c, at.x, at.z)
                if gap < board.ball_radius + FREE_GAP:
                    return False
    return True
