"""Lamps: their lenses and light in the picture, by the states that the rules give them."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pygame
import pytest

from boards import CLASSIC
from silverball.drawing import Moment, Renderer
from silverball.drawing.camera import Camera, best_size
from silverball.drawing.effects import Effects
from silverball.drawing.kernels import inserts
from silverball.drawing.kernels.stage import Lens
from silverball.drawing.lamp_levels import BLINK_RATE, Lamps, blink
from silverball.drawing.lamp_lights import LampLights
from silverball.drawing.layout import Insert, Layout
from silverball.drawing.pictures import AddedLight, BakedTable, load_baked_table, save_baked_table
from silverball.drawing.sketch import LENSES, SketchPainter, lens_outline
from silverball.drawing.themes import THEMES
from silverball.game.game import Game
from silverball.table.rulebook import Lamp, PlayMode, Rule

RED = Lamp(name="red", center=(-2.0, -1.6), color="red", size=0.3)
BLUE = Lamp(name="blue", center=(-2.0, 1.6), color="blue", shape="arrow", size=0.4, angle=45.0, begins="on")
GREEN = Lamp(name="green", center=(-2.6, 1.2), color="green", begins="blinking")
HIDDEN = Lamp(name="on the display only", begins="on")
RULES = [Rule(on_hit=("any",), light=("red",), award=10), Rule(on_press=("left",), light=("red",))]
TABLE = CLASSIC.replace(format=2, lamp=[HIDDEN, RED, BLUE, GREEN], rule=RULES)
OFF, ON, BLINKING = 0, 1, 2
START = Moment.before(TABLE)
SIZE = best_size(TABLE.board, 288)


@pytest.fixture(scope="module")
def renderer(picture_cache):
    return Renderer(TABLE, SIZE, cache=picture_cache)


def drawn(painter, *lamps, time=0.0):
    return painter.array(START._replace(lamps=lamps, time=time)).astype(int)


def around(renderer, lamp, dx=0.0, dz=0.0):
    across, down = renderer.camera.to_pixel(lamp.center[0] + dx, lamp.center[1] + dz, 0.0)
    return int(down), int(across)


def test_a_lamp_that_is_on_shines_in_its_colour_and_onto_the_playfield_around_it(renderer):
    off, on = drawn(renderer, ON, OFF, OFF, OFF), drawn(renderer, ON, ON, OFF, OFF)
    gain = on - off
    assert gain[around(renderer, RED)].min() > 90  # the middle is so bright that it is nearly white
    red, green, blue = on[around(renderer, RED, dx=0.22)]
    assert red > 1.5 * max(green, blue)
    assert gain[around(renderer, RED, dx=0.6)][0] > 5
    assert gain[around(renderer, BLUE)].max() == 0
    assert gain.min() >= 0
    assert (drawn(renderer, ON, OFF, OFF, OFF) == off).all()


def test_the_states_of_a_picture_are_those_of_the_moment_or_those_at_the_start_of_a_game(renderer):
    assert (renderer.array(START) == drawn(renderer, ON, OFF, ON, BLINKING)).all()
    assert (drawn(renderer, OFF, OFF, ON, OFF) == drawn(renderer, ON, OFF, ON, OFF)).all()  # no place


def test_a_blinking_lamp_blinks_two_and_a_half_times_a_second_in_the_time_of_the_world():
    levels = np.array([blink(number / 1000.0) for number in range(2000)])
    rises = np.flatnonzero((levels[1:] > 0.5) & (levels[:-1] <= 0.5))
    assert len(rises) == 2.0 * BLINK_RATE == 5
    assert np.diff(rises).tolist() == [400] * 4
    assert levels.min() == 0.0
    assert levels.max() == 1.0
    assert 0.4 < (levels > 0.5).mean() < 0.6


def test_a_game_lights_its_lamps_in_the_picture(renderer):
    game = Game(TABLE, seed=1)
    before = Moment.of_game(game)
    assert before.lamps == (ON, OFF, ON, BLINKING)
    game.create_ball()
    game.step(left=True, ticks=4)
    after = Moment.of_game(game)
    assert after.lamps == (ON, ON, ON, BLINKING)
    assert Moment.between(before, after, 0.5).lamps == after.lamps
    seen, unlit = (
        renderer.array(START._replace(lamps=lamps)).astype(int) for lamps in (after.lamps, before.lamps)
    )
    assert (seen - unlit)[around(renderer, RED)][0] > 90


def test_lamps_of_the_mode_have_its_colour_while_it_runs(picture_cache):
    lamp = Lamp(name="arrow", center=(-2.0, 0.0), shape="arrow", size=0.5, color="mode", begins="on")
    modes = [PlayMode(name="hunt", color="red"), PlayMode(name="flight", color="blue"), PlayMode(name="rest")]
    rules = [
        Rule(on_press=("left",), start=("flight", "rest")),
        Rule(on_press=("right",), start=("hunt",)),
        Rule(on_ball=("start",), stop=("rest",)),
    ]
    table = CLASSIC.replace(format=2, lamp=[lamp], mode=modes, rule=rules)
    game, colors = Game(table, seed=1), []
    renderer = Renderer(table, SIZE, cache=picture_cache)
    assert [light.color for light in Layout.of(table).lights] == ["white", "red", "blue"]
    game.create_ball()
    for left, right in ((False, False), (True, False), (False, True)):
        game.step(left=left, right=right, ticks=2)
        moment = Moment.of_game(game)._replace(balls=())
        colors.append((moment.color, renderer.array(moment)[around(renderer, lamp, dx=0.4)].astype(int)))
    (plain, white), (second, blue), (first, red) = colors
    assert (plain, second, first) == ("white", "blue", "red")
    assert white.min() > 130
    assert red[0] > red[2] + 50
    assert blue[2] > blue[0] + 50


def test_a_sketch_shows_lamps_too():
    camera = Camera(TABLE.board, SIZE)
    painter = SketchPainter(TABLE, camera, THEMES["neon"])

    def sketched(*lamps):
        surface = painter.compose(START._replace(lamps=lamps), Effects())
        return pygame.surfarray.array3d(surface).swapaxes(0, 1).astype(int)

    gain = sketched(OFF, ON, OFF, OFF) - sketched(OFF, OFF, OFF, OFF)
    across, down = camera.to_pixel(*RED.center, 0.0)
    assert gain[int(down), int(across)].max() > 90
    assert np.abs(gain).max(axis=2).astype(bool).sum() < 400


def test_the_lamps_of_a_baked_table_come_back_from_the_cache(renderer, picture_cache):
    baked = renderer._painter._baked
    assert len(baked.lamps) == 3
    assert all(lamp.pixels.size for lamp in baked.lamps)
    save_baked_table(picture_cache, "a table with lamps", baked)
    loaded = load_baked_table(picture_cache, "a table with lamps")
    for lamp, again in zip(baked.lamps, loaded.lamps, strict=True):
        assert (lamp.left, lamp.top) == (again.left, again.top)
        assert (lamp.pixels == again.pixels).all()


def test_a_table_with_lamps_has_no_painted_inserts(renderer, picture_cache):
    painted = Renderer(CLASSIC, SIZE, cache=picture_cache).array(START).astype(int)
    real = drawn(renderer, OFF, OFF, OFF, OFF)
    lens = around(renderer, Lamp(name="x", center=(-0.53, 1.745)))  # one of the ring around the emblem
    assert np.abs(painted - real)[lens].max() > 60


def test_any_order_of_changes_leads_to_the_same_picture_and_the_boxes_cover_them():
    random = np.random.default_rng(5)
    still = random.integers(0, 256, (150, 110, 3), np.uint8)
    lamps = []
    for _ in range(12):
        rows, columns = random.integers(1, 60, 2)
        left, top = random.integers(0, 110 - columns + 1), random.integers(0, 150 - rows + 1)
        pixels = random.integers(0, 256, (rows, columns, 3), np.uint8)
        lamps.append(AddedLight(int(left), int(top), pixels))
    lamps.append(AddedLight(0, 0, np.zeros((0, 0, 3), np.uint8)))  # of one that nothing shows
    lights = LampLights(BakedTable(still, np.zeros((150, 110), np.float32), {}, tuple(lamps)))
    for _ in range(40):
        before = lights.pixels.copy()
        levels = lights._levels[1] / 256.0
        some = random.random(13) < 0.3
        levels = np.where(some, random.choice([0.0, 0.25, 1.0], 13), levels)
        boxes = lights.update(levels)
        expected = still.astype(int)
        for lamp, level in zip(lamps, levels, strict=True):
            rows, columns = lamp.pixels.shape[:2]
            place = (slice(lamp.top, lamp.top + rows), slice(lamp.left, lamp.left + columns))
            more = lamp.pixels.astype(int) * round(256 * level) >> 8
            expected[place] = np.minimum(expected[place] + more, 255)
        assert (lights.pixels == expected).all()
        covered = np.zeros((150, 110), int)
        for left, top, right, bottom in boxes:
            covered[top:bottom, left:right] += 1
        assert covered.max(initial=0) <= 1
        assert covered[(before != lights.pixels).any(axis=2)].all()


@pytest.mark.parametrize("shape", [lens.name.lower() for lens in Lens])
def test_the_lens_of_the_sketch_has_the_edge_of_the_baked_one(shape, monkeypatch):
    monkeypatch.setattr(inserts, "_star_distance", inserts._star_distance.py_func)
    insert = Insert(0, (1.5, -2.0), shape, 0.4, 30.0, "red", 0, 0)
    sine, cosine = math.sin(math.radians(30.0)), math.cos(math.radians(30.0))
    lens = SimpleNamespace(shape=Lens[shape.upper()], x=1.5, z=-2.0, size=0.4, sine=sine, cosine=cosine)
    outline = lens_outline(insert)
    for x, z in outline:
        assert math.dist((x, z), insert.center) <= 0.4 + 1e-9
    sides = zip(outline, (*outline[1:], outline[0]), strict=True)
    for (x0, z0), (x1, z1) in sides:
        for share in (0.25, 0.5, 0.75):
            place = x0 + share * (x1 - x0), z0 + share * (z1 - z0)
            slack = 0.004 if shape == "round" else 0.001  # chords of the circle; rounded coefficients
            assert inserts.insert_distance.py_func(lens, *place) == pytest.approx(0.0, abs=slack)
    assert inserts.insert_distance.py_func(lens, *insert.center) < 0.0
    assert (shape in LENSES) != (shape == "round")


def test_lamps_of_a_group_have_one_colour_of_the_theme():
    lamps = [Lamp(name=f"{n}", group="abc"[n // 2 : n // 2 + 1], center=(0.5 * n, 0.0)) for n in range(6)]
    found = Layout.of(CLASSIC.replace(format=2, lamp=lamps)).inserts
    assert [one.number for one in found] == [0, 0, 1, 1, 2, 2]
    alone = [Lamp(name=f"{n}", center=(0.5 * n, 0.0)) for n in range(3)]
    assert [one.number for one in Layout.of(CLASSIC.replace(format=2, lamp=alone)).inserts] == [0, 1, 2]


def test_without_lamps_there_are_no_levels():
    assert len(Lamps(Layout.of(CLASSIC)).levels(Moment.before(CLASSIC), Effects())) == 0
