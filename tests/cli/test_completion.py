"""Shell completion: the scripts, the names that they get, and that a press of Tab is quick and harmless."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from hostile_text import NAMES, NO_TEXT
from patience import PATIENCE
from silverball.cli import completion
from silverball.drawing import THEMES
from silverball.players import player_names
from silverball.table import table_names

SHELLS = ("bash", "zsh", "fish", "powershell")
DISABLED_DETECTION = "_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION"


@pytest.fixture
def completed(new_process, tmp_path):
    """The completions of a command line, one per line, as fish gets them."""

    def run(line: str) -> list[str]:
        environment = os.environ | {
            "_SILVERBALL_COMPLETE": "complete_fish",
            "_TYPER_COMPLETE_FISH_ACTION": "get-args",
            "_TYPER_COMPLETE_ARGS": line,
        }
        result = new_process(env=environment, cwd=tmp_path)
        assert (result.returncode, result.stderr) == (0, "")
        return result.stdout.split()

    return run


@pytest.mark.parametrize(
    ("line", "names"),
    [
        ("simulate --table ", table_names()),
        ("play --table cl", ("classic",)),
        ("generate --table ra", ("random",)),
        ("soak --table ro", ("rolling",)),
        ("bench step --table o", ("original",)),
        ("check cl", ("classic",)),
        ("simulate --player re", ("reflex",)),
        ("demo --theme ", tuple(THEMES)),
        ("replay l", ("last",)),
        ("page --replay l", ("last",)),
        ("page --table cl", ("classic",)),
        ("page --player re", ("reflex",)),
        ("scores --mode a", ("arcade",)),
    ],
)
def test_names_are_completed(completed, line, names):
    assert completed(f"silverball {line}") == list(names)


def test_commands_and_options_are_completed(completed):
    assert completed("silverball inf")[0] == "info"
    assert completed("silverball cache --cl")[0] == "--clear"


def test_files_of_the_current_folder_are_completed_by_their_kind(completed, tmp_path):
    for name in ("mine.toml", "my-2.toml", "my.replay", "my.txt"):
        (tmp_path / name).touch()
    assert completed("silverball show --table m") == ["mine.toml", "my-2.toml"]
    assert completed("silverball replay m") == ["my.replay"]


def test_another_folder_is_left_to_the_shell(completed, tmp_path):
    (tmp_path / "tables").mkdir()
    assert completed("silverball check tables/") == []


def test_the_names_are_those_of_the_library(unregistered):
    assert completion.complete_table("")[: len(table_names())] == list(table_names())
    assert completion.complete_theme("") == list(THEMES)
    assert completion.complete_player("") == list(player_names())


def test_players_of_installed_packages_are_completed_without_importing_them(site):
    folder = site / "fake_players-1.0.dist-info"
    folder.mkdir()
    (folder / "METADATA").write_text("Metadata-Version: 2.1\nName: fake-players\nVersion: 1.0\n")
    (folder / "entry_points.txt").write_text("[silverball.players]\nlefty = no_such_module:Lefty\n")
    assert completion.complete_player("l") == ["lefty"]


def test_a_name_that_a_shell_could_interpret_is_left_out(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    interpreted = {
        *(name.replace("/", "|") for name in NAMES.values()),
        NO_TEXT, "a b", "$(touch owned)", "a;b", "a&b", "a|b", "a>b", "a*", "a?", "~a", "-a", "--table",
        "a:b", "a\tb", "#a",
    }  # fmt: skip
    for name in (*interpreted, "good"):
        (tmp_path / f"{name}.toml").touch()
    found = set(completion.complete_table("")) - set(table_names())
    assert found == {"good.toml"}


@pytest.mark.skipif(os.name != "posix", reason="only Unix removes a folder that is in use")
def test_a_current_folder_that_is_gone_is_no_error(tmp_path, monkeypatch):
    folder = tmp_path / "gone"
    folder.mkdir()
    monkeypatch.chdir(folder)
    folder.rmdir()
    assert completion.complete_table("") == list(table_names())


@pytest.mark.parametrize("shell", SHELLS)
def test_the_script_of_every_shell_is_printed(new_process, shell):
    environment = os.environ | {DISABLED_DETECTION: "1"}
    result = new_process("--show-completion", shell, env=environment)
    assert (result.returncode, result.stderr) == (0, "")
    assert f"complete_{shell}" in result.stdout
    assert "_SILVERBALL_COMPLETE" in result.stdout


def test_the_script_is_installed_in_the_home_folder(new_process, tmp_path):
    environment = os.environ | {DISABLED_DETECTION: "1", "HOME": str(tmp_path), "USERPROFILE": str(tmp_path)}
    result = new_process("--install-completion", "bash", env=environment)
    assert result.returncode == 0, result.stderr
    assert "_SILVERBALL_COMPLETE" in (tmp_path / ".bash_completions" / "silverball.sh").read_text()


@pytest.mark.skipif(shutil.which("bash") is None, reason="bash is not installed")
def test_bash_completes_a_table(new_process, tmp_path):
    script = new_process("--show-completion", "bash", env=os.environ | {DISABLED_DETECTION: "1"}).stdout
    program = tmp_path / "program"
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m silverball "$@"\n')
    program.chmod(0o755)
    press_tab = (
        f"{script}\nCOMP_WORDS=(silverball simulate --table r); COMP_CWORD=3\n"
        f'_silverball_completion "{program}"; echo "${{COMPREPLY[@]}}"'
    )
    result = subprocess.run(
        ["bash", "-c", press_tab], cwd=tmp_path, capture_output=True, text=True, timeout=PATIENCE, check=False
    )
    assert (result.stdout, result.stderr) == ("random rolling\n", "")


IMPORTED = """
import sys
from silverball.cli.app import run
try:
    run([])
finally:
    print(*{name.partition(".")[0] for name in sys.modules} & {"numba", "llvmlite", "pygame"})
"""


@pytest.mark.parametrize("line", ["simulate --table ", "simulate --player ", "show --theme ", "replay "])
def test_completing_imports_no_large_package(line):
    environment = os.environ | {
        "_SILVERBALL_COMPLETE": "complete_zsh", "_TYPER_COMPLETE_ARGS": f"silverball {line}",
    }  # fmt: skip
    result = subprocess.run(
        [sys.executable, "-c", IMPORTED],
        env=environment,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    assert result.stdout.splitlines()[-1] == "", result.stdout


def test_the_help_page_stays_short(silverball):
    page = silverball("--help").stdout
    options = page.split("Options", 1)[1].split("Commands", 1)[0]
    assert "--install-completion" in options
    assert len(options.splitlines()) <= 10
    assert "completion" not in silverball("simulate", "--help").stdout


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="only Linux has a device that is always full")
def test_a_script_that_cannot_be_printed_ends_in_one_sentence():
    environment = os.environ | {DISABLED_DETECTION: "1"}
    command = [sys.executable, "-m", "silverball", "--show-completion", "bash"]
    with Path("/dev/full").open("w") as full:
        result = subprocess.run(
            command, stdout=full, stderr=subprocess.PIPE, text=True, env=environment, check=False
        )
    assert (result.returncode, result.stderr) == (2, "silverball: No space left on device\n")
