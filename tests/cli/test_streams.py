"""Standard streams that are closed, full, without a reader, or in a narrow encoding."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from patience import PATIENCE

pytestmark = pytest.mark.skipif(os.name != "posix", reason="streams are closed as a shell of Unix does it")

PRINTING = ("--help", "check classic", "scores --json", "info", "info --json", "cache", "cache --clear")
MISTAKES = ("check nowhere.toml", "simulate --seconds soon")
HARNESS = """
import os, resource, sys
for number in map(int, sys.argv[1].split(",")):
    os.close(number)
os.execv(sys.executable, [sys.executable, "-X", "dev", "-W", "ignore", "-m", "silverball", *sys.argv[2:]])
"""


@pytest.fixture(autouse=True)
def _own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SILVERBALL_DATA", str(tmp_path / "data"))
    monkeypatch.setenv("SILVERBALL_CACHE", str(tmp_path / "cache"))
    monkeypatch.chdir(tmp_path)


def without(streams: str, arguments: str, **options) -> subprocess.CompletedProcess[str]:
    """Run a command with some of the streams 0, 1, 2 closed."""
    command = [sys.executable, "-c", HARNESS, streams, *arguments.split()]
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | options
    return subprocess.run(command, text=True, timeout=PATIENCE, check=False, **options)


@pytest.mark.parametrize("arguments", PRINTING)
def test_without_standard_output_what_would_be_printed_is_a_mistake(arguments: str):
    result = without("1", arguments)
    assert result.returncode == 2
    assert result.stderr == "standard output is closed: open it, or send it to a file or to /dev/null\n"


def test_without_standard_output_a_file_is_written_all_the_same():
    result = without("1", "generate --seed 7 --out seven.toml")
    assert result.returncode == 2
    assert Path("seven.toml").read_text(encoding="utf-8") == without("0", "generate --seed 7").stdout


@pytest.mark.parametrize("streams", ["0", "2"])
def test_without_standard_input_or_error_all_is_as_ever(streams: str):
    result = without(streams, "check classic")
    assert (result.returncode, result.stdout) == (0, "classic: no problems in 'Classic'\n")
    assert result.stderr == ""
    assert without(streams, "check nowhere.toml").returncode == 2


@pytest.mark.parametrize("streams", ["0,1,2"])
def test_without_any_stream_the_exit_code_is_what_is_left(streams: str):
    assert without(streams, "generate --out there.toml").returncode == 2
    assert (
        Path("there.toml").read_text(encoding="utf-8").startswith("format = 1\n")
    )  # and nothing else is in it
    assert without(streams, "check nowhere.toml").returncode == 2


@pytest.mark.parametrize("arguments", MISTAKES)
def test_a_mistake_does_not_need_standard_output(arguments: str):
    result = without("1", arguments)
    assert result.returncode == 2
    assert len(result.stderr.splitlines()) in (1, 2)
    assert "standard output" not in result.stderr


def gone() -> int:
    """The writing end of a pipe without a reader."""
    reading, writing = os.pipe()
    os.close(reading)
    return writing


@pytest.mark.parametrize("arguments", PRINTING)
def test_a_reader_who_goes_away_is_no_error(arguments: str):
    pipe = gone()
    result = without("0", arguments, stdout=pipe)
    os.close(pipe)
    assert (result.returncode, result.stderr) == (0, "")


def test_output_that_is_longer_than_what_is_read_of_it_is_no_error():
    lines = "[[cylinder]]\nradius = 0.01\ncenter = [{}, 0.0]\n"
    Path("many.toml").write_text("format = 1\n" + "".join(lines.format(x / 10) for x in range(200)), "utf-8")
    script = f'"{sys.executable}" -m silverball check many.toml 2>&1 | head -1; echo "${{PIPESTATUS[0]}}"'
    result = subprocess.run(
        ["bash", "-c", script], capture_output=True, text=True, timeout=PATIENCE, check=False
    )  # fmt: skip
    head, code = result.stdout.splitlines()
    assert head.startswith("many.toml: ")
    assert code == "2"
    assert result.stderr == ""


@pytest.mark.parametrize("arguments", MISTAKES)
def test_a_mistake_that_nobody_reads_of_is_a_mistake_still(arguments: str):
    pipe = gone()
    result = without("0", arguments, stdout=pipe, stderr=pipe)
    os.close(pipe)
    assert result.returncode == 2


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="only Linux has a device that is always full")
@pytest.mark.parametrize("arguments", ["generate", "--help"])
def test_a_full_disk_is_told_once(arguments: str):
    with open("/dev/full", "w", encoding="utf-8") as full:
        result = without("0", arguments, stdout=full)
        assert (result.returncode, result.stderr) == (2, "silverball: No space left on device\n")
        assert without("0", arguments, stdout=full, stderr=full).returncode == 2
        assert without("0", "check nowhere.toml", stderr=full).returncode == 2


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "utf-16"])
def test_what_an_encoding_has_no_letter_for_is_printed_all_the_same(encoding: str):
    Path("mine.toml").write_text('format = 1\nname = "ピンボール × 🧙"\n', encoding="utf-8")
    environment = os.environ | {"PYTHONIOENCODING": encoding}
    command = [sys.executable, "-m", "silverball", "check", "mine.toml"]
    result = subprocess.run(command, capture_output=True, timeout=PATIENCE, check=False, env=environment)
    assert result.returncode == 0, result.stderr
    assert b"mine.toml" in result.stdout.replace(b"\0", b"")
    assert result.stderr == b""
