"""Compiled code is cached where a change of a callee cannot leave it stale."""

from __future__ import annotations

import ast
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import silverball
from patience import PATIENCE
from silverball.physics import code_cache as codecache, kernel

PACKAGE = Path(silverball.__file__).parent

DECORATED = re.compile(r"^\s*@(kernel|internal|inlined|ir_inlined)\b", re.MULTILINE)


def test_every_package_that_holds_kernels_takes_part_in_the_name_of_the_cache():
    holders = {
        path.relative_to(PACKAGE).parts[0]
        for path in PACKAGE.rglob("*.py")
        if re.search(
            r"^\s*@(kernel|internal|inlined|ir_inlined)\b", path.read_text(encoding="utf-8"), re.MULTILINE
        )
    }
    assert holders == set(kernel.KERNEL_PACKAGES)


CALLEE = """
from silverball.physics.kernel import kernel

STEP = 1

@kernel
def callee(number):
    return 10 * number
"""
CALLER = """
from silverball.physics.callee import STEP, callee
from silverball.physics.kernel import kernel

@kernel
def caller(number):
    return callee(number) + STEP

print(caller(4), sum(caller.stats.cache_hits.values()))
"""


def test_cached_code_never_uses_a_stale_callee_or_constant_of_another_file(tmp_path):
    """Numba's own cache would: it looks at the file of the caller alone, which does not change in here."""
    package = tmp_path / "silverball"
    shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__"))
    callee = package / "physics" / "callee.py"
    (package / "world" / "caller.py").write_text(CALLER, encoding="utf-8")
    environment = os.environ | {"PYTHONPATH": str(tmp_path), "SILVERBALL_CACHE": str(tmp_path / "cache")}

    def result_and_hits(source: str) -> tuple[int, int]:
        callee.write_text(source, encoding="utf-8")
        printed = subprocess.run(
            [sys.executable, "-c", "import silverball.world.caller"],
            env=environment, capture_output=True, text=True, check=True, timeout=PATIENCE,
        ).stdout  # fmt: skip
        result, hits = printed.split()
        return int(result), int(hits)

    other_callee, other_constant = CALLEE.replace("10 *", "100 *"), CALLEE.replace("STEP = 1", "STEP = 3")
    assert result_and_hits(CALLEE) == (41, 0)
    assert result_and_hits(CALLEE) == (41, 1), "nothing is cached, so this test shows nothing"
    assert result_and_hits(other_callee) == (401, 0)
    assert result_and_hits(other_constant) == (43, 0)
    assert result_and_hits(CALLEE) == (41, 1)


def test_importing_the_package_alone_loads_nothing_heavy():
    script = "import sys, silverball; print(sorted({name.split('.')[0] for name in sys.modules}))"
    printed = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True, timeout=PATIENCE
    ).stdout
    loaded = set(ast.literal_eval(printed))
    assert "silverball" in loaded
    assert not loaded & {"numba", "llvmlite", "numpy", "pygame", "pydantic", "PIL", "typer", "rich"}


def test_a_full_disk_costs_the_cache_and_nothing_else(tmp_path, monkeypatch):
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    def doubled(number):
        return 2 * number

    tried = []
    monkeypatch.setattr(codecache, "write", lambda *of: (tried.append(of), full()))
    compiled = kernel.kernel(doubled)
    compiled._cache = codecache.CodeCache(doubled, tmp_path)
    assert compiled(4) == 8
    assert tried, "nothing was to be written: numba keeps its cache elsewhere, mend code_cache.py"
    assert not list(tmp_path.rglob("*.nb?"))


def test_the_names_of_files_say_for_which_worlds_code_was_compiled():
    from silverball.app.startup import compile_rules, is_compiled_on_disk

    for layout, table in (("plain", "classic"), ("full", "parts")):
        silverball.World(table).step()
        compile_rules(layout)
        for name in ("step_single_world", "judge_single_game"):
            assert kernel.is_compiled(name, layout=layout)
            (found,) = codecache.find_code(kernel.code_folder(), name, layout)
            assert f".{layout}-" in found.name
        assert is_compiled_on_disk(layout)
        assert not kernel.is_compiled("step_single_world", layout="another")
