"""Plays notes on the channels of pygame's mixer.

Strengths are set on a channel while it is idle, before its sound starts: otherwise the mixer thread could
play the first few milliseconds at full strength. If the mixer was closed meanwhile, that first call raises an
error; `play` alone would crash.

A sound is kept until no channel can have it. Were the mixer the last to let go of it, pygame would free it
while a channel still names it, and a sound that ends in just that moment would be freed twice.
"""

from __future__ import annotations

import contextlib
import os
from collections import deque
from collections.abc import Iterator
from typing import TypeAlias

import numpy as np
import pygame

from silverball.app.sound.bank import Bank, Key, Samples
from silverball.app.sound.rolling import LANES, ROLL_SPEEDS, Gains
from silverball.app.sound.synth import RATE
from silverball.app.sound.voices import Note

BUFFERS = (512, 1024, 2048)
"""Sizes of the device's buffer [sample], tried in order; 512 are 11 ms. Smaller ones crackle while the
physics is compiled."""

HIT_CHANNELS = 20
MUSIC_STEP = 1.0 / 256.0  # least change of the music's strength: half of what the mixer can tell apart
MusicBar: TypeAlias = pygame.mixer.Sound
_SPARE = 4  # channels kept free for the next frame
_FADE = 15  # [ms] to fade out a sound
_REST = 64  # [sample] of silence
_KEPT_BANKS = 3  # that were replaced, and whose last sounds may still play


class Mixer:
    """An open sound device.

    Raises:
        pygame.error: There is no sound device.
    """

    def __init__(self) -> None:
        self._open()
        pygame.mixer.set_num_channels(HIT_CHANNELS + LANES * len(ROLL_SPEEDS) + 1)
        channels = [pygame.mixer.Channel(number) for number in range(pygame.mixer.get_num_channels())]
        self._free = channels[:HIT_CHANNELS]
        self._busy: deque[pygame.mixer.Channel] = deque()  # oldest first
        self._fading: list[pygame.mixer.Channel] = []
        self._roll = channels[HIT_CHANNELS:-1]
        self._music = channels[-1]
        self._rolling: dict[int, tuple[float, float]] = {}
        self._music_volume = -1.0
        self._sounds: dict[Key, pygame.mixer.Sound] = {}
        self._loops: list[pygame.mixer.Sound] = []
        self._replaced: deque[object] = deque(maxlen=_KEPT_BANKS)  # banks
        self._bars: list[MusicBar] = []  # that play, wait or did so just now
        self._rest = pygame.mixer.Sound(buffer=bytes(4 * _REST))

    def _open(self) -> None:
        pygame.mixer.quit()  # it may have been opened with another rate
        for number, buffer in enumerate(BUFFERS):
            try:
                with _without_stderr():
                    pygame.mixer.init(RATE, -16, 2, buffer, allowedchanges=0)
                return
            except pygame.error:
                if number == len(BUFFERS) - 1:
                    raise

    def load(self, bank: Bank) -> None:
        """Load the waves into the mixer; may be called from a thread."""
        self._replaced.append((self._sounds, self._loops))
        loops = [_sound(loop) for loop in bank.loops]
        self._sounds = {key: _sound(wave) for key, wave in bank.waves.items()}
        self._loops = loops

    @property
    def is_loaded(self) -> bool:
        """Whether the waves are loaded."""
        return bool(self._loops)

    @property
    def voices(self) -> int:
        """The number of playing sounds, including rolling, without the music."""
        return sum(channel.get_busy() for channel in [*self._busy, *self._fading, *self._roll])

    def play(self, note: Note, volume: float) -> None:
        """Play a note, if a channel is free."""
        left, right = volume * note.left, volume * note.right
        if max(left, right) < 1.0 / 255.0 or not self.is_loaded:  # the resolution of the mixer
            return
        self._tidy()
        if not self._free:
            return
        channel = self._free.pop()
        channel.set_volume(min(left, 1.0), min(right, 1.0))
        channel.play(self._sounds[note.key])
        self._busy.append(channel)

    def roll(self, gains: Gains, volume: float) -> None:
        """Set the strengths of the rolling loops; loops that are not named stop."""
        if not self.is_loaded:
            return
        wanted = {
            lane * len(ROLL_SPEEDS) + loop: (volume * left, volume * right)
            for (lane, loop), (left, right) in gains.items()
        }
        for number in self._rolling.keys() - wanted.keys():
            self._roll[number].stop()  # nearly silent by now
        for number, (left, right) in wanted.items():
            channel = self._roll[number]
            was_busy = (
                channel.get_busy()
            )  # read first: it may end in between, and would restart at full strength
            channel.set_volume(left, right)
            if not was_busy:
                channel.play(self._loops[number % len(ROLL_SPEEDS)], loops=-1)
        self._rolling = wanted

    def fade_rolling(self) -> None:
        """Fade out the rolling loops."""
        for number in self._rolling:
            self._roll[number].fadeout(4 * _FADE)
        self._rolling = {}

    # --- music ----------------------------------------------------------------------------------------

    @staticmethod
    def music_bar(samples: Samples) -> MusicBar:
        """Make a bar of int16 `[sample, 2]`; may be called from a thread."""
        return pygame.mixer.Sound(buffer=samples.tobytes())

    @property
    def music(self) -> MusicBar | None:
        """The bar that plays now."""
        return self._music.get_sound() if self._music.get_busy() else None

    def play_music(self, bar: MusicBar) -> None:
        """Play a bar now."""
        self._bars.append(bar)
        self._music.play(bar)
        self._drop_bars()

    def queue_music(self, bar: MusicBar) -> None:
        """Play a bar when the present one ends, to the sample; it replaces another one that waits."""
        self._bars.append(bar)
        self._music.queue(bar)
        self._drop_bars()

    def _drop_bars(self) -> None:
        """Let go of the bars that the mixer has let go of."""
        had = (self._music.get_sound(), self._music.get_queue())
        self._bars = [bar for bar in self._bars if any(bar is one for one in had)]

    def set_music_volume(self, volume: float) -> None:
        """Set the strength of the music, 0 to 1."""
        if abs(volume - self._music_volume) >= MUSIC_STEP:
            self._music.set_volume(volume)
            self._music_volume = volume

    def stop_music(self, milliseconds: int) -> None:
        """Fade out the music and forget the bar that waits."""
        if self._music.get_queue() is not None:
            self._music.queue(self._rest)  # a channel that has faded out begins what waits
        self._music.fadeout(milliseconds)

    def fade_all(self) -> None:
        """Fade out all sounds but the music."""
        self.fade_rolling()
        for channel in self._busy:
            channel.fadeout(2 * _FADE)

    def close(self) -> None:
        """Close the device."""
        if pygame.mixer.get_init() is not None:
            for _ in range(2):  # a bar that waits begins when the one before it stops
                pygame.mixer.stop()
        pygame.mixer.quit()
        self._sounds, self._loops, self._bars = {}, [], []
        self._replaced.clear()

    def _tidy(self) -> None:
        """Collect free channels; if there are few, fade out the oldest sounds."""
        if len(self._free) > _SPARE:
            return
        for group in (self._busy, self._fading):
            still = [channel for channel in group if channel.get_busy()]
            self._free.extend(channel for channel in group if not channel.get_busy())
            group.clear()
            group.extend(still)
        while self._busy and len(self._free) + len(self._fading) < _SPARE:
            oldest = self._busy.popleft()
            oldest.fadeout(_FADE)
            self._fading.append(oldest)


def _sound(wave: Samples) -> pygame.mixer.Sound:
    return pygame.mixer.Sound(buffer=np.repeat(wave, 2).tobytes())


@contextlib.contextmanager
def _without_stderr() -> Iterator[None]:
    """Suppress messages of the sound system about a missing device; `Sounds.warning` reports it."""
    try:
        stderr = os.dup(2)
    except OSError:  # there is no standard error, as with pythonw
        yield
        return
    devnull = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(devnull, 2)
        yield
    finally:
        os.dup2(stderr, 2)
        os.close(stderr)
        os.close(devnull)
