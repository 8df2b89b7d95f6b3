"""`silverball info`: everything a bug report needs, also where folders, packages or a display are missing."""

from __future__ import annotations

import json
import os
import tomllib
from importlib import metadata
from pathlib import Path

import numba
import pytest

import silverball as sb
from hostile_text import FEW, NAMES, NO_TEXT, obeyed_in
from silverball.cli import cache, info
from silverball.physics import PHYSICS_VERSION, kernel

ROOT = Path(__file__).parent.parent.parent


@pytest.fixture
def folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Path, Path]:
    """The folders of data and caches, which do not exist yet."""
    data, caches = tmp_path / "data", tmp_path / "cache"
    monkeypatch.setenv("SILVERBALL_DATA", str(data))
    monkeypatch.setenv("SILVERBALL_CACHE", str(caches))
    return data, caches


def reported(silverball) -> dict:
    result = silverball("info", "--json")
    assert result.returncode == 0, result.stderr
    return json.loads(result.stdout)


def test_info_names_versions_machine_folders_and_display(silverball, folders):
    data, caches = folders
    report = reported(silverball)
    versions = report["versions"]
    assert (versions["silverball"], versions["physics"]) == (sb.__version__, PHYSICS_VERSION)
    assert versions["numba"] == numba.__version__
    assert report["optional_packages"]["gymnasium"] == metadata.version("gymnasium")
    assert report["machine"]["cores"] == os.cpu_count()
    assert {name: one["path"] for name, one in report["folders"].items()} == {
        "data": str(data), "tables": str(data / "tables"), "cache": str(caches),
    }  # fmt: skip
    assert report["variables"]["SILVERBALL_CACHE"] == str(caches)
    text = silverball("info").stdout
    for word in (sb.__version__, numba.__version__, str(data), str(caches), "gymnasium", "display"):
        assert word in text


def test_info_creates_and_compiles_nothing_and_prints_nothing_but_its_report(new_process, folders):
    result = new_process("info", "--json", env=os.environ | {"PYTHONWARNINGS": "error"})
    assert (result.returncode, result.stderr) == (0, "")
    report = json.loads(result.stdout)  # without the greeting of pygame
    assert not any(folder.exists() for folder in folders)
    assert {one["state"] for one in report["folders"].values()} == {"does not exist yet"}
    assert set(report["compiled"].values()) == {False}
    assert all(one == {"files": 0, "bytes": 0} for one in report["caches"]["sizes"].values())


@pytest.mark.parametrize("name", ["play", "planner", "drawing", "environments"])
def test_info_says_what_is_compiled(silverball, folders, name):
    from silverball.envs.episode import run_task
    from silverball.physics.code_cache import code_digest, code_path

    assert run_task.__name__ == info.LAST_KERNEL_OF_ENVIRONMENTS
    function, packages = {
        "play": ("step_single_world", kernel.PLAY),
        "planner": ("plan_worlds", kernel.PLAY),
        "drawing": ("draw_ball", kernel.DRAWING),
        "environments": ("run_task", kernel.AGENTS),
    }[name]
    index = kernel.code_folder(packages) / "physics" / f"module.{function}-1.py311.{'0' * 16}.nbi"
    index.parent.mkdir(parents=True)
    digest = code_digest(index, b"code")
    index.write_text(digest)
    code_path(index, digest).write_bytes(b"code")
    assert reported(silverball)["compiled"] == {
        one: one == name for one in ("play", "planner", "drawing", "environments")
    }
    kind = "play" if name == "planner" else name
    assert reported(silverball)["caches"]["sizes"][kind] == {"files": 2, "bytes": 64 + 4}
    code_path(index, digest).write_bytes(b"damaged")
    assert not reported(silverball)["compiled"][name]


def test_every_declared_package_is_reported():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]

    def names(requirements: list[str]) -> set[str]:
        return {one.split(">")[0].split("[")[0] for one in requirements}

    assert names(project["dependencies"]) <= set(info.REQUIRED)
    assert names([*extras["video"], *extras["rl"], *extras["bench"]]) <= set(info.OPTIONAL)


def test_folders_that_are_something_else_are_reported(silverball, folders):
    data, caches = folders
    data.write_text("a file")
    caches.write_text("a file")
    report = reported(silverball)
    assert {name: one["state"] for name, one in report["folders"].items()} == {
        "data": "not a folder",
        "tables": "does not exist and cannot be created",
        "cache": "not a folder",
    }
    assert any(str(caches) in problem for problem in report["caches"]["problems"])
    assert str(caches) in silverball("info").stdout


def test_folders_without_permission_are_reported(silverball, folders, monkeypatch):
    for folder in folders:
        folder.mkdir()
    for denied, state in ((os.W_OK, "read-only"), (os.R_OK, "cannot be read")):
        monkeypatch.setattr(os, "access", lambda path, mode, denied=denied: not mode & denied)
        states = reported(silverball)["folders"]
        assert states["data"]["state"] == states["cache"]["state"] == state
    assert states["tables"]["state"] == "does not exist yet"
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    assert reported(silverball)["folders"]["tables"]["state"] == "does not exist and cannot be created"


def test_a_cache_that_cannot_be_listed_is_reported(silverball, folders, monkeypatch):
    def refuse(folder):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(cache.os, "scandir", refuse)
    problems = reported(silverball)["caches"]["problems"]
    assert len(problems) == 2
    assert all("Permission denied" in problem for problem in problems)


def test_a_folder_with_too_long_a_name_is_reported(silverball, folders, monkeypatch):
    for name in ("SILVERBALL_DATA", "SILVERBALL_CACHE"):
        monkeypatch.setenv(name, f"/{'x' * 5000}/y")
    states = {one["state"] for one in reported(silverball)["folders"].values()}
    assert states == {"does not exist and cannot be created"}


def test_a_package_that_cannot_be_imported_is_reported_and_the_rest_is_printed(
    silverball, folders, monkeypatch
):
    def broken(error: type[Exception]):
        raise error("libSDL2.so: cannot open shared object file")

    monkeypatch.setitem(info.PARTS, "display", lambda: broken(ImportError))
    monkeypatch.setitem(info.PARTS, "compiled", lambda: broken(AttributeError))
    report = reported(silverball)
    assert "libSDL2.so" in report["display"]["problem"]
    assert "libSDL2.so" in report["compiled"]["problem"]
    assert report["versions"]["silverball"] == sb.__version__
    text = silverball("info").stdout
    assert text.count("libSDL2.so") == 2
    assert sb.__version__ in text


def test_a_display_that_is_missing_is_reported(new_process):
    without = {"SDL_VIDEODRIVER": "x11", "DISPLAY": ":nowhere"}
    report = json.loads(new_process("info", "--json", env=os.environ | without).stdout)
    assert report["display"]["driver"] is None
    assert "no display" in report["display"]["problem"]
    assert report["variables"]["SDL_VIDEODRIVER"] == "x11"
    text = new_process("info", env=os.environ | without).stdout
    assert "none (SDL" in text


def test_a_display_that_is_open_stays_open(silverball, monkeypatch):
    import pygame

    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    pygame.display.init()
    try:
        driver = pygame.display.get_driver()
        assert reported(silverball)["display"]["driver"] == driver
        assert pygame.display.get_init()
    finally:
        pygame.display.quit()


@pytest.mark.parametrize("name", [*(NAMES[key] for key in FEW), NO_TEXT], ids=[*FEW, "no text"])
def test_hostile_names_of_folders_are_shown(silverball, tmp_path, monkeypatch, name):
    for variable in ("SILVERBALL_DATA", "SILVERBALL_CACHE"):
        monkeypatch.setenv(variable, str(tmp_path / name.replace("/", "|")))
    monkeypatch.setenv("SDL_HINT", name)
    for command in (["info"], ["info", "--json"], ["cache"], ["cache", "--json"], ["cache", "--clear"]):
        result = silverball(*command)
        assert result.returncode == 0, result.stderr
        assert obeyed_in(result.stdout + result.stderr) == set()
        if "--json" in command:
            json.loads(result.stdout)
