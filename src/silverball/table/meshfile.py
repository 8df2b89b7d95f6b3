"""Readers of mesh files: the vertices that the faces use, at their positions in the scene.

STL (binary and text), OBJ and GLB (binary glTF 2.0) are read, as far as a footprint needs: no colours, no
textures, no other files. The file size limits the vertices of STL and OBJ. A GLB can describe far more than
it holds (many nodes with one mesh, accessors without data), so its vertices are counted before they are made.

Source: Khronos Group, glTF 2.0 specification, sections 3.5 (scenes), 3.6 (accessors) and 4.4 (GLB).
"""

from __future__ import annotations

import io
import json
import struct
from array import array
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.table.geometry import Floats

KINDS = ("stl", "obj", "glb")
POINTS_LIMIT = 1_100_000  # vertices of all instances; chosen: those of the largest binary STL
JSON_LIMIT = 2**20  # [bytes] of a GLB's scene; chosen: a thousand nodes take a tenth of it
NODES_LIMIT = 10_000  # nodes of a scene, counted once per path
LINES_LIMIT = 2_200_000  # lines of text; chosen: the most short lines ("v 1 1 1", "f 1 2 3") in 16 MiB
LINE_LIMIT = 2**16  # [bytes] of a line of text; chosen: a face of 5,000 corners
# Extensions that are supported, or do not change the shape
SUPPORTED_EXTENSIONS = ("KHR_mesh_quantization", "KHR_materials_", "KHR_texture_")
STL_HEADER = 84  # [bytes] header of a binary STL; its last four are the number of triangles
GLB_JSON, GLB_BINARY = 0x4E4F534A, 0x004E4942  # types of the chunks of a GLB
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corner", "<f4", (3, 3)), ("attribute", "<u2")])  # 50 bytes
_TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}


class MeshError(Exception):
    """A mesh file cannot be used; the message continues a sentence that starts with the file's name."""


def mesh_points(content: bytes, kind: str) -> Floats:
    """Return the vertices of a mesh file, shape [vertex, 3], some of them repeatedly.

    Args:
        content: The whole file.
        kind: One of `KINDS`.

    Raises:
        MeshError: The file is damaged, or exceeds a limit.
    """
    read = {"stl": _stl, "obj": _obj, "glb": _glb}[kind]
    try:
        with np.errstate(all="ignore"):  # values that are not finite are refused afterwards
            return read(content)
    except (ValueError, OverflowError, struct.error) as error:
        reason = str(error).split("\n")[0][:80]
        raise MeshError(f"is damaged or not a {kind.upper()} file ({reason})") from error
    except (
        TypeError,
        KeyError,
        IndexError,
        AttributeError,
        RecursionError,
    ) as error:  # JSON of another shape
        raise MeshError(
            f"is damaged or not a {kind.upper()} file (the structure of its scene is invalid)"
        ) from error


# --- STL ------------------------------------------------------------------------------------------------


def _stl(content: bytes) -> Floats:
    """Every corner of every triangle."""
    is_binary = len(content) >= STL_HEADER
    count = int.from_bytes(content[STL_HEADER - 4 : STL_HEADER], "little") if is_binary else 0
    end = STL_HEADER + _TRIANGLE.itemsize * count
    is_text = content.lstrip()[:5].lower() == b"solid" and len(content) != end
    if not is_text:
        if len(content) < max(end, STL_HEADER):
            raise ValueError(f"{len(content):,} bytes are too few for {count:,} triangles")
        triangles = np.frombuffer(content, _TRIANGLE, count, STL_HEADER)
        return triangles["corner"].reshape(-1, 3).astype(np.float64)
    values = array("d")
    for line in _lines(content):
        words = line.split()
        if words and words[0].lower() == b"vertex":
            values.extend(_vertex(words[1:]))
    return np.array(values).reshape(-1, 3)


# --- OBJ ------------------------------------------------------------------------------------------------


def _obj(content: bytes) -> Floats:
    """The vertices that a face, a line or a point uses."""
    values, used = array("d"), array("q")
    for line in _lines(content.replace(b"\\\r\n", b" ").replace(b"\\\n", b" ")):
        words = line.split()
        if not words:
            continue
        if words[0] == b"v":
            values.extend(_vertex(words[1:]))
        elif words[0] in (b"f", b"l", b"p"):
            count = len(values) // 3
            for word in words[1:]:
                number = int(word.partition(b"/")[0])
                place = number - 1 if number > 0 else count + number  # from the end, if negative
                if not 0 <= place < count:
                    raise ValueError(f"a face names vertex {number}, of {count:,} so far")
                used.append(place)
    return np.array(values).reshape(-1, 3)[np.unique(np.array(used, dtype=np.int64))]


def _lines(content: bytes) -> Iterator[bytes]:
    """Iterate over the lines; a list of them would take ten times the memory of the file."""
    text = content if b"\n" in content else content.replace(b"\r", b"\n")
    count = text.count(b"\n")
    if count > LINES_LIMIT:
        raise ValueError(f"{count:,} lines, at most {LINES_LIMIT:,}")
    for line in io.BytesIO(text):
        if len(line) > LINE_LIMIT:
            raise ValueError(f"a line of more than {LINE_LIMIT:,} characters")
        yield line


def _vertex(words: list[bytes]) -> tuple[float, float, float]:
    return float(words[0]), float(words[1]), float(words[2])


# --- GLB ------------------------------------------------------------------------------------------------


def _glb(content: bytes) -> Floats:
    """The vertices of all meshes of the scene, transformed by their nodes."""
    scene, binary = _chunks(content)
    for extension in scene.get("extensionsRequired", ()):
        if not str(extension).startswith(SUPPORTED_EXTENSIONS):
            raise MeshError(
                f"needs the extension {str(extension)[:60]!r}, which is not supported: export it without"
            )
    places = _instances(scene)
    parts = {mesh: scene["meshes"][mesh]["primitives"] for mesh, _ in places}
    counts = {mesh: sum(_count(scene, each) for each in primitives) for mesh, primitives in parts.items()}
    total = sum(counts[mesh] for mesh, _ in places)
    if total > POINTS_LIMIT:
        many = f"has {total:,} vertices in {len(places):,} places"
        raise MeshError(f"{many}, but the limit for a mesh is {POINTS_LIMIT:,}; simplify it")
    points = {
        mesh: np.concatenate(
            [np.empty((0, 3)), *(_used_vertices(scene, binary, each) for each in primitives)]
        )
        for mesh, primitives in parts.items()
    }
    found = (points[mesh] @ matrix[:3, :3].T + matrix[:3, 3] for mesh, matrix in places)
    return np.concatenate([np.empty((0, 3)), *found])


def _chunks(content: bytes) -> tuple[dict[str, Any], memoryview]:
    """The scene, and the binary data that it refers to."""
    magic, version, _, length, kind = struct.unpack_from("<4sIIII", content)
    if magic != b"glTF" or version != 2 or kind != GLB_JSON:
        raise ValueError("it does not have the header of binary glTF 2.0")
    if length > JSON_LIMIT:
        raise MeshError(f"has a scene of {length:,} bytes, at most {JSON_LIMIT:,}: simplify it")
    scene = json.loads(content[20 : 20 + length])
    if not isinstance(scene, dict):
        raise ValueError("it holds no scene")
    rest = memoryview(content)[20 + length :]
    if len(rest) < 8:
        return scene, rest[:0]
    size, kind = struct.unpack_from("<II", rest)
    return scene, rest[8 : 8 + size] if kind == GLB_BINARY else rest[:0]


def _instances(scene: dict[str, Any]) -> list[tuple[int, Floats]]:
    """Every instance of a mesh in the scene, with its matrix, shape [4, 4]."""
    nodes = scene.get("nodes", [])
    scenes = scene.get("scenes", [])
    if scenes:
        roots = scenes[_index(scene.get("scene", 0), scenes)].get("nodes", [])
    else:
        children = {child for node in nodes for child in node.get("children", [])}
        roots = [number for number in range(len(nodes)) if number not in children]
    found: list[tuple[int, Floats]] = []
    open_ = [(_index(root, nodes), np.eye(4), 0) for root in roots]
    for _ in range(NODES_LIMIT + 1):
        if not open_:
            return found
        number, above, depth = open_.pop()
        if depth > len(nodes):
            raise MeshError("has a node that contains itself: export it again")
        node = nodes[number]
        matrix = above @ _matrix(node)
        if "mesh" in node:
            found.append((_index(node["mesh"], scene["meshes"]), matrix))
        if len(open_) + len(node.get("children", [])) > NODES_LIMIT:
            break
        open_ += [(_index(child, nodes), matrix, depth + 1) for child in node.get("children", [])]
    raise MeshError(
        f"has a scene of more than {NODES_LIMIT:,} nodes, or one that contains itself: simplify it"
    )


def _matrix(node: dict[str, Any]) -> Floats:
    """The transformation of a node relative to its parent: its matrix, or T · R · S."""
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    x, y, z, w = (float(value) for value in node.get("rotation", (0.0, 0.0, 0.0, 1.0)))
    turn = np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )
    matrix = np.eye(4)
    matrix[:3, :3] = turn * np.array(node.get("scale", (1.0, 1.0, 1.0)), dtype=np.float64)
    matrix[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
    return matrix


def _count(scene: dict[str, Any], primitive: dict[str, Any]) -> int:
    """The number of vertices that reading a primitive makes."""
    names = [primitive["attributes"]["POSITION"], *([primitive["indices"]] if "indices" in primitive else [])]
    return max(
        _checked_count(scene["accessors"][_index(name, scene["accessors"])]["count"]) for name in names
    )


def _used_vertices(scene: dict[str, Any], binary: memoryview, primitive: dict[str, Any]) -> Floats:
    """The vertices of a primitive, shape [vertex, 3]; with indices only those that are used."""
    points = _accessor(scene, binary, primitive["attributes"]["POSITION"], 3).astype(np.float64)
    if "indices" not in primitive:
        return points
    named: Floats = points[np.unique(_accessor(scene, binary, primitive["indices"], 1))]
    return named


def _accessor(scene: dict[str, Any], binary: memoryview, name: Any, width: int) -> NDArray[Any]:
    """The rows of an accessor, shape [row, width] or [row]."""
    accessor = scene["accessors"][_index(name, scene["accessors"])]
    kind, count = np.dtype(_TYPES[accessor["componentType"]]), _checked_count(accessor["count"])
    if accessor["type"] != {1: "SCALAR", 3: "VEC3"}[width]:
        raise ValueError(f"an accessor of type {str(accessor['type'])[:20]}")
    if "bufferView" in accessor:
        rows = _rows(scene, binary, accessor, kind, count, width)
    else:
        rows = np.zeros((count, width), kind)
    if "sparse" in accessor:
        rows = _with_sparse(scene, binary, accessor["sparse"], rows)
    if accessor.get("normalized") and kind.kind != "f":
        rows = np.maximum(rows / np.iinfo(kind).max, -1.0)
    return rows if width > 1 else rows[:, 0]


def _with_sparse(
    scene: dict[str, Any], binary: memoryview, sparse: dict[str, Any], rows: NDArray[Any]
) -> NDArray[Any]:
    """The rows with the sparse ones filled in."""
    count = _checked_count(sparse["count"])
    if count > len(rows):
        raise ValueError("more sparse rows than rows")
    where = _rows(
        scene, binary, sparse["indices"], np.dtype(_TYPES[sparse["indices"]["componentType"]]), count, 1
    )
    rows = rows.copy()
    rows[where[:, 0]] = _rows(scene, binary, sparse["values"], rows.dtype, count, rows.shape[1])
    return rows


def _rows(
    scene: dict[str, Any],
    binary: memoryview,
    given: dict[str, Any],
    kind: np.dtype[Any],
    count: int,
    width: int,
) -> NDArray[Any]:
    """Rows of a buffer view, possibly with a stride; nothing is read beyond the view."""
    view = scene["bufferViews"][_index(given["bufferView"], scene["bufferViews"])]
    if _checked_count(view["buffer"]) != 0 or "uri" in scene["buffers"][0]:  # only buffer 0 is in this file
        raise MeshError("has its data in another file, which is not read: export it as one GLB file")
    start, size = _checked_count(view.get("byteOffset", 0)), _checked_count(view["byteLength"])
    offset, row = _checked_count(given.get("byteOffset", 0)), kind.itemsize * width
    stride = _checked_count(view.get("byteStride", 0)) or row
    if count == 0 or stride < row or start + size > len(binary) or offset + (count - 1) * stride + row > size:
        raise ValueError("an accessor reaches beyond its data")
    return np.ndarray((count, width), kind, binary, start + offset, (stride, kind.itemsize))


def _index(value: Any, among: list[Any]) -> int:
    """Check a number that refers to an item of a list."""
    number = _checked_count(value)
    if number >= len(among):
        raise ValueError(f"it names number {number:,} of {len(among):,}")
    return number


def _checked_count(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < 2**32:
        raise ValueError("an invalid count")
    return value
