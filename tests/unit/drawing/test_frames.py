"""Frames of play: what moves is where the physics has it, before and behind what it should be."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pygame
import pytest

from boards import CLASSIC
from silverball.drawing import Moment, Renderer, best_size
from silverball.drawing.moment import BallAt
from silverball.drawing.sketch import sketch
from silverball.table import Table, TriangularPrism, generate_table
from silverball.world import Event, World

TABLE = CLASSIC
SIZE = best_size(TABLE.board, 480)
START = Moment.before(TABLE)
RADIUS = TABLE.board.ball_radius


@pytest.fixture(scope="module")
def shared(picture_cache):
    return Renderer(TABLE, SIZE, theme="clear", cache=picture_cache)


@pytest.fixture
def renderer(shared):
    shared.effects.clear()
    return shared


@pytest.fixture(scope="module")
def picture(shared):
    return shared.array(START).astype(int)


def at(picture, renderer, x, z, y=0.0):
    across, down = renderer.camera.to_pixel(x, z, y)
    return picture[int(down), int(across)]


def with_balls(renderer, *places, **changes):
    balls = tuple(BallAt(number, x, z) for number, (x, z) in enumerate(places, 1))
    return renderer.array(START._replace(balls=balls, **changes)).astype(int)


def test_a_picture_is_rgb_bytes_of_the_size_asked_for(renderer):
    array = renderer.array(START)
    assert array.shape == (SIZE[1], SIZE[0], 3)
    assert array.dtype == np.uint8


def test_the_same_moment_has_the_same_bytes_whatever_was_drawn_in_between(renderer, picture):
    moment = START._replace(balls=(BallAt(1, 0.4, 0.3),), angles=(10.0, 30.0))
    first = renderer.array(moment)
    with_balls(renderer, (3.0, -3.0), (-6.0, 1.0), angles=(45.0, -10.0))
    renderer.effects.clear()
    assert (renderer.array(moment) == first).all()
    renderer.effects.clear()
    assert (renderer.array(START) == picture).all()


def test_a_ball_covers_the_disc_that_the_camera_gives_it(renderer, picture):
    x, z = 1.0, 0.4
    changed = np.abs(with_balls(renderer, (x, z)) - picture).max(axis=2) > 12
    changed[: renderer.score_panel.bottom] = False  # which counts the balls
    across, down = renderer.camera.to_pixel(x, z, RADIUS)
    size = RADIUS * renderer.camera.scale
    rows, columns = np.nonzero(changed)
    assert columns.min() == pytest.approx(across - size, abs=4.0)  # its shadow is a little wider
    assert rows.min() == pytest.approx(down - size, abs=2.0)
    for turn in np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False):
        on = down + 0.8 * size * np.sin(turn), across + 0.8 * size * np.cos(turn)
        assert changed[int(on[0]), int(on[1])]


def test_a_ball_is_the_brightest_thing_near_it(renderer):
    for x, z in ((1.0, 0.4), (-3.0, 0.0), (8.0, 1.5)):
        picture = with_balls(renderer, (x, z))
        across, down = renderer.camera.to_pixel(x, z, RADIUS)
        size = RADIUS * renderer.camera.scale
        ball = picture[int(down - size) : int(down + size), int(across - size) : int(across + size)]
        assert np.percentile(ball.min(axis=2), 80) > 150


def test_a_ball_behind_a_raised_paddle_is_hidden_and_before_it_is_not(renderer):
    angles = (45.0, -10.0)
    (_, _), tip, upper = TABLE.paddle[0].corners(45.0)
    way_x, way_z = tip[0] - upper[0], tip[1] - upper[1]
    edge = (upper[0] + 0.5 * way_x, upper[1] + 0.5 * way_z)
    length = np.hypot(way_x, way_z)
    above = (edge[0] + way_z / length * 1.001 * RADIUS, edge[1] - way_x / length * 1.001 * RADIUS)
    bare = with_balls(renderer, angles=angles)
    renderer.effects.clear()
    behind = with_balls(renderer, above, angles=angles)
    height = renderer.camera.dimensions.paddle_height
    # Just inside the paddle's upper edge its top is seen: the ball that touches it there lies behind.
    inside = (edge[0] - way_z / length * 0.07, edge[1] + way_x / length * 0.07)
    assert np.abs(at(behind, renderer, *inside, height) - at(bare, renderer, *inside, height)).max() < 90
    across, down = renderer.camera.to_pixel(*above, RADIUS)
    assert np.abs(behind[int(down) - 2, int(across)] - bare[int(down) - 2, int(across)]).max() > 60
    # A ball below the paddle covers it wherever the two overlap in the picture.
    renderer.effects.clear()
    low = (edge[0] - way_z / length * 0.55, edge[1] + way_x / length * 0.55)
    before = with_balls(renderer, low, angles=angles)
    across, down = renderer.camera.to_pixel(*low, RADIUS)
    assert np.abs(before[int(down) - 2, int(across)] - bare[int(down) - 2, int(across)]).max() > 60


def test_a_ball_behind_an_obstacle_is_hidden_by_it(picture_cache):
    prism = TriangularPrism(vertices=((0.0, -1.5), (0.0, 1.5), (-1.2, 0.0)))
    renderer = Renderer(Table(triangular_prism=(prism,), name=""), SIZE, theme="clear", cache=picture_cache)
    bare = renderer.array(START).astype(int)
    seen = renderer.array(START._replace(balls=(BallAt(1, 0.01 + RADIUS, 0.0),))).astype(int)
    top = renderer.camera.dimensions.prism_height
    assert np.abs(at(seen, renderer, -0.08, 0.0, top) - at(bare, renderer, -0.08, 0.0, top)).max() < 40
    assert np.abs(at(seen, renderer, 0.3, 0.0, 0.5) - at(bare, renderer, 0.3, 0.0, 0.5)).max() > 60


def test_the_shadow_of_a_ball_falls_onto_the_top_of_an_obstacle(picture_cache):
    """A ball that touches a prism's upper edge darkens the prism's top: its shadow has climbed onto it."""
    prism = TriangularPrism(vertices=((0.0, -3.0), (0.0, 3.0), (-2.5, 0.0)))
    renderer = Renderer(Table(triangular_prism=(prism,), name=""), SIZE, theme="clear", cache=picture_cache)
    dimensions = renderer.camera.dimensions
    place = (-0.07, 0.0, dimensions.prism_height)
    across, down = renderer.camera.to_pixel(*place)
    assert renderer._painter._layers[0].height[int(down), int(across)] == pytest.approx(
        dimensions.prism_height, abs=0.06
    )
    bare = renderer.array(START).astype(int)
    seen = renderer.array(START._replace(balls=(BallAt(1, 1.001 * RADIUS, 0.0),))).astype(int)
    assert at(seen, renderer, *place).sum() < 0.92 * at(bare, renderer, *place).sum()
    far = (-0.07, 1.9, dimensions.prism_height)
    assert (at(seen, renderer, *far) == at(bare, renderer, *far)).all()


@pytest.mark.parametrize("angle", [-10.0, 17.3, 45.0])
def test_paddles_are_drawn_at_their_angle(renderer, angle):
    bare = Renderer(TABLE.model_copy(update={"paddle": ()}), SIZE, theme="clear").array(START).astype(int)
    picture = renderer.array(START._replace(angles=(angle, angle))).astype(int)
    height = renderer.camera.dimensions.paddle_height
    for paddle in TABLE.paddle:
        corners = np.array(paddle.corners(angle))
        middle = corners.mean(axis=0)
        for corner in corners:
            inside = 0.75 * corner + 0.25 * middle
            assert (
                np.abs(at(picture, renderer, *inside, height) - at(bare, renderer, *inside, height)).max()
                > 35
            )
            beyond = corner + 0.7 * (corner - middle) / np.hypot(*(corner - middle)) + (0.35, 0.0)
            difference = at(picture, renderer, *beyond) - at(bare, renderer, *beyond)
            assert np.abs(difference).max() < 40


def test_the_right_paddle_is_the_left_one_in_the_mirror(renderer):
    picture = renderer.array(START._replace(angles=(20.0, 20.0))).astype(int)
    top = int(renderer.camera.to_pixel(-6.0, 0.0)[1])
    bottom = int(renderer.camera.to_pixel(-9.0, 0.0)[1])
    difference = np.abs(picture[top:bottom] - picture[top:bottom, ::-1]).max(axis=2)
    assert (difference > 24).mean() < 0.01


def test_a_hit_lights_a_part_and_the_floor_around_it_up_and_the_light_goes_out(renderer, picture):
    x, z, radius = TABLE.cylinder[1].circle()
    event = Event("hit", "cylinder[1]", 1, 240, 0.0, (x, 1.0, z), (1.0, 0.0, 0.0), 5.0)
    renderer.add_events([event], 240)
    times = (0.0, 0.1, 0.2)
    lit = [renderer.array(START._replace(time=1.0 + after)).astype(int) for after in times]
    assert lit[0].sum() > lit[1].sum() > lit[2].sum() > picture.sum()
    beside = at(lit[0], renderer, x, z + radius + 0.45) - at(picture, renderer, x, z + radius + 0.45)
    assert beside.max() > 20
    assert (renderer.array(START._replace(time=2.0)) == picture).all()


def test_hard_hits_strike_sparks_which_less_effects_leave_out(picture_cache):
    hit = Event("hit", "board.left", 1, 240, 0.0, (0.0, 1.0, -4.6), (0.0, 0.0, 1.0), 15.0)
    sums = {}
    for effects in ("full", "less"):
        renderer = Renderer(TABLE, SIZE, theme="clear", effects=effects, cache=picture_cache)
        before = renderer.array(START._replace(time=1.05)).astype(int)
        renderer.add_events([hit], 240)
        sums[effects] = renderer.array(START._replace(time=1.05)).astype(int).sum() - before.sum()
    assert sums["full"] > 2000
    assert sums["less"] == 0


def test_a_fast_ball_leaves_a_trail_for_a_moment(renderer, picture):
    for frame in range(4):
        moment = START._replace(time=1.0 + frame / 60, balls=(BallAt(1, 2.0 - 0.3 * frame, 0.0),))
        seen = renderer.array(moment).astype(int)
    where = (1.8, 0.0, RADIUS)
    assert at(seen, renderer, *where).sum() > at(picture, renderer, *where).sum() + 20


def test_a_ball_in_the_gutter_rolls_under_the_apron(renderer, picture):
    event = Event("gutter", "gutter", 1, 240, 0.0, (-9.0, 1.0, 0.0), (1.0, 0.0, 0.0), 8.0)
    renderer.add_events([event], 240)
    seen = renderer.array(START._replace(time=1.02)).astype(int)
    changed = np.argwhere(np.abs(seen - picture).max(axis=2) > 0)[:, 0]
    dimensions = renderer.camera.dimensions
    apron = renderer.camera.to_pixel(dimensions.apron_top, 0.0, dimensions.apron_height)[1]
    assert changed.size
    assert changed.max() <= apron + 3
    assert (renderer.array(START._replace(time=2.0)) == picture).all()


def test_the_score_is_shown_in_the_panel_and_nowhere_else(renderer, picture):
    scored = renderer.array(START._replace(score=1234567)).astype(int)
    changed = np.argwhere((scored != picture).any(axis=2))
    assert len(changed)
    assert all(renderer.score_panel.collidepoint(column, row) for row, column in changed)


def test_a_seed_is_written_only_beside_a_board_that_was_made_from_one(picture, picture_cache):
    seeded, other = (
        Renderer(TABLE, SIZE, theme="clear", board_seed=seed, cache=picture_cache).array(START)
        for seed in (7, 8)
    )
    assert (seeded != other).any()
    assert (seeded != picture).any()


def test_a_film_of_one_game_is_the_same_twice(picture_cache):
    table = generate_table(3)

    def tone_map():
        world, renderer = World(table, 9), Renderer(table, (120, 192), cache=picture_cache)
        for frame in range(30):
            if len(world.balls) < 2:
                world.create_ball()
            world.step(left=frame % 5 == 0, right=frame % 7 == 0, ticks=6)
            renderer.add_events(world.events, world.tick_rate)
            yield renderer.array(Moment.of(world)).copy()

    frames, again = list(tone_map()), list(tone_map())
    assert all((one == other).all() for one, other in zip(frames, again, strict=True))
    assert len({frame.tobytes() for frame in frames}) == len(frames)


@pytest.mark.parametrize("size", [(1, 1), (2, 3), (170, 340), (900, 60), (31, 200)])
def test_pictures_of_odd_sizes_and_tables_with_little_in_them_can_be_drawn(size):
    moment = Moment(0.5, (BallAt(1, 0.0, 0.0), BallAt(2, 60.0, -60.0)), (3.0, 4.0), 5)
    for table in (TABLE, Table()):
        assert Renderer(table, size).array(moment).shape == (size[1], size[0], 3)


def test_a_frame_goes_onto_surfaces_of_any_kind(renderer):
    moment = START._replace(balls=(BallAt(1, 0.0, 1.0),))
    array = renderer.array(moment)
    for depth in (24, 32):
        target = pygame.Surface(SIZE, 0, depth)
        renderer.draw(moment, target)
        assert (pygame.surfarray.array3d(target).swapaxes(0, 1) == array).all()


def test_the_sketch_lies_where_the_picture_lies(picture, renderer):
    """Blurred to what is alike in both, no shift of a few pixels fits better than none."""
    rough = sketch(TABLE, renderer.camera, renderer.theme).astype(float).sum(axis=2)[120:]
    fine = picture.astype(float).sum(axis=2)[120:]

    def edges(image):
        return np.abs(np.diff(image, axis=0))[:, :-1] + np.abs(np.diff(image, axis=1))[:-1]

    one, other = edges(rough), edges(fine)
    match = {
        (down, across): (one[8:-8, 8:-8] * np.roll(other, (down, across), (0, 1))[8:-8, 8:-8]).sum()
        for down in range(-6, 7, 2)
        for across in range(-6, 7, 2)
    }
    assert max(match, key=match.__getitem__) == (0, 0)


def test_drawing_needs_no_display_and_no_video(tmp_path):
    program = (
        "import pygame\n"
        "from silverball.drawing import Moment, Renderer\n"
        "from silverball.table import load_table\n"
        "table = load_table('classic')\n"
        "renderer = Renderer(table, (100, 160), background=True)\n"
        "assert renderer.array(Moment.before(table)).shape == (160, 100, 3)\n"
        "renderer.close()\n"
        "assert not pygame.display.get_init()\n"
    )
    result = subprocess.run(
        [sys.executable, "-c", program], env={"SDL_VIDEODRIVER": "no such driver"}, check=False
    )
    assert result.returncode == 0
