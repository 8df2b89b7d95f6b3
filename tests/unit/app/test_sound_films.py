"""The sound of a film: every hit at its sample, in its ear, and the same every time."""

from __future__ import annotations

import wave

import numpy as np
import pytest

import silverball as sb
from silverball.app.sound import FilmSound, Frame, RollingBall, mixdown, write_wav
from silverball.app.sound.mixdown import Soundtrack
from silverball.app.sound.synth import RATE
from silverball.export.film import write_film
from silverball.game.view import GameEvent, GameEventKind
from silverball.table import load_table
from silverball.world.events import Event

TABLE = load_table("classic")
TICKS = 240


def hit(part: str, tick: int, *, z: float = 0.0, speed: float = 20.0, offset: float = 0.0) -> Event:
    return Event("hit", part, 1, tick, offset, (0.0, 1.0, z), (1.0, 0.0, 0.0), speed)


def frames(count: int, changes: dict[int, dict]) -> list[Frame]:
    """Frames of 1/60 s, of which some are told what happens in them."""
    return [Frame((number + 1) / 60, (number + 1) / 60, **changes.get(number, {})) for number in range(count)]


def mix(seconds: float, changes: dict[int, dict]) -> np.ndarray:
    return mixdown(frames(round(60 * seconds), changes), seconds, TABLE, TICKS).astype(float)


def onset(samples: np.ndarray) -> float:
    """When something is first heard [s]."""
    return int(np.flatnonzero(np.abs(samples).max(axis=1) > 0.0)[0]) / RATE


def test_silence_is_silence_of_the_right_length():
    samples = mix(0.5, {})
    assert samples.shape == (RATE // 2, 2)
    assert not samples.any()


@pytest.mark.parametrize(("tick", "offset"), [(20, 0.0), (41, 0.003), (79, 0.0011)])
def test_a_hit_is_heard_at_its_exact_time_and_not_at_the_frame(tick, offset):
    time = tick / TICKS + offset
    samples = mix(1.0, {int(time * 60): {"events": (hit("cylinder[0]", tick, offset=offset),)}})
    assert onset(samples) == pytest.approx(time, abs=0.0005)  # a wave's first samples are zero


def test_a_film_in_slow_motion_keeps_a_hit_within_its_picture():
    slow = [
        Frame(
            (number + 1) / 60,
            (number + 1) / 240,
            (hit("board.left", 10, offset=0.002),) if number == 10 else (),
        )
        for number in range(60)
    ]
    time = onset(mixdown(slow, 1.0, TABLE, TICKS).astype(float))
    assert 10 / 60 <= time <= 11 / 60 + 0.001


def test_a_hit_on_the_left_is_heard_on_the_left():
    samples = mix(0.5, {5: {"events": (hit("board.left", 20, z=-4.75),)}})
    left, right = (samples**2).sum(axis=0)
    assert left > 10.0 * right > 0.0


def test_a_harder_hit_is_louder():
    soft, hard = (mix(0.5, {5: {"events": (hit("board.top", 20, speed=speed),)}}) for speed in (1.0, 4.0))
    ratio = np.abs(hard).max() / np.abs(soft).max()
    assert ratio == pytest.approx(4.0**0.7, rel=0.15)  # the same layer, but not the same variation


def test_the_paddles_news_and_menus_are_heard():
    for change in (
        {"buttons": (True, False)},
        {"game_events": (GameEvent(GameEventKind.TILT, 0),)},
        {"menu": "choose"},
    ):
        assert mix(0.5, {3: change}).any()


def test_a_paddle_is_heard_again_at_its_stop():
    down = {number: {"buttons": (True, False)} for number in range(10, 30)}
    samples = np.abs(mix(0.5, down)).max(axis=1)
    stop = round((10 / 60 + TABLE.paddle[0].stroke) * RATE)
    quiet, loud = samples[stop - 480 : stop].max(), samples[stop : stop + 480].max()
    assert loud > 3.0 * quiet


def test_rolling_has_no_click_where_frames_meet():
    ball = {
        number: {"balls": (RollingBall(1, 0.0, np.sin(number / 10.0), 3.0 + 10.0 * (number > 30)),)}
        for number in range(10, 80)
    }
    samples = mix(2.5, ball)
    assert np.abs(samples).max() > 300
    curves = np.abs(np.diff(samples[:, 0], 2))
    seams = np.array([round(number * RATE / 60) for number in range(11, 81)])
    around = np.concatenate([seams + shift for shift in (-2, -1, 0)])
    near = curves[around]
    assert near.max() <= np.delete(curves, around).max()
    assert near.mean() < 1.3 * curves[seams[0] : seams[-1]].mean()
    assert onset(samples) == pytest.approx(10 / 60, abs=0.01)
    assert not samples[-RATE // 4 :].any()


def game(seconds: float) -> np.ndarray:
    """A real game with two balls and restless paddles."""
    world = sb.World(sb.generate_table(seed=7), seed=7)
    film = FilmSound(world.table, world.tick_rate, 60)
    for number in range(round(60 * seconds)):
        events = []
        buttons = (number % 40 < 15, number % 50 < 20)
        if len(world.balls) < 2:
            world.create_ball()
            events += world.events[-1:]
        world.step(*buttons, ticks=4)
        film.add_picture(world, [*events, *world.events], buttons)
    track = film.track()
    assert track.rate == RATE
    assert len(track.samples) == round(seconds * RATE)
    return track.samples


def test_the_same_game_has_the_same_sound_twice():
    one, other = game(4.0), game(4.0)
    assert one.dtype == np.int16
    assert np.array_equal(one, other)
    assert np.abs(one).max() > 2000


def test_a_game_is_not_clipped_and_ends_at_zero():
    samples = game(6.0)
    assert np.abs(samples.astype(int)).max() < 32767
    assert np.abs(samples[-1]).max() <= 1


def test_a_wav_file_holds_the_samples(tmp_path):
    samples = game(1.0)
    write_wav(tmp_path / "out.wav", samples)
    with wave.open(str(tmp_path / "out.wav")) as file:
        assert (file.getnchannels(), file.getsampwidth(), file.getframerate()) == (2, 2, RATE)
        assert np.array_equal(np.frombuffer(file.readframes(RATE), "<i2").reshape(-1, 2), samples)


# --- in an MP4 ------------------------------------------------------------------------------------------


def pictures(count: int) -> list[np.ndarray]:
    return [np.full((64, 48, 3), number, np.uint8) for number in range(count)]


def decoded(path) -> np.ndarray:
    """The sound of a film as players hear it, float [sample, 2]."""
    with pytest.importorskip("av").open(path) as film:
        pieces = [frame.to_ndarray() for frame in film.decode(audio=0)]
    return (np.concatenate(pieces, axis=1).T * 32768.0).astype(float)


def test_an_mp4_carries_the_sound(tmp_path):
    pytest.importorskip("av")
    samples = mixdown(frames(60, {30: {"events": (hit("cylinder[0]", 120, z=-4.0),)}}), 1.0, TABLE, TICKS)
    write_film(tmp_path / "out.mp4", pictures(60), lambda: Soundtrack(samples, RATE))
    heard = decoded(tmp_path / "out.mp4")
    # Packing blurs: the hit at 0.5 s stands out of what little is before it, on the left.
    left, right = (heard**2).sum(axis=0)
    assert left > 4.0 * right
    power = (heard**2).sum(axis=1)
    assert power[: int(0.49 * RATE)].sum() < 1e-3 * power.sum()
    assert len(heard) / RATE == pytest.approx(1.0, abs=0.05)
    assert [path.name for path in tmp_path.iterdir()] == ["out.mp4"]


def test_sound_and_pictures_are_in_step_to_the_sample(tmp_path):
    pytest.importorskip("av")
    start = RATE // 2
    samples = np.zeros((RATE, 2), np.int16)
    time = np.arange(RATE - start) / RATE
    samples[start:] = (12_000 * np.sin(2 * np.pi * (300 + 2000 * time) * time))[:, None]  # a rising tone
    write_film(tmp_path / "out.mp4", pictures(60), lambda: Soundtrack(samples, RATE))
    heard, played = decoded(tmp_path / "out.mp4")[:RATE, 0], samples[:, 0].astype(float)
    # The shift at which the decoded wave fits best; the encoder puts 1024 samples before the first one.
    match = {shift: float((np.roll(heard, -shift) * played).sum()) for shift in range(-1100, 1101)}
    assert max(match, key=match.__getitem__) == 0


def test_the_sound_is_asked_for_after_the_last_picture(tmp_path):
    pytest.importorskip("av")
    order = []

    def drawn():
        for number, picture in enumerate(pictures(10)):
            order.append(number)
            yield picture

    def sound() -> Soundtrack:
        order.append("sound")
        return Soundtrack(mix(10 / 60, {}).astype(np.int16), RATE)

    write_film(tmp_path / "out.mp4", drawn(), sound)
    assert order == [*range(10), "sound"]


def test_a_sound_that_cannot_be_made_leaves_no_film(tmp_path):
    pytest.importorskip("av")

    def fail() -> Soundtrack:
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        write_film(tmp_path / "out.mp4", pictures(10), fail)
    assert not list(tmp_path.iterdir())


def test_a_film_without_sound_has_no_sound_track(tmp_path):
    pytest.importorskip("av")
    write_film(tmp_path / "out.mp4", pictures(10))
    assert b"soun" not in (tmp_path / "out.mp4").read_bytes()  # the handler of ISO/IEC 14496-12, 8.4.3
