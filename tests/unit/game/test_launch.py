"""The launch button in recordings, saved games and rules."""

from __future__ import annotations

import json

import pytest

from silverball.game.builtin_rules import ArcadeRules, FreeRules
from silverball.game.game import Game
from silverball.game.referee_state import StuckTracker
from silverball.game.replay.recording import (
    BALL,
    LAUNCH,
    LEFT,
    LINE,
    RIGHT,
    SHOVE,
    format_input,
    parse_inputs,
)
from silverball.game.rules import InPlay, RuleState
from silverball.game.saved_game import GameState
from silverball.table import load_table

DIGESTS = "q3Zx0aKfB1Gg"
RULES = ArcadeRules()
CONFIG = RULES.configure(load_table("classic"), 240)


@pytest.mark.parametrize("ticks", [0, 25, 26, 239, 999])
def test_an_input_of_the_launch_button_is_read_as_it_was_written(ticks):
    text = format_input(LAUNCH, ticks)
    assert text.startswith("^")
    (one,) = parse_inputs(text)
    assert one == (ticks, LAUNCH)


def test_a_line_holds_inputs_of_all_kinds():
    kinds = (LEFT, LAUNCH, RIGHT, BALL, LAUNCH, SHOVE)
    text = "".join(format_input(kind, number) for number, kind in enumerate(kinds))
    assert LINE.fullmatch(f"{DIGESTS} {text}")
    assert [one.kind for one in parse_inputs(text)] == list(kinds)


@pytest.mark.parametrize("text", ["^A", "^04b", "^+b", "^"])
def test_an_input_of_the_launch_button_has_one_spelling(text):
    with (
        pytest.raises(ValueError, match=r"[\^A]")
        if LINE.fullmatch(f"{DIGESTS} {text}")
        else pytest.raises(AssertionError)
    ):
        assert LINE.fullmatch(f"{DIGESTS} {text}")
        list(parse_inputs(text))


def test_the_state_of_a_game_names_the_launch_button_only_while_it_is_held():
    released = GameState(RuleState(), StuckTracker(), False, True, False, False, "")
    held = released._replace(launch=True)
    assert "launch" not in json.loads(released.to_json())
    assert GameState.from_json(released.to_json()) == released
    assert GameState.from_json(held.to_json()) == held


def test_without_a_plunger_the_launch_button_changes_and_records_nothing():
    one, other = Game("classic", 3), Game("classic", 3)
    for game, launch in ((one, True), (other, False)):
        game.create_ball()
        game.step(ticks=300, launch=launch)
    assert not one.is_launch_held
    assert one.digest() == other.digest()
    assert one.replay.to_text() == other.replay.to_text()


def test_a_ball_is_safe_from_its_launch_on():
    waiting = RuleState(balls=(InPlay(7, 1, safe_until=960, saves=1), InPlay(8, 2, safe_until=0, saves=0)))
    state, events = RULES.launched(CONFIG, waiting, 5000, 7)
    assert [ball.safe_until for ball in state.balls] == [5000 + CONFIG.save_ticks, 0]
    assert state.quiet_since == 5000
    assert events == ()


@pytest.mark.parametrize("ball", [8, 9])
def test_a_ball_that_is_not_saved_stays_so(ball):
    waiting = RuleState(balls=(InPlay(8, 2, safe_until=0, saves=0),))
    assert RULES.launched(CONFIG, waiting, 5000, ball)[0].balls == waiting.balls
    assert FreeRules().launched(CONFIG, waiting, 5000, ball)[0].balls == waiting.balls


def test_a_third_ball_does_not_announce_the_double_again():
    state, kinds = RuleState(), []
    for ball in range(1, 4):
        state, events = RULES.started(CONFIG, state, 0, ball)
        kinds.append([event.kind.value for event in events])
    assert kinds == [[], ["double_on"], []]
    for ball in range(1, 4):
        state, events = RULES.drained(CONFIG, state, 10_000, ball)
        kinds.append([event.kind.value for event in events if event.kind.value.startswith("double")])
    assert kinds[3:] == [[], ["double_off"], []]
