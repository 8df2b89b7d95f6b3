"""The first start: a bar with the time, in the menus and instead of an empty display."""

from __future__ import annotations

import time

import numpy as np
import pytest

from reading import reads
from silverball.app import startup
from silverball.app.menus.page_layout import MIDDLE_Y
from silverball.app.startup import LINE_Y, MIN_SHARE, Progress, draw_line, draw_page
from silverball.drawing.dotmatrix.canvas import FULL, WIDTH, Dots
from silverball.physics import kernel
from silverball.table import load_table


def lit(dots: Dots, y: int) -> int:
    """Bright dots of a row."""
    return int((dots.pixels[y] == FULL).sum())


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9, 1.0])
def test_the_bar_is_as_long_as_the_share_that_is_compiled(share):
    page = draw_page(3.0, Progress(8.0, share))
    assert lit(page, MIDDLE_Y + 4) == pytest.approx(share * WIDTH, abs=3)
    menu = Dots()
    draw_line(menu, Progress(8.0, share))
    assert lit(menu, LINE_Y) == pytest.approx(share * WIDTH, abs=1)


def test_the_time_so_far_and_in_all_is_always_there():
    for seconds in np.arange(0.0, 20.0, 0.7):
        progress = Progress(seconds, 0.25)
        assert progress.text == f"{seconds:.0f}/{max(seconds / 0.25, seconds + 1.0):.0f} S"
        assert reads(draw_page(seconds, progress), progress.text)
        menu = Dots()
        draw_line(menu, progress)
        assert reads(menu, f"COMPILING {progress.text}")


def test_nobody_is_told_a_time_that_nobody_knows():
    assert Progress(4.0, MIN_SHARE / 2).text == "4 S"
    assert Progress(30.0, 1.0).text == "30/31 S"


def test_a_long_time_does_not_reach_into_the_marks_of_the_menu():
    menu = Dots()
    menu.box(WIDTH - 60, 0, 60, LINE_Y)
    before = menu.pixels[:LINE_Y, WIDTH - 60 :].copy()
    draw_line(menu, Progress(999.0, 0.3))
    assert (menu.pixels[:LINE_Y, WIDTH - 60 :] == before).all()
    assert reads(menu, "999/3330 S")


def test_while_all_is_only_loaded_something_moves():
    assert reads(draw_page(0.0, None), "GETTING READY")
    assert (draw_page(0.0, None).pixels != draw_page(0.5, None).pixels).any()


def test_the_share_grows_as_kernels_are_compiled_and_nothing_is_said_of_what_is_only_loaded(monkeypatch):
    table = load_table("classic")
    monkeypatch.setattr(kernel, "is_compiled", lambda: True)
    starting = startup.Startup(table)
    starting.wait()
    assert starting.is_done
    assert starting.progress is None
    monkeypatch.setattr(kernel, "is_compiled", lambda: False)
    monkeypatch.setattr(kernel, "evict_old_code", lambda: None)
    monkeypatch.setattr(startup, "warm_up", lambda _: time.sleep(0.2))
    compiling = startup.Startup(table)
    compiling.wait()
    assert compiling.progress.seconds >= 0.2
    assert 0.0 < compiling.progress.share <= 1.0

    def nothing(number):
        return number

    before = kernel.compiled_share(kernel.PLAY)
    made = kernel.kernel(nothing)
    assert kernel.compiled_share(kernel.PLAY) < before
    made(1)
    assert kernel.compiled_share(kernel.PLAY) > before - 1e-12
    kernel._kernels.remove(made)
