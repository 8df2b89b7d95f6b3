"""Mesh files are read as trimesh reads them, or refused in a sentence and with little memory."""

from __future__ import annotations

import json
import math
import struct
import tracemalloc

import numpy as np
import pytest

from silverball.errors import TableError
from silverball.table import mesh, parse_table
from silverball.table.mesh import MESH_LIMIT, circle_footprint, triangle_footprint
from silverball.table.meshfile import KINDS, MeshError, mesh_points
from silverball.table.table import MESHES_LIMIT

trimesh = pytest.importorskip("trimesh")

BOX = [(x, y, z) for x in (0.0, 1.0) for y in (0.0, 2.0) for z in (0.0, 3.0)]


def glb(scene, binary=b"", length=None):
    """A GLB file of a scene and its data."""
    text = json.dumps({"asset": {"version": "2.0"}} | scene).encode() if isinstance(scene, dict) else scene
    text += b" " * (-len(text) % 4)
    binary += bytes(-len(binary) % 4)
    total = 12 + 8 + len(text) + 8 + len(binary)
    head = struct.pack("<4sIIII", b"glTF", 2, total, len(text) if length is None else length, 0x4E4F534A)
    return head + text + struct.pack("<II", len(binary), 0x004E4942) + binary


def scene_of(points, nodes=None, **more):
    """A scene whose mesh 0 are some points, and its data."""
    binary = np.array(points, "<f4").tobytes()
    scene = {
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}] if nodes is None else nodes,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": len(binary)}],
        "buffers": [{"byteLength": len(binary)}],
    }
    return scene | more, binary


def box_scene(**changes):
    """The scene of a box with parts of it changed: each change is a path and a value."""
    scene, binary = scene_of(BOX)
    for path, value in changes.items():
        *steps, last = [int(step) if step.isdigit() else step for step in path.split("__")]
        place = scene
        for step in steps:
            place = place[step]
        place[last] = value
    return glb(scene, binary)


def sorted_rows(points):
    return sorted({tuple(round(float(value), 5) for value in point) for point in points})


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(5))
def test_a_mesh_has_the_points_that_trimesh_finds(tmp_path, kind, seed):
    random = np.random.default_rng(seed)
    ball = trimesh.creation.icosphere(subdivisions=2, radius=float(random.uniform(0.1, 3.0)))
    ball.apply_transform(trimesh.transformations.random_rotation_matrix(random.uniform(size=3)))
    ball.apply_translation(random.uniform(-5.0, 5.0, 3))
    ball.export(tmp_path / f"ball.{kind}")
    found = mesh_points((tmp_path / f"ball.{kind}").read_bytes(), kind)
    again = trimesh.load(tmp_path / f"ball.{kind}", force="mesh", process=False)
    assert np.allclose(sorted_rows(found), sorted_rows(again.vertices), atol=2e-5)


def test_a_text_stl_has_the_points_of_the_binary_one(tmp_path):
    box = trimesh.creation.box((1.0, 2.0, 3.0))
    texts = [box.export(file_type="stl_ascii").encode(), box.export(file_type="stl")]
    assert sorted_rows(mesh_points(texts[0], "stl")) == sorted_rows(mesh_points(texts[1], "stl"))
    assert sorted_rows(mesh_points(texts[0].replace(b"\n", b"\r\n"), "stl")) == sorted_rows(
        BOX - np.array([0.5, 1, 1.5])
    )


def test_a_tree_of_nodes_moves_its_meshes_as_trimesh_does(tmp_path):
    scene = trimesh.Scene()
    turned = trimesh.transformations.rotation_matrix(0.7, (1.0, 2.0, 3.0), (0.5, 0.0, 1.0))
    moved = trimesh.transformations.compose_matrix(scale=(2.0, 1.0, 0.5), translate=(1.0, 2.0, 3.0))
    box = trimesh.creation.box((1.0, 2.0, 3.0))
    scene.add_geometry(box, node_name="one", geom_name="box", transform=turned)
    scene.add_geometry(box, node_name="two", geom_name="box", parent_node_name="one", transform=moved)
    content = scene.export(file_type="glb")
    places = [turned, turned @ moved]
    expected = np.concatenate([trimesh.transform_points(box.vertices, place) for place in places])
    assert np.allclose(sorted_rows(mesh_points(content, "glb")), sorted_rows(expected), atol=2e-5)


def test_translation_rotation_and_scale_of_a_node_are_applied_in_this_order():
    half = math.sqrt(0.5)  # a quarter turn about y takes z to x and x to -z
    node = {"mesh": 0, "translation": [10, 0, 0], "rotation": [0, half, 0, half], "scale": [2, 1, 1]}
    points = mesh_points(glb(*scene_of([(1.0, 0.0, 0.0), (0.0, 0.0, 1.0)], [node])), "glb")
    assert np.allclose(points, [(10.0, 0.0, -2.0), (11.0, 0.0, 0.0)])


def test_vertices_that_no_face_uses_do_not_count():
    text = b"v 0 0 0\nv 1 0 0\nv 0 0 1\nv 9 9 9\nf 1 2/1 -2//3\n"
    assert sorted_rows(mesh_points(text, "obj")) == [(0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)]
    scene, binary = scene_of([(0, 0, 0), (1, 0, 0), (0, 0, 1), (9, 9, 9)])
    scene["meshes"][0]["primitives"][0]["indices"] = 1
    scene["accessors"].append({"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"})
    scene["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": 6})
    points = mesh_points(glb(scene, binary + np.array([2, 0, 1], "<u2").tobytes()), "glb")
    assert sorted_rows(points) == [(0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)]


def test_sparse_rows_take_the_places_of_others():
    scene, binary = scene_of([(5.0, 6.0, 7.0)])
    sparse = {
        "count": 1,
        "indices": {"bufferView": 1, "componentType": 5121},
        "values": {"bufferView": 0},
    }
    scene["accessors"] = [{"componentType": 5126, "count": 3, "type": "VEC3", "sparse": sparse}]
    scene["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": 1})
    points = mesh_points(glb(scene, binary + b"\x01"), "glb")
    assert points.tolist() == [[0.0, 0.0, 0.0], [5.0, 6.0, 7.0], [0.0, 0.0, 0.0]]


def deep(depth):
    nodes = [{"children": [number + 1]} for number in range(depth)] + [{"mesh": 0}]
    return glb(*scene_of(BOX, nodes))


def doubling(levels):
    """Each node shows the next one twice."""
    nodes = [{"children": [number + 1] * 2} for number in range(levels)] + [{"mesh": 0}]
    return glb(*scene_of(BOX, nodes))


def instances(count, points):
    nodes = [{"children": list(range(1, count + 1))}, *[{"mesh": 0}] * count]
    return glb(*scene_of(np.random.default_rng(1).random((points, 3)), nodes))


def external(uri):
    return box_scene(buffers__0={"byteLength": 96, "uri": uri})


def stl(count, size):
    return bytes(80) + struct.pack("<I", count) + bytes(size)


TOO_MUCH = {
    "60 instances of 14 MB": (lambda: instances(60, 1_200_000), "glb"),
    "9,000 instances of a box": (lambda: instances(9_000, 1_000), "glb"),
    "nodes that double 40 times": (lambda: doubling(40), "glb"),
    "a node inside itself": (lambda: box_scene(nodes__0={"mesh": 0, "children": [0]}), "glb"),
    "two nodes inside each other": (
        lambda: glb(*scene_of(BOX, [{"children": [1]}, {"children": [0]}])),
        "glb",
    ),
    "100,000 nodes one in another": (lambda: deep(100_000), "glb"),
    "an accessor of 4 billion rows without data": (
        lambda: box_scene(accessors__0={"componentType": 5126, "count": 2**32 - 1, "type": "VEC3"}),
        "glb",
    ),
    "an accessor beyond its data": (lambda: box_scene(accessors__0__count=9), "glb"),
    "an accessor of a negative count": (lambda: box_scene(accessors__0__count=-1), "glb"),
    "an accessor that counts with a fraction": (lambda: box_scene(accessors__0__count=1.5), "glb"),
    "an accessor of an unknown type": (lambda: box_scene(accessors__0__componentType=9), "glb"),
    "an accessor of matrices": (lambda: box_scene(accessors__0__type="MAT4"), "glb"),
    "a stride that is shorter than a row": (lambda: box_scene(bufferViews__0__byteStride=4), "glb"),
    "a view beyond the data": (
        lambda: box_scene(bufferViews__0__byteLength=10**9, accessors__0__count=10**6),
        "glb",
    ),
    "data in a file": (lambda: external("data.bin"), "glb"),
    "data in the system": (lambda: external("/etc/hostname"), "glb"),
    "data on the web": (lambda: external("https://example.org/data.bin"), "glb"),
    "a mesh that is not there": (lambda: box_scene(nodes__0__mesh=7), "glb"),
    "a node that is not there": (lambda: box_scene(scenes__0__nodes=[7]), "glb"),
    "nodes that are no list": (lambda: box_scene(nodes=7), "glb"),
    "a scene that is a list": (lambda: glb(b"[]"), "glb"),
    "a scene that is nested without end": (lambda: glb(b"[" * 500_000), "glb"),
    "a scene of 12 MB": (lambda: glb(b"[" + b"[]," * 4_000_000 + b"0]"), "glb"),
    "a scene that ends early": (lambda: glb({}, length=4), "glb"),
    "a matrix of two numbers": (lambda: box_scene(nodes__0__matrix=[1, 2]), "glb"),
    "a place that is no number": (lambda: box_scene(nodes__0__translation=[math.nan, 0, 0]), "glb"),
    "a place beyond all bounds": (lambda: box_scene(nodes__0__scale=[1e300, 1e300, 1e300]), "glb"),
    "compression": (lambda: box_scene(extensionsRequired=["KHR_draco_mesh_compression"]), "glb"),
    "nothing": (lambda: b"", "glb"),
    "an STL that promises 4 billion triangles": (lambda: stl(2**32 - 1, 50), "stl"),
    "an STL of 16 MB of noise": (lambda: np.random.default_rng(2).bytes(MESH_LIMIT), "stl"),
    "an STL of 16 MB in text": (lambda: b"solid\n" + b"vertex 1 1 1\n" * (MESH_LIMIT // 13 - 1), "stl"),
    "a text STL of empty lines": (lambda: b"solid" + b"\n" * (MESH_LIMIT - 5), "stl"),
    "an OBJ of one line": (lambda: b"v 0 0 0\nf " + b"1 " * (MESH_LIMIT // 2 - 5), "obj"),
    "an OBJ of empty lines": (lambda: b"\n" * MESH_LIMIT, "obj"),
    "an OBJ of 16 MB of vertices": (lambda: b"v 1 1 1\n" * (MESH_LIMIT // 8), "obj"),
    "an OBJ whose faces name what is not there": (lambda: b"v 0 0 0\nf 1 2 999999999999\n", "obj"),
    "an OBJ whose faces count back too far": (lambda: b"v 0 0 0\nf -1 -2 -3\n", "obj"),
    "an OBJ of huge numbers": (lambda: b"v 1e308 0 0\nv 0 0 1e308\nv 1 1 1\nf 1 2 3\n", "obj"),
    "an OBJ of a number with 100,000 digits": (lambda: b"v 0 0 0\nf 1" + b"0" * 60_000 + b"\n", "obj"),
    "290,000 corners": (
        lambda: b"".join(b"v %r 0 %r\nf %d\n" % (math.cos(i), math.sin(i), i + 1) for i in range(290_000)),
        "obj",
    ),
}


LONG_TEXTS = ("an STL of 16 MB in text", "an OBJ of 16 MB of vertices")  # a minute each under the tracing


@pytest.mark.parametrize(
    "what", [pytest.param(what, marks=[pytest.mark.slow] * (what in LONG_TEXTS)) for what in TOO_MUCH]
)
def test_a_file_that_asks_for_too_much_is_refused_in_a_sentence_and_in_little_memory(tmp_path, what):
    make, kind = TOO_MUCH[what]
    path = tmp_path / f"some.{kind}"
    path.write_bytes(make()[:MESH_LIMIT])
    tracemalloc.start()
    try:
        with pytest.raises(TableError) as caught:
            triangle_footprint(path)
        assert tracemalloc.get_traced_memory()[1] < 200e6
    finally:
        tracemalloc.stop()
    ((place, message, _),) = caught.value.problems
    assert place == "mesh"
    assert message
    assert "\n" not in message


def test_a_post_of_100_000_corners_leaves_its_circle_in_little_memory(tmp_path):
    path = tmp_path / "post.stl"
    turn = np.linspace(0.0, 2.0 * np.pi, 300_000)
    corners = np.stack([np.cos(turn) + 2.0, np.zeros_like(turn), np.sin(turn) - 1.0], axis=-1).astype("<f4")
    triangles = np.zeros(100_000, [("normal", "<f4", 3), ("corner", "<f4", 9), ("attribute", "<u2")])
    triangles["corner"] = corners.reshape(-1, 9)
    path.write_bytes(stl(len(triangles), 0) + triangles.tobytes())
    tracemalloc.start()
    try:
        assert circle_footprint(path) == pytest.approx((2.0, -1.0, 1.0), abs=1e-5)
        assert tracemalloc.get_traced_memory()[1] < 200e6
    finally:
        tracemalloc.stop()


def parts_of_meshes(names):
    return "".join(f'[[triangular_prism]]\nmesh = "{name}"\n' for name in names)


def test_a_mesh_that_many_parts_name_is_read_once(tmp_path, monkeypatch):
    (tmp_path / "bad.obj").write_text("v 1 2 3\nf 1 2 3\n", encoding="utf-8")
    (tmp_path / "good.obj").write_text("v 2 0 -1\nv 3.2 0 -1.4\nv 2.4 0 0.2\nf 1 2 3\n", encoding="utf-8")
    read = []
    monkeypatch.setattr(
        mesh, "mesh_points", lambda content, kind: read.append(kind) or mesh_points(content, kind)
    )
    with pytest.raises(TableError) as caught:
        parse_table(parts_of_meshes(["bad.obj", "good.obj"] * 50), folder=tmp_path)
    assert len(read) == 2
    assert sum(problem.path.endswith(".mesh") for problem in caught.value.problems) == 50
    assert all(problem.is_error for problem in caught.value.problems), "that the good ones overlap is none"


def test_a_table_reads_no_more_meshes_than_its_limit(tmp_path):
    for number in range(MESHES_LIMIT + 3):
        text = f"v {number / 4 - 4} 0 0\nv {number / 4 - 3.9} 0 0.1\nv {number / 4 - 4} 0 0.2\nf 1 2 3\n"
        (tmp_path / f"{number}.obj").write_text(text, encoding="utf-8")
    with pytest.raises(TableError) as caught:
        parse_table(parts_of_meshes(f"{number}.obj" for number in range(MESHES_LIMIT + 3)), folder=tmp_path)
    refused = [path for path, message, _ in caught.value.problems if "too many" in message]
    assert refused == [f"triangular_prism[{MESHES_LIMIT + more}].mesh" for more in range(3)]


@pytest.mark.parametrize("kind", KINDS)
def test_any_damage_to_a_mesh_file_is_an_error_in_words_or_still_a_mesh(kind):
    content = trimesh.creation.box((1.0, 2.0, 3.0)).export(file_type=kind)
    content = content.encode() if isinstance(content, str) else content
    random = np.random.default_rng(5)
    for _ in range(600):
        damaged = bytearray(content)
        for place in random.integers(len(damaged), size=random.integers(1, 4)):
            damaged[place] = random.integers(256)
        cut = len(damaged) if random.random() < 0.7 else random.integers(len(damaged))
        try:
            width = mesh_points(bytes(damaged[:cut]), kind).shape[1]
        except MeshError as error:
            width = 0 if "\n" in str(error) else 3
        assert width == 3
