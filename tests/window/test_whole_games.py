"""Whole games on Silver Comet, by real keys, a real mouse and a gamepad, in a window that an X server shows.

Shots are those of games that a scout has found (`comet_games.py`): the keys are pressed at the ticks of the
replay. Where a test begins in the middle of a game, its first part has been played with the same inputs at
once, so every game has a replay, which is verified at the end.

Needs Debian's packages xvfb and libxtst6; without them these tests are skipped.
"""

from __future__ import annotations

import ctypes.util
import shutil
from collections.abc import Callable, Iterator

import pytest
from comet_games import MISSIONS, SEEDS, first_ticks, load
from hands import Hands, at_window, lamp_center
from joysticks import GAMEPAD, VirtualJoystick

from silverball.game.game import Game
from silverball.game.replay.format import Replay
from silverball.game.replay.verify import verify
from silverball.game.scores.store import Store
from silverball.game.view import Mode, Phase
from silverball.table import load_table

pytestmark = pytest.mark.skipif(
    shutil.which("Xvfb") is None or ctypes.util.find_library("Xtst") is None,
    reason="needs the program Xvfb and the library libXtst",
)
SOUTH, LEFT_SHOULDER, RIGHT_SHOULDER = 0, 9, 10  # of SDL's virtual gamepad
BEFORE = 300  # [tick] for which a test presses keys before the event that it is about
COMET = load_table("silver_comet")
PLANETS = ("Comet", "Moon", "Mars", "Rings", "Star")


@pytest.fixture
def comet(tmp_path) -> Iterator[Callable[..., Hands]]:
    """Opens a window with an arcade game on Silver Comet, or in the menu."""
    opened = []

    def opener(seed: int | None = SEEDS["great"], mode: Mode | None = Mode.ARCADE, **options) -> Hands:
        context = at_window(tmp_path / "data", table="silver_comet", seed=seed, mode=mode, **options)
        opened.append(context)
        return context.__enter__()

    yield opener
    for context in opened:
        context.__exit__(None, None, None)


@pytest.fixture(scope="module")
def great() -> tuple[Replay, dict[str, int]]:
    replay = load("great")
    return replay, first_ticks(replay)


def play_until(hands: Hands, replay: Replay, tick: int, after: int = 120) -> None:
    """Press the keys of a found game around a tick."""
    hands.skip(replay, max(tick - BEFORE, 0))
    hands.follow(replay, tick + after)


def is_proven(game: Game) -> bool:
    """Whether the replay of a game leads to the very same game."""
    return verify(Replay.from_text(game.replay.to_text())).ok


def brightness(hands: Hands, lamp: str) -> float:
    """How bright a lamp of the table is in the picture, from 0 to 255."""
    return float(hands.pixels(lamp_center(COMET, lamp)).mean())


def test_the_plunger_is_drawn_back_and_the_skill_shot_pays(comet, great):
    replay, ticks = great
    hands = comet()
    assert hands.game.has_ball_to_launch
    assert "blinking" in hands.game.lamps["skill A"]
    hands.follow(replay, ticks["skill shot"] + 120)
    assert hands.game.counters["skill value"] == 1
    assert hands.game.score >= 3000
    assert "SKILL SHOT" in hands.said
    assert is_proven(hands.game)


def test_a_mission_is_started_at_the_ramp_and_won(comet, great):
    replay, ticks = great
    hands = comet()
    play_until(hands, replay, ticks[MISSIONS[0]], after=40)
    assert MISSIONS[0] in hands.game.modes
    assert hands.game.lamps["left orbit arrow"] == "blinking"
    assert "SHOOT THREE ORBITS" in hands.said
    lit = []
    for _ in range(30):
        hands.follow(replay, hands.game.tick + 4)
        lit.append(brightness(hands, "left orbit arrow"))
    assert max(lit) > min(lit) + 20.0  # it blinks in the picture too
    hands.follow(replay, ticks["comet caught"] + 240)
    assert hands.game.ranks == (1,)
    assert hands.game.lamps["Comet"] == "on"
    assert MISSIONS[0] not in hands.game.modes
    assert "COMET CAUGHT" in hands.said
    assert is_proven(hands.game)


def test_a_mission_whose_time_runs_out_is_lost(comet):
    replay = load("late")
    tick = first_ticks(replay)["too late"]
    hands = comet(seed=replay.seed)
    play_until(hands, replay, tick, after=0)
    assert hands.game.modes[MISSIONS[0]] == pytest.approx(0.0, abs=0.05)
    hands.follow(replay, tick + 120)
    assert MISSIONS[0] not in hands.game.modes
    assert hands.game.ranks == (0,)
    assert hands.game.lamps["left orbit arrow"] == "off"
    assert hands.game.lamps["mission at the ramp"] == "blinking"
    assert "TOO LATE" in hands.said
    assert is_proven(hands.game)


def test_two_locked_balls_begin_a_multiball_with_jackpots(comet, great):
    replay, ticks = great
    hands = comet()
    hands.skip(replay, ticks["ball locked"] - BEFORE)
    assert hands.game.lamps["lock"] == "blinking"
    hands.follow(replay, ticks["ball locked"] + 120)
    assert hands.game.counters["locks"] == 1
    assert "BALL 1 LOCKED" in hands.said
    hands.skip(replay, ticks["multiball"] - BEFORE)
    dark = brightness(hands, "left jackpot")
    hands.follow(replay, ticks["multiball"] + 300)  # the plunger has launched one, and the other lies there
    assert hands.game.view.on_board == 2
    assert hands.game.lamps["left jackpot"] == "blinking"
    assert "MULTIBALL" in hands.said
    assert brightness(hands, "left jackpot") != dark
    hands.skip(replay, ticks["jackpot"] - BEFORE)
    score = hands.game.score
    hands.follow(replay, ticks["jackpot"] + 120)
    assert hands.game.score >= score + 50_000
    assert "JACKPOT" in hands.said
    assert is_proven(hands.game)


def test_an_extra_ball_is_lit_by_two_missions_and_shot(comet, great):
    replay, ticks = great
    hands = comet()
    hands.skip(replay, ticks["extra ball"] - BEFORE)
    assert hands.game.lamps["extra ball"] == "blinking"
    hands.follow(replay, ticks["extra ball"] + 120)
    assert hands.game.lamps["extra ball"] == "off"
    assert hands.game.lamps["shoot again"] == "on"
    assert "EXTRA BALL" in hands.said
    assert brightness(hands, "shoot again") > 60.0
    assert is_proven(hands.game)


def test_all_missions_light_the_wizard_mode_which_brings_three_balls(comet, great):
    replay, ticks = great
    hands = comet()
    hands.skip(replay, ticks["silver comet"] - BEFORE)
    assert hands.game.lamps["wizard"] == "blinking"
    assert all(hands.game.lamps[lamp] == "on" for lamp in PLANETS)
    hands.follow(replay, ticks["silver comet"] + 240)
    assert "silver comet" in hands.game.modes
    assert "SILVER COMET" in hands.said
    hands.let_go()
    hands.until(lambda: hands.game.view.on_board >= 2, 20.0)
    assert hands.game.lamps["ramp arrow"] == "blinking"
    assert is_proven(hands.game)


def test_nudging_too_hard_tilts_and_the_table_goes_dark(comet):
    hands = comet()
    hands.launch()
    lamp = next(name for name, state in hands.game.lamps.items() if state == "blinking" and name in PLANETS)
    seen = [brightness(hands, lamp) for _ in range(30) if hands.frames(1) is None]
    assert max(seen) > min(seen) + 20.0
    for key in ("z", "x", "Up"):
        hands.tap(key)
    assert hands.game.view.tilted
    hands.seconds(1.5)  # the flash of the tilt
    seen = [brightness(hands, lamp) for _ in range(30) if hands.frames(1) is None]
    assert max(seen) < min(seen) + 1.0
    rest = hands.game.world.paddles[0].angle
    hands.press("a")
    hands.frames(10)
    assert hands.game.world.paddles[0].angle == rest
    hands.release("a")
    assert is_proven(hands.game)


def test_a_game_ends_with_its_bonus_and_initials_typed_and_is_in_the_list(comet, tmp_path):
    hands = comet(mode=None)
    hands.click("PLAY")
    assert hands.game.has_ball_to_launch
    hands.drain()
    assert any(text.startswith("BONUS") for text in hands.said)
    score = hands.game.score
    hands.until(lambda: hands.menus.page == "initials", 10.0)
    hands.tap("c", "o", "m", "Return")
    assert hands.menus.page == "over"
    hands.click("MENU")
    hands.click("SCORES")
    assert any("COM" in f"{row.label} {row.detail}" for row in hands.menus.listing.rows)
    with Store(tmp_path / "data") as store:
        (row,) = store.scores()
        assert (row.initials, row.score) == ("COM", score)
        verdict = verify(Replay.from_text(store.replay(row.id)))
    assert (verdict.ok, verdict.score) == (True, score)


def test_two_players_take_turns_and_each_signs_with_the_mouse(comet, tmp_path):
    hands = comet(mode=None)
    hands.click("CHALLENGES")
    hands.click("2 PLAYERS")
    assert hands.game.players == 2
    up = []
    for _ in range(20):
        if hands.game.is_over:
            break
        up.append(hands.game.view.player)
        hands.launch()
        hands.until(lambda: hands.game.phase is not Phase.PLAY or hands.game.has_ball_to_launch, 200.0)
    assert hands.game.is_over
    assert {1, 2} <= set(up)
    scores = hands.game.scores
    for letters in ("ABC", "DEF"):
        hands.until(lambda: hands.menus.page == "initials", 10.0)
        for letter in letters:
            hands.click(letter)
        hands.click("END")
    hands.until(lambda: hands.menus.page == "over", 10.0)
    with Store(tmp_path / "data") as store:
        found = {(row.initials, row.score) for row in store.scores()}
        replays = [Replay.from_text(store.replay(row.id)) for row in store.scores()]
    assert found == {("ABC", scores[0]), ("DEF", scores[1])}
    assert all(verify(replay).ok for replay in replays)


def test_todays_board_has_a_list_and_the_medals_a_page(comet):
    hands = comet(mode=None, seed=None)
    hands.click("CHALLENGES")
    hands.click("TODAY'S BOARD")
    assert hands.game.mode is Mode.ARCADE
    hands.drain()
    hands.until(lambda: hands.menus.page == "initials", 10.0)
    hands.tap("d", "a", "y", "Return")
    hands.click("MENU")
    hands.click("CHALLENGES")
    hands.click("TODAY'S SCORES")
    assert any("DAY" in label for label in hands.labels)
    hands.click("BACK")
    hands.click("MEDALS")
    assert "SILVER COMET" in hands.labels
    hands.click("BACK")
    hands.click("RACE THE BEST")
    assert hands.program.session.rival is not None
    hands.launch()
    hands.seconds(2.0)
    assert "DAY" in hands.program.display.note


def test_a_gamepad_launches_shoots_and_nudges(comet):
    hands = comet()
    device = VirtualJoystick(GAMEPAD, 6, 15)
    try:
        hands.frames(2)
        for down in (True, False):
            device.button(SOUTH, down)
            hands.seconds(0.4)
        assert not hands.game.has_ball_to_launch
        rest = [paddle.angle for paddle in hands.game.world.paddles]
        for button in (LEFT_SHOULDER, RIGHT_SHOULDER):
            device.button(button, True)
        hands.frames(12)
        now = [paddle.angle for paddle in hands.game.world.paddles]
        assert all(abs(a - b) > 0.5 for a, b in zip(rest, now, strict=True))
        for button in (LEFT_SHOULDER, RIGHT_SHOULDER):
            device.button(button, False)
        device.axis(0, 32767)
        hands.frames(3)
        assert hands.game.world.cabinet[1] != 0.0
        assert is_proven(hands.game)
    finally:
        device.pull_out()
