"""The picture cache: what comes out is what went in, and faults of a disk cost time only."""

from __future__ import annotations

import io
import os
import sys

import numpy as np
import pytest

from silverball.drawing import (
    Moment,
    Renderer,
    picture_cache as cache_module,
    picture_provider as provider_module,
)
from silverball.drawing.picture_cache import ENDING, PictureCache, key_of
from silverball.table import generate_table, load_table

TABLE = load_table("classic")
SIZE = (120, 192)
MOMENT = Moment.before(TABLE)._replace(angles=(12.0, 40.0))


def arrays(number: int, size: int = 10) -> dict[str, np.ndarray]:
    return {"values": np.full(size, number, np.uint8)}


@pytest.fixture
def baked(monkeypatch):
    """How many still tables have been baked."""
    count = []
    bake = provider_module.bake_table
    monkeypatch.setattr(provider_module, "bake_table", lambda *a, **k: (count.append(1), bake(*a, **k))[1])
    return count


def picture(folder, table=TABLE, **options):
    renderer = Renderer(table, SIZE, cache=PictureCache(folder), **options)
    array = renderer.array(MOMENT)
    renderer.close()
    return array


def test_a_picture_from_the_store_has_the_bytes_of_the_baked_one(tmp_path, baked):
    first = picture(tmp_path)
    assert len(baked) == 1
    assert (picture(tmp_path) == first).all()
    assert len(baked) == 1


def test_another_board_size_or_theme_is_another_picture(tmp_path, baked):
    picture(tmp_path)
    picture(tmp_path, generate_table(1))
    picture(tmp_path, theme="clear")
    assert len(baked) == 3
    assert key_of(1, "a") != key_of(1, "b")


def test_a_change_of_the_drawings_sources_makes_all_pictures_anew(monkeypatch):
    before = key_of("table")
    cache_module._sources.cache_clear()
    monkeypatch.setattr(cache_module.np, "__version__", "another")
    assert key_of("table") != before
    cache_module._sources.cache_clear()


@pytest.mark.parametrize("damage", ["cut", "flipped", "empty", "text", "array", "others", "folder", "pipe"])
def test_a_damaged_picture_is_baked_anew(tmp_path, baked, damage):
    first = picture(tmp_path)
    for path in tmp_path.glob("*" + ENDING):
        content = bytearray(path.read_bytes())
        if damage == "flipped":
            content[len(content) // 2] ^= 0xFF
        changed = {"cut": content[: len(content) // 2], "empty": b"", "text": b"no picture"}
        if damage in ("array", "others"):
            content = io.BytesIO()
            np.savez(content, a=np.zeros(3))
            changed[damage] = content.getvalue()
            if damage == "others":  # a whole file, but that of another picture
                PictureCache(tmp_path / "other").save("other", arrays(1))
                changed[damage] = (tmp_path / "other" / f"other{ENDING}").read_bytes()
        path.unlink()
        if damage == "folder":
            (path / "deep").mkdir(parents=True)
        elif damage == "pipe":
            os.mkfifo(path) if hasattr(os, "mkfifo") else None
        else:
            path.write_bytes(bytes(changed.get(damage, content)))
    assert (picture(tmp_path) == first).all()
    assert len(baked) == 2
    assert (picture(tmp_path) == first).all()  # the new ones are whole
    assert len(baked) == 2


def test_a_picture_without_what_belongs_to_it_is_no_picture(tmp_path, baked):
    picture(tmp_path)
    for path in tmp_path.glob("*" + ENDING):
        PictureCache(tmp_path).save(path.stem, arrays(1))
    picture(tmp_path)
    assert len(baked) == 2


def test_the_oldest_pictures_go_when_there_are_too_many(tmp_path):
    store = PictureCache(tmp_path, limit=3900)
    for number in range(4):
        store.save(f"p{number}", arrays(number, 1000))
        os.utime(tmp_path / f"p{number}{ENDING}", (number, number))
    store.load("p1")  # looked at just now
    store.save("p4", arrays(4, 1000))
    left = {path.stem for path in tmp_path.glob("*" + ENDING)}
    assert "p1" in left
    assert "p4" in left
    assert "p0" not in left
    assert sum(path.stat().st_size for path in tmp_path.glob("*" + ENDING)) <= 3900


def test_a_folder_that_cannot_be_made_costs_nothing_but_time(tmp_path):
    (tmp_path / "file").write_text("in the t")
    blocked = tmp_path / "file" / "pictures"
    store = PictureCache(blocked)
    store.save("p", arrays(1))
    assert store.load("p") is None
    assert picture(blocked).shape == (SIZE[1], SIZE[0], 3)


@pytest.mark.skipif(sys.platform == "win32" or os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_that_cannot_be_written_costs_nothing_but_time(tmp_path):
    tmp_path.chmod(0o500)
    try:
        assert picture(tmp_path).shape == (SIZE[1], SIZE[0], 3)
    finally:
        tmp_path.chmod(0o700)
