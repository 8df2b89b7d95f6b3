"""States of devices that nobody could have played: no crash, and a named fault or a possible state."""

from __future__ import annotations

import numpy as np
import pytest

from device_boards import everything, play
from silverball.errors import StateError
from silverball.physics.records import MAX_LEVELS, Fault, Motion
from silverball.world import World, WorldBatch

BALL_WHOLES = ("level", "holder", "due_tick", "passed_row", "solid_row", "motion", "contact_row")
BALL_NUMBERS = ("due_offset", "search_age", "passed_age", "solid_age")
WORLD_WHOLES = ("off", "next_clock", "launch_held", "banks_due")
WHOLES = (-(2**62), -9, -1, 0, 1, 2, 3, 4, 5, 8, 14, 63, 1000, 2**31, 2**62)
NUMBERS = (float("nan"), float("inf"), -1.0, 0.0, 1e-9, 0.01, 0.5, 3.0, 1e9, 1e300)


@pytest.fixture(scope="module")
def states() -> tuple[World, list[bytes]]:
    """A world with all devices, and what it was like at several moments."""
    world, rng, found = World(everything(), 5, 60), np.random.default_rng(0), []
    for tick in range(600):
        play(world, tick, rng)
        if tick % 15 == 14:
            found.append(world.save())
    return world, found


def forge(record, rng: np.random.Generator) -> None:
    """Write one to three values into the devices of a world or into its balls."""
    for _ in range(rng.integers(1, 4)):
        whole, number = int(rng.choice(WHOLES)), float(rng.choice(NUMBERS))
        match rng.integers(5):
            case 0:
                record["ball"][str(rng.choice(BALL_WHOLES))][rng.integers(5)] = whole
            case 1:
                record["ball"][str(rng.choice(BALL_NUMBERS))][rng.integers(5)] = number
            case 2:
                record[str(rng.choice(WORLD_WHOLES))] = whole
            case 3:
                name = str(rng.choice(("angle", "speed", "tick", "offset", "turns")))
                record["spinner"][name][0] = whole if name in ("tick", "turns") else number
            case _:
                record["bank_tick"][0], record["bank_offset"][0] = whole, number


def test_a_forged_state_stops_with_a_name_or_plays_on_as_a_possible_one(states) -> None:
    world, found = states
    rng = np.random.default_rng(1)
    batch = WorldBatch(everything(), 400, 5, 60)
    for index in range(len(batch)):
        world.restore(found[index % len(found)])
        batch.state[index] = world.records[0]
        forge(batch.state[index], rng)
    for _ in range(30):
        batch.step(rng.random((400, 4)) < (0.3, 0.3, 0.02, 0.8), 4)
    state = batch.state
    assert np.isin(state["fault"], list(Fault)).all()
    playing = state[state["fault"] == Fault.NONE]
    assert len(playing) > 200
    balls = playing["ball"][playing["ball"]["id"] != 0]
    assert np.isfinite([balls["x"], balls["z"], balls["vx"], balls["vz"]]).all()
    assert ((balls["level"] >= 0) & (balls["level"] < MAX_LEVELS)).all()
    assert np.isin(balls["motion"], (Motion.SLIDING, Motion.CAPTURED)).all()
    assert not (playing["off"] & ~batch.boards.board["switches"][0]).any()
    assert np.isfinite(playing["spinner"]["angle"][:, 0]).all()


def test_a_forged_state_is_refused_or_restored(states) -> None:
    world, found = states
    rng = np.random.default_rng(2)
    other = World(everything(), 5, 60)
    refused = 0
    for index in range(300):
        world.restore(found[index % len(found)])
        forge(world.records[0], rng)
        try:
            other.restore(world.save())
        except StateError:
            refused += 1
            continue
        other.step(ticks=10)
    assert 0 < refused < 250
