"""Where compiled code is kept: never in a place where a change of a callee could leave it stale."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import silverball
from silverball.physics import kernel

PACKAGE = Path(silverball.__file__).parent


def test_every_package_that_holds_kernels_takes_part_in_the_name_of_the_cache():
    holders = {
        path.relative_to(PACKAGE).parts[0]
        for path in PACKAGE.rglob("*.py")
        if re.search(r"^\s*@(kernel|inlined)\b", path.read_text(encoding="utf-8"), re.MULTILINE)
    }
    assert holders == set(kernel.KERNEL_PACKAGES)


def test_a_change_in_a_callee_of_another_file_is_seen_by_cached_code(tmp_path):
    package = tmp_path / "silverball"
    shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__"))
    script = (
        "from silverball.physics.bounce import capped\n"  # calls nothing of another file but a constant
        "from silverball.physics.layout import Ball\n"
        "print(capped(Ball(0.0, 0.0, 8.0, 0.0, 1), 4.0).vx)"
    )
    environment = os.environ | {"PYTHONPATH": str(tmp_path), "SILVERBALL_CACHE": str(tmp_path / "cache")}

    def speed() -> float:
        printed = subprocess.run(
            [sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True
        ).stdout
        return float(printed)

    before = speed()
    tolerances = package / "physics" / "tolerances.py"
    tolerances.write_text(
        re.sub(r"CAP_MARGIN = .*", "CAP_MARGIN = 0.5", tolerances.read_text(encoding="utf-8"))
    )
    assert (before, speed()) == (4.0 * kernel_margin(), 2.0)


def kernel_margin() -> float:
    from silverball.physics.tolerances import CAP_MARGIN

    return CAP_MARGIN


def test_a_full_disk_costs_the_cache_and_nothing_else():
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    class Store:
        save_overload = staticmethod(full)

    store = Store()
    kernel._save_if_possible(store)
    store.save_overload("signature", "code")
    assert hasattr(kernel.kernel(kernel_margin), "_cache"), "numba keeps its cache elsewhere: mend kernel.py"
