"""The sounds of a window: `Sounds` opens the device, plays events, and never raises an error."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from silverball.app.settings import Settings
from silverball.app.sound.bank import make_bank
from silverball.app.sound.calls import CALLS, seconds_of
from silverball.app.sound.ducking import ROLL_UNDER_MUSIC, Ducker
from silverball.app.sound.moods import MoodReader
from silverball.app.sound.music import band_of
from silverball.app.sound.music_player import MusicPlayer
from silverball.app.sound.music_track import STOP_SECONDS
from silverball.app.sound.rolling import Rolling
from silverball.app.sound.sound_sets import SoundSet, sound_set
from silverball.app.sound.voices import Note, Voices
from silverball.background_thread import BackgroundThread

if TYPE_CHECKING:
    from silverball.app.sound.mixer import Mixer
    from silverball.app.sound.music import Mood
    from silverball.game.core import GameCore
    from silverball.game.view import GameEvent
    from silverball.table import Table
    from silverball.world import Event


def master_volume(settings: Settings) -> float:
    """Return the strength of all sounds, 0 to 1, from the volume: about −5 dB at 7 and −32 dB at 1."""
    return 0.0 if settings.muted else (settings.volume / 10.0) ** 1.6


def music_volume(settings: Settings) -> float:
    """Return the strength of the music before that of all sounds, 0 to 1, by the same curve."""
    return float((settings.music / 10.0) ** 1.6)


class Sounds:
    """The sounds of a window; silent until `open`, and without a sound device.

    In each frame call `play_game_events`, `play_events`, `set_buttons`, `set_rolling`, then `follow`.

    Args:
        settings: Settings with the volumes, mute, and the theme, which has a sound set of its own.

    Attributes:
        warning: Why there is no sound, in one sentence; empty if there is.
    """

    def __init__(self, settings: Settings) -> None:
        self.warning = ""
        self._volume, self._music_volume = master_volume(settings), music_volume(settings)
        self._set: SoundSet = sound_set(settings.theme)
        self._voices = Voices()
        self._rolling = Rolling()
        self._ducker = Ducker()
        self._music = MusicPlayer()
        self._moods: MoodReader | None = None
        self._table: Table | None = None
        self._mixer: Mixer | None = None
        self._maker: BackgroundThread | None = None
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
        self._start_loading(self._mixer)

    def _start_loading(self, mixer: Mixer) -> None:
        """Make the sounds of the set in a thread; until they are ready, those of the last one play."""
        before = self._maker
        self._maker = BackgroundThread(partial(self._load, mixer, self._set, before), "sounds")
        self._maker.start()

    def _load(self, mixer: Mixer, sounds: SoundSet, before: BackgroundThread | None) -> None:
        if before is not None:
            before.join()
        try:
            mixer.load(make_bank(sounds))
        except Exception as error:
            self.warning = f"no sound: the sounds could not be made ({error})"

    def wait(self) -> None:
        """Wait until the sounds, and the next bar of the music, are made."""
        if self._maker is not None:
            self._maker.join()
        self._music.wait()

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
        """Set the volumes and the sound set of the theme; muting fades out all sounds."""
        self._volume, self._music_volume = master_volume(settings), music_volume(settings)
        if self._volume == 0.0:
            self._try(lambda mixer: mixer.fade_all())
        if self._volume * self._music_volume == 0.0:
            self._end_music()
        if sound_set(settings.theme) != self._set:
            self._set = sound_set(settings.theme)
            self._end_music()
            self._choose_band()
            if self._mixer is not None:
                self._start_loading(self._mixer)

    # --- events ---------------------------------------------------------------------------------------

    def begin_game(self, table: Table) -> None:
        """Begin another game on a table; its music and the timing of the paddles' stops depend on it."""
        self._voices.begin_game(table)
        self._end_rolling()
        self._end_music()
        self._ducker.reset()
        self._table, self._moods = table, MoodReader(table)
        self._choose_band()

    def _choose_band(self) -> None:
        table, sounds = self._table, self._set
        if table is not None:
            self._music.begin(lambda: band_of(table, sounds))

    def follow(self, game: GameCore, seconds: float) -> None:
        """Let the music follow a game, some seconds after the last call."""
        ducked = self._ducker.update(seconds)
        if self._moods is None or self._is_paused:
            return
        mood = self._moods.read(game, seconds)
        volume = self._volume * self._music_volume
        if mood is None or volume == 0.0:
            self._end_music()
            return
        self._try(lambda mixer: self._play_music(mixer, mood, volume * ducked))

    def _play_music(self, mixer: Mixer, mood: Mood, volume: float) -> None:
        mixer.set_music_volume(volume)
        self._music.update(mixer, mood)

    @property
    def mood(self) -> Mood | None:
        """The mood of the music that plays; None: there is none."""
        return self._music.mood

    def _end_music(self) -> None:
        self._try(lambda mixer: self._music.stop(mixer, round(1000 * STOP_SECONDS)))

    def play_game_events(self, events: Sequence[GameEvent]) -> None:
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
        strength = self._volume * self._ducker.gain * (ROLL_UNDER_MUSIC if self._music.is_playing else 1.0)
        self._try(lambda mixer: mixer.roll(gains if self._volume > 0.0 else {}, strength))

    def play_menu(self, name: str) -> None:
        """Play a menu sound: "move", "choose", "back", "refuse", "high_score" or "attract"."""
        self._play(self._voices.menu(name))

    def pause(self) -> None:
        """Pause: rolling and music fade, hits ring out, menus stay audible."""
        self._is_paused = True
        self._end_rolling()
        self._end_music()

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
                if note.key.name in CALLS:
                    self._ducker.call(seconds_of(note.key.name))

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
