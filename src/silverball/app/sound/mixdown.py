"""How does a film get its sound? All notes and loops of a game, added up where they belong.

The same voices as in the window, but with every hit at its exact sample and rolling that changes smoothly;
the same frames always give the same samples.
"""

from __future__ import annotations

import wave
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from silverball.app.sound.bank import FULL, Bank, Samples, make_bank, to_samples
from silverball.app.sound.rolling import Gains, Rolling, RollingBall
from silverball.app.sound.synth import RATE, soft_limit
from silverball.app.sound.voices import Note, Voices
from silverball.game.news import News
from silverball.table import Table
from silverball.world.events import Event

if TYPE_CHECKING:
    from silverball.world import World

VOLUME = 0.8
"""Strength of a film's sound: a film should not be louder than others."""


class Frame(NamedTuple):
    """What is heard of one picture's time.

    Attributes:
        time: In the film, at its end [s].
        world_time: In the world [s]; the film may be slower, or begin later.
        events: Since the picture before.
        balls: On the board.
        buttons: Whether the left and the right paddle button are down.
        news: Of the game, since the picture before.
        menu: What a menu says, see `Sounds.menu`.
    """

    time: float
    world_time: float
    events: tuple[Event, ...] = ()
    balls: tuple[RollingBall, ...] = ()
    buttons: tuple[bool, bool] = (False, False)
    news: tuple[News, ...] = ()
    menu: str = ""

    @classmethod
    def of(
        cls,
        world: World,
        time: float,
        events: Iterable[Event],
        buttons: tuple[bool, bool] = (False, False),
        news: Iterable[News] = (),
    ) -> Self:
        """The frame that ends with a world as it is now, at a time in the film [s]."""
        return cls(time, world.time, tuple(events), rolling_balls(world), buttons, tuple(news))


def rolling_balls(world: World) -> tuple[RollingBall, ...]:
    """The balls of a world, as rolling wants to know them."""
    return tuple(
        RollingBall(
            ball.id, ball.position[0], ball.position[2], float(np.hypot(ball.velocity[0], ball.velocity[2]))
        )
        for ball in world.balls
    )


def mixdown(frames: Iterable[Frame], seconds: float, table: Table, tick_rate: int) -> Samples:
    """The sound of a film: int16 [sample, 2], left and right, `RATE` samples a second.

    Args:
        frames: One for every picture, in the order of time.
        seconds: Length of the film; what rings on after it is cut off with a short fade.
        table: On which is played.
        tick_rate: Ticks per second of the world.
    """
    bank = make_bank()
    total = np.zeros((max(round(seconds * RATE), 1), 2), np.float32)
    voices, rolling = Voices(), Rolling()
    voices.begin(table)
    gains: Gains = {}
    before = 0.0
    for frame in frames:
        dt = max(frame.time - before, 0.0)
        notes = voices.news(frame.news)
        notes += voices.hits(frame.events, tick_rate, table.board.width, frame.world_time)
        # The buttons went down when the frame began: what they do is due within it.
        notes += [note._replace(ago=dt) for note in voices.buttons(*frame.buttons)]
        notes += voices.pass_time(dt) + voices.menu(frame.menu)
        for note in notes:
            _add_note(total, bank, note, frame.time - min(note.ago, dt))
        following = rolling.update(frame.balls, dt, table.board.width)
        _add_rolling(total, bank, (gains, following), (before, frame.time))
        gains, before = following, max(frame.time, before)
    _fade_out(total)
    return to_samples(soft_limit(VOLUME * total))


def write_wav(path: Path, samples: Samples) -> None:
    """Write int16 [sample, 2] as a WAV file.

    Raises:
        OSError: It cannot be written.
    """
    with wave.open(str(path), "wb") as file:
        file.setnchannels(2)
        file.setsampwidth(2)
        file.setframerate(RATE)
        file.writeframes(samples.astype("<i2").tobytes())


def _add_note(total: NDArray[np.float32], bank: Bank, note: Note, time: float) -> None:
    begin = max(round(time * RATE), 0)
    samples = bank.waves[note.key][: max(len(total) - begin, 0)]
    strengths = np.array([note.left, note.right], np.float32) / np.float32(FULL)
    total[begin : begin + len(samples)] += samples[:, None] * strengths


def _add_rolling(
    total: NDArray[np.float32], bank: Bank, gains: tuple[Gains, Gains], times: tuple[float, float]
) -> None:
    """Add the loops from one time to another [s], with strengths that change evenly."""
    begin, end = (min(max(round(time * RATE), 0), len(total)) for time in times)
    if end <= begin:
        return
    share = (np.arange(end - begin, dtype=np.float32) / np.float32(end - begin))[:, None]
    for lane, loop in gains[0].keys() | gains[1].keys():
        first, last = (
            np.array(one.get((lane, loop), (0.0, 0.0)), np.float32) / np.float32(FULL) for one in gains
        )
        # Lanes start at different places of the loop, or two balls of one speed would sound like one.
        at = (begin + lane * RATE // 2 + np.arange(end - begin)) % len(bank.loops[loop])
        total[begin:end] += bank.loops[loop][at, None] * (first + share * (last - first))


def _fade_out(total: NDArray[np.float32]) -> None:
    count = min(RATE // 50, len(total))
    total[len(total) - count :] *= np.linspace(1.0, 0.0, count, dtype=np.float32)[:, None]
