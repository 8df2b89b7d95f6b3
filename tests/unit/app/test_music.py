"""The music: composed from a table, without a seam, in the mood of the game."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from silverball.app.sound.bank import FULL
from silverball.app.sound.composition import BARS, LAYERS, compose
from silverball.app.sound.ducking import DUCKED, Ducker
from silverball.app.sound.instruments import NOTE_LEVEL, SAW_PAD
from silverball.app.sound.levels import loudness
from silverball.app.sound.mixdown import MUSIC_VOLUME, VOLUME, Frame, mixdown
from silverball.app.sound.moods import DRAIN_PAUSE, MISSION, PLAYING, WAITING, Goal, MoodReader, missions_of
from silverball.app.sound.music import (
    LIFT,
    MAX_LEVEL,
    MUSIC_LEVEL,
    MUSIC_PEAK,
    Band,
    Mood,
    Place,
    band_of,
    loop_of,
    note,
)
from silverball.app.sound.music_track import STOP_SECONDS
from silverball.app.sound.sound_sets import SOUND_SETS
from silverball.app.sound.synth import RATE, pitch_of
from silverball.benchmarks.sound_levels import integrated_loudness
from silverball.drawing.themes import THEMES
from silverball.game.view import Mode, Phase
from silverball.table import load_table, parse_table, table_names

ROOT = Path(__file__).parents[3]
TABLE = load_table("classic")
FULL_MOOD = Mood(MAX_LEVEL)
BANDS = {name: Band(12345, sounds) for name, sounds in SOUND_SETS.items()}


def jumps(samples: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Steps from sample to sample, and their changes, the larger of both ears."""
    samples = samples.astype(int)
    return tuple(np.abs(np.diff(samples, order, axis=0)).max(axis=1) for order in (1, 2))


# --- composition ----------------------------------------------------------------------------------------


def test_a_seed_is_a_piece_and_another_seed_another_one():
    assert compose(5, (100.0, 120.0)) == compose(5, (100.0, 120.0))
    assert compose(5, (100.0, 120.0)) != compose(6, (100.0, 120.0))
    assert np.array_equal(Band(5).bar(Place(0, FULL_MOOD)), Band(5).bar(Place(0, FULL_MOOD)))


def test_every_built_in_table_has_a_melody_of_its_own():
    tables = [load_table(name) for name in table_names()]
    lead = LAYERS.index("lead")
    melodies = [band_of(table, SOUND_SETS["neon"]).composition.layers[lead] for table in tables]
    assert len(set(melodies)) == len(melodies)


@pytest.mark.parametrize("seed", range(8))
def test_every_bar_of_every_layer_lies_within_its_bar_and_its_register(seed):
    piece = compose(seed, (100.0, 120.0), 0.33)
    assert 100.0 <= piece.tempo <= 120.0
    assert [len(bars) for bars in piece.layers] == [BARS] * len(LAYERS)
    for bars in piece.layers:
        for tone in (tone for bar in bars for tone in bar):
            assert 0.0 <= tone.start < 4.0
            assert 0.0 < tone.strength <= 1.0
            if tone.instrument == "bass":
                assert 60.0 < pitch_of(tone.step) < 260.0
            elif tone.instrument in ("pad", "lead", "arpeggio"):
                assert 190.0 < pitch_of(tone.step) < 1400.0


def test_a_note_has_the_pitch_of_the_bumpers_scale():
    wave = note(SAW_PAD._replace(spread=0.0), 3, 0, 2.0)
    power = np.abs(np.fft.rfft(wave * np.hanning(len(wave)), 1 << 19))
    assert np.fft.rfftfreq(1 << 19, 1.0 / RATE)[power.argmax()] == pytest.approx(pitch_of(3), rel=1e-3)
    assert loudness(wave) == pytest.approx(NOTE_LEVEL, abs=0.1)


def test_every_theme_has_a_sound_set():
    assert SOUND_SETS.keys() == THEMES.keys()
    assert [name for name, sounds in SOUND_SETS.items() if sounds.name != name] == []


# --- bars -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("level", [1, 2, 3, MAX_LEVEL])
@pytest.mark.parametrize("name", SOUND_SETS)
def test_the_loop_has_no_seam(name, level):
    band = BANDS[name]
    twice = loop_of(band, Mood(level), 2 * BARS)
    steps, curves = jumps(twice)
    joins = np.arange(1, 2 * BARS) * band.bar_samples
    inside_steps, inside_curves = np.delete(steps, joins - 1), np.delete(curves, joins - 1)
    assert steps[joins - 1].max() <= inside_steps.max()
    assert curves[joins - 1].max() <= inside_curves.max()
    # After its first bar, which nothing rings into, the second round is the first one, sample by sample.
    count = BARS * band.bar_samples
    assert np.array_equal(twice[band.bar_samples : count], twice[count + band.bar_samples :])


def test_bars_that_follow_one_another_are_one_long_piece():
    band = BANDS["neon"]
    count = band.bar_samples
    piece = np.zeros((2, (BARS + 1) * count), np.float32)
    for number in range(BARS):
        piece[:, number * count : (number + 2) * count] += band._rendered(Place(number, Mood(3)))
    joined = loop_of(band, Mood(3)).T / FULL
    assert np.abs(joined - piece[:, : BARS * count]).max() < 2.0 / FULL


def test_a_change_of_mood_and_key_has_no_step_either():
    band = BANDS["neon"]
    moods = [Mood(2), Mood(6), Mood(6, LIFT), Mood(3), Mood(1)]
    places = [Place(number, mood) for number, mood in enumerate(moods)]
    bars = [band.bar(place, before) for before, place in zip([None, *places], places, strict=False)]
    steps, _ = jumps(np.concatenate(bars))
    joins = np.arange(1, len(moods)) * band.bar_samples - 1
    assert steps[joins].max() <= np.delete(steps, joins).max()


@pytest.mark.parametrize("name", SOUND_SETS)
def test_the_music_grows_with_its_level_up_to_its_loudness_and_never_clips(name):
    levels = []
    for level in range(1, MAX_LEVEL + 1):
        samples = loop_of(BANDS[name], Mood(level), 4)
        assert np.abs(samples.astype(int)).max() <= MUSIC_PEAK * FULL + 1
        levels.append(integrated_loudness(samples / FULL))
    assert all(one < other for one, other in pairwise(levels))
    assert levels[-1] == pytest.approx(MUSIC_LEVEL, abs=1.5)


def test_a_multiball_raises_the_key_by_a_fifth():
    band = BANDS["neon"]

    def lowest_pad(mood: Mood) -> float:
        wave = band._rendered(Place(0, mood))[:, : band.bar_samples].sum(axis=0)
        power = np.abs(np.fft.rfft(wave, 1 << 18))
        pitches = np.fft.rfftfreq(1 << 18, 1.0 / RATE)
        peaks = pitches[power > 0.3 * power.max()]
        return float(peaks.min())

    assert lowest_pad(Mood(1, LIFT)) / lowest_pad(Mood(1)) == pytest.approx(2.0 ** (7 / 12), rel=0.01)


# --- moods ----------------------------------------------------------------------------------------------


def game(phase=Phase.PLAY, on_board=1, combo=0, *, tilted=False, modes=None, counters=None, lamps=None):
    view = SimpleNamespace(phase=phase, on_board=on_board, combo=combo, tilted=tilted)
    return SimpleNamespace(view=view, modes=modes or {}, counters=counters or {}, lamps=lamps or {})


def rules_of(path: str):
    parts = (ROOT / "src/silverball/table/tables/parts.toml").read_text(encoding="utf-8")
    return parse_table(parts + (ROOT / path).read_text(encoding="utf-8"))


def test_the_music_waits_plays_and_stops_at_a_drain_for_a_moment():
    reader = MoodReader(TABLE)
    assert reader.read(game(Phase.READY, 0), 0.1) == Mood(WAITING)
    assert reader.read(game(), 0.1) == Mood(PLAYING)
    assert reader.read(game(Phase.READY, 0), 0.1) is None
    assert reader.read(game(Phase.READY, 0), 0.9 * DRAIN_PAUSE) is None
    assert reader.read(game(Phase.READY, 0), 0.2 * DRAIN_PAUSE) == Mood(WAITING)


@pytest.mark.parametrize("silent", [game(tilted=True), game(Phase.OVER, 0)])
def test_there_is_no_music_after_a_tilt_or_a_game(silent):
    assert MoodReader(TABLE).read(silent, 0.1) is None


def test_two_balls_lift_the_key_and_long_combos_add_layers():
    reader = MoodReader(TABLE)
    assert reader.read(game(on_board=2), 0.1) == Mood(MAX_LEVEL, LIFT)
    levels = [reader.read(game(combo=combo), 0.1).level for combo in (0, 5, 6, 12, 1000)]
    assert levels == [PLAYING, PLAYING, PLAYING + 1, PLAYING + 2, MAX_LEVEL - 1]


def test_missions_are_modes_of_some_length_that_rules_start():
    missions = missions_of(rules_of("tests/tables/comet_rules.toml"))
    assert set(missions) == {
        "chase the comet", "land on the moon", "storm of Mars", "through the rings", "birth of a star",
        "silver comet",
    }  # fmt: skip
    assert missions["silver comet"].seconds == 60.0
    assert missions_of(rules_of("docs/rules/mission.toml"))["hunt"].goals == (Goal("turns", 3, ()),)


def test_the_music_grows_with_what_a_mission_counts_and_with_its_time():
    reader = MoodReader(rules_of("docs/rules/mission.toml"))

    def level(turns: int, left: float) -> int:
        return reader.read(game(modes={"hunt": left}, counters={"turns": turns}), 0.1).level

    assert [level(turns, 20.0) for turns in (0, 1, 2, 3)] == [MISSION, MISSION + 1, MISSION + 2, MAX_LEVEL]
    assert [level(0, left) for left in (20.0, 14.0, 13.0, 6.0)] == [
        MISSION,
        MISSION,
        MISSION + 1,
        MISSION + 2,
    ]


def test_the_mood_of_a_real_game_is_read():
    import silverball as sb

    table = rules_of("docs/rules/mission.toml")
    played = sb.Game(table, seed=3, mode=Mode.ARCADE)
    reader = MoodReader(played.table)
    assert reader.read(played, 0.1) == Mood(WAITING)
    played.create_ball()
    assert reader.read(played, 0.1) == Mood(PLAYING)


# --- ducking --------------------------------------------------------------------------------------------


def test_music_steps_back_under_a_call_and_comes_back_after_it():
    ducker = Ducker()
    ducker.call(1.0)
    gains = [ducker.update(1 / 60) for _ in range(240)]
    assert gains[20] == pytest.approx(DUCKED, abs=0.01)
    assert max(abs(one - other) for one, other in pairwise(gains)) < 0.25
    assert gains[-1] > 0.99


# --- films ----------------------------------------------------------------------------------------------


def frames(moods: list[Mood | None]) -> list[Frame]:
    return [Frame((number + 1) / 60, 0.0, mood=mood) for number, mood in enumerate(moods)]


def film(moods: list[Mood | None]) -> np.ndarray:
    return mixdown(frames(moods), len(moods) / 60, TABLE, 240)


def test_a_film_has_the_bars_of_its_moods_to_the_sample():
    band = band_of(TABLE, SOUND_SETS["neon"])
    count = band.bar_samples
    change = count * 60 // RATE // 2  # in the middle of the first bar: heard from the second on
    heard = film([Mood(3)] * change + [Mood(6)] * (240 - change)) / FULL
    first, second = Place(0, Mood(3)), Place(1, Mood(6))
    expected = np.concatenate([band.bar(first), band.bar(second, first)]) / FULL * MUSIC_VOLUME * VOLUME
    end = min(2 * count, len(heard) - RATE // 50)
    assert np.abs(heard[:end] - expected[:end]).max() < 3.0 / FULL


def test_the_music_of_a_film_stops_at_a_drain_and_begins_anew_with_its_first_bar():
    heard = film([Mood(3)] * 60 + [None] * 60 + [Mood(3)] * 60)
    silent = heard[RATE + round((STOP_SECONDS + 1 / 60) * RATE) : 2 * RATE]
    assert heard[: RATE // 2].any()
    assert not silent.any()
    assert np.array_equal(heard[2 * RATE : 2 * RATE + RATE // 2], heard[: RATE // 2])
    steps, _ = jumps(heard[: 2 * RATE])
    assert steps[RATE:].max() <= steps[:RATE].max()


def test_without_a_mood_a_film_has_no_music():
    assert not film([None] * 30).any()
