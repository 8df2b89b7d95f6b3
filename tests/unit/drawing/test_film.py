"""Films and pictures in files: complete on the disk, or an error and no file."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from silverball.cli.shared_options import check_output
from silverball.errors import MissingExtra, OutputError
from silverball.export.film import FILM_RATES, write_film, write_picture

PICTURES = [np.random.default_rng(seed).integers(0, 256, (120, 80, 3), np.uint8) for seed in range(5)]
ENDINGS = ["png", "gif", "mp4"]


def write(path: Path) -> None:
    if path.suffix == ".mp4":
        pytest.importorskip("av")
    if path.suffix == ".png":
        write_picture(path, PICTURES[0])
    else:
        write_film(path, PICTURES)


@contextmanager
def full_disk():
    """No file of this process can grow beyond 4 kB; not even one that pytest prints to."""
    resource = pytest.importorskip("resource")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize("ending", ENDINGS)
def test_a_full_disk_is_an_error_and_what_was_there_stays(tmp_path, ending):
    path = tmp_path / f"out.{ending}"
    path.write_text("mine", encoding="utf-8")
    with full_disk(), pytest.raises(OutputError, match="cannot be written"):
        write(path)
    assert path.read_text(encoding="utf-8") == "mine"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("ending", ENDINGS)
def test_a_disk_that_tells_at_the_end_that_it_is_full_is_an_error(tmp_path, monkeypatch, ending):
    def refuse(_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", refuse)
    with pytest.raises(OutputError, match="No space left"):
        write(tmp_path / f"out.{ending}")
    assert not list(tmp_path.iterdir())


def test_an_error_of_the_encoder_is_an_error_of_the_file(tmp_path, monkeypatch):
    av = pytest.importorskip("av")

    def refuse(*_, **__):
        raise av.error.UndefinedError(1, "No such encoder")

    monkeypatch.setattr("av.open", refuse)
    with pytest.raises(OutputError, match="No such encoder"):
        write(tmp_path / "out.mp4")


@pytest.mark.parametrize("error", [KeyboardInterrupt, SystemExit, ZeroDivisionError])
@pytest.mark.parametrize("ending", ["gif", "mp4"])
def test_whatever_stops_a_film_leaves_no_file(tmp_path, ending, error):
    if ending == "mp4":
        pytest.importorskip("av")

    def pictures():
        for _ in range(60):
            yield PICTURES[0]
        raise error

    with pytest.raises(error):
        write_film(tmp_path / f"out.{ending}", pictures())
    assert not list(tmp_path.iterdir())


def test_an_mp4_without_pyav_names_the_extra_before_any_work(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "av", None)
    for attempt in (check_output, lambda path, _: write_film(path, PICTURES)):
        with pytest.raises(MissingExtra, match=r"pip install 'silverball\[video\]'"):
            attempt(tmp_path / "out.mp4", (".mp4",))
    assert not list(tmp_path.iterdir())


def test_an_mp4_plays_in_browsers_and_looks_like_its_pictures(tmp_path):
    av = pytest.importorskip("av")
    row, column = np.ogrid[:120, :80]
    pictures = [
        np.stack([row + column, 2 * row + 0 * column, 0 * row + 3 * column], axis=-1) + k for k in range(9)
    ]
    pictures = [picture.astype(np.uint8) for picture in pictures]
    write_film(tmp_path / "out.mp4", pictures)
    content = (tmp_path / "out.mp4").read_bytes()
    assert content.index(b"moov") < content.index(b"mdat")  # the index comes first
    with av.open(tmp_path / "out.mp4") as film:
        (video,) = film.streams
        assert (video.codec.name, video.pix_fmt, video.average_rate) == (
            "h264",
            "yuv420p",
            FILM_RATES[".mp4"],
        )
        frames = list(film.decode(video))
    assert [frame.time for frame in frames] == pytest.approx([number / 60 for number in range(9)])
    for frame, picture in zip(frames, pictures, strict=True):
        assert np.abs(frame.to_ndarray(format="rgb24").astype(int) - picture).mean() < 4.0


@pytest.mark.parametrize("ending", ENDINGS)
def test_a_file_has_the_usual_permissions(tmp_path, ending):
    (tmp_path / "usual").touch()
    write(tmp_path / f"out.{ending}")
    assert (tmp_path / f"out.{ending}").stat().st_mode == (tmp_path / "usual").stat().st_mode


def test_a_png_holds_the_picture(tmp_path):
    write_picture(tmp_path / "out.png", PICTURES[0])
    with Image.open(tmp_path / "out.png") as image:
        assert (np.asarray(image) == PICTURES[0]).all()
