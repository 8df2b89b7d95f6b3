"""The sound of a film: all notes and loops of a game, mixed at their exact times.

The voices are those of the window, but every hit starts at its exact sample, and rolling changes smoothly.
The same frames always give the same samples.
"""

from __future__ import annotations

import wave
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from silverball.app.sound.bank import FULL, Bank, Samples, make_bank, to_samples
from silverball.app.sound.calls import CALLS, seconds_of
from silverball.app.sound.ducking import ROLL_UNDER_MUSIC, Ducker
from silverball.app.sound.moods import MoodReader
from silverball.app.sound.music import Mood, band_of
from silverball.app.sound.music_track import MusicTrack
from silverball.app.sound.rolling import LANES, Gains, Rolling, RollingBall
from silverball.app.sound.sound_sets import DEFAULT_SET, SoundSet
from silverball.app.sound.synth import RATE, Wave, as_float32, soft_limit
from silverball.app.sound.voices import Note, Voices

if TYPE_CHECKING:
    from silverball.game.core import GameCore
    from silverball.game.view import GameEvent
    from silverball.table import Table
    from silverball.world import Event, World

VOLUME = 1.1
"""Strength of a film's sound: games with music have about −24 LUFS, see `silverball bench sound`."""

MUSIC_VOLUME = 0.565
"""Strength of a film's music: that of the usual volume in the settings."""

MAX_FADE = RATE // 2  # [sample] longest change of a strength; in longer frames it is constant afterwards


class Soundtrack(NamedTuple):
    """The sound of a film.

    Attributes:
        samples: int16 `[sample, 2]`, left and right.
        rate: Samples per second.
    """

    samples: NDArray[np.int16]
    rate: int


class Frame(NamedTuple):
    """The sound events of one frame of the film.

    Attributes:
        time: End of the frame in the film [s].
        world_time: Time of the world at that moment [s]; the film may be slower, or begin later.
        events: Events of the world since the previous frame.
        balls: All balls on the board.
        buttons: Whether the left and the right paddle button are down, and the launch button.
        game_events: Game events since the previous frame.
        menu: A menu sound, see `Sounds.play_menu`.
        mood: The mood of the music; None: there is none.
    """

    time: float
    world_time: float
    events: tuple[Event, ...] = ()
    balls: tuple[RollingBall, ...] = ()
    buttons: tuple[bool, ...] = (False, False)
    game_events: tuple[GameEvent, ...] = ()
    menu: str = ""
    mood: Mood | None = None

    @classmethod
    def of(
        cls,
        world: World,
        time: float,
        events: Iterable[Event],
        buttons: tuple[bool, ...] = (False, False),
        game_events: Iterable[GameEvent] = (),
        mood: Mood | None = None,
    ) -> Self:
        """Return the frame that ends with the current state of a world, at a time in the film [s]."""
        return cls(
            time, world.time, tuple(events), rolling_balls(world), buttons, tuple(game_events), mood=mood
        )


class FilmSound:
    """Collects the sound of a film, frame by frame.

    Args:
        table: The board.
        tick_rate: Ticks per second of the world.
        frame_rate: Frames per second of the film.
        sounds: The sound set.
        has_music: Whether it has music, where pictures are added with their game.
    """

    def __init__(
        self,
        table: Table,
        tick_rate: int,
        frame_rate: float,
        sounds: SoundSet = DEFAULT_SET,
        *,
        has_music: bool = True,
    ) -> None:
        self._table, self._tick_rate, self._frame_rate = table, tick_rate, frame_rate
        self._sounds = sounds
        self._moods = MoodReader(table) if has_music else None
        self._frames: list[Frame] = []

    def add_picture(
        self,
        world: World,
        events: Iterable[Event],
        buttons: tuple[bool, ...] = (False, False),
        game_events: Iterable[GameEvent] = (),
        game: GameCore | None = None,
    ) -> None:
        """Add a frame: the current state of a world, the events since the last frame, and the buttons.

        The music follows the game; without one there is none.
        """
        time = (len(self._frames) + 1) / self._frame_rate
        mood = None
        if self._moods is not None and game is not None:
            mood = self._moods.read(game, 1.0 / self._frame_rate)
        self._frames.append(Frame.of(world, time, events, buttons, game_events, mood))

    def track(self) -> Soundtrack:
        """Return the sound of all frames so far, for `write_film`."""
        seconds = len(self._frames) / self._frame_rate
        samples = mixdown(self._frames, seconds, self._table, self._tick_rate, self._sounds)
        return Soundtrack(samples, RATE)


def rolling_balls(world: World) -> tuple[RollingBall, ...]:
    """Return the balls of a world for `Rolling`."""
    return tuple(
        RollingBall(
            ball.id, ball.position[0], ball.position[2], float(np.hypot(ball.velocity[0], ball.velocity[2]))
        )
        for ball in world.balls
    )


def mixdown(
    frames: Iterable[Frame], seconds: float, table: Table, tick_rate: int, sounds: SoundSet = DEFAULT_SET
) -> Samples:
    """Return the sound of a film: int16 `[sample, 2]`, left and right, `RATE` samples per second.

    Args:
        frames: All frames in order.
        seconds: Length of the film; longer sounds end with a short fade.
        table: The board.
        tick_rate: Ticks per second of the world.
        sounds: The sound set.
    """
    mixing = _Mixing(seconds, table, tick_rate, sounds)
    for frame in frames:
        mixing.add(frame)
    total = mixing.total
    _fade_out(total)
    return to_samples(soft_limit(VOLUME * total).T)


class _Mixing:
    """A film whose frames are added one after the other.

    Attributes:
        total: The samples so far, `[2, sample]`.
    """

    def __init__(self, seconds: float, table: Table, tick_rate: int, sounds: SoundSet) -> None:
        self.total = np.zeros((2, max(round(seconds * RATE), 1)), np.float32)
        self._tick_rate, self._width = tick_rate, table.board.width
        self._bank: Bank = make_bank(sounds)
        self._loops = [
            as_float32(np.concatenate([loop, loop[:MAX_FADE]]) / FULL) for loop in self._bank.loops
        ]
        self._voices, self._rolling, self._ducker = Voices(table), Rolling(), Ducker()
        self._music: MusicTrack | None = None
        self._table, self._sounds = table, sounds
        self._gains: Gains = {}
        self._before = 0.0  # [s] the end of the last frame

    def add(self, frame: Frame) -> None:
        """Add a frame."""
        dt = max(frame.time - self._before, 0.0)
        for note in self._notes(frame, dt):
            _add_note(self.total, self._bank, note, frame.time - min(note.ago, dt))
            if note.key.name in CALLS:
                self._ducker.call(seconds_of(note.key.name))
        ducks = self._ducker.gain, self._ducker.update(dt)
        if frame.mood is not None and self._music is None:
            self._music = MusicTrack(band_of(self._table, self._sounds), MUSIC_VOLUME)
        following = self._rolling.update(frame.balls, dt, self._width)
        begin, end = (min(round(time * RATE), self.total.shape[1]) for time in (self._before, frame.time))
        if self._music is not None:
            self._music.add(self.total, slice(begin, end), frame.mood, ducks)
        strength = ducks[1] * (ROLL_UNDER_MUSIC if self._music is not None and self._music.is_heard else 1.0)
        following_gains = {
            key: (strength * left, strength * right) for key, (left, right) in following.items()
        }
        for start in range(begin, end, MAX_FADE):
            span = slice(start, min(start + MAX_FADE, end))
            _add_rolling(self.total, self._loops, (self._gains, following_gains), span)
            self._gains = following_gains
        self._gains, self._before = following_gains, max(frame.time, self._before)

    def _notes(self, frame: Frame, dt: float) -> list[Note]:
        voices = self._voices
        notes = voices.game_events(frame.game_events)
        notes += voices.world_events(frame.events, self._tick_rate, self._width, frame.world_time)
        # The buttons were pressed at the beginning of the frame.
        notes += [note._replace(ago=dt) for note in voices.buttons(*frame.buttons)]
        return notes + voices.advance(dt) + voices.menu(frame.menu)


def write_wav(path: Path, samples: Samples) -> None:
    """Write int16 `[sample, 2]` as a WAV file.

    Raises:
        OSError: It cannot be written.
    """
    with wave.open(str(path), "wb") as file:
        file.setnchannels(2)
        file.setsampwidth(2)
        file.setframerate(RATE)
        file.writeframes(samples.astype("<i2").tobytes())


def _add_note(total: Wave, bank: Bank, note: Note, time: float) -> None:
    begin = max(round(time * RATE), 0)
    samples = bank.waves[note.key][: max(total.shape[1] - begin, 0)]
    for ear, strength in zip(total, (note.left, note.right), strict=True):
        ear[begin : begin + len(samples)] += np.float32(strength / FULL) * samples


def _add_rolling(total: Wave, loops: list[Wave], gains: tuple[Gains, Gains], span: slice) -> None:
    """Add the loops to a span of samples, with strengths that change linearly between two gains."""
    count = span.stop - span.start
    share = np.arange(count, dtype=np.float32) / np.float32(max(count, 1))
    for lane, loop in sorted(gains[0].keys() | gains[1].keys()):
        length = len(loops[loop]) - MAX_FADE
        # Lanes start at different places of the loop, so that two balls of one speed do not sound like one.
        begin = (span.start + lane * length // LANES) % length
        piece = loops[loop][begin : begin + count]
        firsts, lasts = (one.get((lane, loop), (0.0, 0.0)) for one in gains)
        for ear, first, last in zip(total[:, span], firsts, lasts, strict=True):
            np.add(ear, piece * (np.float32(first) + share * np.float32(last - first)), out=ear)


def _fade_out(total: Wave) -> None:
    count = min(RATE // 50, total.shape[1])
    total[:, total.shape[1] - count :] *= np.linspace(1.0, 0.0, count, dtype=np.float32)
