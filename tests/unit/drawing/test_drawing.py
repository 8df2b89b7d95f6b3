"""Pictures: everything is drawn where the physics has it, with smooth edges, and without a display."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pygame
import pytest

from silverball.drawing import Camera, Moment, Renderer, best_size, palette
from silverball.drawing.moment import BallAt
from silverball.drawing.sprites import SHIFTS, BallSprites
from silverball.table import Cylinder, SlantWall, Table, generate_table, load_table
from silverball.world import Event

TABLE = load_table("classic")
SIZE = best_size(TABLE.board, 700)
START = Moment.before(TABLE)


@pytest.fixture(scope="module")
def renderer():
    return Renderer(TABLE, SIZE)


@pytest.fixture(scope="module")
def picture(renderer):
    return renderer.array(START).astype(int)


def at(picture, camera, x, z):
    across, down = camera.to_pixel(x, z)
    return picture[int(down), int(across)]


def is_like(color, wanted, tolerance=60):
    return np.abs(np.asarray(color, int) - wanted).max() <= tolerance


def test_a_picture_is_rgb_bytes_of_the_size_asked_for(renderer):
    array = renderer.array(START)
    assert array.shape == (SIZE[1], SIZE[0], 3)
    assert array.dtype == np.uint8


def test_pixel_and_board_coordinates_are_inverse_and_the_right_way_round():
    camera = Camera(TABLE.board, (500, 900))
    for x, z in ((0.0, 0.0), (10.0, -5.0), (-9.0, 3.3)):
        assert camera.to_board(*camera.to_pixel(x, z)) == pytest.approx((x, z))
    assert camera.to_pixel(5.0, 0.0)[1] < camera.to_pixel(0.0, 0.0)[1]  # x runs up
    assert camera.to_pixel(0.0, 2.0)[0] > camera.to_pixel(0.0, 0.0)[0]  # z runs right


@pytest.mark.parametrize("size", [(300, 900), (900, 300), (331, 681), (40, 80)])
def test_the_whole_board_is_visible_at_any_size(size):
    camera = Camera(TABLE.board, size)
    for x in (-10.0, 10.0):
        for z in (-5.0, 5.0):
            across, down = camera.to_pixel(x, z)
            assert 0 <= across <= size[0]
            assert 0 <= down <= size[1]
    assert Renderer(TABLE, size).array(START).shape == (size[1], size[0], 3)


@pytest.mark.parametrize("index", range(4))
def test_a_prism_has_its_colour_just_inside_its_corners_and_not_just_outside(picture, renderer, index):
    corners = np.array(TABLE.triangular_prism[index].corners())
    middle = corners.mean(axis=0)
    color = palette.in_turn(palette.PRISMS, index)
    assert is_like(at(picture, renderer.camera, *middle), color, 40)
    for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        edge = 0.5 * (start + end)
        outward = (edge - middle) / np.hypot(*(edge - middle))
        beyond = at(picture, renderer.camera, *(edge + 0.25 * outward))
        assert not is_like(beyond, color)


@pytest.mark.parametrize("index", range(3))
def test_a_cylinder_ends_at_its_radius(picture, renderer, index):
    x, z, radius = TABLE.cylinder[index].circle()
    color = palette.in_turn(palette.CYLINDERS, index)
    cap = at(picture, renderer.camera, x - 0.62 * radius, z)
    ring = at(picture, renderer.camera, x, z + 0.9 * radius)
    beyond = at(picture, renderer.camera, x + radius + 0.3, z)
    assert np.argmax(cap) == np.argmax(color)
    assert ring.max() - ring.min() < 40  # steel is grey
    assert is_like(beyond, color, 40)  # the ring of light on the floor


def test_a_slant_wall_is_as_thick_as_in_the_physics():
    wall = SlantWall(start=(0.0, -3.0), end=(0.0, 3.0), thickness=0.4)
    bare = Renderer(Table(), SIZE).array(START).astype(int)
    walled = Renderer(Table(slant_wall=(wall,)), SIZE)
    difference = np.abs(walled.array(START).astype(int) - bare).max(axis=2)
    column = int(walled.camera.to_pixel(0.0, 0.0)[0])
    top, bottom = walled.camera.to_pixel(0.4, 0.0)[1], walled.camera.to_pixel(-0.4, 0.0)[1]
    edges = (difference[int(top) + 1, column], difference[int(bottom) - 1, column])
    assert min(edges) > 80
    assert difference[int(top) - 2, column] < 0.5 * min(edges)  # below it lies its shadow


@pytest.mark.parametrize("angle", [-10.0, 17.3, 45.0])
def test_paddles_are_drawn_at_their_angle(renderer, angle):
    picture = renderer.array(START._replace(angles=(angle, angle))).astype(int)
    for paddle in TABLE.paddle:
        low, tip, high = (np.array(corner) for corner in paddle.corners(angle))
        middle = (low + tip + high) / 3
        assert is_like(at(picture, renderer.camera, *middle), palette.PADDLE, 70)
        near_tip = 0.25 * middle + 0.75 * tip
        assert at(picture, renderer.camera, *near_tip)[0] > at(picture, renderer.camera, *near_tip)[2]


def test_a_ball_is_bright_where_it_is_and_leaves_no_mark_where_it_was(renderer, picture):
    ball = BallAt(1, 1.0, 0.4)
    with_ball = renderer.array(START._replace(balls=(ball,))).astype(int)
    assert at(with_ball, renderer.camera, ball.x + 0.05, ball.z - 0.05).min() > 180
    renderer.effects.forget()
    assert (renderer.array(START) == picture).all()


def test_a_ball_moves_smoothly_between_pixels():
    """Wherever a ball is, the middle of its image is there, to an eighth of a pixel."""
    camera = Camera(TABLE.board, SIZE)
    balls = BallSprites(camera)
    for step in range(20):
        x, z = 1.0 + 0.013 * step, 0.4 + 0.017 * step
        image, place = balls.at(x, z)
        alpha = pygame.surfarray.array_alpha(image).astype(float)
        middle = [
            place[axis] + 0.5 + (alpha.sum(axis=1 - axis) * np.arange(alpha.shape[axis])).sum() / alpha.sum()
            for axis in (0, 1)
        ]
        assert middle == pytest.approx(camera.to_pixel(x, z), abs=0.5 / SHIFTS + 0.02)


def test_edges_are_smooth():
    """Along a paddle's slanting edge, pixels between paddle and floor have colours in between."""
    renderer = Renderer(TABLE, SIZE)
    left = renderer.array(START).astype(int)
    without = Renderer(TABLE.model_copy(update={"paddle": ()}), SIZE).array(START).astype(int)
    redness = (left - without)[..., 0]
    between = (redness > 40) & (redness < 160)
    assert between.sum() > 40


def test_a_hit_lights_a_part_up_and_the_light_goes_out(renderer, picture):
    x, z, _ = TABLE.cylinder[1].circle()
    event = Event("hit", "cylinder[1]", 1, 240, 0.0, (x, 1.0, z), (1.0, 0.0, 0.0), 5.0)
    renderer.note([event], 240)
    brightness = [
        renderer.array(START._replace(time=1.0 + after)).astype(int).sum() for after in (0.0, 0.1, 0.2)
    ]
    dark = picture.sum()
    assert brightness[0] > brightness[1] > brightness[2] > dark
    assert renderer.array(START._replace(time=2.0)).astype(int).sum() == dark


def test_a_ball_in_the_gutter_dives_under_the_apron(renderer, picture):
    event = Event("gutter", "gutter", 1, 240, 0.0, (-9.0, 1.0, 0.0), (1.0, 0.0, 0.0), 8.0)
    renderer.note([event], 240)
    seen = renderer.array(START._replace(time=1.005)).astype(int)
    changed = np.argwhere(np.abs(seen - picture).max(axis=2) > 0)[:, 0]
    apron = renderer.camera.to_pixel(TABLE.board.gutter - TABLE.board.ball_radius, 0.0)[1]
    assert changed.size
    assert changed.max() <= apron + 1
    assert (renderer.array(START._replace(time=2.0)) == picture).all()


def test_the_score_is_shown(renderer, picture):
    scored = renderer.array(START._replace(score=1234567)).astype(int)
    top = int(renderer.camera.to_pixel(TABLE.board.length / 2 + 0.4, 0.0)[1])
    assert (scored[:top] != picture[:top]).any()
    assert (scored[top:] == picture[top:]).all()


def test_a_seed_is_written_only_beside_a_board_that_was_made_from_one(picture):
    seeded = Renderer(TABLE, SIZE, board_seed=7).array(START).astype(int)
    other = Renderer(TABLE, SIZE, board_seed=8).array(START).astype(int)
    unseeded = Renderer(TABLE, SIZE).array(START._replace(time=1.0)).astype(int)
    assert (seeded != other).any()
    assert (seeded != picture).any()
    assert (unseeded == picture).all()


def test_the_emblem_is_too_faint_to_be_taken_for_a_target(picture, renderer):
    """It stands out from the floor less than a quarter as much as a cylinder's ring of light."""
    camera = renderer.camera
    turn = np.linspace(0.0, 2.0 * np.pi, 60)
    x, z = -0.07 * TABLE.board.length, 0.125 * TABLE.board.width

    def contrast(around_x, around_z, radius):
        on, off = (
            np.array([at(picture, camera, around_x + r * np.sin(a), around_z + r * np.cos(a)) for a in turn])
            for r in (radius, radius + 0.25)
        )
        return np.abs(on - off).max(axis=1).mean()

    top_x, top_z, radius = TABLE.cylinder[0].circle()
    assert contrast(x, 0.0, z) < 0.25 * contrast(top_x, top_z, radius + 0.3)


def test_every_generated_board_can_be_drawn():
    for seed in range(5):
        table = generate_table(seed)
        assert Renderer(table, (120, 240)).array(Moment.before(table)).std() > 10


def test_a_table_that_touches_the_borders_everywhere_can_be_drawn():
    parts = tuple(Cylinder(center=(x, z), radius=1.0) for x in (-10.0, 10.0) for z in (-5.0, 5.0))
    assert Renderer(Table(cylinder=parts), (150, 300)).array(START).shape == (300, 150, 3)


def test_drawing_needs_no_display_and_no_video():
    program = (
        "import pygame\n"
        "from silverball.drawing import Moment, Renderer\n"
        "from silverball.table import load_table\n"
        "table = load_table('classic')\n"
        "assert Renderer(table, (100, 200)).array(Moment.before(table)).shape == (200, 100, 3)\n"
        "assert not pygame.display.get_init()\n"
    )
    result = subprocess.run(
        [sys.executable, "-c", program], env={"SDL_VIDEODRIVER": "no such driver"}, check=False
    )
    assert result.returncode == 0
