"""Themes: whole palettes; and in "clear" all eyes tell the kinds of things apart."""

from __future__ import annotations

from itertools import combinations, pairwise

import numpy as np
import pytest

from boards import CLASSIC
from silverball.drawing import THEMES, Moment, Renderer, Theme
from silverball.drawing.kernels.stage import FLOOR, Material
from silverball.drawing.layout import Layout
from silverball.drawing.moment import BallAt
from silverball.drawing.moving import moving_parts
from silverball.drawing.scene import make_scene

# How linear light is seen by eyes that lack a kind of cone.
# Source: G. M. Machado, M. M. Oliveira, L. A. F. Fernandes, "A physiologically-based model for simulation of
# color vision deficiency", IEEE TVCG 15 (2009), table 1, severity 1.0.
EYES = {
    "all cones": np.eye(3),
    "protanope": [
        [0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]
    ],
    "deuteranope": [
        [0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]
    ],
    "tritanope": [
        [1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]
    ],
}  # fmt: skip
MIN_DIFFERENCE = 22.0  # of CIELAB; 2.3 is just seen, and about 10 is seen at a glance

# Source: IEC 61966-2-1, linear sRGB to CIE XYZ, and its white D65.
TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
WHITE = np.array([0.9505, 1.0, 1.089])

TABLE = CLASSIC
SIZE = (240, 384)
BALL = BallAt(1, 0.6, 1.9)


def lab(color, eyes):
    """CIELAB of a colour of the screen (0 to 255), as these eyes see it."""
    share = np.asarray(color) / 255.0
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    xyz = TO_XYZ @ np.clip(np.asarray(EYES[eyes]) @ linear, 0.0, 1.0) / WHITE
    f = np.where(xyz > (6 / 29) ** 3, np.cbrt(xyz), xyz / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


@pytest.fixture(scope="module")
def seen(picture_cache):
    """The mean colours of the kinds of things in a picture of the clear theme."""
    renderer = Renderer(TABLE, SIZE, theme="clear", cache=picture_cache)
    picture = renderer.array(Moment.before(TABLE)._replace(balls=(BALL,))).astype(float)
    from silverball.drawing.bake_threads import BakeThreads
    from silverball.drawing.kernels.bake import new_canvas

    layout = Layout.of(TABLE)
    poses = [(part, 0) for part in moving_parts(layout)]
    scene = make_scene(layout, renderer.camera, renderer.theme, poses)
    canvas = new_canvas(SIZE)
    BakeThreads().bake(scene, canvas)
    materials = {Material.BUMPER: "cylinder", Material.ACRYLIC: "prism", Material.PADDLE: "paddle"}
    colors = {
        name: picture[np.isin(canvas.part, np.flatnonzero(scene.solids["material"] == material))].mean(axis=0)
        for material, name in materials.items()
    }
    colors["floor"] = picture[canvas.part == FLOOR].mean(axis=0)
    across, down = renderer.camera.to_pixel(BALL.x, BALL.z, TABLE.board.ball_radius)
    rows, columns = np.ogrid[: SIZE[1], : SIZE[0]]
    size = TABLE.board.ball_radius * renderer.camera.scale
    disc = (rows + 0.5 - down) ** 2 + (columns + 0.5 - across) ** 2 < (0.8 * size) ** 2
    colors["ball"] = picture[disc].mean(axis=0)
    return colors


@pytest.mark.parametrize("eyes", EYES)
def test_all_eyes_tell_the_kinds_of_things_of_the_clear_theme_apart(seen, eyes):
    differences = {
        (one, other): float(np.linalg.norm(lab(seen[one], eyes) - lab(seen[other], eyes)))
        for one, other in combinations(seen, 2)
    }
    assert len(differences) == 10
    assert min(differences.values()) > MIN_DIFFERENCE, differences


def test_the_kinds_of_the_clear_theme_differ_in_brightness_alone_too(seen):
    """Ball, paddle, cylinder, prism, floor: in grey they come in this order, well apart."""
    light = {name: lab(color, "all cones")[0] for name, color in seen.items()}
    order = sorted(light, key=light.__getitem__, reverse=True)
    assert order == ["ball", "paddle", "cylinder", "prism", "floor"]
    assert min(light[one] - light[other] for one, other in pairwise(order)) > 5.0


@pytest.mark.parametrize("name", THEMES)
def test_every_theme_has_colours_that_are_colours_and_a_bright_ball(name, picture_cache):
    theme = THEMES[name]
    for value in vars(theme).values():
        for color in value if isinstance(value, tuple) and isinstance(value[0], tuple) else ():
            assert all(0 <= level <= 255 for level in color)
    moment = Moment.before(TABLE)
    renderer = Renderer(TABLE, SIZE, theme=name, cache=picture_cache)
    bare = renderer.array(moment).astype(int)
    across, down = renderer.camera.to_pixel(BALL.x, BALL.z, TABLE.board.ball_radius)
    with_ball = renderer.array(moment._replace(balls=(BALL,))).astype(int)
    box = np.s_[int(down) - 3 : int(down) + 3, int(across) - 3 : int(across) + 3]
    assert with_ball[box].mean() > bare[box].mean() + 60


def test_themes_are_looks_that_differ(picture_cache):
    moment = Moment.before(TABLE)
    pictures = {
        name: Renderer(TABLE, SIZE, theme=name, cache=picture_cache).array(moment).astype(int)
        for name in THEMES
    }
    for one, other in combinations(pictures.values(), 2):
        assert np.abs(one - other).mean() > 10.0


def test_a_theme_of_ones_own_can_be_given():
    own = Theme(**(vars(THEMES["neon"]) | {"room": (200, 0, 0)}))
    picture = Renderer(TABLE, (200, 100), theme=own).array(Moment.before(TABLE))
    assert picture[-1, 0, 0] > picture[-1, 0, 1] + 40
