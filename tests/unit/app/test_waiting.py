"""The first start: a bar with the time, in the menus and instead of an empty display."""

from __future__ import annotations

import time

import numpy as np
import pytest

from reading import reads
from silverball.app import startup
from silverball.app.dot_game import DotGame
from silverball.app.startup import LINE_Y, MIN_SHARE, Progress, draw_line, draw_page
from silverball.drawing.dotmatrix.canvas import FULL, WIDTH, Dots
from silverball.physics import kernel
from silverball.table import load_table


def lit(dots: Dots, y: int) -> int:
    """Bright dots of a row."""
    return int((dots.pixels[y] == FULL).sum())


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9, 1.0])
def test_the_bar_is_as_long_as_the_share_that_is_compiled(share):
    page = draw_page(3.0, Progress(8.0, share), DotGame())
    menu = Dots()
    draw_line(menu, Progress(8.0, share))
    for dots in (page, menu):
        assert lit(dots, LINE_Y) == pytest.approx(share * WIDTH, abs=1)


def test_the_time_so_far_and_in_all_is_always_there():
    for seconds in np.arange(0.0, 20.0, 0.7):
        progress = Progress(seconds, 0.25)
        assert progress.text == f"{seconds:.0f}/{max(seconds / 0.25, seconds + 1.0):.0f} S"
        assert reads(draw_page(seconds, progress, DotGame()), progress.text)
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
    pages = [draw_page(seconds, None, DotGame()) for seconds in (0.0, 0.5)]
    assert reads(pages[0], "GETTING READY")
    assert (pages[0].pixels != pages[1].pixels).any()


class Elsewhere:
    """Compiles nothing, at once."""

    def __init__(self, *command) -> None:
        self.start = self.close = lambda: None

    def finish(self, stop, most_seconds) -> bool:
        return True


def test_the_share_grows_as_kernels_are_compiled_and_nothing_is_said_of_what_is_only_loaded(monkeypatch):
    table = load_table("classic")
    monkeypatch.setattr(startup, "is_compiled_on_disk", lambda layout: True)
    starting = startup.Startup(table)
    starting.wait()
    assert starting.is_done
    assert starting.progress is None
    monkeypatch.setattr(startup, "is_compiled_on_disk", lambda layout: False)
    monkeypatch.setattr(startup, "Compiler", Elsewhere)
    monkeypatch.setattr(kernel, "evict_old_code", lambda: None)
    monkeypatch.setattr(startup, "warm_up", lambda _: time.sleep(0.2))
    compiling = startup.Startup(table)
    compiling.wait()
    assert compiling.progress.seconds >= 0.2
    assert compiling.progress.share == 0.0, "nothing has been compiled since"

    def nothing(number):
        return number

    before = kernel.compiled_share(kernel.PLAY)
    made = kernel.kernel(nothing)
    assert kernel.compiled_share(kernel.PLAY) < before
    made(1)
    assert kernel.compiled_share(kernel.PLAY) > before - 1e-12
    kernel._kernels.remove(made)
