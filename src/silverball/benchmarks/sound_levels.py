"""How loud and how bright the sound of a game is: loudness, peaks and the level of every octave.

Loudness is that of broadcasting, [LUFS]: K-weighted power of blocks of 0.4 s that overlap by three quarters,
without those below −70 LUFS and those 10 dB below the mean of the rest. Source: Recommendation ITU-R
BS.1770-5 (2023), annex 1. The true peak is that of four times as many samples, annex 2.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.app.sound.bank import FULL, Samples
from silverball.app.sound.mixdown import FilmSound, write_wav
from silverball.app.sound.sound_sets import sound_set
from silverball.app.sound.synth import RATE
from silverball.benchmarks.speed import Figure
from silverball.game.game import Game
from silverball.game.mechanisms import plungers
from silverball.game.view import Mode
from silverball.players import make_player
from silverball.players.simple import holds_launch
from silverball.table import Table

FRAME_RATE = 60  # of the recorded game [1/s]
BALL_WAIT = 1.0  # [s] from a lost ball to the next one
BLOCK = 0.4  # [s]
OVERLAP = 4  # blocks that begin within one block
SILENCE = -70.0  # [LUFS] blocks below do not count
BELOW_MEAN = 10.0  # [dB] blocks further below the mean of the rest do not count
OFFSET = -0.691  # [dB] so that a sine of 997 Hz at full scale in one ear has −3.01 LUFS
OVERSAMPLING = 4
LOWEST = 62.5  # [Hz] where the first octave begins
OCTAVES = 8

# The two filters of BS.1770 at 48 kHz, as coefficients of z⁻ⁿ: numerator and denominator.
_SHELF = ((1.53512485958697, -2.69169618940638, 1.19839281085285), (1.0, -1.69065929318241, 0.73248077421585))
_HIGH_PASS = ((1.0, -2.0, 1.0), (1.0, -1.99004745483398, 0.99007225036621))


class Recording(NamedTuple):
    """What is recorded.

    Attributes:
        table: The table.
        seed: Seed of the game.
        seconds: Length of the recording [s].
        player: Name of the player.
        theme: Name of the theme, which has a sound set of its own.
        has_music: Whether there is music.
    """

    table: Table
    seed: int
    seconds: float
    player: str
    theme: str = "neon"
    has_music: bool = True


def recorded_game(recording: Recording) -> Samples:
    """Return the sound of an arcade game, int16 `[sample, 2]`; when it is over, another one follows."""
    table, seed, seconds = recording.table, recording.seed, recording.seconds
    chosen = make_player(recording.player, seed)
    game = Game(table, seed, Mode.ARCADE)
    sounds = sound_set(recording.theme)
    sound = FilmSound(game.table, game.tick_rate, FRAME_RATE, sounds, has_music=recording.has_music)
    has_plunger = bool(plungers(game.table))
    wait = 0
    for _ in range(round(seconds * FRAME_RATE)):
        for _ in range(game.tick_rate // FRAME_RATE):
            wait = 0 if game.world.balls else wait + 1
            if wait > BALL_WAIT * game.tick_rate and not game.is_over:
                game.create_ball()
            record = game.world.records[0]
            launch = has_plunger and bool(holds_launch(record, 1.0 / game.tick_rate))
            game.step(*chosen.press(game.world), 1, launch=launch)
        held = (*game.held, game.is_launch_held)
        sound.add_picture(game.world, game.take_world_events(), held, game.take_game_events(), game)
        if game.is_over and wait > BALL_WAIT * game.tick_rate:
            seed += 1
            game, wait = Game(table, seed, Mode.ARCADE), 0
    return sound.track().samples


def measure_sound(
    recording: Recording, wav: Path | None = None, advance: Callable[[str], None] = lambda _: None
) -> list[Figure]:
    """Record a game and measure its sound.

    Args:
        recording: What is recorded.
        wav: File for the recording; None: none.
        advance: Called with the name of what is done next.
    """
    advance(f"playing {recording.seconds:g} s")
    samples = recorded_game(recording)
    if wav is not None:
        write_wav(wav, samples)
    advance("measuring")
    sound = samples / FULL
    figures = [
        Figure("loudness", integrated_loudness(sound), "LUFS"),
        Figure("true peak", true_peak(sound), "dB"),
        Figure("samples at full scale", float(np.count_nonzero(np.abs(samples.astype(int)) >= FULL)), ""),
    ]
    return figures + [
        Figure(f"{low:g} to {2.0 * low:g} Hz, below the loudest octave", level, "dB")
        for low, level in octave_levels(sound).items()
    ]


def octave_levels(sound: NDArray[np.float64]) -> dict[float, float]:
    """Return the power of every octave from 62.5 Hz up, relative to the loudest [dB], by its lower end [Hz].

    Args:
        sound: `[sample, ear]`, full scale is 1.
    """
    count = _whole_seconds(len(sound))
    power = (np.abs(np.fft.rfft(sound, count, axis=0)) ** 2).sum(axis=1)
    pitches = np.fft.rfftfreq(count, 1.0 / RATE)
    lows = [LOWEST * 2.0**number for number in range(OCTAVES)]
    levels = [power[(pitches >= low) & (pitches < 2.0 * low)].sum() for low in lows]
    loudest = max(*levels, 1e-30)
    return {
        low: 10.0 * math.log10(max(level / loudest, 1e-12)) for low, level in zip(lows, levels, strict=True)
    }


def integrated_loudness(sound: NDArray[np.float64]) -> float:
    """Return the gated loudness of a whole sound [LUFS]; silence has −inf.

    Args:
        sound: `[sample, ear]`, full scale is 1.
    """
    weighted = _weighted(sound)
    step = round(BLOCK * RATE / OVERLAP)
    steps = len(weighted) // step
    quarters = (weighted[: steps * step] ** 2).reshape(steps, step, -1).mean(axis=1).sum(axis=1)
    blocks = np.convolve(quarters, np.full(OVERLAP, 1.0 / OVERLAP), "valid")
    blocks = blocks[_lufs(blocks) > SILENCE]
    if not len(blocks):
        return -math.inf
    gate = float(_lufs(blocks.mean())) - BELOW_MEAN
    return float(_lufs(blocks[_lufs(blocks) > gate].mean()))


def true_peak(sound: NDArray[np.float64]) -> float:
    """Return the greatest value between and at the samples, relative to full scale [dB]."""
    count = _whole_seconds(len(sound))
    spectrum = np.fft.rfft(sound, count, axis=0)
    peak = np.abs(np.fft.irfft(spectrum, OVERSAMPLING * count, axis=0)).max() * OVERSAMPLING
    return 20.0 * math.log10(max(float(peak), 1e-10))


def _whole_seconds(count: int) -> int:
    """A number of samples that is no less, and has small factors: Fourier transforms of others take long."""
    return -(-count // RATE) * RATE


def _weighted(sound: NDArray[np.float64]) -> NDArray[np.float64]:
    # The filters in one Fourier transform; zeros behind the sound keep its end from reaching its beginning.
    count = _whole_seconds(len(sound) + RATE)
    turn = np.exp(-2j * np.pi * np.fft.rfftfreq(count))
    response = np.ones(len(turn), complex)
    for above, below in (_SHELF, _HIGH_PASS):
        response *= np.polyval(above[::-1], turn) / np.polyval(below[::-1], turn)
    weighted = np.fft.irfft(np.fft.rfft(sound, count, axis=0) * response[:, None], count, axis=0)
    return weighted[: len(sound)]


def _lufs(power: NDArray[np.float64] | float) -> NDArray[np.float64]:
    with np.errstate(divide="ignore"):
        return np.asarray(OFFSET + 10.0 * np.log10(power))
