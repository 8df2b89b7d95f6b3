"""In the background: a picture at once, the best one soon, and nothing left behind."""

from __future__ import annotations

import subprocess
import threading
import time

import numpy as np
import pytest

from patience import PATIENCE
from silverball.drawing import Moment, Renderer, background as background_module, warm_up
from silverball.drawing.picture_cache import PictureCache
from silverball.table import load_table

TABLE = load_table("classic")
SIZE = (90, 144)
START = Moment.before(TABLE)


@pytest.fixture(scope="module", autouse=True)
def _compiled():
    warm_up.compile_all()


@pytest.fixture(autouse=True)
def _no_compiler(monkeypatch):
    """Each test has a compiler of its own."""
    monkeypatch.setattr(
        background_module, "_compiler", background_module.Compiler("silverball.drawing.warm_up")
    )


def made_sharp(renderer):
    limit = time.monotonic() + PATIENCE
    while not renderer.is_sharp and time.monotonic() < limit:
        time.sleep(0.01)
    return renderer.is_sharp


def test_there_is_a_picture_at_once_and_it_becomes_the_best_one(tmp_path):
    renderer = Renderer(TABLE, SIZE, background=True, cache=PictureCache(tmp_path))
    rough = renderer.array(START).copy()
    assert made_sharp(renderer)
    renderer.wait(PATIENCE)
    assert renderer._background.error is None
    best = Renderer(TABLE, SIZE, cache=PictureCache(tmp_path / "other")).array(START)
    assert (renderer.array(START) == best).all()
    assert (rough != best).any()
    assert np.corrcoef(rough[40:].ravel(), best[40:].ravel())[0, 1] > 0.5  # of the same thing
    renderer.close()


def test_a_board_that_was_seen_before_is_shown_from_the_store_at_once(tmp_path):
    Renderer(TABLE, SIZE, cache=PictureCache(tmp_path)).close()
    best = Renderer(TABLE.model_copy(update={"paddle": ()}), SIZE, cache=PictureCache(tmp_path)).array(START)
    renderer = Renderer(TABLE, SIZE, background=True, cache=PictureCache(tmp_path))
    first = renderer.array(START)
    renderer.close()
    assert (first[40:100] == best[40:100]).all()  # above the paddles, whose sprites come later


def test_paddles_turn_while_their_pictures_are_still_baked(tmp_path, monkeypatch):
    gate = threading.Event()
    bake = provider_class().bake_sprites
    monkeypatch.setattr(provider_class(), "bake_sprites", lambda self: (gate.wait(), bake(self)))
    renderer = Renderer(TABLE, SIZE, background=True, cache=PictureCache(tmp_path))
    assert made_sharp(renderer)
    down, up = (renderer.array(START._replace(angles=(angle, angle))) for angle in (-10.0, 45.0))
    assert (down != up).any()
    gate.set()
    renderer.close()


def provider_class():
    from silverball.drawing.picture_provider import PictureProvider

    return PictureProvider


def test_a_fault_in_the_background_leaves_the_sketch(tmp_path, monkeypatch):
    def fault(self):
        raise ValueError("a fault")

    monkeypatch.setattr(provider_class(), "table", fault)
    renderer = Renderer(TABLE, SIZE, background=True, cache=PictureCache(tmp_path))
    renderer.wait(PATIENCE)
    assert not renderer.is_sharp
    assert isinstance(renderer._background.error, ValueError)
    assert renderer.array(START).std() > 10


def test_closing_ends_the_work_soon(tmp_path):
    renderer = Renderer(TABLE, (720, 1152), background=True, cache=PictureCache(tmp_path))
    time.sleep(0.3)
    renderer.close()
    renderer.wait(PATIENCE)
    assert renderer._background.is_done


def test_code_that_is_not_there_is_compiled_in_another_process(tmp_path, monkeypatch):
    started = []

    class Process:
        returncode = 0

        def __init__(self, command, **_):
            started.append(command)

        def poll(self):
            return 0

    answers = iter([False, True])
    monkeypatch.setattr(background_module, "is_compiled", lambda: next(answers))
    monkeypatch.setattr(subprocess, "Popen", Process)
    renderer = Renderer(TABLE, SIZE, background=True, cache=PictureCache(tmp_path))
    assert made_sharp(renderer)
    assert started[0][1:] == ["-m", "silverball.drawing.warm_up"]
    renderer.close()


@pytest.mark.parametrize("fault", ["no process", "a failure", "too slow"])
def test_the_sketch_stays_if_nothing_can_be_compiled(tmp_path, monkeypatch, fault):
    killed = []

    class Process:
        returncode = 1

        def __init__(self, *_, **__):
            if fault == "no process":
                raise OSError

        def poll(self):
            return None if fault == "too slow" and not killed else 1

        def kill(self):
            killed.append(1)

        def wait(self):
            return 1

    monkeypatch.setattr(background_module, "is_compiled", lambda: False)
    monkeypatch.setattr(background_module, "COMPILE_SECONDS", 0.3)
    monkeypatch.setattr(subprocess, "Popen", Process)
    renderer = Renderer(TABLE, SIZE, background=True, cache=PictureCache(tmp_path))
    renderer.wait(PATIENCE)
    assert renderer._background.is_done
    assert bool(killed) == (fault == "too slow")
    assert not renderer.is_sharp
    assert renderer.array(START).std() > 10


def test_one_compiler_serves_all_renderers_and_is_killed_at_the_end(tmp_path, monkeypatch):
    processes = []
    popen = subprocess.Popen

    def start(command, **options):
        processes.append(popen([command[0], "-c", "import time; time.sleep(600)"], **options))
        return processes[-1]

    monkeypatch.setattr(background_module, "is_compiled", lambda: False)
    monkeypatch.setattr(subprocess, "Popen", start)
    first = Renderer(TABLE, SIZE, background=True, cache=PictureCache(tmp_path))
    limit = time.monotonic() + PATIENCE
    while not processes and time.monotonic() < limit:
        time.sleep(0.01)
    first.close()
    first.wait(PATIENCE)
    assert processes[0].poll() is None  # the next picture needs it too
    second = Renderer(TABLE, SIZE, background=True, cache=PictureCache(tmp_path))
    time.sleep(0.3)
    assert len(processes) == 1
    background_module._compiler.kill()  # as at the program's end
    assert processes[0].wait(PATIENCE) != 0
    second.close()
    second.wait(PATIENCE)
