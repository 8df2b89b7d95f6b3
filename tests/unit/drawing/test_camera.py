"""The camera: there and back again, and nothing of any table is cut off."""

from __future__ import annotations

import math

import pytest

from silverball.drawing import Camera, best_size
from silverball.table import Board

BOARD = Board()
SHAPES = [(20.0, 10.0), (4.0, 2.0), (50.0, 2.0), (4.0, 50.0), (50.0, 50.0), (12.0, 30.0)]


def test_pixel_and_board_coordinates_are_inverse_at_every_height_and_the_right_way_round():
    camera = Camera(BOARD, (500, 900))
    for x, z, y in ((0.0, 0.0, 0.0), (10.0, -5.0, 0.3), (-9.0, 3.3, 0.62)):
        assert camera.to_board(*camera.to_pixel(x, z, y), y) == pytest.approx((x, z))
    assert camera.to_pixel(5.0, 0.0)[1] < camera.to_pixel(0.0, 0.0)[1]  # x runs up
    assert camera.to_pixel(0.0, 2.0)[0] > camera.to_pixel(0.0, 0.0)[0]  # z runs right
    assert camera.to_pixel(0.0, 2.0, 0.5)[1] < camera.to_pixel(0.0, 2.0)[1]  # what is higher is seen higher


def test_the_ray_through_a_point_of_the_picture_meets_what_is_seen_there():
    camera = Camera(BOARD, (500, 900))
    x, y, z = 3.0, 0.4, -2.0
    dx, dy, dz = camera.ray(*camera.to_pixel(x, z, y))
    t = (y - camera.frustum.eye_y) / dy
    assert (camera.frustum.eye_x + t * dx, t * dz) == pytest.approx((x, z))


def test_far_things_look_smaller_and_the_left_is_the_right_in_the_mirror():
    camera = Camera(BOARD, (500, 900))
    near, far = (camera.to_pixel(x, 1.0)[0] - camera.to_pixel(x, -1.0)[0] for x in (-9.0, 9.0))
    assert far < 0.9 * near
    assert camera.to_pixel(2.0, -3.0)[0] + camera.to_pixel(2.0, 3.0)[0] == pytest.approx(500.0)


@pytest.mark.parametrize("size", [(720, 1152), (300, 900), (900, 300), (40, 80), (1, 1), (4000, 20)])
@pytest.mark.parametrize(("length", "width"), SHAPES)
def test_nothing_of_any_board_is_cut_off_at_any_size(length, width, size):
    camera = Camera(Board(length=length, width=width, gutter=-0.45 * length), size)
    dimensions = camera.dimensions
    long, wide = dimensions.half_length + dimensions.rail, dimensions.half_width + dimensions.rail
    for x in (-long, long):
        for z in (-wide, wide):
            for y in (0.0, dimensions.rail_height):
                across, down = camera.to_pixel(x, z, y)
                assert -1e-6 <= across <= size[0] + 1e-6
                assert camera.panel.bottom - 1.0 <= down <= size[1] + 1e-6
    assert camera.panel.left >= 0
    assert camera.panel.top >= 0
    assert camera.panel.right <= size[0]


@pytest.mark.parametrize(("length", "width"), SHAPES)
def test_the_best_size_has_no_room_to_spare(length, width):
    board = Board(length=length, width=width, gutter=-0.45 * length)
    width_, height = best_size(board, 1200)
    assert width_ % 2 == height % 2 == 0
    wider, higher = Camera(board, (width_ + 100, height)), Camera(board, (width_, height + 100))
    scale = Camera(board, (width_, height)).frustum.focal
    assert wider.frustum.focal == pytest.approx(scale, rel=0.01)
    assert higher.frustum.focal == pytest.approx(scale, rel=0.01)


def test_the_usual_board_fills_a_picture_of_five_to_eight():
    wide, high = best_size(BOARD, 1152)
    assert wide / high == pytest.approx(5 / 8, rel=0.03)
    camera = Camera(BOARD, (720, 1152))
    assert camera.panel.width > 0.94 * 720
    assert camera.panel.width / camera.panel.height == pytest.approx(5.0, rel=0.01)
    left = camera.to_pixel(-10.0, -5.0)[0]
    assert left < 0.08 * 720


def test_a_box_of_space_lies_within_its_pixels():
    camera = Camera(BOARD, (500, 900))
    left, top, right, bottom = camera.box(1.0, 2.0, -3.0, -2.0, 0.0, 0.5)
    for x in (1.0, 1.5, 2.0):
        for y in (0.0, 0.5):
            across, down = camera.to_pixel(x, -2.5, y)
            assert left <= across <= right
            assert top <= down <= bottom
    assert camera.box(900.0, 901.0, 0.0, 1.0, 0.0, 0.0)[1] <= 900  # cut off at the picture's edges
    assert math.prod(camera.size) > (right - left) * (bottom - top)
