"""The real window on a real X server, operated with real keys: Xvfb shows it, xdotool presses.

Needs Debian's packages xvfb and xdotool, which `.ci/run` installs; without them these tests are skipped.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from machines import leaky
from xserver import x_server

from patience import PATIENCE
from silverball.app.player_games import GAME_OVER_SECONDS
from silverball.game.replay.format import Replay
from silverball.game.replay.verify import verify
from silverball.game.scores.store import Store
from silverball.game.view import Mode
from silverball.table import save_table

pytestmark = pytest.mark.skipif(
    shutil.which("Xvfb") is None or shutil.which("xdotool") is None,
    reason="needs the programs Xvfb and xdotool",
)


class Machine:
    """A running program and the hands on its keys."""

    def __init__(self, folder: Path, display: str, *options: str) -> None:
        self.data = folder / "data"
        self._environment = os.environ | {
            "DISPLAY": display,
            "SILVERBALL_DATA": str(self.data),
            "SDL_AUDIODRIVER": "dummy",
        }
        self._environment.pop("SDL_VIDEODRIVER", None)
        self._environment.pop("WAYLAND_DISPLAY", None)
        self.log = folder / "log.txt"
        with open(self.log, "wb") as log:
            self.process = subprocess.Popen(
                [sys.executable, "-m", "silverball", "play", *options],
                env=self._environment,
                stdout=log,
                stderr=subprocess.STDOUT,
            )
        # Without a window manager a new window takes the focus by itself.
        until(self._has_focus)

    def _has_focus(self) -> bool:
        focused = self._xdotool("getwindowfocus").stdout.strip()
        owner = self._xdotool("getwindowpid", focused).stdout.strip() if focused else ""
        return owner == str(self.process.pid)

    def _xdotool(self, *words: str) -> subprocess.CompletedProcess[str]:
        assert self.process.poll() is None, self.log.read_text(encoding="utf-8")
        command = ["xdotool", *words]
        return subprocess.run(
            command, env=self._environment, capture_output=True, text=True, timeout=PATIENCE, check=False
        )

    def tap(self, key: str) -> None:
        """Press and release a key as a person does."""
        self._xdotool("keydown", key)
        time.sleep(0.06)
        self._xdotool("keyup", key)
        time.sleep(0.06)

    def close(self) -> int:
        """End the program as a terminal does."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        return self.process.wait(timeout=PATIENCE)


def until(is_reached: Callable[[], bool]) -> None:
    """Wait until something is reached."""
    limit = time.monotonic() + PATIENCE
    while not is_reached():
        assert time.monotonic() < limit, "nothing happened"
        time.sleep(0.1)


@pytest.fixture
def display() -> Iterator[str]:
    with x_server(1024, 800) as name:
        yield name


@pytest.fixture
def start(tmp_path, display) -> Iterator[Callable[..., Machine]]:
    started = []

    def starter(*options: str, folder: Path = tmp_path) -> Machine:
        folder.mkdir(exist_ok=True)
        started.append(Machine(folder, display, *options))
        return started[-1]

    yield starter
    for machine in started:
        machine.close()


def scores(data: Path):
    with Store(data) as store:
        return store.scores()


def test_a_whole_arcade_game_with_real_keys_from_the_menu_to_the_score_table(start, tmp_path):
    table = tmp_path / "leaky.toml"
    save_table(leaky(), table)
    machine = start("--table", str(table), "--seed", "3")
    # Space chooses "play", then brings ball after ball; pressed too often it does no harm.
    for _ in range(300):
        if (machine.data / "silverball.sqlite3").exists() and scores(machine.data):
            break
        machine.tap("space")
    (score,) = scores(machine.data)
    assert score.score > 0
    assert score.initials == "AAA"
    time.sleep(GAME_OVER_SECONDS + 1.0)  # the end is looked at first
    for key in ("b", "a", "a", "Return"):  # beside a list, letters are typed
        machine.tap(key)
        time.sleep(0.1)
    until(lambda: [row.initials for row in scores(machine.data)] == ["BAA"])
    with Store(machine.data) as store:
        verdict = verify(Replay.from_text(store.replay(score.id)))
    assert (verdict.ok, verdict.score) == (True, score.score)
    assert score.mode == Mode.ARCADE


def slow(folder: Path) -> str:
    """The file of a table on which a ball stays on the board for many seconds."""
    table = folder / "slow.toml"
    save_table(leaky().model_copy(update={"board": leaky().board.model_copy(update={"gravity": 0.1})}), table)
    return str(table)


def test_losing_the_focus_pauses_a_real_game(start, tmp_path):
    machine = start("--table", slow(tmp_path), "--seed", "3", "--mode", "free")
    begun = time.monotonic()
    for _ in range(40):  # until the physics is loaded and a ball has come
        machine.tap("space")
    start("--table", slow(tmp_path), "--seed", "4", folder=tmp_path / "other")  # takes the focus
    focused = time.monotonic()
    time.sleep(4.0)
    machine.close()
    with Store(machine.data) as store:
        played = Replay.from_text(store.last_game()).seconds
    assert 0.0 < played < focused - begun + 1.0


def test_a_program_that_is_ended_in_a_game_has_kept_it(start, tmp_path):
    table = slow(tmp_path)
    for taps in (10, 40, 160):  # more only where the physics must be compiled first
        machine = start("--table", table, "--seed", "3", "--mode", "free")
        for _ in range(taps):
            machine.tap("space")
        assert machine.close() == 128 + signal.SIGTERM
        with Store(machine.data) as store:
            text = store.last_game()
        if text is not None:
            break
    assert text is not None
    assert verify(Replay.from_text(text)).ok
