"""Speed of the drawing: time to the first and to the best picture of a board, and frames per second.

Pictures are cached in a temporary folder, so the cache is empty at the start. The code is compiled before the
measurement, since that happens only at the first start on a machine.
"""

from __future__ import annotations

import statistics
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from silverball.benchmarks.speed import Figure
from silverball.drawing import Moment, Renderer, best_size
from silverball.drawing.picture_cache import PictureCache
from silverball.drawing.sketch import rgb_surface
from silverball.errors import NoRoom
from silverball.table import Table, generate_table, load_table
from silverball.world import World

HEIGHT = 1152  # [pixel] of the picture
FRAMES = 240  # of a game, drawn in every round
FRAME_RATE = 60
TICK_RATE = 240
SEEDS = (11, 12)


def measure_drawing(rounds: int, advance: Callable[[str], None] = lambda _: None) -> list[Figure]:
    """Measure everything, baking once; `advance` is called with the name of what is measured next."""
    from silverball.drawing.warm_up import compile_all

    advance("loading compiled code")
    compile_all()
    recipe = load_table("random")
    first, second = (generate_table(seed, recipe) for seed in SEEDS)
    size = best_size(first.board, HEIGHT)
    with tempfile.TemporaryDirectory() as folder:
        cache = PictureCache(Path(folder))
        advance("a sketch")
        figures = [Figure("first picture of an unknown board", _first_picture(first, size, rounds), "s")]
        advance("baking a board")
        figures.append(
            Figure("best picture of an unknown board", _seconds(lambda: _bake(first, size, cache)), "s")
        )
        advance("baking an empty board and paddles")
        renderer = _bake(first, size, cache)
        assert renderer._provider is not None
        provider = renderer._provider
        figures.append(Figure("all angles of the paddles, once", _seconds(provider.bake_sprites), "s"))
        figures.append(Figure("the empty board, once", _seconds(provider.bake_empty), "s"))
        advance("baking another board")
        figures.append(
            Figure("best picture of another board", _seconds(lambda: _bake(second, size, cache)), "s")
        )
        advance("a board from the cache")
        known = statistics.median(_seconds(lambda: _bake(second, size, cache)) for _ in range(rounds))
        figures.append(Figure("picture of a cached board", known, "s"))
        advance("drawing frames")
        figures += _frames(_bake(first, size, cache), rounds)
        advance("drawing lamps")
        figures += _lamp_frames(Renderer(load_table("silver_comet"), size, cache=cache), rounds)
    return figures


def _bake(table: Table, size: tuple[int, int], cache: PictureCache) -> Renderer:
    return Renderer(table, size, board_seed=SEEDS[0], cache=cache)


def _seconds(work: Callable[[], Any]) -> float:
    before = time.perf_counter()
    work()
    return time.perf_counter() - before


def _first_picture(table: Table, size: tuple[int, int], rounds: int) -> float:
    """Time [s] to create a renderer that works in the background and to draw its first picture."""
    times = []
    for _ in range(rounds):
        with tempfile.TemporaryDirectory() as folder:
            before = time.perf_counter()
            renderer = Renderer(table, size, board_seed=0, background=True, cache=PictureCache(Path(folder)))
            renderer.surface(Moment.before(table))
            times.append(time.perf_counter() - before)
            renderer.close()
    return statistics.median(times)


def _frames(renderer: Renderer, rounds: int) -> list[Figure]:
    """Frames of a game with two balls and moving paddles, in processor time of one core."""
    play = list(_play(renderer.table))
    target = rgb_surface(renderer.camera.size)
    times = []
    for _ in range(max(rounds, 3)):
        renderer.effects.clear()
        before = time.process_time()
        for moment, events in play:
            renderer.add_events(events, TICK_RATE)
            renderer.draw(moment, target)
        times.append((time.process_time() - before) / len(play))
    import pygame

    window = pygame.Surface(renderer.camera.size, 0, 32)
    blit = statistics.median(_seconds(lambda: window.blit(target, (0, 0))) for _ in range(60))
    return [
        Figure("frames drawn, two balls", 1.0 / statistics.median(times), "frames/s"),
        Figure("a frame", 1000.0 * statistics.median(times), "ms"),
        Figure("copying it to a 32-bit window", 1000.0 * blit, "ms"),
    ]


def _lamp_frames(renderer: Renderer, rounds: int) -> list[Figure]:
    """The same game on a table with lamps, of which all or none change from frame to frame."""
    play = list(_play(renderer.table))
    target = rgb_surface(renderer.camera.size)
    count = len(renderer.table.lamp)
    figures = []
    for name, states in (("no lamp changes", (0, 0)), ("all lamps change", (0, 1))):
        times = []
        for _ in range(max(rounds, 3)):
            renderer.effects.clear()
            before = time.process_time()
            for number, (moment, events) in enumerate(play):
                renderer.add_events(events, TICK_RATE)
                renderer.draw(moment._replace(lamps=(states[number % 2],) * count), target)
            times.append((time.process_time() - before) / len(play))
        figures.append(
            Figure(f"frames drawn, {count} lamps, {name}", 1.0 / statistics.median(times), "frames/s")
        )
    return figures


def _play(table: Table) -> Iterator[tuple[Moment, Any]]:
    world = World(table, 5, TICK_RATE)
    for frame in range(FRAMES):
        while len(world.balls) < min(table.board.max_balls, 2):
            try:
                world.create_ball()
            except NoRoom:  # the last one has not left the plunger yet
                break
        world.step(
            left=frame // 7 % 2 == 0,
            right=frame // 9 % 2 == 0,
            ticks=TICK_RATE // FRAME_RATE,
            launch=frame % 90 < 60,
        )
        yield Moment.of(world), world.events
