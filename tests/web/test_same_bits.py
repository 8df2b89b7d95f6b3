"""The shipped WebAssembly module plays every game to the same bits as Python: state, tallies and events."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator

import numpy as np
import pytest

from golden.make_digests import digest, read
from scenes import ALL_PARTS, BEAT, SCENES, Scene, batch_of, generated, rolling
from silverball.soak.part_boards import part_table
from silverball.world import WorldBatch
from wasm_worlds import MISSING, WasmWorld, events_of

pytestmark = pytest.mark.skipif(bool(MISSING), reason=MISSING)

GOLDEN = read()
SECONDS, LONG_SECONDS = 10, 60
BOARDS, MANY_BOARDS = 4, 100


def tables_of(number: int):
    """A random board: with sliding balls, with rolling ones, or of all kinds of parts."""
    return (generated, rolling, part_table)[number % 3](5000 + number)


def board_scene(number: int, seconds: int) -> Scene:
    rate = (240, 60, 977)[number // 3 % 3]
    ticks = seconds * rate // BEAT * BEAT
    return Scene(f"board {number}", lambda: tables_of(number), number, rate, ticks, launch=0.5)


def play_both(scene: Scene) -> WasmWorld:
    """Play a scene in Python and in the module; they must agree after every beat."""
    batch = batch_of([scene])
    other = WasmWorld(batch)
    for start, (left, right, jitter, launch) in zip(
        range(0, scene.ticks, BEAT), scene.buttons()[::BEAT].tolist(), strict=True
    ):
        assert other.create_ball() == batch.create_balls()[0]
        other.step(left | 2 * right | 4 * jitter | 8 * launch, BEAT)
        batch.step(np.array([[left, right, jitter, launch]]), BEAT)
        end = f"{scene.name}, tick {start + BEAT}"
        assert other.state == batch.state.tobytes(), end
        assert other.events == events_of(batch.logs[0]), end
    assert other.tallies == batch.tallies.tobytes()
    return other


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.name)
def test_a_golden_scene_comes_to_its_digest(scene):
    world = scene.world()
    world._batch.state[:] = np.frombuffer(play_both(scene).state, world._batch.state.dtype)
    assert digest(world, GOLDEN.since[scene.name]) == GOLDEN.digests[scene.name]


@pytest.mark.parametrize("scene", ALL_PARTS, ids=lambda scene: scene.name)
def test_a_board_of_all_parts_plays_the_same(scene):
    play_both(scene)


@pytest.mark.parametrize("number", range(BOARDS))
def test_a_random_board_plays_the_same(number):
    play_both(board_scene(number, SECONDS))


@pytest.mark.campaign
@pytest.mark.parametrize("number", range(MANY_BOARDS))
def test_many_random_boards_play_the_same_for_a_minute(number):
    play_both(board_scene(number, LONG_SECONDS))


SOAKED, CALL, LOOK = 1_000_000, 250, 20_000  # ticks of a board, of a call, and between two looks


@pytest.mark.campaign
@pytest.mark.parametrize("number", range(MANY_BOARDS))
def test_a_hundred_million_ticks_come_to_the_same_digests(number):
    """A million on each of a hundred boards."""
    batch = WorldBatch(tables_of(number), 1, number, 240, threads=1)
    other, rng = WasmWorld(batch), np.random.default_rng(number)
    for start in range(0, SOAKED, LOOK):
        for _ in range(LOOK // CALL):
            if other.create_ball() != batch.create_balls()[0]:
                raise AssertionError(f"tick {start}: only one of them has room for a ball")
            left, right, jitter, launch = (rng.random(4) < (0.3, 0.3, 0.02, 0.5)).tolist()
            other.step(left | 2 * right | 4 * jitter | 8 * launch, CALL)
            batch.step(np.array([[left, right, jitter, launch]]), CALL)
        assert hashlib.sha256(other.state).digest() == hashlib.sha256(batch.state.tobytes()).digest(), start
    assert other.tallies == batch.tallies.tobytes()


STRANGE = (np.nan, np.inf, -np.inf, 0.0, -0.0, 5e-324, 1e308, -1e308, 1e19, -9.3e18, 1.0, -3.0)


def words_of(layout: np.dtype, at: int = 0) -> Iterator[tuple[int, str]]:
    """The place of every word of a record, and whether it is a float ("f") or an integer ("i")."""
    for name in layout.names or ():
        field, start = layout.fields[name][:2]
        base, shape = field.subdtype or (field, ())
        for number in range(int(np.prod(shape))):
            place = at + start + number * base.itemsize
            if base.names:
                yield from words_of(base, place)
            else:
                yield place // 8, base.kind


def spoil(state: np.ndarray, rng: np.random.Generator) -> None:
    """Write nonsense into one to three words of a world record."""
    places = list(words_of(state.dtype))
    floats, whole = state.view(np.float64).reshape(-1), state.view(np.int64).reshape(-1)
    for _ in range(rng.integers(1, 4)):
        word, kind = places[rng.integers(len(places))]
        if kind == "i":
            whole[word] = rng.integers(-4, 70) if rng.random() < 0.7 else rng.integers(-(2**63), 2**63 - 1)
        elif rng.random() < 0.5:
            floats[word] = rng.choice(STRANGE)
        else:
            floats[word] *= 1 + rng.normal() * 10.0 ** -rng.integers(0, 12)


def without_nan_bits(state: bytes, layout: np.dtype) -> bytes:
    """A state in which all NaNs are one: which bits a NaN has depends on the processor."""
    words = np.frombuffer(state, np.int64).copy()
    floats = words.view(np.float64)
    for word, kind in words_of(layout):
        if kind == "f" and np.isnan(floats[word]):
            floats[word] = np.nan
    return words.tobytes()


def play_spoilt(table, count: int) -> None:
    batch = WorldBatch(table, 1, 1, threads=1)
    other, rng, faults = WasmWorld(batch), np.random.default_rng(3), set()
    for _ in range(6):
        batch.create_balls()
        batch.step(rng.random((1, 4)) < 0.3, 60)
    state, log = batch.state.copy(), batch.logs.copy()
    for _ in range(count):
        batch.state[:], batch.logs[:] = state, log
        spoil(batch.state, rng)
        spoilt = batch.state.tobytes()
        other.machine.memory.write(other.machine.store, spoilt, other.at["world"])
        other.machine.memory.write(other.machine.store, log.tobytes(), other.at["log"])
        with np.errstate(all="ignore"):
            batch.step(np.ones((1, 3), np.bool_), 3)
        other.step(1 | 2 | 4, 3)
        layout = batch.state.dtype
        assert without_nan_bits(other.state, layout) == without_nan_bits(batch.state.tobytes(), layout), (
            spoilt.hex()
        )
        faults.add(int(batch.state["fault"][0]))
    assert len(faults) > 3


@pytest.mark.parametrize("name", ["classic", "rolling", "parts"])
def test_spoilt_states_end_in_the_same_faults(name):
    play_spoilt(name, 400)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["classic", "rolling", "parts"])
def test_many_spoilt_states_end_in_the_same_faults(name):
    play_spoilt(name, 10_000)
