"""The still table: what is drawn lies where the physics has it, and a patch is as good as the whole."""

from __future__ import annotations

import math

import numpy as np
import pytest

from boards import FIRST_SHAPE
from silverball.drawing import THEMES, Camera, best_size
from silverball.drawing.bake_table import bake_table, without_obstacles
from silverball.drawing.bake_threads import BakeThreads
from silverball.drawing.kernels.bake import new_canvas
from silverball.drawing.kernels.stage import APRON, FLOOR, RAIL
from silverball.drawing.scene import make_scene
from silverball.physics import shapes
from silverball.table import Cylinder, SlantWall, Table, TriangularPrism, generate_table, load_table

TABLE = load_table("classic")
CAMERA = Camera(TABLE.board, best_size(TABLE.board, 420))
CLEAR = THEMES["clear"]


@pytest.fixture(scope="module")
def scene():
    return make_scene(TABLE, CAMERA, CLEAR)


@pytest.fixture(scope="module")
def canvas(scene):
    canvas = new_canvas(CAMERA.size)
    BakeThreads().bake(scene, canvas)
    return canvas


def part_at(canvas, x, z, y=0.0):
    across, down = CAMERA.to_pixel(x, z, y)
    return canvas.part[int(down), int(across)]


def test_the_playfield_is_seen_exactly_where_no_part_stands(canvas, scene):
    """No pixel of floor lies inside a footprint of the physics, but for half a pixel."""
    half = 0.75 / CAMERA.scale
    rows, columns = np.nonzero(canvas.part == FLOOR)
    assert len(rows) > 0.4 * canvas.part.size
    for row, column in zip(rows[::7], columns[::7], strict=True):
        x, z = CAMERA.to_board(column + 0.5, row + 0.5)
        for shape in scene.shapes[FIRST_SHAPE:]:
            assert shapes.distance(shape, x, z)[0] > -half


def near_edges(table):
    """Points of outlines with outward normals towards the player: there a face rises from the floor."""
    number = FIRST_SHAPE + len(table.slant_wall)
    for prism in table.triangular_prism:
        corners = prism.corners()
        for (x0, z0), (x1, z1) in zip(corners, (*corners[1:], corners[0]), strict=True):
            length = math.hypot(x1 - x0, z1 - z0)
            nx, nz = (z0 - z1) / length, (x1 - x0) / length
            if nx < -0.4:
                yield number, 0.5 * (x0 + x1), 0.5 * (z0 + z1), nx, nz
        number += 1
    for cylinder in table.cylinder:
        x, z, radius = cylinder.circle()
        for turn in (-0.7, 0.0, 0.7):
            nx, nz = -math.cos(turn), math.sin(turn)
            yield number, x + radius * nx, z + radius * nz, nx, nz
        number += 1


def test_parts_begin_where_the_physics_has_their_edge_within_a_pixel(canvas):
    edges = list(near_edges(TABLE))
    assert len(edges) >= 4 + 3 * 3
    # A pixel downwards covers more of the board than one across, for the view is slanting.
    down = CAMERA.to_board(0.5 * CAMERA.size[0], 500)[0] - CAMERA.to_board(0.5 * CAMERA.size[0], 501)[0]
    pixel = max(down, 1.0 / CAMERA.scale)
    for number, x, z, nx, nz in edges:
        assert part_at(canvas, x + pixel * nx, z + pixel * nz) == FLOOR, (number, x, z)
        assert part_at(canvas, x - pixel * nx, z - pixel * nz) == number, (number, x, z)


def test_a_slant_wall_is_as_thick_as_in_the_physics(canvas):
    wall = TABLE.slant_wall[0]
    (x0, z0), (x1, z1) = wall.start, wall.end
    middle_x, middle_z = 0.5 * (x0 + x1), 0.5 * (z0 + z1)
    length = math.hypot(x1 - x0, z1 - z0)
    nx, nz = (z1 - z0) / length, -(x1 - x0) / length
    if nx > 0.0:
        nx, nz = -nx, -nz
    pixel = 1.3 / CAMERA.scale
    near = wall.thickness + pixel
    assert part_at(canvas, middle_x + near * nx, middle_z + near * nz) == FLOOR
    near = wall.thickness - pixel
    assert part_at(canvas, middle_x + near * nx, middle_z + near * nz) == FIRST_SHAPE


def test_rails_begin_where_balls_meet_them_and_the_apron_hides_the_gutter(canvas):
    board, pixel = TABLE.board, 1.5 / CAMERA.scale
    side = 0.5 * board.width - board.wall_thickness
    for hand in (-1.0, 1.0):
        assert part_at(canvas, 0.0, hand * (side - pixel)) == FLOOR
        assert part_at(canvas, 0.0, hand * (side + pixel)) == RAIL
    assert (
        part_at(canvas, board.gutter - board.ball_radius - 0.4, 0.0, CAMERA.dimensions.apron_height) == APRON
    )
    assert part_at(canvas, board.gutter, 0.0) == FLOOR


def test_heights_are_those_of_what_is_seen(canvas):
    dimensions = CAMERA.dimensions
    x, z, _ = TABLE.cylinder[0].circle()
    across, down = CAMERA.to_pixel(x, z, dimensions.top)
    assert canvas.height[int(down) + 2, int(across)] > dimensions.body_height
    corner = np.mean(TABLE.triangular_prism[0].corners(), axis=0)
    across, down = CAMERA.to_pixel(*corner, dimensions.prism_height)
    assert canvas.height[int(down), int(across)] == pytest.approx(dimensions.prism_height, abs=0.01)
    assert canvas.height[canvas.part == FLOOR] == pytest.approx(0.0, abs=1e-4)


def test_edges_are_smooth(canvas):
    """Where two things meet, pixels do not show what one ray saw but the mean of several."""
    light = canvas.light.astype(float)
    one_ray = light * (2.51 * light + 0.03) / (light * (2.43 * light + 0.59) + 0.14)
    refined = np.abs(canvas.shown - np.sqrt(np.clip(one_ray, 0.0, 1.0))).max(axis=2) > 1e-4
    edges = canvas.part[1:] != canvas.part[:-1]
    assert refined[1:][edges].mean() > 0.9
    assert refined[1:][~edges].mean() < 0.4


def test_a_board_baked_around_its_obstacles_is_the_board_baked_in_full():
    table = generate_table(5)
    camera = Camera(table.board, best_size(table.board, 260))
    empty = bake_table(without_obstacles(table), camera, CLEAR, BakeThreads())
    patched = bake_table(table, camera, CLEAR, BakeThreads(), empty)
    full = bake_table(table, camera, CLEAR, BakeThreads())
    assert (patched.pixels == full.pixels).all()
    assert (patched.height == full.height).all()
    assert patched.flashes.keys() == full.flashes.keys()
    assert all((patched.flashes[name].pixels == full.flashes[name].pixels).all() for name in full.flashes)


def test_any_number_of_threads_bakes_the_same():
    camera = Camera(TABLE.board, best_size(TABLE.board, 150))
    one, three = (bake_table(TABLE, camera, THEMES["neon"], BakeThreads(threads)) for threads in (1, 3))
    assert (one.pixels == three.pixels).all()


def test_a_mirrored_table_has_a_mirrored_picture():
    """Within a few levels: the finer rays of a pixel do not lie in mirrored places."""
    parts = {
        "cylinder": (Cylinder(center=(3.0, 2.0), radius=0.8),),
        "triangular_prism": (TriangularPrism(vertices=((0.0, -3.0), (1.5, -2.0), (0.0, -1.5))),),
        "slant_wall": (SlantWall(start=(-5.0, -5.0), end=(-7.0, -3.0)),),
    }
    mirrored = {
        "cylinder": (Cylinder(center=(3.0, -2.0), radius=0.8),),
        "triangular_prism": (TriangularPrism(vertices=((0.0, 3.0), (1.5, 2.0), (0.0, 1.5))),),
        "slant_wall": (SlantWall(start=(-5.0, 5.0), end=(-7.0, 3.0)),),
    }
    camera = Camera(TABLE.board, best_size(TABLE.board, 240))
    one, other = (
        bake_table(Table(name="", **kinds), camera, CLEAR, BakeThreads()).pixels.astype(int)
        for kinds in (parts, mirrored)
    )
    difference = np.abs(one - other[:, ::-1]).max(axis=2)
    assert (difference > 24).mean() < 0.02
    assert difference.mean() < 2.0
    assert np.abs(one - other).max() > 100  # it is another picture, before it is turned round


@pytest.mark.parametrize("name", ["", "A name " * 11, "Ж ★ 球", "x"])
def test_a_table_of_any_name_can_be_baked_and_its_name_is_read_on_the_apron(name):
    table = Table(name=name)
    camera = Camera(table.board, (150, 240))
    named, bare = (
        bake_table(table.model_copy(update={"name": words}), camera, CLEAR, BakeThreads()).pixels.astype(int)
        for words in (name, "")
    )
    rows = np.flatnonzero(np.abs(named - bare).max(axis=(1, 2)) > 30)
    assert bool(len(rows)) == bool(name)
    if name:
        dimensions = camera.dimensions
        assert rows.min() >= camera.to_pixel(dimensions.apron_top, 0.0, dimensions.apron_height)[1] - 1.0


def test_every_generated_board_and_one_full_of_parts_can_be_baked():
    parts = tuple(Cylinder(center=(x, z), radius=1.0) for x in (-10.0, 10.0) for z in (-5.0, 5.0))
    for table in (generate_table(1), Table(cylinder=parts), Table()):
        still = bake_table(table, Camera(table.board, (75, 120)), THEMES["parlour"], BakeThreads())
        assert still.pixels.shape == (120, 75, 3)
        assert still.pixels.std() > 10
        assert np.isfinite(still.height).all()
