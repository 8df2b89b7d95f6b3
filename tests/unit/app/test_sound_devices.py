"""Sounds through pygame's mixer: without a device, with a dummy, and with one that writes a file."""

from __future__ import annotations

import itertools
import os
import subprocess
import sys
import textwrap
import time
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pygame
import pytest

from patience import PATIENCE
from silverball.app.settings import Settings
from silverball.app.sound import Sounds
from silverball.app.sound.bank import Key, make_bank
from silverball.app.sound.ducking import DUCKED
from silverball.app.sound.mixer import HIT_CHANNELS, Mixer
from silverball.app.sound.moods import PLAYING
from silverball.app.sound.music import LIFT, MAX_LEVEL, Mood, Place, band_of
from silverball.app.sound.rolling import LANES, ROLL_SPEEDS
from silverball.app.sound.sound_sets import SOUND_SETS
from silverball.app.sound.sounds import master_volume, music_volume
from silverball.app.sound.synth import RATE
from silverball.app.sound.voices import Note
from silverball.game.view import GameEvent, GameEventKind, Phase
from silverball.table import Cylinder, Table, load_table
from silverball.world.events import Event

WIDTH, TICKS = 10.0, 240
LOUD = Settings(volume=10, music=10)
TOO_MUCH = HIT_CHANNELS + LANES * len(ROLL_SPEEDS) + 1  # one is for the music
DRIVER_BUFFER = 512  # [sample]
BYTES = 4  # of a sample in both ears


def hit(part="board.left", *, ball=1, tick=0, z=0.0, speed=20.0) -> Event:
    return Event("hit", part, ball, tick, 0.0, (0.0, 1.0, z), (1.0, 0.0, 0.0), speed)


@pytest.fixture
def dummy(monkeypatch):
    """Open sounds on a device that swallows everything."""
    monkeypatch.setenv("SDL_AUDIODRIVER", "dummy")
    sounds = Sounds(LOUD)
    sounds.begin_game(_classic())
    sounds.open()
    assert sounds.warning == ""
    sounds.wait()
    yield sounds
    sounds.close()


# --- no device ----------------------------------------------------------------------------------------


def use_all(sounds: Sounds) -> None:
    """Call everything that a window calls."""
    sounds.begin_game(_classic())
    sounds.apply_settings(Settings(volume=3))
    sounds.play_game_events([GameEvent(GameEventKind.TILT, 1)])
    sounds.play_events([hit(), hit("cylinder[0]")], TICKS, WIDTH)
    sounds.set_buttons(True, False)
    sounds.set_rolling([(1, 0.0, 0.0, 10.0)], 1 / 60, WIDTH)
    sounds.play_menu("choose")
    sounds.pause()
    sounds.resume()
    sounds.set_rolling([], 1 / 60, WIDTH)
    sounds.wait()
    sounds.close()
    sounds.close()


def _classic():
    return load_table("classic")


def test_without_a_device_it_is_silent_and_says_why_in_one_sentence(monkeypatch, capfd):
    monkeypatch.setenv("SDL_AUDIODRIVER", "nonexistent")
    sounds = Sounds(LOUD)
    sounds.open()
    assert sounds.warning.startswith("no sound: no audio device could be opened (")
    assert "\n" not in sounds.warning
    use_all(sounds)
    assert sounds.voices == 0
    assert capfd.readouterr().err == ""


def test_without_pygames_mixer_it_is_silent(monkeypatch):
    class Missing:
        def __getattr__(self, name):
            raise NotImplementedError(f"mixer module not available: {name}")

    monkeypatch.setattr(pygame, "mixer", Missing())
    sounds = Sounds(LOUD)
    sounds.open()
    assert "mixer module not available" in sounds.warning
    use_all(sounds)


def test_before_it_is_opened_it_is_silent_without_a_complaint():
    sounds = Sounds(LOUD)
    use_all(sounds)
    assert sounds.warning == ""


def test_a_device_that_refuses_a_small_buffer_gets_a_larger_one(monkeypatch):
    tried = []
    init = pygame.mixer.init

    def refuse_small(rate, size, channels, buffer, **more):
        tried.append(buffer)
        if buffer < 2000:
            raise pygame.error("too small")
        init(rate, size, channels, buffer, **more)

    monkeypatch.setenv("SDL_AUDIODRIVER", "dummy")
    monkeypatch.setattr(pygame.mixer, "init", refuse_small)
    sounds = Sounds(LOUD)
    sounds.open()
    assert sounds.warning == ""
    assert tried == sorted(tried)
    assert len(tried) > 1
    sounds.close()


def test_sounds_can_be_closed_and_opened_again(dummy):
    dummy.close()
    assert pygame.mixer.get_init() is None
    dummy.open()
    dummy.wait()
    dummy.play_menu("choose")
    assert dummy.voices == 1


# --- a device that swallows everything ------------------------------------------------------------------


def test_the_device_is_stereo_of_16_bits(dummy):
    assert pygame.mixer.get_init() == (RATE, -16, 2)


def test_what_happens_is_played(dummy):
    dummy.play_events([hit(), hit("cylinder[1]")], TICKS, WIDTH)
    dummy.set_buttons(True, True)
    dummy.play_menu("move")
    assert dummy.voices == 5


def test_a_storm_of_a_thousand_events_has_few_voices(dummy):
    dummy.begin_game(Table(cylinder=tuple(Cylinder(center=(0.0, 0.0), radius=1.0) for _ in range(40))))
    parts = [f"cylinder[{number}]" for number in range(40)]
    for frame in range(100):
        events = [
            hit(parts[(10 * frame + number) % 40], ball=number % 2, tick=4 * frame, speed=5.0 + number % 7)
            for number in range(10)
        ]
        dummy.play_events(events, TICKS, WIDTH)
        dummy.set_buttons(frame % 2 == 0, frame % 2 == 1)
        dummy.set_rolling([(1, 0.0, -3.0, 15.0), (2, 0.0, 3.0, 7.0)], 1 / 60, WIDTH)
        assert dummy.voices <= HIT_CHANNELS + 2 * LANES
    assert dummy.voices > 4
    assert pygame.mixer.get_num_channels() == TOO_MUCH


def test_the_oldest_sounds_make_room(dummy):
    for number in range(3 * HIT_CHANNELS):
        dummy.play_events([hit("cylinder[0]", ball=number, tick=100 * number)], TICKS, WIDTH)
        time.sleep(0.03)  # two frames: what fades is gone
    before = dummy.voices
    dummy.play_menu("choose")
    assert dummy.voices == before + 1 <= HIT_CHANNELS


def test_muted_nothing_is_played_and_what_was_playing_ends(dummy):
    dummy.play_menu("high_score")
    dummy.set_rolling([(1, 0.0, 0.0, 10.0)], 0.1, WIDTH)
    assert dummy.voices > 1
    dummy.apply_settings(Settings(muted=True))
    dummy.play_events([hit()], TICKS, WIDTH)
    dummy.set_rolling([(1, 0.0, 0.0, 10.0)], 0.1, WIDTH)
    deadline = time.monotonic() + 5.0
    while dummy.voices and time.monotonic() < deadline:
        time.sleep(0.01)
    assert dummy.voices == 0


def test_a_pause_ends_rolling_but_menus_are_heard(dummy):
    ball = [(1, 0.0, 0.0, 10.0)]
    dummy.set_rolling(ball, 0.1, WIDTH)
    assert dummy.voices > 0
    dummy.pause()
    deadline = time.monotonic() + 5.0
    while dummy.voices and time.monotonic() < deadline:
        time.sleep(0.01)
    dummy.set_rolling(ball, 0.1, WIDTH)
    assert dummy.voices == 0
    dummy.play_menu("move")
    assert dummy.voices == 1
    dummy.resume()
    dummy.set_rolling(ball, 0.1, WIDTH)
    assert dummy.voices > 1


def test_volume_follows_the_settings():
    volumes = [master_volume(Settings(volume=step)) for step in range(11)]
    assert volumes[0] == 0.0
    assert volumes[-1] == 1.0
    assert all(one < other for one, other in itertools.pairwise(volumes))
    assert master_volume(Settings(volume=10, muted=True)) == 0.0


# --- music ----------------------------------------------------------------------------------------------


def playing(phase=Phase.PLAY, on_board=1, **view):
    """What the music reads of a game."""
    seen = {"phase": phase, "on_board": on_board, "combo": 0, "tilted": False} | view
    return SimpleNamespace(view=SimpleNamespace(**seen), modes={}, counters={}, lamps={})


def follow(sounds: Sounds, game, until, seconds: float = 20.0) -> None:
    """Frames of a game until something holds."""
    deadline = time.monotonic() + seconds
    while not until():
        assert time.monotonic() < deadline, "not reached in time"
        sounds.follow(game, 1 / 60)
        time.sleep(0.01)


def test_music_plays_in_a_game_and_changes_its_mood_at_the_end_of_a_bar(dummy):
    follow(dummy, playing(), lambda: dummy.mood == Mood(PLAYING))
    assert dummy._mixer.music is not None
    follow(dummy, playing(on_board=2), lambda: dummy.mood == Mood(MAX_LEVEL, LIFT))
    assert dummy.warning == ""


@pytest.mark.parametrize(
    "end",
    [
        lambda sounds: sounds.follow(playing(Phase.READY, 0), 0.01),
        lambda sounds: sounds.follow(playing(tilted=True), 0.01),
        lambda sounds: sounds.apply_settings(Settings(music=0)),
        lambda sounds: sounds.apply_settings(Settings(muted=True)),
        lambda sounds: sounds.pause(),
    ],
    ids=["drain", "tilt", "off", "mute", "pause"],
)
def test_music_ends(dummy, end):
    follow(dummy, playing(), lambda: dummy.mood is not None)
    end(dummy)
    assert dummy.mood is None
    deadline = time.monotonic() + 5.0
    while dummy._mixer.music is not None:
        assert time.monotonic() < deadline, "it must fade in a tenth of a second"
        time.sleep(0.01)


def test_the_strength_of_the_music_follows_its_setting_and_steps_back_under_a_call(dummy):
    follow(dummy, playing(), lambda: dummy.mood is not None)
    assert dummy._mixer._music.get_volume() == pytest.approx(music_volume(LOUD), abs=0.02)
    dummy.play_game_events([GameEvent(GameEventKind.CUE, 1, 0, "super jackpot")])
    for _ in range(30):
        dummy.follow(playing(), 1 / 60)
    assert dummy._mixer._music.get_volume() == pytest.approx(DUCKED * music_volume(LOUD), abs=0.02)


def test_another_theme_brings_other_bells_and_another_band(dummy):
    bell = dummy._mixer._sounds[Key("cylinder", 0, 0)].get_raw()
    wood = dummy._mixer._sounds[Key("wall", 0, 0)].get_raw()
    dummy.apply_settings(LOUD.changed(theme="parlour"))
    dummy.wait()
    assert dummy._mixer._sounds[Key("cylinder", 0, 0)].get_raw() != bell
    assert dummy._mixer._sounds[Key("wall", 0, 0)].get_raw() == wood
    follow(dummy, playing(), lambda: dummy.mood is not None)
    assert dummy._music._band.composition == band_of(_classic(), SOUND_SETS["parlour"]).composition


def test_music_that_cannot_be_made_ends_the_sounds_and_nothing_else(dummy, monkeypatch):
    def fail(table, sounds):
        raise ZeroDivisionError("no notes")

    monkeypatch.setattr("silverball.app.sound.sounds.band_of", fail)
    dummy.begin_game(_classic())
    follow(dummy, playing(), lambda: dummy.warning != "")
    assert "no notes" in dummy.warning


# --- a device that writes a file --------------------------------------------------------------------------


@pytest.fixture
def disk(tmp_path, monkeypatch):
    """Open sounds on SDL's device that writes all it plays into a file."""
    monkeypatch.setenv("SDL_AUDIODRIVER", "disk")
    monkeypatch.setenv("SDL_DISKAUDIOFILE", str(tmp_path / "played.raw"))
    sounds = Sounds(LOUD)
    sounds.open()
    assert sounds.warning == ""
    sounds.wait()
    yield sounds, tmp_path / "played.raw"
    sounds.close()


def written(file: Path) -> int:
    """Samples that the device has written so far."""
    return file.stat().st_size // BYTES


def played(file: Path) -> np.ndarray:
    """Everything that was played, int [sample, 2]."""
    return np.fromfile(file, "<i2").reshape(-1, 2).astype(int)


def test_a_scripted_scene_is_heard_when_and_where_it_happens(disk):
    sounds, file = disk
    sounds.begin_game(_classic())
    scene = [("board.left", -4.5), ("cylinder[0]", 0.0), ("triangular_prism[0]", 4.5), ("paddle.left", -2.0)]
    times = []
    for number, (part, z) in enumerate(scene):
        time.sleep(0.2)
        before = written(file)
        sounds.play_events([hit(part, tick=number, z=z)], TICKS, WIDTH)
        times.append((before, written(file)))
        time.sleep(0.15)
        sounds._mixer.fade_all()
        time.sleep(0.15)
    sounds.close()
    wave = played(file)
    loud = np.flatnonzero(np.abs(wave).max(axis=1) > 300)
    onsets = loud[np.flatnonzero(np.diff(loud, prepend=-RATE) > RATE // 20)]
    assert len(onsets) == len(scene)
    for onset, (before, after), (_, z) in zip(onsets, times, scene, strict=True):
        # The file is written in blocks of up to 4096 bytes, so what it holds may be two buffers old.
        assert before - DRIVER_BUFFER <= onset <= after + 5 * DRIVER_BUFFER
        left, right = (wave[onset : onset + RATE // 10] ** 2).sum(axis=0) ** 0.5
        assert (right - left) * z >= 0.0
        if abs(z) > 4.0:
            assert max(left, right) > 3.0 * min(left, right)


def test_a_note_has_its_strength_from_its_very_first_sample(disk):
    sounds, file = disk
    mixer: Mixer = sounds._mixer
    wave = pygame.sndarray.array(mixer._sounds[Key("cylinder", 2, 0)]).astype(int)[: RATE // 5]
    time.sleep(0.05)
    mixer.play(Note(Key("cylinder", 2, 0), 0.2, 0.6), 1.0)
    time.sleep(0.4)
    sounds.close()
    heard = played(file)
    # The mixer's steps are 1/255, and it cuts fractions off.
    begin = np.flatnonzero(np.abs(heard).max(axis=1) > 0)[0] - np.flatnonzero(np.abs(wave).max(axis=1) > 4)[0]
    assert abs(begin) < RATE
    best = min(
        np.abs(heard[at : at + len(wave)] - wave * [51 / 255, 153 / 255]).max()
        for at in range(max(begin - 40, 0), begin + 40)
    )
    assert best <= 3.0


def test_strengths_are_set_before_a_sound_starts(dummy):
    calls = []

    class Channel:
        def get_busy(self):
            return True

        def set_volume(self, left, right):
            calls.append((left, right))

        def play(self, sound):
            calls.append(sound)

    dummy._mixer._free = [Channel()] * HIT_CHANNELS
    dummy._mixer.play(Note(Key("coil"), 0.5, 0.25), 0.5)
    assert calls == [(0.25, 0.125), dummy._mixer._sounds[Key("coil")]]
    dummy._mixer._busy.clear()


def test_rolling_has_no_clicks_in_the_real_mixer(disk):
    sounds, file = disk

    def a_frame(balls) -> None:
        sounds.set_rolling(balls, 1 / 60, WIDTH)
        before, deadline = written(file), time.monotonic() + 5.0
        while (
            written(file) == before and time.monotonic() < deadline
        ):  # a frame is never shorter than a buffer
            time.sleep(0.005)

    for number in range(60):
        a_frame([(1, 0.0, 0.0, (2.0, 14.0, 5.0)[number // 20])])
    for _ in range(60):
        a_frame([])
    assert sounds.voices == 0
    sounds.close()
    wave = played(file)[:, 0]
    assert np.abs(wave).max() > 500
    inside = max(np.abs(np.diff(loop.astype(int))).max() for loop in make_bank().loops)
    assert np.abs(np.diff(wave)).max() <= inside


def test_bars_follow_one_another_to_the_sample_in_the_real_mixer(disk):
    sounds, file = disk
    sounds.begin_game(_classic())
    seen = set()

    def has_played_two() -> bool:
        place = sounds._music._playing
        seen.add(None if place is None else place.number)
        return 2 in seen

    follow(sounds, playing(), has_played_two)
    time.sleep(0.2)
    sounds.close()
    heard = played(file)
    band = band_of(_classic(), SOUND_SETS["neon"])
    places = [Place(number, Mood(PLAYING)) for number in range(2)]
    bars = np.concatenate([band.bar(places[0]), band.bar(places[1], places[0])]).astype(int)
    begin = int(np.flatnonzero(np.abs(heard).max(axis=1) > 2)[0])
    shifts = range(max(begin - 200, 0), begin + 50)
    at = min(shifts, key=lambda shift: np.abs(heard[shift : shift + RATE // 4] - bars[: RATE // 4]).sum())
    # From within the first bar over its end into the second one; the mixer cuts fractions off.
    assert np.abs(heard[at : at + len(bars)] - bars).max() <= 2


def test_volume_zero_writes_silence(disk):
    sounds, file = disk
    sounds.apply_settings(Settings(volume=0))
    sounds.play_events([hit()], TICKS, WIDTH)
    sounds.set_rolling([(1, 0.0, 0.0, 10.0)], 0.1, WIDTH)
    time.sleep(0.2)
    sounds.close()
    assert len(played(file)) > 0
    assert not played(file).any()


def test_a_program_that_ends_without_closing_ends_well():
    script = """
        from silverball.app.settings import Settings
        from silverball.app.sound import Sounds
        sounds = Sounds(Settings())
        sounds.open()
        print("open", sounds.warning)
    """
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(script)],
        env={**os.environ, "SDL_AUDIODRIVER": "dummy"},
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert "open" in done.stdout


def test_sounds_do_not_wait_for_the_physics():
    script = "import sys, silverball.app.sound; print('numba' in sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, timeout=PATIENCE, check=True
    )
    assert done.stdout.strip() == "False"


def test_a_device_that_goes_away_in_the_middle_ends_the_sounds_and_nothing_else(dummy):
    dummy.set_rolling([(1, 0.0, 0.0, 10.0)], 0.1, WIDTH)
    pygame.mixer.quit()
    dummy.play_events([hit()], TICKS, WIDTH)
    assert dummy.warning.startswith("no sound: the audio device has disappeared (")
    use_all(dummy)


def test_a_mixer_that_was_open_with_another_rate_is_opened_anew(monkeypatch):
    monkeypatch.setenv("SDL_AUDIODRIVER", "dummy")
    pygame.mixer.init(22050, -16, 1)
    sounds = Sounds(LOUD)
    sounds.open()
    assert pygame.mixer.get_init() == (RATE, -16, 2)
    sounds.close()
