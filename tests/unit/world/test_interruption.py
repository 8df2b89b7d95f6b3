"""Ctrl-C in a long step: it ends soon, with all worlds at the end of one and the same tick."""

from __future__ import annotations

import signal
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import silverball as sb
from silverball.physics.records import LOG
from silverball.world import batch as batches, threads, world as worlds

FOREVER = 2**40  # ticks, which no machine plays while the tests run


class StopError(Exception):
    """What the handler of these tests raises."""


@pytest.fixture
def in_a_moment(monkeypatch):
    """Sends a signal to the main thread a little later; who ignores Ctrl-C hears this one."""

    def raise_it(number, frame):
        raise StopError

    before = signal.signal(signal.SIGINT, raise_it)
    timers = []

    def begin(seconds: float) -> None:
        timers.append(threading.Timer(seconds, lambda: signal.raise_signal(signal.SIGINT)))
        timers[-1].start()

    yield begin
    for timer in timers:
        timer.cancel()
        timer.join()
    signal.signal(signal.SIGINT, before)


def begun(seed: int = 8) -> sb.World:
    """Two balls on a board on which they stay for long while the left paddle is held."""
    world = sb.World("random", seed=seed)
    world.create_ball()
    world.create_ball()
    world.step(left=True, ticks=10)
    return world


def logged(batch: sb.WorldBatch) -> dict[str, bytes]:
    """What the logs say; the rest of a log is scratch, which all worlds that one thread steps share."""
    names = LOG.names[: LOG.names.index("sweep")]
    return {name: batch.logs[name].tobytes() for name in names}


def fields(world: sb.World) -> tuple[object, ...]:
    return world.digest(), world.events, world.events_lost, world.hits


@pytest.mark.parametrize("seconds", [0.05, 0.2, 0.4])
def test_a_world_stops_at_the_end_of_a_tick_and_goes_on_as_if_nothing_had_been(in_a_moment, seconds):
    world, other = begun(), begun()
    in_a_moment(seconds)
    with pytest.raises(StopError):
        world.step(left=True, ticks=FOREVER)
    assert 10 <= world.tick < FOREVER
    other.step(left=True, ticks=world.tick - 10)
    assert fields(world) == fields(other)
    world.step(right=True, ticks=100)
    other.step(right=True, ticks=100)
    assert fields(world) == fields(other)


@pytest.mark.parametrize("count", [1, 7, 500])
@pytest.mark.parametrize("number", [1, 2, 3])
def test_a_batch_stops_with_all_worlds_at_the_end_of_the_same_tick(in_a_moment, count, number):
    batch, other = (sb.WorldBatch("classic", count, seed=5, threads=number) for _ in range(2))
    held = np.zeros((count, 3), np.bool_)
    held[::2, 0] = held[::3, 2] = True
    for one in (batch, other):
        one.create_balls()
        one.step(held, ticks=1)
    in_a_moment(0.2)
    with pytest.raises(StopError):
        batch.step(held, ticks=FOREVER)
    ticks = set(batch.state["tick"].tolist())
    assert len(ticks) == 1
    other.step(held, ticks=ticks.pop() - 1)
    assert batch.digests() == other.digests()
    assert logged(batch) == logged(other)
    assert (batch.tallies == other.tallies).all()


@pytest.mark.parametrize("piece", [1, 3, 7, 50])
def test_pieces_of_a_step_are_the_step_bit_for_bit(monkeypatch, piece):
    whole, parted = begun(), begun()
    for ticks in (600, 4_000, piece, 2 * piece):
        whole.step(left=True, jitter=ticks < 600, ticks=ticks)
        with monkeypatch.context() as patch:
            patch.setattr(worlds, "CHUNK_TICKS", piece)
            parted.step(left=True, jitter=ticks < 600, ticks=ticks)
        assert fields(whole) == fields(parted)
        if ticks == 4_000:
            assert whole.events_lost > 0, (
                "nothing was lost, so this does not show that a full log is the same"
            )


@pytest.mark.parametrize("rows", ["held", "one for every tick"])
@pytest.mark.parametrize("piece", [1, 40, 900])
def test_pieces_of_a_step_of_a_batch_are_the_step_bit_for_bit(monkeypatch, rows, piece):
    ticks, count = 300, 12
    actions = np.random.default_rng(1).random((ticks, count, 3)) < 0.2
    if rows == "held":
        actions = actions[0]
    whole, parted = (sb.WorldBatch("random", count, seed=8, threads=2) for _ in range(2))
    for batch in (whole, parted):
        batch.create_balls()
    whole.step(actions, ticks)
    monkeypatch.setattr(batches, "CHUNK", piece)
    parted.step(actions, ticks)
    assert whole.state.tobytes() == parted.state.tobytes()
    assert logged(whole) == logged(parted)
    assert (whole.tallies == parted.tallies).all()


def test_a_world_that_stopped_with_a_fault_says_so_at_once_however_long_the_step():
    world = begun()
    world.records[0]["fault"] = 1
    with pytest.raises(sb.FaultError):
        world.step(ticks=FOREVER)


def test_every_slice_is_done_once_when_an_interruption_comes_at_any_point(monkeypatch):
    """An exception at each call that hands out work, in turn: as a signal's handler would raise it there."""
    for point in range(6):
        calls = iter(range(100))
        done: list[tuple[int, int]] = []

        class Pool:
            def submit(self, work, calls=calls, point=point):
                number = next(calls)
                if number == point:
                    raise StopError
                pool.submit(work)
                if number == point - 1:
                    raise StopError

        failing, slices = Pool(), [(first, first + 1) for first in range(9)]
        with ThreadPoolExecutor(2) as pool, monkeypatch.context() as patch:
            patch.setattr(threads, "thread_pool", lambda _, failing=failing: failing)
            try:
                threads.run_on_threads(lambda *slice_, done=done: done.append(slice_), slices, 3)
            except StopError:
                assert point < 4
        assert sorted(slice_ for slice_ in done if slice_ != (0, 0)) == slices


def test_the_error_of_a_slice_is_raised_when_all_are_done():
    done = []

    def task(first: int, end: int) -> None:
        if first == 2:
            raise ZeroDivisionError
        done.append(first)

    with pytest.raises(ZeroDivisionError):
        threads.run_on_threads(task, [(first, first + 1) for first in range(6)], 2)
    assert sorted(done) == [0, 0, 1, 3, 4, 5]
