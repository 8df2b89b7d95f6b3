"""`silverball cache`: counts and clears what Silverball made in its cache folder, and nothing else."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from patience import PATIENCE
from silverball.cli import cache
from silverball.physics import kernel

VERSION, KEY, TEMPORARY = "0123456789abcdef", "ab" * 16, "0" * 16
OURS = {
    f"compiled/{VERSION}/physics/step.run-1.py311.{TEMPORARY}.nbi": 64,
    f"compiled/{VERSION}/physics/step.run-1.py311.{KEY}.nbc": 1000,
    f"compiled/{VERSION}/drawing.kernels/.{TEMPORARY}.tmp": 500,
    f"pictures/{KEY}.picture": 20_000,
    f"pictures/.silverball-{TEMPORARY}.picture": 10,
}
NOT_OURS = (
    "mine.txt",
    "scores.db",
    "compiled/mine.nbc",
    "compiled/mine/physics/a.nbc",
    f"compiled/{VERSION}/mine.nbc",
    f"compiled/{VERSION}/physics/notes.txt",
    f"compiled/{VERSION}/physics/folder.nbc/a.nbc",
    f"compiled/{VERSION}0/physics/a.nbc",
    f"other/{KEY}.picture",
    "pictures/holiday.picture",
    f"pictures/{KEY}.png",
    f"pictures/deeper/{KEY}.picture",
)


def make(folder: Path, names: dict[str, int] | tuple[str, ...]) -> None:
    for name in names:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(bytes(names[name] if isinstance(names, dict) else 3))


def files_in(folder: Path) -> set[str]:
    return {
        os.path.relpath(os.path.join(parent, name), folder)
        for parent, _, names in os.walk(folder)
        for name in names
    }


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty cache folder."""
    path = tmp_path / "cache"
    path.mkdir()
    monkeypatch.setenv("SILVERBALL_CACHE", str(path))
    return path


def test_the_sizes_of_the_caches_are_printed_and_nothing_is_removed(silverball, folder):
    make(folder, OURS)
    make(folder, NOT_OURS)
    before = files_in(folder)
    report = json.loads(silverball("cache", "--json").stdout)
    assert report["folder"] == str(folder)
    assert report["problems"] == []
    assert report["caches"]["other_versions"] == {"files": 3, "bytes": 1564}
    assert report["caches"]["pictures"] == {"files": 2, "bytes": 20_010}
    text = silverball("cache").stdout
    assert text.startswith(f"{folder}\n")
    assert "baked pictures of tables" in text
    assert files_in(folder) == before


def test_compiled_code_of_this_version_is_counted_by_kind(silverball, folder):
    for size, packages in enumerate((kernel.PLAY, kernel.STUDY, kernel.AGENTS, kernel.DRAWING), 1):
        path = kernel.code_folder(packages) / "physics" / "a.nbc"
        path.parent.mkdir(parents=True)
        path.write_bytes(bytes(size))
    caches = json.loads(silverball("cache", "--json").stdout)["caches"]
    sizes = [caches[kind]["bytes"] for kind in ("play", "study", "environments", "drawing")]
    assert sizes == [1, 2, 3, 4]
    assert caches["other_versions"]["files"] == 0


def test_clear_removes_what_silverball_made_and_nothing_else(silverball, folder):
    make(folder, OURS)
    make(folder, NOT_OURS)
    result = silverball("cache", "--clear")
    assert (result.returncode, result.stderr) == (0, "")
    assert result.stdout == f"removed 5 files, 0.0 MB, from {folder}\n"
    assert files_in(folder) == set(NOT_OURS)
    assert silverball("cache", "--clear").stdout == f"removed 0 files, 0.0 MB, from {folder}\n"


def test_clear_removes_the_folders_of_compiled_code_once_they_are_empty(silverball, folder):
    make(folder, OURS)
    report = json.loads(silverball("cache", "--clear", "--json").stdout)
    assert (report["removed_files"], report["removed_bytes"]) == (len(OURS), sum(OURS.values()))
    assert list((folder / "compiled").iterdir()) == []
    assert (folder / "pictures").is_dir()


def test_scores_and_settings_are_kept_where_data_and_caches_share_a_folder(silverball, folder, monkeypatch):
    monkeypatch.setenv("SILVERBALL_DATA", str(folder))
    assert silverball("scores").returncode == 0
    make(folder, ("settings.toml", "tables/mine.toml", "soak/log.json"))
    make(folder, OURS)
    kept = files_in(folder) - set(OURS)
    assert silverball("cache", "--clear").returncode == 0
    assert files_in(folder) == kept


@pytest.mark.parametrize("place", ["compiled", "pictures"])
def test_a_link_in_the_place_of_a_cache_is_not_followed(silverball, folder, tmp_path, place):
    elsewhere = tmp_path / "elsewhere"
    make(elsewhere, OURS)
    before = files_in(elsewhere)
    (folder / place).symlink_to(elsewhere / place)
    result = silverball("cache", "--clear")
    assert result.returncode == 2
    assert result.stderr.startswith(f"{folder / place}: this is a link, which is not followed")
    assert len(result.stderr.splitlines()) == 1
    assert files_in(elsewhere) == before


def test_links_inside_the_caches_are_not_followed_and_not_removed(silverball, folder, tmp_path):
    elsewhere = tmp_path / "elsewhere"
    make(elsewhere, OURS)
    before = files_in(elsewhere)
    (folder / "compiled" / VERSION).mkdir(parents=True)
    (folder / "pictures").mkdir()
    links = {
        f"compiled/{'f' * 16}": f"compiled/{VERSION}",
        f"compiled/{VERSION}/physics": f"compiled/{VERSION}/physics",
        f"pictures/{KEY}.picture": f"pictures/{KEY}.picture",
    }
    for link, target in links.items():
        (folder / link).symlink_to(elsewhere / target)
    assert silverball("cache", "--clear").stdout.startswith("removed 0 files")
    assert files_in(elsewhere) == before
    assert all((folder / link).is_symlink() for link in links)


@pytest.mark.skipif(os.name != "posix", reason="only Unix has pipes and sockets in folders")
def test_what_is_no_regular_file_is_kept(silverball, folder):
    path = folder / "pictures" / f"{KEY}.picture"
    path.parent.mkdir()
    for make_special in (os.mkfifo, os.mkdir):
        make_special(path)
        assert silverball("cache", "--clear").stdout.startswith("removed 0 files")
        assert path.exists()
        path.unlink() if make_special is os.mkfifo else path.rmdir()


def test_a_cache_folder_that_is_itself_a_link_is_cleared(silverball, folder, tmp_path, monkeypatch):
    make(folder, OURS)
    link = tmp_path / "link"
    link.symlink_to(folder)
    monkeypatch.setenv("SILVERBALL_CACHE", str(link))
    assert silverball("cache", "--clear").returncode == 0
    assert files_in(folder) == set()


def test_a_file_that_cannot_be_removed_is_named_and_the_others_are_removed(silverball, folder, monkeypatch):
    make(folder, OURS)
    unlink, kept = os.unlink, f"{KEY}.picture"

    def refuse(path):
        if os.path.basename(path) == kept:
            raise PermissionError(13, "Permission denied")
        unlink(path)

    monkeypatch.setattr(cache.os, "unlink", refuse)
    result = silverball("cache", "--clear")
    assert result.returncode == 2
    assert result.stdout == f"removed 4 files, 0.0 MB, from {folder}\n"
    assert result.stderr == f"{folder / 'pictures' / kept}: cannot be removed (Permission denied)\n"


def test_many_problems_are_printed_in_a_few_lines(silverball, folder, monkeypatch):
    def refuse(path):
        raise PermissionError(13, "Permission denied")

    make(folder, {f"pictures/{number:032x}.picture": 1 for number in range(100)})
    monkeypatch.setattr(cache.os, "unlink", refuse)
    result = silverball("cache", "--clear")
    assert result.returncode == 2
    assert len(result.stderr.splitlines()) == cache.SHOWN_PROBLEMS + 1
    assert "and 90 more problems" in result.stderr


@pytest.mark.parametrize("is_there", [False, True])
def test_a_cache_folder_that_is_missing_or_a_file(silverball, tmp_path, monkeypatch, is_there):
    path = tmp_path / "nowhere"
    monkeypatch.setenv("SILVERBALL_CACHE", str(path))
    if is_there:
        path.write_text("precious")
    assert silverball("cache").returncode == 0
    result = silverball("cache", "--clear")
    assert result.returncode == (2 if is_there else 0)
    assert result.stdout == f"removed 0 files, 0.0 MB, from {path}\n"
    assert (path.read_text() == "precious") if is_there else not path.exists()


def test_indexes_are_removed_before_the_code_that_they_name(folder):
    make(folder, OURS)
    endings = [Path(one.path).suffix for one in cache.find_files(folder).files]
    assert endings[0] == ".nbi"
    assert ".nbi" not in endings[1:]


def test_what_another_process_removes_meanwhile_is_no_error(folder):
    make(folder, OURS)
    listing = cache.find_files(folder)
    for file in listing.files[:3]:
        os.unlink(file.path)
    removed, problems = cache.remove_files(listing)
    assert (len(removed), problems) == (2, [])
    assert cache.remove_files(listing) == ([], [])


def test_the_files_that_silverball_makes_are_recognised(folder):
    import numpy as np

    from silverball.drawing.picture_cache import PictureCache, key_of
    from silverball.physics.code_cache import CodeCache

    def squared(number):
        return number * number

    squared.__module__ = "silverball.drawing.kernels.art"
    dispatcher = kernel.kernel(squared)
    vars(dispatcher)["_cache"] = CodeCache(squared, kernel.code_folder(kernel.DRAWING))
    assert dispatcher(3) == 9
    PictureCache().save(key_of("a picture"), {"pixels": np.zeros(3)})
    listing = cache.find_files(folder)
    assert {one.path for one in listing.files} == {str(folder / name) for name in files_in(folder)}
    assert sorted(one.kind for one in listing.files) == ["drawing", "drawing", "pictures"]


PLAYING = """
import sys
from silverball.physics.kernel import kernel

@kernel
def squared(number):
    return number * number

print(squared(3), flush=True)
sys.stdin.readline()
print(squared(3), squared(0.5), flush=True)
"""


def test_a_program_that_runs_meanwhile_goes_on(silverball, folder):
    command = [sys.executable, "-W", "error", "-c", PLAYING]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "9\n"
        result = silverball("cache", "--clear")
        assert result.returncode == 0
        assert result.stdout.startswith("removed 2 files")
        out, errors = process.communicate("go\n", timeout=PATIENCE)
    assert (out, errors) == ("9 0.25\n", "")
    assert len(files_in(folder)) == 2, "it does not keep what it compiles later"
