"""Ctrl-C and SIGTERM during a first start, which compiles: the command ends at once and says so."""

from __future__ import annotations

import os
import random
import signal
import sys
import time

import pytest

from commandline import started
from patience import PATIENCE
from silverball.cli.app import run

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no signals to send")

COMMANDS = {
    "simulate": ("simulate", "--seconds", "1e6"),
    "planner": ("simulate", "--seconds", "1e6", "--player", "planner"),
    "demo": ("demo", "--out", "film.gif"),
    "bench": ("bench", "step"),
    "soak": ("soak", "--frames", "1000000000"),
}


def stop(tmp_path, name: str, sent: signal.Signals, seconds: float) -> None:
    """Start a command with an empty cache, stop it after some seconds, and check how it ends."""
    folders = {"SILVERBALL_CACHE": str(tmp_path / "cache"), "SILVERBALL_DATA": str(tmp_path / "data")}
    process = started(*COMMANDS[name], cwd=tmp_path, env=os.environ | folders)
    limit = time.monotonic() + 300.0
    while not (tmp_path / "cache").exists() and time.monotonic() < limit:
        time.sleep(0.01)  # its own code runs from now on
    time.sleep(seconds)
    assert process.poll() is None, process.communicate()
    process.send_signal(sent)
    _, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode == 128 + sent
    lines = [line for line in errors.splitlines() if not line.startswith("progress is saved in")]
    assert lines == (["stopped"] if sent == signal.SIGINT else [])
    assert not list(tmp_path.glob("film*"))


@pytest.mark.parametrize(
    ("name", "sent", "seconds"),
    [
        ("simulate", signal.SIGINT, 0.0),
        ("planner", signal.SIGTERM, 0.7),
        ("demo", signal.SIGINT, 1.5),
        ("bench", signal.SIGINT, 3.0),
    ],
)
def test_a_first_start_is_stopped_cleanly(tmp_path, name, sent, seconds):
    stop(tmp_path, name, sent, seconds)


@pytest.mark.slow
@pytest.mark.parametrize("number", range(40))
def test_a_first_start_is_stopped_cleanly_at_any_moment(tmp_path, number):
    chosen = random.Random(number)
    name = list(COMMANDS)[number % len(COMMANDS)]
    stop(tmp_path, name, chosen.choice([signal.SIGINT, signal.SIGTERM]), chosen.uniform(0.0, 9.0))


def test_an_end_of_file_inside_of_the_program_is_not_taken_for_ctrl_d(monkeypatch, capsys):
    def damaged(*_: object, **__: object) -> None:
        raise EOFError("Ran out of input")

    monkeypatch.setattr("silverball.table.file.examine_table", damaged)
    with pytest.raises(EOFError, match="Ran out of input"):
        run(["check", "classic"])
    assert "stopped" not in capsys.readouterr().err
