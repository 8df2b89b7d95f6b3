"""The footprint of a mesh is the triangle or the circle that the mesh was made from."""

import itertools
import math
import pickle

import numpy as np
import pytest

from silverball.errors import TableError
from silverball.table import (
    Cylinder,
    TriangularPrism,
    dump_table,
    load_table,
    mesh as meshes,
    parse_table,
    table_digest,
)
from silverball.table.mesh import (
    MESH_LIMIT,
    circle_footprint,
    convex_hull,
    largest_triangle,
    smallest_circle,
    triangle_footprint,
)

trimesh = pytest.importorskip("trimesh")

KINDS = ["stl", "obj", "glb"]
WEDGE = [(2.0, -1.0), (3.2, -1.4), (2.4, 0.2)]


def write_wedge(path, corners=WEDGE, height=1.5):
    """An upright prism over a triangle: the mesh's axes are the table's, y up."""
    vertices = [(x, y, z) for y in (0.0, height) for x, z in corners]
    count = len(corners)
    caps = [(0, i, i + 1) for i in range(1, count - 1)]
    sides = [(i, (i + 1) % count, i + count) for i in range(count)]
    sides += [((i + 1) % count, (i + 1) % count + count, i + count) for i in range(count)]
    faces = [*caps, *((a + count, b + count, c + count) for a, b, c in caps), *sides]
    trimesh.Trimesh(vertices, faces).export(path)


def write_post(path, center=(5.0, 1.5), radius=0.6):
    mesh = trimesh.creation.cylinder(radius=radius, height=2.0, sections=64)  # along its own z
    mesh.apply_transform(trimesh.transformations.rotation_matrix(math.pi / 2, (1, 0, 0)))
    mesh.apply_translation((center[0], 1.0, center[1]))
    mesh.export(path)


def rotations(corners):
    return [tuple(corners[i:]) + tuple(corners[:i]) for i in range(3)]


@pytest.mark.parametrize("kind", KINDS)
def test_a_wedge_leaves_its_triangle_counter_clockwise(tmp_path, kind):
    path = tmp_path / f"wedge.{kind}"
    write_wedge(path)
    expected = TriangularPrism(vertices=WEDGE).corners()
    found = triangle_footprint(path)
    assert any(np.allclose(found, turned, atol=1e-6) for turned in rotations(expected))


@pytest.mark.parametrize("kind", KINDS)
def test_a_post_leaves_its_circle(tmp_path, kind):
    path = tmp_path / f"post.{kind}"
    write_post(path)
    assert circle_footprint(path) == pytest.approx((5.0, 1.5, 0.6), abs=1e-5)  # STL and GLB: single precision


def test_a_table_file_finds_its_meshes_beside_it_and_keeps_their_footprints(tmp_path):
    write_wedge(tmp_path / "wedge.stl")
    write_post(tmp_path / "post.obj")
    path = tmp_path / "mine.toml"
    path.write_text(
        '[[triangular_prism]]\nmesh = "wedge.stl"\n\n[[cylinder]]\nmesh = "post.obj"\npoints = 7\n',
        encoding="utf-8",
    )
    table = load_table(path)
    assert table.triangular_prism[0].mesh is None
    assert table.cylinder[0].points == 7
    assert table.cylinder[0].circle() == pytest.approx((5.0, 1.5, 0.6), abs=1e-5)
    alone = parse_table(dump_table(table))  # needs no mesh any more
    assert alone == table
    assert table_digest(alone) == table_digest(table)


def test_a_part_made_in_python_reads_its_mesh_when_asked(tmp_path):
    write_wedge(tmp_path / "wedge.stl")
    prism = TriangularPrism(mesh=str(tmp_path / "wedge.stl"))
    assert prism.corners() == prism.resolved().vertices
    write_post(tmp_path / "post.stl")
    assert Cylinder(mesh=str(tmp_path / "post.stl")).circle()[2] == pytest.approx(0.6, abs=1e-5)


def test_all_meshes_that_are_no_good_are_reported_with_their_paths(tmp_path):
    (tmp_path / "damaged.glb").write_bytes(b"glTF but no more")
    (tmp_path / "noise.obj").write_bytes(b"v 1 2\nv a b c\nf 1 2 3\n")
    (tmp_path / "empty.stl").write_bytes(b"")
    (tmp_path / "code.pkl").write_bytes(pickle.dumps({"never": "loaded"}))
    with open(tmp_path / "huge.stl", "wb") as file:
        file.truncate(MESH_LIMIT + 1)
    flat = trimesh.Trimesh([(0, 0, 0), (1, 0, 0), (0.5, 1, 0)], [(0, 1, 2)])
    flat.export(tmp_path / "upright.stl")
    names = ["missing.stl", "damaged.glb", "noise.obj", "empty.stl", "code.pkl", "huge.stl", "upright.stl"]
    text = "".join(f'[[triangular_prism]]\nmesh = "{name}"\n' for name in names)
    (tmp_path / "mine.toml").write_text(text, encoding="utf-8")
    with pytest.raises(TableError) as caught:
        load_table(tmp_path / "mine.toml")
    problems = {problem.path: problem.message for problem in caught.value.problems}
    assert problems.keys() == {f"triangular_prism[{index}].mesh" for index in range(len(names))}
    assert "No such file" in problems["triangular_prism[0].mesh"]
    assert "must be an STL, OBJ or GLB file" in problems["triangular_prism[4].mesh"]
    assert "the limit for a mesh" in problems["triangular_prism[5].mesh"]
    assert "flat" in problems["triangular_prism[6].mesh"]
    assert all("\n" not in message for message in problems.values())


def test_reading_a_mesh_needs_no_package(tmp_path, monkeypatch):
    import sys

    write_wedge(tmp_path / "wedge.glb")
    monkeypatch.setitem(sys.modules, "trimesh", None)
    assert len(triangle_footprint(tmp_path / "wedge.glb")) == 3


def area(a, b, c):
    return (b[1] - a[1]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[1] - a[1])


@pytest.mark.parametrize("seed", range(20))
def test_the_largest_triangle_is_the_largest_of_all_triples(seed):
    points = np.random.default_rng(seed).normal(size=(40, 2))
    hull = convex_hull(points)
    assert all(area(*hull[[i - 2, i - 1, i]]) > 0.0 for i in range(len(hull)))
    best = max(area(*triple) for triple in itertools.combinations(hull, 3))
    assert area(*largest_triangle(hull)) == pytest.approx(best)


@pytest.mark.parametrize("seed", range(20))
def test_the_smallest_circle_holds_all_points_and_cannot_shrink(seed):
    points = np.random.default_rng(seed).normal(size=(30, 2))
    x, z, radius = smallest_circle(points)
    away = points - (x, z)
    distance = np.hypot(*away.T)
    assert distance.max() <= radius + 1e-9
    # Points on the rim must not leave a half circle free, else the circle could move and shrink.
    rim = np.sort(np.arctan2(*away[distance > radius - 1e-9].T))
    gaps = np.diff(np.append(rim, rim[0] + 2 * math.pi))
    assert gaps.max() <= math.pi + 1e-6


def test_a_prism_with_a_footprint_of_too_many_corners_is_refused_at_once(tmp_path, monkeypatch):
    turn = np.linspace(0.0, 2.0 * np.pi, meshes.CORNERS_LIMIT + 2)[:-1]
    monkeypatch.setattr(meshes, "_points", lambda path: np.stack([np.cos(turn), np.sin(turn)], axis=-1))
    with pytest.raises(TableError, match="simplify"):
        meshes.triangle_footprint(tmp_path / "round.stl")
