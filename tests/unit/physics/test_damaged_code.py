"""A file of compiled code that is not what was written is never loaded: the code is compiled again."""

from __future__ import annotations

import logging
import os
import pickle
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from patience import PATIENCE
from silverball.physics import code_cache as codecache, kernel


def tripled_and(number, more):
    return 3 * number + more


def squared(number):
    return number * number


def compiled(function: Callable[..., float], folder: Path) -> Callable[..., float]:
    """A kernel as it is in a process of its own, whose code lies in a folder."""
    dispatcher = kernel.kernel(function)
    dispatcher._cache = codecache.CodeCache(function, folder)
    return dispatcher


def hits(dispatcher) -> int:
    return sum(dispatcher.stats.cache_hits.values())


def flipped(content: bytes) -> bytes:
    middle = len(content) // 2
    return content[:middle] + bytes([content[middle] ^ 0x10]) + content[middle + 1 :]


class Evil:
    """What must never be unpickled."""

    def __reduce__(self):
        return (os._exit, (77,))


def as_folder(path: Path) -> None:
    path.unlink()
    path.mkdir()
    (path / "something").write_text("in it")


def as_pipe(path: Path) -> None:
    path.unlink()
    os.mkfifo(path)


def as_link_to_nothing(path: Path) -> None:
    path.unlink()
    path.symlink_to("nowhere")


DAMAGE: dict[str, Callable[[Path], object]] = {
    "empty": lambda path: path.write_bytes(b""),
    "one byte": lambda path: path.write_bytes(path.read_bytes()[:1]),
    "cut short": lambda path: path.write_bytes(path.read_bytes()[: path.stat().st_size // 2]),
    "longer": lambda path: path.write_bytes(path.read_bytes() + b"\0"),
    "a bit flipped": lambda path: path.write_bytes(flipped(path.read_bytes())),
    "zeros": lambda path: path.write_bytes(bytes(path.stat().st_size)),
    "another pickle": lambda path: path.write_bytes(pickle.dumps({"never": "asked for"})),
    "an evil pickle": lambda path: path.write_bytes(pickle.dumps(Evil())),
    "text": lambda path: path.write_text("é" * 32, encoding="utf-8"),
    "a folder": as_folder,
    "a pipe": as_pipe,
    "a link to nothing": as_link_to_nothing,
    "missing": lambda path: path.unlink(),
}
if os.name != "posix":
    del DAMAGE["a pipe"], DAMAGE["a link to nothing"]


@pytest.fixture
def said(caplog, monkeypatch):
    """The warnings of a process that begins now."""
    monkeypatch.setattr(codecache.Damage, "message", "")
    caplog.set_level(logging.WARNING, "silverball")
    return lambda: [record.getMessage() for record in caplog.records if record.name == "silverball"]


@pytest.mark.parametrize("ending", [codecache.INDEX, codecache.CODE])
@pytest.mark.parametrize("how", DAMAGE)
def test_a_damaged_file_costs_a_compilation_and_one_sentence(tmp_path, said, how, ending):
    assert compiled(tripled_and, tmp_path)(2, 1) == 7
    assert compiled(tripled_and, tmp_path)(2.0, 1) == 7.0
    for path in list(tmp_path.rglob(f"*{ending}")):
        DAMAGE[how](path)
    again = compiled(tripled_and, tmp_path)
    assert (again(2, 1), again(2.0, 1)) == (7, 7.0)
    assert hits(again) == 0
    missing_index = how == "missing" and ending == codecache.INDEX  # then nothing was ever kept
    assert len(said()) == (0 if missing_index else 1)
    assert all(str(tmp_path) in one for one in said())
    mended = compiled(tripled_and, tmp_path)
    assert (mended(2, 1), mended(2.0, 1)) == (7, 7.0)
    assert hits(mended) == 2, "it was not kept whole"
    assert codecache.sweep(tmp_path)


def test_code_of_another_function_in_its_place_is_found_out(tmp_path, said):
    assert compiled(squared, tmp_path)(5) == 25
    other = {path.suffix: path.read_bytes() for path in tmp_path.rglob("*.nb?")}
    shutil.rmtree(tmp_path)
    assert compiled(tripled_and, tmp_path)(5, 0) == 15
    for path in list(tmp_path.rglob("*.nb?")):
        path.write_bytes(other[path.suffix])
        if path.suffix == codecache.INDEX:
            codecache.code_path(path, other[codecache.INDEX].decode()).write_bytes(other[codecache.CODE])
    assert compiled(tripled_and, tmp_path)(5, 0) == 15
    assert len(said()) == 1


@pytest.mark.parametrize("place", ["", "unit.physics", "compiled"])
def test_a_file_where_a_folder_is_expected_makes_room(tmp_path, place):
    """A function's folder, the folder of all code, and the one above, which others may use."""
    folder = tmp_path / "compiled" / "0123456789abcdef"
    module = compiled(squared, folder)._cache.cache_path
    blocked = {"": folder, "unit.physics": Path(module), "compiled": folder.parent}[place]
    blocked.parent.mkdir(parents=True, exist_ok=True)
    blocked.write_text("in the way")
    assert compiled(squared, folder)(3) == 9
    assert compiled(squared, folder)(3) == 9  # at worst compiled each time
    if place == "unit.physics":
        last = compiled(squared, folder)
        assert last(3) == 9
        assert hits(last) == 1


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """An empty folder of compiled code in place of the user's."""
    monkeypatch.setenv("SILVERBALL_CACHE", str(tmp_path))
    kernel.cache_folder.cache_clear()
    monkeypatch.setattr(kernel, "_swept", set())
    yield kernel.cache_folder()
    kernel.cache_folder.cache_clear()


def test_after_damage_a_start_waits_for_the_compilation_and_the_next_one_does_not(cache, said, monkeypatch):
    for function in (squared, tripled_and):
        compiled(function, cache)(*[4] * function.__code__.co_argcount)
    assert kernel.is_compiled("squared")
    for path in cache.rglob("*tripled_and*.nbc"):
        path.write_bytes(b"")
    assert kernel.is_compiled("squared"), "only checked at the start"
    monkeypatch.setattr(kernel, "_swept", set())
    assert not kernel.is_compiled("squared")
    assert len(said()) == 1
    assert not kernel.is_compiled("tripled_and")
    assert compiled(tripled_and, cache)(4, 1) == 13
    assert compiled(squared, cache)(4) == 16
    monkeypatch.setattr(kernel, "_swept", set())
    assert kernel.is_compiled("squared")
    assert kernel.is_compiled("tripled_and")
    assert len(said()) == 1


def test_a_file_in_the_place_of_the_folder_of_all_code_makes_room(tmp_path, monkeypatch, cache):
    shutil.rmtree(cache)
    cache.write_text("in the way")
    kernel.cache_folder.cache_clear()
    assert kernel.cache_folder() == cache
    assert cache.is_dir()


WRITER = """
import sys
from pathlib import Path
from silverball.physics import kernel
from silverball.physics import code_cache as codecache
from test_damaged_code import compiled, tripled_and
one = compiled(tripled_and, Path(sys.argv[1]))
print(one(2, 1), one(2.0, 1), one(1, 2.0))
"""


def test_processes_that_start_together_keep_one_whole_cache(tmp_path, said):
    here = Path(__file__).parent
    environment = os.environ | {"PYTHONPATH": f"{here}{os.pathsep}{here.parents[1]}"}
    started = [
        subprocess.Popen(
            [sys.executable, "-c", WRITER, str(tmp_path)],
            env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )
        for _ in range(4)
    ]  # fmt: skip
    for process in started:
        assert process.communicate(timeout=PATIENCE) == ("7 7.0 5.0\n", "")
    assert codecache.sweep(tmp_path)
    assert not list(tmp_path.rglob("*.tmp"))
    last = compiled(tripled_and, tmp_path)
    assert (last(2, 1), last(2.0, 1), last(1, 2.0)) == (7, 7.0, 5.0)
    assert hits(last) == 3
    assert said() == []


def test_code_that_another_process_clears_is_not_damaged(tmp_path, said, monkeypatch):
    read = codecache.read_file

    def cleared_before_the_code_is_read(path: Path) -> bytes | None:
        if path.suffix == codecache.CODE:
            for ending in (codecache.INDEX, codecache.CODE):
                for one in list(tmp_path.rglob(f"*{ending}")):
                    one.unlink()
        return read(path)

    assert compiled(squared, tmp_path)(3) == 9
    with monkeypatch.context() as patch:
        patch.setattr(codecache, "read_file", cleared_before_the_code_is_read)
        assert compiled(squared, tmp_path)(3) == 9
    assert list(tmp_path.rglob(f"*{codecache.CODE}")), "it was not compiled again"
    with monkeypatch.context() as patch:
        patch.setattr(codecache, "read_file", cleared_before_the_code_is_read)
        assert codecache.sweep(tmp_path)
    assert said() == []


def test_old_code_that_another_process_clears_is_no_error(cache, monkeypatch):
    monkeypatch.setattr(kernel.Path, "iterdir", lambda folder: iter([folder / "cleared"]))
    kernel.evict_old_code()
