"""The shape of the code: no circles of imports, one meaning a file name, few wide kernels."""

from __future__ import annotations

import ast

import structure

REASONS: dict[str, str] = {}
"""Kernels that may have more than eight parameters, and why."""


def test_no_modules_import_each_other():
    assert structure.circles() == []


def test_no_two_files_share_a_name():
    """A command may be called as what it commands, a kind of part as what moves or shows it."""
    shared = {
        name: paths
        for name, paths in structure.homonyms().items()
        if len([path for path in paths if not path.startswith(("cli/", "table/kinds/"))]) > 1
    }
    assert shared == {}


def test_kernels_take_at_most_eight_parameters():
    assert set(structure.wide_kernels()) == set(REASONS)
    assert len(REASONS) <= 5


def test_every_package_is_told_in_one_sentence():
    for module, path in structure.sources().items():
        if path.name == "__init__.py":
            text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
            first = text.split("\n")[0]
            assert first.endswith("."), f"{module}: {first!r}"
            assert "?" not in first


def test_no_file_opens_with_a_question():
    for module, path in structure.sources().items():
        text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
        assert "?" not in text.split("\n")[0], module


ARRAY_PRODUCTS = {
    "table/mesh.py": "a width, only compared with a limit",
    "table/meshfile.py": "places that are rounded before they are used",
    "players/exact_layers.py": "numbers on a grid, whose sums are exact in any order",
    "web/pack.py": "integers", "game/game_batch.py": "integers", "export/film.py": "integers",
    "envs/vector.py": "integers", "envs/single.py": "integers", "envs/player_actions.py": "integers",
}  # fmt: skip
PRODUCTS = {"np." + name for name in ("dot", "vdot", "inner", "einsum", "tensordot", "matmul")}


def is_product(called: str) -> bool:
    return called in PRODUCTS or called.startswith("np.linalg.")


def test_no_bits_come_from_a_product_of_arrays():
    """A linear algebra library rounds as its processor likes; pictures of agents differed by that once."""
    found = {
        path.relative_to(structure.PACKAGE).as_posix()
        for path in structure.PACKAGE.rglob("*.py")
        if "benchmarks" not in path.parts
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if (isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult))
        or (isinstance(node, ast.Call) and is_product(ast.unparse(node.func)))
    }
    assert found == set(ARRAY_PRODUCTS)
