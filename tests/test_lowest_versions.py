"""What is declared as the lowest version of a package is what `.ci/run` installs and tests."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
spec = importlib.util.spec_from_file_location("make_lowest", ROOT / "constraints" / "make_lowest.py")
assert spec is not None
assert spec.loader is not None
make_lowest = importlib.util.module_from_spec(spec)
spec.loader.exec_module(make_lowest)

PROJECT = (ROOT / "pyproject.toml").read_text(encoding="utf-8")


def test_the_lowest_versions_are_those_of_the_project():
    written = (ROOT / "constraints" / "lowest.txt").read_text(encoding="utf-8")
    assert written == make_lowest.lowest(PROJECT), "run: python constraints/make_lowest.py"


def test_every_package_that_is_needed_to_run_is_among_them():
    lines = make_lowest.lowest(PROJECT).splitlines()
    for name in ("numpy", "numba", "pygame-ce", "typer", "trimesh", "av", "gymnasium", "pytest"):
        assert sum(line.startswith(f"{name}==") for line in lines) == 1


def test_a_package_without_a_lowest_version_is_refused():
    with pytest.raises(ValueError, match="rich"):
        make_lowest.lowest(PROJECT.replace("rich>=13.7", "rich"))


def test_the_checks_of_every_change_use_them():
    assert "-c constraints/lowest.txt" in (ROOT / ".ci" / "run").read_text(encoding="utf-8")
