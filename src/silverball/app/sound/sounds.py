"""What must a window know of sound? `Sounds`: open it, tell it what happens, close it. It never fails."""

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
    """The strength of all sounds, 0 to 1, by the volume of 0 to 10: about −5 dB at 7 and −32 dB at 1."""
    return 0.0 if settings.muted else (settings.volume / 10.0) ** 1.6


class Sounds:
    """The sounds of a window; silent until `open`, and wherever there is no sound device.

    Each frame: `tell` the news, `note` the events, `buttons`, then `rolling`.

    Args:
        settings: Volume and whether it is muted.

    Attributes:
        trouble: Why there is no sound, in one sentence; "" if there is.
    """

    def __init__(self, settings: Settings) -> None:
        self.trouble = ""
        self._volume = master_volume(settings)
        self._voices = Voices()
        self._rolling = Rolling()
        self._mixer: Mixer | None = None
        self._maker: threading.Thread | None = None
        self._is_paused = False

    # --- from the start to the end --------------------------------------------------------------------

    def open(self) -> None:
        """Open the sound device and make the sounds in a thread; until they are ready it is silent."""
        if self._mixer is not None:
            return
        self.trouble = ""
        try:
            from silverball.app.sound.mixer import Mixer

            self._mixer = Mixer()
        except Exception as error:  # whatever a sound system throws, the game goes on
            self.trouble = f"no sound: no audio device could be opened ({error})"
            return
        self._maker = threading.Thread(
            target=self._load, args=[self._mixer], name="silverball sounds", daemon=True
        )
        self._maker.start()

    def _load(self, mixer: Mixer) -> None:
        try:
            mixer.load(make_bank())
        except Exception as error:
            self.trouble = f"no sound: the sounds could not be made ({error})"

    def wait(self) -> None:
        """Wait until the sounds are made."""
        if self._maker is not None:
            self._maker.join()

    def close(self) -> None:
        """End all sounds and give the device back."""
        self.wait()
        mixer, self._mixer, self._maker = self._mixer, None, None
        if mixer is not None:
            mixer.close()

    @property
    def voices(self) -> int:
        """How many sounds are being played."""
        return 0 if self._mixer is None else self._mixer.voices

    def change(self, settings: Settings) -> None:
        """Follow the settings; muting ends at once what is being played."""
        self._volume = master_volume(settings)
        if self._volume == 0.0:
            self._try(lambda mixer: mixer.fade_all())

    # --- what happens ---------------------------------------------------------------------------------

    def begin(self, table: Table) -> None:
        """Another game begins, on a table, whose paddles say when they reach their stops."""
        self._voices.begin(table)
        self._end_rolling()

    def tell(self, news: Iterable[GameEvent]) -> None:
        """What the game says; before `note`, so that bells know of the hits in a row."""
        self._play(self._voices.news(news))

    def note(self, events: Sequence[Event], tick_rate: int, width: float) -> None:
        """What happened on the board: events in order of time, ticks per second, the table's width [u]."""
        if events:
            self._play(self._voices.hits(events, tick_rate, width))

    def buttons(self, left: bool, right: bool) -> None:
        """Which paddle buttons are down; every frame, or when it changes."""
        self._play(self._voices.buttons(left, right))

    def rolling(self, balls: Iterable[tuple[int, float, float, float]], dt: float, width: float) -> None:
        """Where the balls are: (id, x [u], z [u], speed [u/s]) each, so many seconds after the last time."""
        if self._is_paused:
            return
        self._play(self._voices.update(dt))
        gains = self._rolling.update(balls, dt, width)
        self._try(lambda mixer: mixer.roll(gains if self._volume > 0.0 else {}, self._volume))

    def menu(self, what: str) -> None:
        """What a menu says: "move", "choose", "back", "refuse", "high_score" or "attract"."""
        self._play(self._voices.menu(what))

    def pause(self) -> None:
        """Time stands still: rolling fades, what was struck rings out, menus are still heard."""
        self._is_paused = True
        self._end_rolling()

    def resume(self) -> None:
        """Time goes on."""
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
        """Ask something of the mixer; if its device is gone, the game goes on in silence."""
        if self._mixer is None:
            return
        try:
            action(self._mixer)
        except Exception as error:
            self._mixer = None
            self.trouble = f"no sound any more: the audio device is gone ({error})"
