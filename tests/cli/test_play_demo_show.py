"""play, demo and show through the real entry point, on a machine without a display."""

from __future__ import annotations

import os
import signal
import time

import numpy as np
import pytest
from PIL import Image

from commandline import started
from patience import PATIENCE

NO_DISPLAY = {
    **{key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")},
    "SDL_VIDEODRIVER": "dummy",
}


def assert_refused(result, *words):
    assert result.returncode == 2, result.stderr
    assert "Traceback" not in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1
    for word in words:
        assert word in result.stderr


@pytest.mark.parametrize("driver", ["dummy", "x11"])
def test_play_without_a_display_names_the_demo_in_one_sentence(silverball, driver):
    result = silverball("play", env=NO_DISPLAY | {"SDL_VIDEODRIVER": driver})
    assert_refused(result, "no display", "silverball demo")


def test_play_complains_of_the_table_before_the_display(silverball):
    result = silverball("play", "--table", "clasic", env=NO_DISPLAY)
    assert result.returncode == 2
    assert "classic" in result.stderr
    assert "no display" not in result.stderr


def test_play_complains_of_a_cabinet_that_it_does_not_know(silverball):
    result = silverball("play", "--cabinet", "sideways", env=NO_DISPLAY)
    assert result.returncode == 2
    for word in ("sideways", "upright", "left", "right"):
        assert word in result.stderr


def test_bare_silverball_without_a_display_makes_a_demo_and_overwrites_nothing(silverball, tmp_path):
    (tmp_path / "demo.gif").write_text("mine", encoding="utf-8")
    result = silverball(env=NO_DISPLAY, cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert "no display" in result.stderr
    assert "demo-2.gif" in result.stdout
    assert (tmp_path / "demo.gif").read_text(encoding="utf-8") == "mine"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["demo-2.gif", "demo.gif"]
    assert (tmp_path / "demo-2.gif").stat().st_size < 6_000_000
    with Image.open(tmp_path / "demo-2.gif") as film:
        assert film.n_frames * film.info["duration"] == pytest.approx(20_000, abs=2_000)


def test_a_gif_moves_and_lasts_as_long_as_asked(silverball, tmp_path):
    out = tmp_path / "short.gif"
    result = silverball(
        "demo", "--out", str(out), "--seconds", "2", "--size", "300", "--table", "random", "--seed", "5"
    )
    assert result.returncode == 0, result.stderr
    assert str(out) in result.stdout
    with Image.open(out) as film:
        pictures, milliseconds = [], 0
        for number in range(film.n_frames):
            film.seek(number)
            pictures.append(np.asarray(film.convert("RGB"), int))
            milliseconds += film.info["duration"]
    assert milliseconds == pytest.approx(2000, abs=40)
    assert pictures[0].shape[0] == 300
    assert (pictures[0] != pictures[-1]).any()


def test_a_png_shows_the_last_moment_and_is_the_same_every_time(silverball, tmp_path):
    names = [tmp_path / f"{letter}.png" for letter in "abc"]
    for name, options in zip(names, ((), ("--player", "planner"), ("--player", "reflex")), strict=True):
        result = silverball("demo", "--out", str(name), "--seconds", "9", "--size", "300", *options)
        assert result.returncode == 0, result.stderr
    assert names[0].read_bytes() == names[1].read_bytes()  # the planner plays unless another is asked for
    assert names[0].read_bytes() != names[2].read_bytes()
    assert names[0].read_bytes().startswith(b"\x89PNG")


def test_an_mp4_can_be_read_back(silverball, tmp_path):
    av = pytest.importorskip("av")
    out = tmp_path / "film.mp4"
    result = silverball("demo", "--out", str(out), "--seconds", "1", "--size", "240")
    assert result.returncode == 0, result.stderr
    with av.open(out) as film:
        video, sound = film.streams
        assert video.frames == 60
        for stream in (video, sound):
            assert float(stream.duration * stream.time_base) == pytest.approx(1.0, abs=0.05)


def test_show_draws_a_table(silverball, tmp_path):
    out = tmp_path / "table.png"
    result = silverball("show", "--out", str(out), "--table", "random", "--seed", "7", "--size", "500")
    assert result.returncode == 0, result.stderr
    with Image.open(out) as picture:
        assert picture.height == 500
        assert len(picture.convert("RGB").getcolors(1 << 24)) > 1000


@pytest.mark.parametrize(
    ("command", "name", "word"),
    [
        ("demo", "film.avi", ".avi"),
        ("demo", "film", "no ending"),
        ("demo", "nowhere/film.gif", "nowhere"),
        ("show", "table.gif", ".png"),
        ("show", "nowhere/table.png", "nowhere"),
        ("demo", "film.gif/", "folder"),
        ("show", "table.png/.", "folder"),
    ],
)
def test_a_file_that_cannot_be_written_is_refused_at_once(silverball, tmp_path, command, name, word):
    assert_refused(silverball(command, "--out", name, cwd=tmp_path), word)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("command", ["demo", "show"])
def test_a_file_that_exists_is_kept_unless_forced(silverball, tmp_path, command):
    out = tmp_path / "there.png"
    out.write_text("mine", encoding="utf-8")
    options = ["--out", str(out), "--size", "200", *(["--seconds", "0.2"] if command == "demo" else [])]
    assert_refused(silverball(command, *options), "--force")
    assert out.read_text(encoding="utf-8") == "mine"
    assert silverball(command, *options, "--force").returncode == 0
    assert out.read_bytes().startswith(b"\x89PNG")


def test_a_gif_too_large_to_make_is_refused(silverball, tmp_path):
    result = silverball("demo", "--out", "film.gif", "--seconds", "600", "--size", "2000", cwd=tmp_path)
    assert_refused(result, ".mp4")


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("ending", ["gif", "mp4"])
def test_an_interruption_leaves_no_half_file(tmp_path, ending, sent):
    options = ("--out", f"film.{ending}", "--seconds", "60", "--player", "reflex")
    process = started("demo", *options, cwd=tmp_path)
    limit = time.monotonic() + 300.0  # a first use compiles
    while not list(tmp_path.iterdir()) and time.monotonic() < limit:
        time.sleep(0.02)
    assert list(tmp_path.iterdir()), "the film was never begun"
    time.sleep(0.2)
    process.send_signal(sent)
    _, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode not in (0, 2)
    assert "Traceback" not in errors
    assert not list(tmp_path.iterdir())
