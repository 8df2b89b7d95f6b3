"""Files of pictures: whole on the disk, or an error and nothing."""

from __future__ import annotations

import stat
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from silverball.errors import OutputError
from silverball.export.film import write_film, write_picture
from silverball.export.mp4 import is_whole_mp4

PICTURES = [np.random.default_rng(seed).integers(0, 256, (120, 80, 3), np.uint8) for seed in range(5)]
ENDINGS = ["png", "gif", "mp4"]


def write(path: Path) -> None:
    if path.suffix == ".mp4":
        pytest.importorskip("imageio_ffmpeg")
    if path.suffix == ".png":
        write_picture(path, PICTURES[0])
    else:
        write_film(path, PICTURES)


@contextmanager
def full_disk():
    """No file of this process or of its children can grow beyond 4 kB; not even one that pytest prints to."""
    resource = pytest.importorskip("resource")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.fixture
def ffmpeg(tmp_path, monkeypatch):
    """Puts a script in the place of ffmpeg; its last argument is the film."""
    imageio_ffmpeg = pytest.importorskip("imageio_ffmpeg")

    def become(script: str) -> None:
        program = tmp_path / "ffmpeg.sh"
        program.write_text(f"#!/bin/sh\nfor film; do :; done\n{script}\n", encoding="utf-8")
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        monkeypatch.setattr(imageio_ffmpeg, "get_ffmpeg_exe", lambda: str(program))

    return become


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


@pytest.mark.parametrize("error", [KeyboardInterrupt, SystemExit, ZeroDivisionError])
@pytest.mark.parametrize("ending", ["gif", "mp4"])
def test_whatever_stops_a_film_leaves_no_file(tmp_path, ending, error):
    if ending == "mp4":
        pytest.importorskip("imageio_ffmpeg")

    def pictures():
        for _ in range(60):
            yield PICTURES[0]
        raise error

    with pytest.raises(error):
        write_film(tmp_path / f"out.{ending}", pictures())
    assert not list(tmp_path.iterdir())


def test_a_failing_ffmpeg_is_an_error_in_its_own_words(tmp_path, ffmpeg):
    ffmpeg('head -c 1000 >/dev/null; echo "[out#0/mp4 @ 0x55] Error: the moon is full" >&2; exit 1')
    with pytest.raises(OutputError, match="the film: Error: the moon is full"):
        write(tmp_path / "out.mp4")
    assert [path.name for path in tmp_path.iterdir()] == ["ffmpeg.sh"]


def test_an_ffmpeg_that_complains_at_length_does_not_hang(tmp_path, ffmpeg):
    ffmpeg('yes "no, no, no" | head -n 90000 >&2; cat >/dev/null; exit 1')
    with pytest.raises(OutputError, match="no, no"):
        write(tmp_path / "out.mp4")


def test_half_a_film_is_an_error_though_ffmpeg_ends_well(tmp_path, ffmpeg):
    write(tmp_path / "good.mp4")
    good = (tmp_path / "good.mp4").read_bytes()
    assert is_whole_mp4(tmp_path / "good.mp4")
    for size in (0, 5, len(good) // 3, len(good) - 1):
        (tmp_path / "half").write_bytes(good[:size])
        ffmpeg(f'cat >/dev/null; cp {tmp_path / "half"} "$film"')
        with pytest.raises(OutputError, match="could not finish"):
            write(tmp_path / "out.mp4")


@pytest.mark.parametrize("ending", ENDINGS)
def test_a_file_has_the_usual_permissions(tmp_path, ending):
    (tmp_path / "usual").touch()
    write(tmp_path / f"out.{ending}")
    assert (tmp_path / f"out.{ending}").stat().st_mode == (tmp_path / "usual").stat().st_mode


def test_a_png_holds_the_picture(tmp_path):
    write_picture(tmp_path / "out.png", PICTURES[0])
    with Image.open(tmp_path / "out.png") as image:
        assert (np.asarray(image) == PICTURES[0]).all()
