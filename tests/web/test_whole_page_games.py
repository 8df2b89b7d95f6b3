"""Whole arcade games in the page, from the first ball to the result: by keys, by touch, with a gamepad."""

from __future__ import annotations

import time

import pytest

from browser import DESKTOP, PHONE
from patience import PATIENCE
from silverball.game.replay.format import Replay
from silverball.game.replay.recording import BALL, LEFT, RIGHT
from web.conftest import write_game_page
from web.test_game_page import PAD, inputs_of

LONGEST = 600  # [s]
OVER, BALLS = "silverball.page.game.isOver", "silverball.stage.world.balls().length"
SHORT, LONG = 60, 120  # [ms]


class Keys:
    size, is_phone, setup = DESKTOP, False, ""

    def __init__(self, page) -> None:
        self.page = page

    def ball(self) -> None:
        self.page.keyboard.press("Space")

    def paddle(self, side: int) -> None:
        self.page.keyboard.press("ad"[side], delay=SHORT)


class Touches(Keys):
    size, is_phone = PHONE, True

    def ball(self) -> None:
        self.page.touchscreen.tap(self.size[0] / 2, 120)

    def paddle(self, side: int) -> None:
        self.page.touchscreen.tap(self.size[0] * (0.2 + 0.6 * side), 500)


class Gamepad(Keys):
    setup = PAD

    def ball(self) -> None:
        self.press(0)

    def paddle(self, side: int) -> None:
        self.press(4 + side)

    def press(self, button: int) -> None:
        for is_down in ("true", "false"):
            self.page.evaluate(f"pressPad({button}, {is_down})")
            self.page.wait_for_timeout(SHORT)


@pytest.mark.campaign
@pytest.mark.parametrize("device", [Keys, Touches, Gamepad])
def test_a_whole_arcade_game(browser, tmp_path, device):
    path = write_game_page(tmp_path / "classic.html", "classic")
    with browser.open(path, device.size, is_phone=device.is_phone, setup=device.setup) as page:
        hands, began, beat = device(page), time.monotonic(), 0
        while not page.evaluate(OVER):
            assert time.monotonic() - began < LONGEST
            if page.evaluate(BALLS) == 0:
                hands.ball()
            hands.paddle(beat % 2)
            page.wait_for_timeout(LONG)
            beat += 1
        page.wait_for_selector("#menu:not([hidden])", timeout=1000 * PATIENCE)
        replay = Replay.from_text(page.evaluate("silverball.page.game.toReplay()"))
        lines = page.locator(".lines p").all_inner_texts()
    assert replay.ended == "over"
    assert {BALL, LEFT, RIGHT} <= inputs_of(replay)
    assert lines[0] == f"{replay.score:,} points"
    assert len(lines) > 2
    verdict = replay.verify()
    assert verdict.ok, verdict.message
