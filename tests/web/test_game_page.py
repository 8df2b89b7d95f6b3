"""A game in the page: keys, touches and gamepads play it, and Python verifies what it saves."""

from __future__ import annotations

import subprocess
import sys

import pytest

from browser import PHONE, wait_until
from patience import PATIENCE
from silverball.game.replay.format import Replay
from silverball.game.replay.recording import BALL, LEFT, RIGHT, SHOVE, parse_inputs

SCORE, TICK = "silverball.page.game.score", "silverball.stage.world.tick"
BALLS = "silverball.stage.world.balls().length"
HELD = "silverball.page.game.held"
PLAY = """([seconds, seed, mode, players = 1]) => {
  const { page } = silverball;
  silverball.isStopped = true;
  page.mode = mode;
  const { game } = page;
  game.restart(players);
  let number = seed, held = 0;
  const random = () => (number = (number * 1103515245 + 12345) % 2147483648) / 2147483648;
  for (let tick = 0; tick < seconds * 240 && !game.isOver; tick++) {
    if (tick % 240 === 5) game.createBall();
    if (tick % 17 === 0) held = (random() < 0.5 ? 1 : 0) | (random() < 0.5 ? 2 : 0);
    if (tick % 300 === 0) held |= 8;
    if (random() < 0.003) game.nudge(["left", "right", "up"][tick % 3]);
    game.playTick(held | (tick % 300 < 200 ? 8 : 0));
  }
  return game.toReplay();
}"""
PLAYED = "(silverball.page.game.inputs + silverball.page.game.seconds.map((one) => one.inputs).join(''))"
PAD = """
const pad = { index: 0, axes: [0, 0, 0, 0], buttons: Array.from({ length: 17 }, () => ({ pressed: false })) };
navigator.getGamepads = () => [pad];
window.pressPad = (number, pressed) => { pad.buttons[number].pressed = pressed; };
window.movePad = (number, value) => { pad.axes[number] = value; };
"""


def inputs_of(replay: Replay) -> set[str]:
    texts = [*(line.partition(" ")[2] for line in replay.lines), replay.tail]
    return {one.kind for text in texts for one in parse_inputs(text)}


@pytest.mark.parametrize("mode", ["free", "arcade"])
@pytest.mark.parametrize("seconds", [0.3, 2, 20.7])
def test_python_verifies_a_saved_game(browser, game_file, seconds, mode):
    with browser.open(game_file) as page:
        replay = Replay.from_text(page.evaluate(PLAY, [seconds, 11, mode]))
    verdict = replay.verify()
    assert verdict.ok, verdict.message
    assert (replay.mode, replay.seed) == (mode, 7)
    if replay.ended == "running":
        assert replay.ticks == int(seconds * 240)
    if seconds > 10:
        assert replay.score > 0
        assert {BALL, SHOVE, LEFT, RIGHT} <= inputs_of(replay)


def test_a_game_is_played_by_keys_and_saved_to_a_file(browser, game_file, tmp_path):
    with browser.open(game_file) as page:
        page.keyboard.press("Space")
        wait_until(page, f"{BALLS} === 1")
        page.keyboard.down("Enter")
        page.wait_for_timeout(700)
        page.keyboard.up("Enter")
        for key, bit in (("a", 1), ("ArrowRight", 2), ("ShiftLeft", 1)):
            page.keyboard.down(key)
            wait_until(page, f"({HELD} & {bit}) !== 0")
            page.keyboard.up(key)
            wait_until(page, f"({HELD} & {bit}) === 0")
        page.keyboard.press("z")
        page.wait_for_timeout(1000)
        page.keyboard.press("p")
        with page.expect_download() as waiting:
            page.click("button:has-text('Save replay')")
        saved = tmp_path / waiting.value.suggested_filename
        waiting.value.save_as(saved)
    assert saved.suffix == ".replay"
    assert {BALL, LEFT, RIGHT, SHOVE} <= inputs_of(Replay.load(saved))
    command = [sys.executable, "-m", "silverball", "replay", str(saved), "--verify"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert done.returncode == 0, done.stderr
    assert "equal in all" in done.stdout


def test_a_game_is_played_by_touch_on_a_phone(browser, game_file):
    width, height = PHONE
    with browser.open(game_file, PHONE, is_phone=True) as page:
        box = page.locator("canvas").bounding_box()
        assert box["width"] == width
        assert page.evaluate("document.documentElement.scrollWidth") == width
        for button in page.locator("button:visible").all():
            place = button.bounding_box()
            assert place["height"] >= 40
            assert place["x"] >= 0
            assert place["x"] + place["width"] <= width
            assert place["y"] + place["height"] <= height
        assert page.evaluate("silverball.stage.display.startText") == "TOUCH TO START"
        page.touchscreen.tap(width / 2, 60)  # the first touch begins the game with a ball
        wait_until(page, f"{BALLS} === 1")
        touch = (
            "new PointerEvent('{}', {{ pointerId: 5, clientX: {}, clientY: 300, bubbles: true, button: 0 }})"
        )
        surface = "document.getElementById('surface')"
        for place, bit in ((40, 1), (width - 40, 2)):
            page.evaluate(f"{surface}.dispatchEvent({touch.format('pointerdown', place)})")
            wait_until(page, f"{HELD} === {bit}")
            page.evaluate(f"{surface}.dispatchEvent({touch.format('pointerup', place)})")
            wait_until(page, f"{HELD} === 0")
        page.touchscreen.tap(60, 300)
        page.tap("button:text('Shove')")
        page.wait_for_timeout(300)
        replay = Replay.from_text(page.evaluate("silverball.page.game.toReplay()"))
    assert {BALL, LEFT, RIGHT, SHOVE} <= inputs_of(replay)
    assert replay.verify().ok


def test_a_game_is_played_with_a_gamepad(browser, game_file):
    with browser.open(game_file, setup=PAD) as page:
        page.evaluate("pressPad(0, true)")
        wait_until(page, f"{BALLS} === 1")
        page.wait_for_timeout(100)
        assert page.evaluate(BALLS) == 1, "a button that stays down acts once"
        page.evaluate("pressPad(0, false)")
        for number, bit in ((4, 1), (5, 2)):
            page.evaluate(f"pressPad({number}, true)")
            wait_until(page, f"{HELD} === {bit}")
            page.evaluate(f"pressPad({number}, false)")
            wait_until(page, f"{HELD} === 0")
        page.evaluate("movePad(0, -0.9)")
        wait_until(page, f"/[!(]/.test({PLAYED})")


TAP = (
    "for (const name of ['keydown', 'keyup'])"
    " dispatchEvent(new KeyboardEvent(name, { code: 'KeyA', bubbles: true }));"
)


@pytest.mark.parametrize("ticks_due", ["some", "none"])
def test_a_tap_between_two_pictures_moves_a_paddle(browser, game_file, ticks_due):
    """Also before a picture in which no tick is due: as the first after a pause, or most on a fast screen."""
    with browser.open(game_file) as page:
        if ticks_due == "none":
            page.evaluate(f"(() => {{ silverball.page.goOn(); {TAP} }})()")
        else:
            page.click("button:text-is('Play')")
            wait_until(page, f"{TICK} > 0")
            page.evaluate(f"(() => {{ {TAP} }})()")
        wait_until(page, f"/[a-z]/.test({PLAYED}.replace(/[+]./, ''))")
        replay = Replay.from_text(page.evaluate("silverball.page.game.toReplay()"))
    assert LEFT in inputs_of(replay)


MENU = "!document.getElementById('menu').hidden"


def test_a_game_stands_still_while_it_is_paused_or_hidden(browser, game_file):
    with browser.open(game_file) as page:
        page.keyboard.press("Space")
        wait_until(page, f"{BALLS} === 1")
        page.keyboard.press("p")
        assert page.evaluate(MENU)
        tick = page.evaluate(TICK)
        page.wait_for_timeout(200)
        assert page.evaluate(TICK) == tick
        page.keyboard.press("p")
        wait_until(page, f"{TICK} > {tick}")
        page.evaluate(
            "(() => { Object.defineProperty(document, 'hidden', { get: () => true });"
            " document.dispatchEvent(new Event('visibilitychange')); })()"
        )
        assert page.evaluate(MENU)
        tick = page.evaluate(TICK)
        page.keyboard.press("Space")  # goes on, without another ball
        wait_until(page, f"{TICK} > {tick}")
        assert page.evaluate(BALLS) == 1


def test_a_game_begins_again_with_another_seed(browser, game_file):
    seed = "silverball.stage.world.seed"
    with browser.open(game_file) as page:
        assert page.evaluate(seed) == 7
        page.click("button:text-is('Play')")
        page.evaluate(PLAY, [5, 3, "arcade"])
        page.evaluate("silverball.isStopped = false")
        page.keyboard.press("r")
        assert page.evaluate(SCORE) == 0
        wait_until(page, f"{TICK} < 240 && {TICK} > 0")
        page.keyboard.press("Space")
        page.wait_for_timeout(500)
        replay = Replay.from_text(page.evaluate("silverball.page.game.toReplay()"))
    assert replay.seed != 7
    assert inputs_of(replay) == {BALL}
    assert replay.verify().ok


def test_a_clicked_button_is_not_pressed_again_by_space(browser, game_file):
    with browser.open(game_file) as page:
        page.click("button:text-is('Play')")
        wait_until(page, f"{BALLS} === 1")
        page.click("#bar >> text=Menu")
        page.click("button:has-text('Go on')")
        tick = page.evaluate(TICK)
        page.keyboard.press("Space")
        wait_until(page, f"{TICK} > {tick + 10}")
        assert not page.evaluate(MENU)


def test_buttons_reached_by_tab_are_pressed_by_space(browser, game_file):
    with browser.open(game_file) as page:
        page.click("button:text-is('Play')")
        page.focus("#bar >> text=Menu")
        page.keyboard.press("Space")
        assert page.evaluate(MENU)
        page.focus("button:text-is('2')")
        page.keyboard.press("Space")
        assert page.evaluate("[silverball.page.players, silverball.page.game.match.players]") == [2, 2]
        assert page.evaluate(BALLS) == 0


@pytest.mark.parametrize("size", [(844, 390), (320, 568), (1920, 1080)])
def test_all_of_the_page_is_visible(browser, game_file, size):
    width, height = size
    with browser.open(game_file, size, is_phone=width < 900) as page:
        page.evaluate("silverball.page.menu.close()")
        places = [one.bounding_box() for one in page.locator("canvas, button:visible").all()]
        for place in places:
            assert place["x"] >= 0
            assert place["x"] + place["width"] <= width
            assert place["y"] + place["height"] <= height
        table = places[0]
        others = [place for place in places[1:] if place["x"] < table["x"] + table["width"]]
        assert all(place["y"] >= table["y"] + table["height"] for place in others), "buttons cover the table"
        assert table["height"] > height * 0.6


def test_whole_arcade_games_end_as_in_python(browser, game_file):
    """Tilts, saved balls, combos, double points: whatever happens, Python comes to the same state."""
    ends = []
    with browser.open(game_file) as page:
        for seed in range(6):
            replay = Replay.from_text(page.evaluate(PLAY, [120, seed, "arcade"]))
            verdict = replay.verify()
            assert verdict.ok, verdict.message
            ends.append(replay.ended)
    assert "over" in ends


def test_an_extra_ball_in_arcade_is_asked_for_twice(browser, game_file):
    with browser.open(game_file) as page:
        page.keyboard.press("Space")
        wait_until(page, f"{BALLS} === 1")
        page.keyboard.press("Space")  # too early
        wait_until(page, "silverball.stage.world.tick > silverball.page.createdAt + 250")
        page.keyboard.press("Space")
        page.wait_for_timeout(100)
        used = "silverball.page.game.judge.int('used')"
        assert page.evaluate(used) == 1
        texts = page.evaluate("silverball.stage.display.messages.texts")
        if game_file.stem == "parts":  # with a plunger, balls come one after the other
            assert texts == []
            return
        assert texts == ["AGAIN: BALL 2 OF 3"]
        page.keyboard.press("Space")
        wait_until(
            page, f"{used} === 2 || silverball.stage.display.messages.texts[0] === 'NO ROOM FOR A BALL'"
        )


def test_the_mode_is_changed_by_its_button(browser, game_file):
    with browser.open(game_file) as page:
        assert page.evaluate("silverball.page.mode") == "arcade"
        page.click("button:has-text('Free play')")
        assert page.evaluate("silverball.page.mode") == "free"
        page.keyboard.press("Space")
        wait_until(page, f"{BALLS} === 1")
        replay = Replay.from_text(page.evaluate("silverball.page.game.toReplay()"))
        assert replay.mode == "free"
        page.keyboard.press("p")
        page.click("button:has-text('Arcade')")
        assert page.evaluate(BALLS) == 0


def test_a_game_is_heard(browser, game_file):
    with browser.open(game_file) as page:
        assert page.evaluate("silverball.stage.sounds.context") is None, "browsers forbid it before a gesture"
        page.keyboard.press("Space")
        wait_until(page, "silverball.stage.sounds.context?.state === 'running'")
        waves = page.evaluate("Object.keys(silverball.meta.sounds.waves)")
        assert page.evaluate("Object.keys(silverball.stage.sounds.buffers)") == waves
        page.keyboard.press("m")
        wait_until(page, "silverball.stage.sounds.context.state === 'suspended'")
