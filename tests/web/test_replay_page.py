"""A replay in the page: Python's digests in every second, and a sentence where they are not."""

from __future__ import annotations

import hashlib
from base64 import b64decode
from dataclasses import replace

import pygame
import pytest

from browser import PHONE, wait_until
from silverball.drawing.camera import best_size
from silverball.drawing.moment import Moment
from silverball.drawing.renderer import Renderer
from silverball.game.replay.player import Playback
from silverball.table import load_table
from silverball.table.rulebook import Lamp, PlayMode, Rule
from silverball.web.replay_inputs import recording_of
from web.conftest import HEIGHT, SECONDS, arcade_replay, write_game_page, write_replay_page

FRAMES, FRAME_TICKS = 240, 4
VERDICT = "document.querySelector('.verdict').textContent"
DRAW = f"""(() => {{
  const {{ page, stage }} = silverball, {{ follower }} = page, {{ painter, world, effects }} = stage;
  silverball.isStopped = true;
  follower.restart();
  stage.clear();
  const frames = [], size = 4 * painter.width * painter.height;
  for (let count = 0; count < {FRAMES}; count++) {{
    follower.advance({FRAME_TICKS}, (moved) => stage.see(moved));
    stage.announce(follower.game);
    painter.compose(world, effects, follower.game.judge);
    const {{ data }} = painter.image();
    let pixels = "";
    for (let at = 0; at < size; at += 4) pixels += String.fromCharCode(data[at], data[at + 1], data[at + 2]);
    frames.push(btoa(pixels));
  }}
  return frames;
}})()"""


def test_every_second_has_the_digest_of_the_replay(browser, replay_file):
    replay, path = replay_file
    assert recording_of(replay).differs == ""
    with browser.open(path) as page:
        wait_until(page, f"/^same bits: {SECONDS} of/.test({VERDICT})")
        assert page.evaluate(VERDICT) == f"same bits: {SECONDS} of {SECONDS} s"
        page.evaluate("silverball.page.seek(silverball.meta.replay.ticks)")
        assert page.evaluate("silverball.page.follower.game.score") == replay.score
        assert page.evaluate("silverball.stage.world.tick") == replay.ticks


def test_a_wrong_digest_is_named_by_its_second(browser, tmp_path):
    replay = arcade_replay("classic")
    wrong = "AAAA" if not replay.lines[4].startswith("AAAA") else "BBBB"
    lines = (*replay.lines[:4], wrong + replay.lines[4][4:], *replay.lines[5:])
    forged = replace(replay, lines=lines)
    assert recording_of(forged).differs == "second 5 differs from the replay's"
    with browser.open(write_replay_page(tmp_path / "forged.html", forged)) as page:
        wait_until(page, f"{VERDICT}.startsWith('not')")
        assert page.evaluate(VERDICT) == "not the same bits: second 5 differs, 4 s before it agree"
        assert "differs" in page.get_attribute(".verdict", "class")


def test_a_changed_input_is_noticed_in_its_second(browser, tmp_path):
    """The page itself compares: it is given other inputs than Python has played."""
    with browser.open(write_replay_page(tmp_path / "page.html", arcade_replay("classic"))) as page:
        page.evaluate(
            "(() => { const { checker } = silverball.page; checker.replay.inputs[2] = '';"
            " checker.restart(); })()"
        )
        wait_until(page, f"{VERDICT}.startsWith('not')")
        assert page.evaluate(VERDICT) == "not the same bits: second 3 differs, 2 s before it agree"


@pytest.mark.parametrize("change", [{"score": 1}, {"ended": "stopped"}, {"digest": "0" * 64}])
def test_a_wrong_end_is_noticed(browser, tmp_path, change):
    replay = arcade_replay("classic", seconds=2)
    assert replay.ended == "running"
    forged = replace(replay, **change)
    assert recording_of(forged).differs == "its end differs from the replay's"
    with browser.open(write_replay_page(tmp_path / "end.html", forged)) as page:
        wait_until(page, f"{VERDICT}.startsWith('not')")
        assert page.evaluate(VERDICT) == "not the same bits: the end differs, 2 s before it agree"


def test_inputs_that_the_rules_refuse_are_noticed(browser, tmp_path):
    replay = arcade_replay("classic", seconds=2)
    forged = replace(replay, lines=(replay.lines[0], f"{replay.lines[1]}+a+a+a+a+a"))
    assert "a new ball was recorded, but" in recording_of(forged).differs
    with browser.open(write_replay_page(tmp_path / "refused.html", forged)) as page:
        wait_until(page, f"{VERDICT}.startsWith('not')")


def test_frames_are_those_of_python_pixel_by_pixel(browser, replay_file):
    assert_same_frames(browser, *replay_file)


def test_lamps_are_those_of_python_pixel_by_pixel(browser, tmp_path):
    lamps = [
        Lamp(name="hit", center=(-2.0, -1.0), size=0.4, color="red"),
        Lamp(name="wait", center=(-2.0, 0.0), size=0.5, shape="star", begins="blinking"),
        Lamp(name="shoot", center=(-2.0, 1.0), size=0.4, shape="arrow", color="mode", begins="on"),
    ]
    rules = [
        Rule(on_hit=("any",), light=("hit",), award=10, cue="jackpot"),
        Rule(on_press=("left",), start=("hunt",)),
    ]
    modes = [PlayMode(name="rest", seconds=1.0), PlayMode(name="hunt", seconds=0.5, color="blue")]
    table = load_table("classic").replace(format=2, lamp=lamps, mode=modes, rule=rules)
    replay = arcade_replay(table, seconds=5)
    assert_same_frames(browser, replay, write_replay_page(tmp_path / "lamps.html", replay))


def assert_same_frames(browser, replay, path):
    with browser.open(path) as page:
        frames = page.evaluate(DRAW)
    renderer = Renderer(replay.table, best_size(replay.table.board, HEIGHT))
    playback = Playback(replay)
    wrong = []
    for number, frame in enumerate(frames):
        for _ in range(FRAME_TICKS):
            playback.play(1)
            renderer.add_events(playback.game.take_world_events(), replay.tick_rate)
        renderer.add_game_events(playback.game.take_game_events(), replay.tick_rate)
        surface = renderer._painter.compose(Moment.of_game(playback.game), renderer.effects)
        expected = hashlib.sha256(pygame.image.tobytes(surface, "RGB")).digest()
        if hashlib.sha256(b64decode(frame)).digest() != expected:
            wrong.append(number)
    renderer.close()
    assert wrong == []
    assert len(set(frames)) > FRAMES // 2


def test_the_slider_and_the_button_go_where_they_say(browser, replay_file):
    _, path = replay_file
    with browser.open(path) as page:
        page.evaluate("Object.assign(document.querySelector('input'), { value: 700 }).oninput()")
        page.click("button:has-text('Pause')")
        tick = page.evaluate("silverball.stage.world.tick")
        assert 700 <= tick < 960
        page.wait_for_timeout(150)
        assert page.evaluate("silverball.stage.world.tick") == tick
        page.click("button:has-text('Play')")
        wait_until(page, f"silverball.stage.world.tick > {tick}")
        page.evaluate("silverball.page.seek(silverball.meta.replay.ticks)")
        page.click("button:has-text('Again')")
        wait_until(page, "silverball.stage.world.tick < 240")


@pytest.mark.parametrize(
    "name", ["<script>alert(1)</script>", '"><img src=x onerror=alert(1)>', "%TITLE% & %DATA%"]
)
def test_the_name_of_a_table_is_only_shown(browser, tmp_path, name):
    table = load_table("classic").model_copy(update={"name": name})
    with browser.open(write_game_page(tmp_path / "named.html", table), PHONE) as page:
        assert page.title() == f"{name} – Silverball"
        assert page.get_attribute("canvas", "aria-label") == f"Pinball table {name}"
        assert page.evaluate("silverball.stage.title") == name
        assert page.locator("img").count() == 0
        assert page.locator("script:not([type])").count() == 1


def test_an_old_replay_is_compared_with_digests_of_today():
    replay = arcade_replay("classic", seconds=2)
    old = recording_of(replace(replay, physics=3, lines=tuple("A" * 12 + line[12:] for line in replay.lines)))
    assert old == recording_of(replay)
