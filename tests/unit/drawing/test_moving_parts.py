"""What moves on a table: each part is seen in the pose that the state of play gives it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from silverball.drawing import THEMES, Camera, Moment, Renderer, best_size, moment
from silverball.drawing.bake_levels import FLOOR_CELL, floor_cells
from silverball.drawing.layout import Layout
from silverball.drawing.looks import LOOKS
from silverball.drawing.moment import BallAt, BladeAt
from silverball.drawing.moving import Motion, coarse_to_fine, moving_parts, pose_angle, turning_pose
from silverball.drawing.pictures import levels_key, sprites_key, table_key
from silverball.drawing.themes import role_color
from silverball.physics.records import NOTHING, Motion as Motions
from silverball.table import Table, load_table
from silverball.table.primitive import Finish
from silverball.world import Event

TABLE = load_table("parts")
LAYOUT = Layout.of(TABLE)
SIZE = best_size(TABLE.board, 300)
START = Moment.before(TABLE)
RADIUS = TABLE.board.ball_radius


@pytest.fixture(scope="module")
def renderer(picture_cache):
    return Renderer(TABLE, SIZE, theme="neon", cache=picture_cache)


@pytest.fixture(scope="module")
def picture(renderer):
    return renderer.array(START).astype(int)


def part_of(motion):
    return next(part for part in moving_parts(LAYOUT) if part.motion is motion)


def seen(renderer, **changes):
    renderer.effects.clear()
    return renderer.array(START._replace(**changes)).astype(int)


def difference(one, other, renderer, points):
    """The largest difference in the box of pixels around points (x, z) [u]."""
    xs, zs = [x for x, _ in points], [z for _, z in points]
    left, top, right, bottom = renderer.camera.box(min(xs), max(xs), min(zs), max(zs), 0.0, 0.5)
    return np.abs(one - other)[top:bottom, left:right].max()


def changed_outside(one, other, renderer, points, margin=1.6):
    xs, zs = [x for x, _ in points], [z for _, z in points]
    left, top, right, bottom = renderer.camera.box(
        min(xs) - margin, max(xs) + margin, min(zs) - margin, max(zs) + margin, 0.0, 1.0
    )
    rest = np.abs(one - other)
    rest[top:bottom, left:right] = 0
    rest[: renderer.score_panel.bottom] = 0
    return rest.max()


def test_every_finish_has_a_look_and_every_look_colours_in_every_theme():
    assert LOOKS.keys() == set(Finish)
    for look in LOOKS.values():
        for theme in THEMES.values():
            for role in (look.role, look.fill.role):
                assert all(0 <= level <= 255 for level in role_color(theme, role, 3))


def test_the_number_of_captured_balls_is_that_of_the_physics():
    """It stands twice, because the drawing starts before the physics is loaded."""
    assert (moment.CAPTURED, moment.NOTHING) == (Motions.CAPTURED, NOTHING)


def test_the_playground_has_every_motion():
    assert {part.motion for part in moving_parts(LAYOUT)} == set(Motion)


def test_a_fallen_target_is_gone_and_the_others_stand(renderer, picture):
    target = part_of(Motion.STANDING)
    fallen = seen(renderer, off=1 << target.switch)
    points = target.primitive.points
    assert difference(fallen, picture, renderer, points) > 60
    assert changed_outside(fallen, picture, renderer, points) == 0


def test_a_blade_turns_as_the_physics_says_and_stops(renderer, picture):
    spinner = part_of(Motion.SPINNING)
    damping = spinner.primitive.spin.damping
    points = spinner.primitive.points
    # It comes to rest after speed / damping; a whole turn shows the blade as before.
    still = BladeAt(0.0, 2.0 * math.pi * damping, 0.0)
    assert (seen(renderer, blades=(still,), time=100.0) == seen(renderer, time=100.0)).all()
    turned = seen(renderer, blades=(BladeAt(0.5 * math.pi, 0.0, 0.0),))
    assert difference(turned, picture, renderer, points) > 30
    assert changed_outside(turned, picture, renderer, points) == 0


def test_a_plunger_is_pulled_as_far_as_it_is_charged(renderer, picture):
    plunger = part_of(Motion.PULLED)
    charge = plunger.primitive.launch.charge
    pictures = [seen(renderer, launch_held=share * charge) for share in (0.0, 0.5, 1.0, 2.0)]
    assert (pictures[0] == picture).all()
    assert (pictures[0] != pictures[1]).any()
    assert (pictures[1] != pictures[2]).any()
    assert (pictures[2] == pictures[3]).all()


def test_a_gate_opens_for_the_ball_below_it(renderer):
    gate = next(p for p in moving_parts(LAYOUT) if p.motion is Motion.HANGING and p.switch is None)
    (x0, z0), (x1, z1) = gate.primitive.points
    way_x, way_z = gate.primitive.one_way
    middle = (0.5 * (x0 + x1), 0.5 * (z0 + z1))
    from silverball.drawing.poses import pose_of

    def pose(away):
        ball = BallAt(1, middle[0] + away * way_x, middle[1] + away * way_z)
        return pose_of(gate, START._replace(balls=(ball,)), renderer.effects, RADIUS)

    assert pose(0.0) == gate.poses - 1
    assert pose(-0.7 * RADIUS) > 0
    assert pose(1.01 * RADIUS) == 0  # blocked


def test_the_rubber_of_a_slingshot_bulges_to_the_ball_for_a_moment(renderer):
    sling = part_of(Motion.KICKING)
    (x0, z0), (x1, z1) = sling.primitive.points
    still = seen(renderer, time=1.05)
    pictures = []
    for side in (1.0, -1.0):
        x, z = 0.5 * (x0 + x1) - side * 0.3 * (z1 - z0), 0.5 * (z0 + z1) + side * 0.3 * (x1 - x0)
        renderer.effects.clear()
        renderer.add_events([Event("hit", sling.part, 1, 240, 0.0, (x, 1.0, z), (1.0, 0.0, 0.0), 3.0)], 240)
        pictures.append(renderer.array(START._replace(time=1.05)).astype(int))
        assert (renderer.array(START._replace(time=1.3)) == seen(renderer, time=1.3)).all()
    assert (pictures[0] != still).any()
    assert (pictures[1] != still).any()
    assert (pictures[0] != pictures[1]).any()


def test_a_ball_in_a_hole_is_sunk_and_one_on_a_plunger_is_not(renderer, picture):
    rows = {}
    for number, row in enumerate(LAYOUT.rows, 3):
        if row.primitive.hold is not None or row.primitive.launch is not None:
            rows[number] = row.primitive.points[0]
    for number, (x, z) in rows.items():
        free = (seen(renderer, balls=(BallAt(1, x, z),)) != picture).any(axis=2).sum()
        held = (seen(renderer, balls=(BallAt(1, x, z, 0, number),)) != picture).any(axis=2).sum()
        assert (held < free) == LAYOUT.is_hole(number)


def test_a_ball_on_a_ramp_is_drawn_above_it_and_one_below_shines_through(renderer, picture):
    cells = floor_cells(LAYOUT, 1)
    rows, columns = np.nonzero(cells)
    assert 0 < len(rows) < 0.3 * cells.size
    middle = len(rows) // 2
    x = rows[middle] * FLOOR_CELL - 0.5 * TABLE.board.length
    z = columns[middle] * FLOOR_CELL - 0.5 * TABLE.board.width
    above = seen(renderer, balls=(BallAt(1, x, z, 1),))
    below = seen(renderer, balls=(BallAt(1, x, z, 0),))
    assert (above != picture).any()
    assert (below != picture).any()
    at_above, at_below = (np.argwhere((p != picture).any(axis=2)).mean(axis=0) for p in (above, below))
    assert at_above[0] < at_below[0]  # higher in the picture
    renderer.effects.clear()
    assert (renderer.array(START) == picture).all()


def test_open_levels_have_no_floor():
    wall = {"points": [[0.0, -1.0], [2.0, -1.0]], "level": 1}
    mouth = {"start": [0.0, -1.0], "end": [0.0, 1.0], "from": 0, "to": 1}
    table = Table.model_validate({"format": 2, "name": "", "wall": [wall], "passage": [mouth]})
    assert not floor_cells(Layout.of(table), 1).any()


def test_poses_of_a_paddle_go_from_stop_to_stop():
    for part in moving_parts(LAYOUT):
        if part.motion is Motion.TURNING:
            angles = [pose_angle(part, pose) for pose in range(part.poses)]
            assert angles == sorted(angles)
            assert [turning_pose(part, angle) for angle in angles] == list(range(part.poses))
            assert turning_pose(part, -400.0) == 0
            assert turning_pose(part, 400.0) == part.poses - 1
        assert sorted(coarse_to_fine(part.poses)) == list(range(part.poses))


def test_keys_of_pictures_depend_on_every_key_of_the_table():
    camera, theme = Camera(TABLE.board, SIZE), THEMES["neon"]
    changed = [
        TABLE.model_copy(update={"name": "other"}),
        TABLE.replace(board={"wall_thickness": 0.09}),
        TABLE.model_copy(update={"spinner": ()}),
        TABLE.model_copy(update={"post": ()}),
        TABLE.model_copy(update={"passage": ()}),
    ]
    for key in (table_key, sprites_key, levels_key):
        keys = [key(Layout.of(table), camera, theme) for table in (TABLE, *changed)]
        assert len(set(keys)) == len(keys)


def test_eight_balls_differ_in_colour_where_a_table_has_more_than_two(renderer):
    pictures = [seen(renderer, balls=(BallAt(number, -3.0, 0.3),)) for number in range(1, 10)]
    assert len({p[renderer.score_panel.bottom :].tobytes() for p in pictures}) == 8  # the ninth is the first
