"""Waves of the bank: finite, without clicks and offset, at the specified pitches and loudness."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from silverball.app.sound.bank import FULL, PEAK, RECIPES, Key, common_sounds, make_bank
from silverball.app.sound.levels import loudness
from silverball.app.sound.rolling import ROLL_LEVEL, ROLL_SPEEDS, roll_pitch
from silverball.app.sound.synth import BELL_STEPS, RATE, Partial, finished, noise, pitch_of, ring, soft_limit

BANK = make_bank()
KEYS = list(BANK.waves)
NAME = "{0.name}-{0.layer}-{0.variation}".format
HUSH = 0.002  # of full scale, −54 dB: what a wave may jump by at its ends


def wave_of(key: Key) -> np.ndarray:
    return BANK.waves[key] / FULL


def spectrum(wave: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pitches [Hz] and power, ten times finer than the wave's length gives."""
    count = 1 << (10 * len(wave)).bit_length()
    return np.fft.rfftfreq(count, 1.0 / RATE), np.abs(np.fft.rfft(wave * np.hanning(len(wave)), count)) ** 2


@pytest.mark.parametrize("key", KEYS, ids=NAME)
def test_a_wave_begins_and_ends_at_zero_without_offset_and_below_the_peak(key):
    wave = wave_of(key)
    assert np.abs(wave).max() <= PEAK
    assert np.abs(wave).max() > 0.1
    assert abs(wave[0]) <= HUSH
    assert abs(wave[-1]) <= HUSH
    assert abs(wave.mean()) <= 1e-3


@pytest.mark.parametrize("key", KEYS, ids=NAME)
def test_a_sound_has_its_loudness_and_is_short(key):
    # Half a decibel is what the soft limit takes from the highest peaks, a second one from short knocks.
    assert loudness(wave_of(key)) == pytest.approx(RECIPES[key.name].level, abs=1.5)
    assert len(wave_of(key)) / RATE <= 3.5


@pytest.mark.parametrize("key", KEYS, ids=NAME)
def test_nothing_is_shrill(key):
    # Real coils and plates click up to 10 kHz; what is above, or goes on for long, would hiss.
    pitches, power = spectrum(wave_of(key))
    assert power[pitches > 6000.0].sum() < 0.15 * power.sum()
    assert power[pitches > 12_000.0].sum() < 0.03 * power.sum()


BRIGHT = (
    "coil",
    "stop",
    "balls",
    "metal",
    "kick",
    "target",
    "drop",
    "bank_reset",
    "spinner",
    "release",
    "launch",
)


@pytest.mark.parametrize("name", BRIGHT)
def test_coils_steel_and_targets_have_a_bright_layer(name):
    wave = wave_of(Key(name, RECIPES[name].layers - 1))
    pitches = np.fft.rfftfreq(len(wave), 1.0 / RATE)
    power = np.abs(np.fft.rfft(wave)) ** 2  # without a window, which would take away the first millisecond
    bright = power[(pitches > 2000.0) & (pitches < 10_000.0)].sum()
    assert bright > 0.04 * power.sum()  # no more than 14 dB below the whole


def test_no_sound_is_more_than_ten_decibels_over_another_and_rolling_lies_below_hits():
    levels = [loudness(wave_of(key)) for key in KEYS]
    assert max(levels) - min(levels) <= 10.0
    hits = min(
        loudness(wave_of(key)) for key in KEYS if key.name in ("wall", "slant_wall", "prism", "cylinder")
    )
    assert all(loudness(loop / FULL) <= hits - 5.0 for loop in BANK.loops)


@pytest.mark.parametrize("step", range(BELL_STEPS))
@pytest.mark.parametrize("variation", range(RECIPES["cylinder"].variations))
def test_the_bell_of_a_step_has_the_pitch_of_the_scale(step, variation):
    pitches, power = spectrum(wave_of(Key("cylinder", step, variation)))
    assert pitches[power.argmax()] == pytest.approx(pitch_of(step), rel=0.005)  # a twelfth of a semitone


def test_the_scale_is_g_major_pentatonic():
    # An equal-tempered semitone is 2^(1/12); A4 is 440 Hz by convention.
    assert [pitch_of(step) for step in (0, 1, 5)] == pytest.approx([391.995, 440.0, 783.991], abs=0.01)
    semitones = [round(12.0 * np.log2(pitch_of(step) / pitch_of(0))) for step in range(-5, 6)]
    assert semitones == [-12, -10, -8, -5, -3, 0, 2, 4, 7, 9, 12]


@pytest.mark.parametrize("number", range(len(ROLL_SPEEDS)))
def test_a_loop_sounds_at_the_pitch_of_its_speed(number):
    pitches, power = spectrum(np.tile(BANK.loops[number] / FULL, 2))
    # Noise has no single pitch: the middle of its power around the hump, in octaves.
    near = np.abs(np.log2(np.maximum(pitches, 1.0) / roll_pitch(ROLL_SPEEDS[number]))) < 0.6
    middle = np.exp2(np.average(np.log2(pitches[near]), weights=power[near]))
    assert middle == pytest.approx(roll_pitch(ROLL_SPEEDS[number]), rel=0.06)


@pytest.mark.parametrize("loop", BANK.loops, ids=lambda loop: "")
def test_a_loop_has_no_click_at_its_seam(loop):
    steps = np.abs(np.diff(loop.astype(int)))
    curves = np.abs(np.diff(loop.astype(int), 2))
    twice = np.concatenate([loop, loop]).astype(int)
    seam = slice(len(loop) - 3, len(loop) + 2)
    assert np.abs(np.diff(twice))[seam].max() <= steps.max()
    assert np.abs(np.diff(twice, 2))[seam].max() <= curves.max()
    assert abs(loop.mean()) < 1.0


def test_loops_rise_in_pitch_and_keep_their_level():
    middles = []
    for loop in BANK.loops:
        assert loudness(loop / FULL) == pytest.approx(ROLL_LEVEL, abs=0.5)
        pitches, power = spectrum(loop / FULL)
        middles.append(np.average(pitches, weights=power))
    assert np.all(np.diff(middles) > 0.0)


def test_variations_differ_but_are_the_same_sound():
    for name, recipe in RECIPES.items():
        for layer in range(recipe.layers):
            waves = [wave_of(Key(name, layer, number)) for number in range(recipe.variations)]
            for one, other in pairwise(waves):
                assert not np.array_equal(one, other)
                assert len(one) == len(other)


def test_the_bank_is_the_same_when_it_is_made_again_and_fits_its_memory():
    make_bank.cache_clear()
    common_sounds.cache_clear()
    again = make_bank()
    assert again is not BANK
    assert all(np.array_equal(again.waves[key], BANK.waves[key]) for key in KEYS)
    assert all(np.array_equal(one, other) for one, other in zip(again.loops, BANK.loops, strict=True))
    assert 3 * BANK.size < 26_000_000  # once in mono here, once in stereo in the mixer


def test_a_ring_is_the_sum_of_decaying_sines():
    time = np.arange(RATE // 4) / RATE
    expected = 0.7 * 10.0 ** (-3.0 * time / 0.3) * np.sin(2.0 * np.pi * 440.0 * time)
    expected += 0.2 * 10.0 ** (-3.0 * time / 0.1) * np.sin(2.0 * np.pi * 1234.5 * time)
    wave = ring([Partial(440.0, 0.7, 0.3), Partial(1234.5, 0.2, 0.1)], 0.25)
    assert np.abs(wave - expected).max() < 1e-4  # partials are cut where they are 80 dB down


def test_a_tone_above_what_samples_can_hold_is_left_out():
    assert not ring([Partial(23_000.0, 1.0, 0.1)], 0.1).any()


def test_noise_has_its_power_between_its_pitches():
    pitches, power = spectrum(noise(0.5, 300.0, 1200.0, np.random.default_rng(0)))
    inside = (pitches > 150.0) & (pitches < 2400.0)  # an octave more to both sides, where it falls by 12 dB
    assert power[inside].sum() > 0.9 * power.sum()


def test_finishing_takes_the_offset_and_the_clicks():
    wave = finished(np.full(4800, 0.5, np.float32) + np.sin(np.arange(4800) / 10.0).astype(np.float32))
    assert abs(wave.mean()) < 1e-6
    assert wave[0] == 0.0
    assert abs(wave[-1]) < 1e-6


def test_the_soft_limit_leaves_quiet_waves_alone_and_never_passes_one():
    quiet = np.linspace(-0.69, 0.69, 100, dtype=np.float32)
    assert np.array_equal(soft_limit(quiet), quiet)
    loud = soft_limit(np.linspace(-9.0, 9.0, 1001, dtype=np.float32))
    assert np.abs(loud).max() <= 1.0
    assert np.all(np.diff(loud) >= 0.0)


def test_a_full_sine_has_three_decibels_less_than_full_and_low_pitches_count_less():
    time = np.arange(RATE) / RATE
    of_1_khz, of_50_hz = (loudness(np.sin(2.0 * np.pi * pitch * time)) for pitch in (1000.0, 50.0))
    assert of_1_khz == pytest.approx(-3.01 + 0.7, abs=0.2)  # the standard's filters add 0.7 dB at 1 kHz
    assert of_50_hz < of_1_khz - 4.0
    assert loudness(np.zeros(100)) == -np.inf


def test_prisms_sing_on_three_notes_of_the_low_scale():
    for layer in range(2):
        sung = set()
        for variation in range(3):
            pitches, power = spectrum(wave_of(Key("prism", layer, variation)))
            high = pitches > 150.0  # above the thud
            sung.add(round(pitches[high][power[high].argmax()]))
        assert sung == {round(pitch_of(step)) for step in (-5, -3, -2)}


def test_the_page_about_sound_shows_every_sound():
    page = (Path(__file__).parents[3] / "docs" / "sound.md").read_text(encoding="utf-8")
    assert [name for name in RECIPES if not re.search(rf"^\| {name}( \d+)? \|", page, re.MULTILINE)] == []
