"""Make the screenshots of docs/silver_comet.md: `python docs/make_look.py`, or some of them by their names.

Each is what the window shows at a moment of a game, without a display. The games are those of
`tests/window/comet_games.py`, found from their seeds. It needs `.venv/bin/pip install '.[test,bench]'`, and
some minutes the first time, while the table is baked in two sizes.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

os.environ |= {"SDL_VIDEODRIVER": "dummy", "SDL_AUDIODRIVER": "dummy"}
TESTS = Path(__file__).parent.parent / "tests"
sys.path[:0] = [str(TESTS), str(TESTS / "window")]

import pygame  # noqa: E402
from comet_games import MISSIONS, first_ticks, inputs_of, load, skip  # noqa: E402
from PIL import Image  # noqa: E402

from silverball.app.controls import Action  # noqa: E402
from silverball.app.window import Window  # noqa: E402
from silverball.game.replay.recording import LAUNCH, LEFT, RIGHT  # noqa: E402
from silverball.game.scores.store import Store  # noqa: E402
from silverball.game.view import Mode, Phase  # noqa: E402

FOLDER = Path(__file__).with_name("look")
WIDE, TALL = (1280, 720), (390, 844)
COLOURS = 256  # of a picture file
TICKS = 4  # in a frame
FRAME = TICKS / 240  # [s]
ROUNDING = 1e-6  # [s] more, so that no frame is a tick short
PATIENCE = 1200.0  # [s] for the compiler and the bakery
HELD = {LEFT: Action.LEFT, RIGHT: Action.RIGHT, LAUNCH: Action.LAUNCH}


class Photographer:
    """A window without a display, in which games go on when they are told to."""

    def __init__(self, folder: Path, size: tuple[int, int], mode: Mode | None = Mode.ARCADE) -> None:
        with Store(folder) as store:
            store.save_settings({"is_guided": True})  # not the first game, so without its hints
        self.window = Window(
            "silver_comet", load("great").seed, mode=mode, size=size, without_display=True, folder=folder
        )
        self._until(lambda: self.window.is_ready)
        self.frames(2, 0.0)
        self._until(lambda: self.window.is_sharp)

    def _until(self, is_reached: Callable[[], bool]) -> None:
        limit = time.monotonic() + PATIENCE
        while not is_reached():
            assert time.monotonic() < limit, "the window does not get ready"
            self.window.frame(0.0)
            time.sleep(0.05)

    def frames(self, count: int, elapsed: float = FRAME) -> None:
        """Draw so many frames."""
        for _ in range(count):
            self.window.frame(elapsed)

    def play(self, name: str, event: str, after: float, before: float = 3.0) -> None:
        """Play a found game until some seconds after an event, the last of them frame by frame."""
        replay = load(name)
        tick = first_ticks(replay)[event]
        start = max(tick - round(before * 240), 0) // TICKS * TICKS  # buttons change between two frames
        session = self.window.program.session
        game, held = session.game, skip(session, replay, start)
        game.take_game_events()
        game.take_world_events()
        inputs = [one for one in inputs_of(replay) if one[0] >= start]
        self.frames(1, ROUNDING)
        while game.tick < tick + round(after * 240):
            while inputs and inputs[0][0] <= game.tick:
                _, kind = inputs.pop(0)
                if kind in held:
                    held[kind] = not held[kind]
                elif game.phase is Phase.READY:
                    game.create_ball()
            self._hold(held)
            self.frames(1)

    def _hold(self, held: dict[str, bool]) -> None:
        buttons = self.window.input_handler.buttons
        for kind, action in HELD.items():
            (buttons.press if held[kind] else lambda source, _: buttons.release(source))(kind, action)

    def save(self, name: str) -> None:
        """Write what the window shows as a picture of few colours."""
        self.frames(1, 0.0)
        surface = self.window._screen.surface
        picture = Image.frombytes("RGB", surface.get_size(), pygame.image.tobytes(surface, "RGB"))
        path = FOLDER / f"silver_comet_{name}.png"
        picture.quantize(COLOURS, dither=Image.Dither.NONE).save(path, optimize=True)
        print(f"{path.name}: {path.stat().st_size / 1000:.0f} kB")


def menu(eye: Photographer) -> None:
    """The menu in which the program begins."""
    eye.frames(90)


def event(name: str, part: str, after: float) -> Callable[[Photographer], None]:
    """Some seconds after the first event of a part, message, cue or mode in a found game."""
    return lambda eye: eye.play(name, part, after)


def over(eye: Photographer) -> None:
    """A game that the player has ended, and its list."""
    eye.play("great", "silver comet", 0.5)
    eye.window.program.session.game.end()
    eye.frames(round(4.0 / FRAME))


SCENES: dict[str, tuple[tuple[int, int], Mode | None, Callable[[Photographer], None]]] = {
    "menu": (WIDE, None, menu),
    "skill_shot": (WIDE, Mode.ARCADE, event("great", "skill shot", 0.25)),
    "mission": (WIDE, Mode.ARCADE, event("great", MISSIONS[0], 1.55)),
    "won": (WIDE, Mode.ARCADE, event("great", "comet caught", 0.55)),
    "extra_ball": (WIDE, Mode.ARCADE, event("great", "extra ball", 0.55)),
    "lock": (WIDE, Mode.ARCADE, event("great", "lock is lit", 0.6)),
    "multiball": (WIDE, Mode.ARCADE, event("great", "multiball", 1.6)),
    "jackpot": (WIDE, Mode.ARCADE, event("great", "jackpot", 0.8)),
    "wizard": (WIDE, Mode.ARCADE, event("great", "silver comet", 1.6)),
    "over": (WIDE, Mode.ARCADE, over),
    "phone": (TALL, Mode.ARCADE, event("great", MISSIONS[3], 1.3)),
}


def main(names: list[str]) -> None:
    """Make the pictures of these names, or all."""
    FOLDER.mkdir(exist_ok=True)
    for name in names or SCENES:
        size, mode, act = SCENES[name]
        with tempfile.TemporaryDirectory() as folder:
            eye = Photographer(Path(folder), size, mode)
            act(eye)
            eye.save(name)
            eye.window.close()


if __name__ == "__main__":
    main(sys.argv[1:])
