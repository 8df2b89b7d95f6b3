"""Loudness by the test signals of EBU Tech 3341, peaks, octaves, and `silverball bench sound`."""

from __future__ import annotations

import json
import wave

import numpy as np
import pytest

from commandline import ran
from silverball.app.sound.synth import RATE
from silverball.benchmarks.sound_levels import integrated_loudness, octave_levels, true_peak


def sine(pitch: float, level: float, seconds: float, phase: float = 0.0) -> np.ndarray:
    """A sine of a level [dB] in both ears."""
    time = np.arange(round(seconds * RATE)) / RATE
    return np.repeat(10.0 ** (level / 20.0) * np.sin(2.0 * np.pi * pitch * time + phase)[:, None], 2, axis=1)


def test_a_full_sine_in_one_ear_has_minus_three():
    one_ear = sine(997.0, 0.0, 5.0)
    one_ear[:, 1] = 0.0
    assert integrated_loudness(one_ear) == pytest.approx(-3.01, abs=0.02)  # BS.1770, annex 1


# EBU Tech 3341 (2016), table 1, cases 1 to 5: level [dB] and length [s] of sines of 1 kHz in both ears. Those
# of 1 to 4 are shortened, which does not change their loudness.
CASES = {
    -23.0: [[(-23.0, 10.0)], [(-36.0, 3.0), (-23.0, 12.0), (-36.0, 3.0)],
            [(-72.0, 3.0), (-36.0, 3.0), (-23.0, 12.0), (-36.0, 3.0), (-72.0, 3.0)],
            [(-26.0, 20.0), (-20.0, 20.1), (-26.0, 20.0)]],
    -33.0: [[(-33.0, 10.0)]],
}  # fmt: skip


@pytest.mark.parametrize(("expected", "parts"), [(level, case) for level in CASES for case in CASES[level]])
def test_loudness_is_that_of_the_standards_test_signals(expected, parts):
    sound = np.concatenate([sine(1000.0, level, seconds) for level, seconds in parts])
    assert integrated_loudness(sound) == pytest.approx(expected, abs=0.1)


def test_silence_has_no_loudness():
    assert integrated_loudness(np.zeros((RATE, 2))) == -np.inf


def test_the_true_peak_lies_between_the_samples():
    # A quarter of the rate, 45° off: all samples lie at 0.707 of the peak.
    tone = sine(RATE / 4, 0.0, 1.0, np.pi / 4)
    assert np.abs(tone).max() == pytest.approx(0.7071, abs=1e-3)
    assert true_peak(tone[100:-100]) == pytest.approx(0.0, abs=0.3)


def test_octaves_are_compared_with_the_loudest():
    levels = octave_levels(sine(750.0, -10.0, 1.0) + sine(3000.0, -30.0, 1.0))
    assert levels[500.0] == 0.0
    assert levels[2000.0] == pytest.approx(-20.0, abs=0.1)
    assert levels[8000.0] < -60.0


def test_a_game_is_recorded_and_measured(tmp_path):
    file = tmp_path / "game.wav"
    result = ran("bench", "sound", "--table", "classic", "--seconds", "4", "--out", str(file), "--json")
    assert result.returncode == 0, result.stderr
    found = {one["name"]: one["value"] for one in json.loads(result.stdout)}
    assert -40.0 < found["loudness"] < -15.0
    assert found["true peak"] < 0.0
    assert found["samples at full scale"] == 0.0
    with wave.open(str(file)) as recording:
        assert recording.getnframes() == 4 * RATE


@pytest.mark.parametrize(
    ("option", "value"), [("--theme", "loud"), ("--player", "nobody"), ("--out", "game.mp3")]
)
def test_what_does_not_exist_is_refused_in_a_sentence(option, value):
    result = ran("bench", "sound", "--seconds", "1", option, value)
    assert result.returncode == 2
    assert value in result.stderr
    assert "Traceback" not in result.stderr
