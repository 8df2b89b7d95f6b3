"""The sounds of a window: `Sounds` opens the device, plays events, and never raises an error."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING

from silverball.app.settings import Settings
from silverball.app.sound.bank import make_bank
from silverball.app.sound.rolling import Rolling
from silverball.app.sound.voices import Note, Voices

if TYPE_CHECKING:
    from silverball.app.sound.mixer import Mixer
    from silverball.game.view import GameEvent
    from silverball.table import Table
    from silverball.world import Event


def master_volume(settings: Settings) -> float:
    """Return the strength of all sounds, 0 to 1, from the volume: about −5 dB at 7 and −32 dB at 1."""
    return 0.0 if settings.muted else (settings.volume / 10.0) ** 1.6


class Sounds:
    """The sounds of a window; silent until `open`, and without a sound device.

    In each frame call `play_game_events`, `play_events`, `set_buttons`, then `set_rolling`.

    Args:
        settings: Settings with the volume and mute.

    Attributes:
        warning: Why there is no sound, in one sentence; empty if there is.
    """

    def __init__(self, settings: Settings) -> None:
        self.warning = ""
        self._volume = master_volume(settings)
        self._voices = Voices()
        self._rolling = Rolling()
        self._mixer: Mixer | None = None
        self._maker: threading.Thread | None = None
        self._is_paused = False

    # --- life cycle -----------------------------------------------------------------------------------

    def open(self) -> None:
        """Open the sound device and make the sounds in a thread; it is silent until they are ready."""
        if self._mixer is not None:
            return
        self.warning = ""
        try:
            from silverball.app.sound.mixer import Mixer

            self._mixer = Mixer()
        except Exception as error:  # no error of the sound system may stop the game
            self.warning = f"no sound: no audio device could be opened ({error})"
            return
        self._maker = threading.Thread(
            target=self._load, args=[self._mixer], name="silverball sounds", daemon=True
        )
        self._maker.start()

    def _load(self, mixer: Mixer) -> None:
        try:
            mixer.load(make_bank())
        except Exception as error:
            self.warning = f"no sound: the sounds could not be made ({error})"

    def wait(self) -> None:
        """Wait until the sounds are made."""
        if self._maker is not None:
            self._maker.join()

    def close(self) -> None:
        """Stop all sounds and close the device."""
        self.wait()
        mixer, self._mixer, self._maker = self._mixer, None, None
        if mixer is not None:
            mixer.close()

    @property
    def voices(self) -> int:
        """The number of playing sounds."""
        return 0 if self._mixer is None else self._mixer.voices

    def apply_settings(self, settings: Settings) -> None:
        """Set the volume; muting fades out all sounds."""
        self._volume = master_volume(settings)
        if self._volume == 0.0:
            self._try(lambda mixer: mixer.fade_all())

    # --- events ---------------------------------------------------------------------------------------

    def begin_game(self, table: Table) -> None:
        """Begin another game on a table; the timing of the paddles' stops depends on it."""
        self._voices.begin_game(table)
        self._end_rolling()

    def play_game_events(self, events: Iterable[GameEvent]) -> None:
        """Play events of the game; call it before `play_events`, so that bells know the hits in a row."""
        self._play(self._voices.game_events(events))

    def play_events(self, events: Sequence[Event], tick_rate: int, width: float) -> None:
        """Play events of the board, in order of time; the width of the table is in [u]."""
        if events:
            self._play(self._voices.world_events(events, tick_rate, width))

    def set_buttons(self, left: bool, right: bool, launch: bool = False) -> None:
        """Set which buttons are down; call it in every frame, or on changes."""
        self._play(self._voices.buttons(left, right, launch))

    def set_rolling(self, balls: Iterable[tuple[int, float, float, float]], dt: float, width: float) -> None:
        """Set the balls as `RollingBall`, `dt` [s] after the last call."""
        if self._is_paused:
            return
        self._play(self._voices.advance(dt))
        gains = self._rolling.update(balls, dt, width)
        self._try(lambda mixer: mixer.roll(gains if self._volume > 0.0 else {}, self._volume))

    def play_menu(self, name: str) -> None:
        """Play a menu sound: "move", "choose", "back", "refuse", "high_score" or "attract"."""
        self._play(self._voices.menu(name))

    def pause(self) -> None:
        """Pause: rolling fades, hits ring out, menus stay audible."""
        self._is_paused = True
        self._end_rolling()

    def resume(self) -> None:
        """Continue after a pause."""
        self._is_paused = False

    def _end_rolling(self) -> None:
        self._rolling.reset()
        self._try(lambda mixer: mixer.fade_rolling())

    def _play(self, notes: list[Note]) -> None:
        def play(mixer: Mixer) -> None:
            for note in notes:
                mixer.play(note, self._volume)

        if notes:
            self._try(play)

    def _try(self, action: Callable[[Mixer], None]) -> None:
        """Run an action of the mixer; if its device has disappeared, the game continues in silence."""
        if self._mixer is None:
            return
        try:
            action(self._mixer)
        except Exception as error:
            self._mixer = None
            self.warning = f"no sound: the audio device has disappeared ({error})"
