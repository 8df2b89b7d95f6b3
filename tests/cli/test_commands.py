"""Every command: its output, its files, and its error messages."""

from __future__ import annotations

import json
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import silverball as sb
from silverball.cli.app import main_command
from silverball.cli.demo import free_name

COMMANDS = [
    [name, *more]
    for name, command in main_command().commands.items()
    for more in ([[one] for one in command.commands] if name == "bench" else [[]])
]


def assert_friendly_refusal(result, *words):
    """One clear message on standard error, exit code 2, no traceback."""
    assert result.returncode == 2, result.stderr
    assert "Traceback" not in result.stderr
    for word in words:
        assert word in result.stderr, result.stderr


def test_version_is_that_of_the_package(silverball):
    assert silverball("--version").stdout.strip() == f"silverball {sb.__version__}"


@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
def test_every_command_has_help_with_an_example_of_itself(silverball, command):
    result = silverball(*command, "--help")
    assert result.returncode == 0
    assert f"silverball {' '.join(command)}" in result.stdout.split("Example", 1)[1]


def test_the_help_page_names_every_command(silverball):
    assert all(command[0] in silverball("--help").stdout for command in COMMANDS)
    page = silverball("bench", "--help").stdout
    assert all(command[1] in page for command in COMMANDS if command[0] == "bench")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("simulate --soak --frames 5", "soak"),
        ("simulate --frames 5 --soak", "soak"),
        ("simulate --feel --games 5", "feel"),
        ("simulate --ball-time", "ball-time"),
        ("bench --peers --out peers.md", "bench peers"),
        ("bench --marks", "bench marks"),
        ("bench --drawing", "bench drawing"),
        ("bench --envs", "bench envs"),
        ("bench --threads 2", "bench step"),
    ],
)
def test_an_old_spelling_names_the_new_command(silverball, old, new):
    result = silverball(*old.split())
    assert_friendly_refusal(result, f"`silverball {new}`")
    assert len(result.stderr.splitlines()) == 1


def test_bench_alone_names_the_benchmarks(silverball):
    assert_friendly_refusal(silverball("bench"), "step, marks, drawing")


def test_tables_lists_the_built_in_tables(silverball):
    listed = silverball("tables").stdout
    assert "classic" in listed
    assert "random" in listed


def test_simulate_prints_everything_that_happened_and_nothing_went_wrong(silverball):
    result = silverball(*"simulate --table random --seed 7 --seconds 30 --balls 2 --json".split())
    report = json.loads(result.stdout)
    assert report["seconds"] == 30
    assert report["balls_created"] - report["balls_drained"] in (1, 2)
    assert set(report["hits"]) >= {"board.left", "paddle.right", "triangular_prism[3]", "cylinder[2]"}
    assert report["score"] == sum(
        count * (50 if "prism" in part else 100 if "cylinder" in part else 0)
        for part, count in report["hits"].items()
    )
    assert report["faults"] == 0
    assert 0 <= report["deepest_penetration"] <= 1e-9
    assert report["simulated_seconds_per_second"] > 1


def test_simulate_gives_the_same_digest_in_a_new_process_and_another_for_another_seed(new_process):
    arguments = "simulate --table random --seed 3 --seconds 10 --player random --json".split()
    digests = {json.loads(new_process(*arguments).stdout)["digest"] for _ in range(2)}
    assert len(digests) == 1
    other = json.loads(new_process(*arguments, "--seed", "4").stdout)
    assert other["digest"] not in digests


def test_generate_writes_the_same_board_for_the_same_seed_and_check_accepts_it(silverball, tmp_path):
    first, second = tmp_path / "a.toml", tmp_path / "b.toml"
    for path in (first, second):
        assert silverball("generate", "--seed", "7", "--out", str(path)).returncode == 0
    assert first.read_bytes() == second.read_bytes()
    assert silverball("generate", "--seed", "7").stdout == first.read_text(encoding="utf-8")
    table = tomllib.loads(first.read_text(encoding="utf-8"))
    assert (len(table["triangular_prism"]), len(table["cylinder"])) == (4, 3)
    assert silverball("check", str(first)).returncode == 0


def test_generate_does_not_overwrite_a_file_unless_told_to(silverball, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text("precious", encoding="utf-8")
    assert_friendly_refusal(silverball("generate", "--out", str(path)), "exists", "--force")
    assert path.read_text(encoding="utf-8") == "precious"
    assert silverball("generate", "--out", str(path), "--force").returncode == 0


def test_generate_into_a_folder_that_does_not_exist_says_so(silverball, tmp_path):
    path = tmp_path / "nowhere" / "mine.toml"
    assert_friendly_refusal(silverball("generate", "--out", str(path)), str(path))


def test_check_reports_all_eight_mistakes_of_a_file_at_once(silverball, tmp_path):
    path = tmp_path / "eight.toml"
    path.write_text(
        """
format = 1
[board]
gravity = -3.0
balls = 2
[[slant_wall]]
start = [-4.5, -5.0]
end = [-6.88, "far"]
[[paddle]]
side = "up"
pivot = [-7.2, -2.5]
length = 2.1
base = 0.5
[[triangular_prism]]
vertices = [[2.0, -1.0], [3.2, -1.4]]
[[cylinder]]
center = [5.0, 1.5]
radius = true
[[cylinder]]
center = [5.0, 40.0]
radius = 0.6
restitution = 7
[[bumper]]
center = [1.0, 1.0]
""",
        encoding="utf-8",
    )
    result = silverball("check", str(path))
    assert_friendly_refusal(
        result,
        "board.gravity",
        "board.balls",
        "slant_wall[0].end",
        "paddle[0].side",
        "triangular_prism[0].vertices",
        "cylinder[0].radius",
        "cylinder[1].restitution",
        "bumper",
    )
    assert result.stderr.count("\n  ") >= 8


def test_an_unknown_table_is_refused_with_the_nearest_name(silverball):
    assert_friendly_refusal(silverball("simulate", "--table", "clasic"), "classic")


def test_an_unknown_player_is_refused_with_the_nearest_name(silverball):
    assert_friendly_refusal(silverball("simulate", "--player", "reflexes"), "reflex")


def test_a_file_of_100_megabytes_is_refused_at_once(silverball, tmp_path):
    path = tmp_path / "huge.toml"
    with path.open("wb") as file:
        file.truncate(100_000_000)
    assert_friendly_refusal(silverball("check", str(path)), str(path))


def test_bench_prints_a_median_and_what_it_was_measured_on(silverball):
    result = silverball(*"bench step --worlds 64 --frames 30 --rounds 3 --json".split())
    report = json.loads(result.stdout)
    assert 0 < report["slowest"] <= report["frames_per_second"] <= report["fastest"]
    assert report["machine"]
    assert report["numba"]


def test_a_wrong_argument_ends_in_one_sentence_that_repeats_it(silverball):
    for arguments in ("simulate --seconds soon", "simulate --seconds=soon"):
        result = silverball(*arguments.split())
        assert_friendly_refusal(result, "--seconds", "'soon'", "silverball simulate --help")
        assert len(result.stderr.splitlines()) == 1


def test_an_unknown_command_is_refused_with_the_nearest_name(silverball):
    assert_friendly_refusal(silverball("simulat"), "simulate")


def test_a_demo_without_a_name_takes_the_first_that_is_free(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    taken = []
    for _ in range(3):
        taken.append(free_name("demo.gif"))
        taken[-1].touch()
    assert [path.name for path in taken] == ["demo.gif", "demo-2.gif", "demo-3.gif"]


def test_less_than_one_tick_is_refused(silverball):
    assert_friendly_refusal(
        silverball(*"simulate --seconds 0.01 --tick-rate 10".split()), "--seconds", "tick"
    )


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="only Linux has a device that is always full")
def test_output_that_cannot_be_written_ends_in_one_sentence():
    command = [sys.executable, "-m", "silverball", "generate"]
    with Path("/dev/full").open("w") as full:
        result = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert_friendly_refusal(result, "No space left")


def test_feel_measures_how_a_table_plays(silverball):
    result = silverball("feel", "--games", "3", "--table", "random", "--json")
    assert result.returncode == 0, result.stderr
    report = json.loads(result.stdout)
    assert set(report["players"]) == {"idle", "random", "beginner", "reflex"}
    for found in report["players"].values():
        value, low, high = found["seconds_per_ball"]
        assert 0.0 <= low < value < high
    assert {shots["paddle"] for shots in report["shots"]} == {"left", "right"}
    text = silverball("feel", "--games", "3", "--table", "random").stdout
    assert f"{report['players']['idle']['seconds_per_ball'][0]:.1f} ±" in text
    assert "cylinder[2]" in text
    assert "left, down the guide" in text
