"""Every trigger, condition and effect of the rules of a table does what its description says."""

from __future__ import annotations

from pathlib import Path

import pytest

import silverball as sb
from rule_tables import Bench, comet, with_rules
from silverball.physics.records import LAUNCH, LEFT, RIGHT, EventKind, Motion
from silverball.table import load_table
from silverball.table.rulebook.rule import CONDITIONS, EFFECTS, TRIGGERS

SECOND = 240  # ticks

STATES = """
[[lamp]]
name = "a"
group = "g"
[[lamp]]
name = "b"
group = "g"
[[lamp]]
name = "c"
group = "g"
[[lamp]]
name = "kept"
lasts = "game"
[[counter]]
name = "n"
most = 5
[[counter]]
name = "of ball"
begins = 2
lasts = "ball"
[[mode]]
name = "m"
seconds = 2.0
[[mode]]
name = "endless"
lasts = "game"
"""


def bench(rules: str) -> Bench:
    return Bench(STATES + rules)


def rule(**keys: object) -> str:
    """A rule as TOML."""
    return "[[rule]]\n" + "".join(f"{key} = {value}\n" for key, value in keys.items())


PAYS = {"award": 100}
HIT = {"on_hit": '"side target"'}


# --- triggers ---------------------------------------------------------------------------------------------


def two_balls(one: Bench) -> None:
    """Bring a second ball, and lose the first."""
    one.keeper.record["ball"][1]["id"] = 2
    one.keeper.record["balls"] = 2
    one.drain(1)


SET_OFF = {
    "on_hit": ('"side target"', lambda one: one.hit("side target")),
    "on_hit bank": ('"middle"', lambda one: one.hit("left drop target")),
    "on_hit any": ('"any"', lambda one: one.hit("side target")),
    "on_hit place": ('"target[0]"', lambda one: one.hit("target[0]")),
    "on_hit crossing": ('"left lane"', lambda one: one.happen(EventKind.PASS, "left lane")),
    "on_hit turn": ('"spinner"', lambda one: one.happen(EventKind.SPIN, "spinner")),
    "on_hit hole": ('"saucer"', lambda one: one.happen(EventKind.CAPTURED, "saucer")),
    "on_release": ('"saucer"', lambda one: one.happen(EventKind.RELEASED, "saucer")),
    "on_down": ('"middle"', lambda one: one.hit(*(f"{x} drop target" for x in ("left", "middle", "right")))),
    "on_press": ('"right"', lambda one: one.press(RIGHT)),
    "on_press launch": ('"launch"', lambda one: one.press(LAUNCH)),
    "on_ball launch": ('"launch"', lambda one: one.happen(EventKind.RELEASED, "plunger")),
    "on_ball end": ('"end"', lambda one: (one.wait(9 * SECOND), one.drain())),
    "on_ball save": ('"save"', lambda one: one.drain()),
    "on_ball drain": ('"drain"', lambda one: one.drain()),
    "on_ball lost": ('"lost"', lambda one: (one.wait(9 * SECOND), two_balls(one))),
    "on_ball tilt": ('"tilt"', lambda one: [one.keeper.shoved() for _ in range(3)]),
    "on_ball warning": ('"warning"', lambda one: [one.keeper.shoved() for _ in range(2)]),
}


@pytest.mark.parametrize("name", SET_OFF)
def test_a_trigger_sets_off_its_rule_once_and_nothing_else_does(name: str):
    value, cause = SET_OFF[name]
    one = bench(rule(**{name.partition(" ")[0]: value}, **PAYS))
    assert one.score == 0
    one.hit("left bumper") if name not in ("on_hit any",) else None
    one.press(LEFT)
    assert one.score == 0
    cause(one)
    assert one.score == 100


def test_a_ball_that_starts_on_the_empty_table_is_a_trigger():
    assert bench(rule(on_ball='"start"', **PAYS)).score == 100


def test_modes_set_off_rules_when_they_start_run_out_and_end():
    one = bench(
        rule(**HIT, start='"m"')
        + rule(on_start='"m"', award=1)
        + rule(on_time='"m"', award=10)
        + rule(on_end='"m"', award=100)
        + rule(on_hit='"saucer"', stop='"m"')
    )
    one.hit("side target", "side target")
    assert one.score == 1, "it runs already"
    one.wait(2 * SECOND - 2)
    assert one.score == 1, "its time began anew"
    one.wait(3)
    assert one.score == 111
    one.hit("side target")
    one.hit("saucer")
    assert one.score == 212, "stopped by a rule: it ended, but its time did not run out"
    assert one.game.modes == {}


def test_a_counter_sets_off_rules_when_it_reaches_a_value_from_below():
    one = bench(
        rule(**HIT, add="{ n = 2 }")
        + rule(on_count="{ n = 3 }", award=1)
        + rule(on_count="{ n = 5 }", award=10)
    )
    scores = []
    for _ in range(4):
        one.hit("side target")
        scores.append(one.score)
    assert scores == [0, 1, 11, 11]
    assert one.game.counters["n"] == 5, "its `most`"


def test_a_group_is_complete_when_its_last_lamp_goes_on():
    one = bench(
        rule(**HIT, light_next='"g"') + rule(on_hit='"saucer"', light='"c"') + rule(on_complete='"g"', **PAYS)
    )
    one.hit("saucer", "side target", "side target")
    assert one.score == 100
    one.hit("saucer", "side target")
    assert one.score == 100, "they were on already"


# --- conditions -------------------------------------------------------------------------------------------

HOLDS = {
    "if_lit": ('"g"', 'light = "g"', 'light = ["a", "b"]'),
    "if_lit blinking": ('"a"', 'blink = "a"', 'blink = "b"'),
    "if_blinking": ('"a"', 'blink = "a"', 'light = "a"'),
    "if_unlit": ('"a"', 'light = "b"', 'blink = "a"'),
    "if_running": ('"m"', 'start = "m"', 'start = "endless"'),
    "if_stopped": ('"m"', 'start = "endless"', 'start = "m"'),
    "if_at_least": ("{ n = 3 }", "add = { n = 3 }", "add = { n = 2 }"),
    "if_below": ("{ n = 3 }", "add = { n = 2 }", "add = { n = 3 }"),
    "if_below own": ("{ in_play = 2 }", "add = { n = 1 }", "multiball = 2"),
}


@pytest.mark.parametrize("holds", [True, False])
@pytest.mark.parametrize("name", HOLDS)
def test_a_rule_acts_only_if_its_condition_holds(name: str, holds: bool):
    value, true, false = HOLDS[name]
    enabling = rule(on_hit='"saucer"', light='"g"', blink='"a"', start='["m", "endless"]', add="{ n = 5 }")
    one = bench(
        f'[[rule]]\non_hit = "top"\n{true if holds else false}\n'
        + rule(**HIT, **{name.partition(" ")[0]: value}, **PAYS)
        + enabling
    )
    one.hit("top")
    one.hit("side target")
    assert one.score == (100 if holds else 0)


def test_the_conditions_of_one_trigger_are_looked_at_before_any_rule_acts():
    one = bench(
        rule(**HIT, if_unlit='"a"', light='"a"', award=1) + rule(**HIT, if_lit='"a"', unlight='"a"', award=10)
    )
    scores = []
    for _ in range(3):
        one.hit("side target")
        scores.append(one.score)
    assert scores == [1, 11, 12]


def test_no_rule_acts_while_the_table_is_tilted():
    one = bench(rule(**HIT, **PAYS))
    for _ in range(3):
        one.keeper.shoved()
    one.hit("side target")
    assert one.game.view.tilted
    assert one.score == 0


# --- effects ----------------------------------------------------------------------------------------------


def lamps(one: Bench) -> list[str]:
    return [one.game.lamps[name] for name in "abc"]


def test_lamps_are_lit_blink_and_go_off_one_by_one_or_as_a_group():
    one = bench(
        rule(on_hit='"top"', light='"g"')
        + rule(on_hit='"saucer"', blink='"b"')
        + rule(**HIT, unlight='["a", "c"]')
    )
    one.hit("top")
    assert lamps(one) == ["on"] * 3
    one.hit("saucer", "side target")
    assert lamps(one) == ["off", "blinking", "off"]


def test_the_lit_lamps_of_a_group_rotate():
    one = bench(
        rule(on_hit='"top"', light='"a"', blink='"b"')
        + rule(on_press='"left"', rotate_left='"g"')
        + rule(on_press='"right"', rotate_right='"g"')
    )
    one.hit("top")
    one.press(LEFT)
    assert lamps(one) == ["blinking", "off", "on"]
    one.press(RIGHT)
    one.press(RIGHT)
    assert lamps(one) == ["off", "on", "blinking"]


def test_the_blinking_lamp_advances_to_the_next_one_that_is_off():
    one = bench(rule(**HIT, advance='"g"') + rule(on_hit='"top"', light='"b"'))
    seen = []
    for name in ("side target", "side target", "side target", "top", "side target", "side target"):
        one.hit(name)
        seen.append(lamps(one))
    off, blinking, on = "off", "blinking", "on"
    assert seen == [
        [blinking, off, off], [off, blinking, off], [off, off, blinking], [off, on, blinking],
        [blinking, on, off], [off, on, blinking],
    ]  # fmt: skip


def test_points_are_multiplied_by_counters():
    one = bench(rule(**HIT, add="{ n = 3 }", award=100, times='["n", "of ball"]'))
    one.hit("side target")
    assert one.score == 100 * 3 * 2
    event = one.said[-1]
    assert (event.kind, event.value, event.part) == (sb.GameEventKind.SCORED, 600, "target[0]")


def test_a_rule_can_give_the_points_of_the_part():
    one = bench(rule(on_hit='"any"', award=1, award_part="true"))
    one.hit("side target", "left bumper")
    target, bumper = (expand_points(one, name) for name in ("side target", "left bumper"))
    assert one.score == target + bumper + 2


def expand_points(one: Bench, name: str) -> int:
    return next(part.part.worth for part in one.table.parts() if part.part.name == name)


def test_counters_are_raised_lowered_and_set_within_their_range():
    one = bench(
        rule(**HIT, add="{ n = 4 }")
        + rule(on_hit='"top"', add="{ n = -3 }")
        + rule(on_hit='"saucer"', set="{ n = 2 }")
    )
    values = []
    for name in ("side target", "side target", "top", "top", "saucer"):
        one.hit(name)
        values.append(one.game.counters["n"])
    assert values == [4, 5, 2, 0, 2]


def test_a_mode_is_extended_only_while_it_runs():
    one = bench(rule(**HIT, extend="{ m = 3 }") + rule(on_hit='"top"', start='"m"'))
    one.hit("side target", "top")
    one.hit("side target")
    assert one.game.modes["m"] == pytest.approx(5.0, abs=0.02)


def test_what_lasts_for_a_ball_ends_with_it_and_the_rest_stays():
    one = bench(rule(**HIT, light='["a", "kept"]', add='{ n = 1, "of ball" = 1 }', start='["m", "endless"]'))
    one.hit("side target")
    assert one.game.counters == {"n": 1, "of ball": 3}
    one.wait(SECOND)
    one.keeper.record["ball"][0]["saves"] = 0
    one.drain()
    assert one.game.counters == {"n": 1, "of ball": 2}
    assert (one.game.lamps["a"], one.game.lamps["kept"]) == ("off", "on")
    assert one.game.modes == {"endless": None}


def test_an_extra_ball_is_played_with_the_same_number():
    one = bench(rule(**HIT, extra_ball=1))
    one.hit("side target")
    assert "extra_ball" in one.kinds
    one.wait(9 * SECOND)
    one.drain()
    assert one.said[-1][:3] == (sb.GameEventKind.BALL_READY, one.said[-1].tick, 1)
    assert one.game.view.ball == 1


def test_a_saved_ball_comes_back_once():
    one = bench(rule(**HIT, save=10.0))
    one.wait(9 * SECOND)
    one.hit("side target")
    one.drain()
    assert one.kinds[-1] == "ball_saved"
    assert one.keeper.has_waiting


def test_a_rule_saves_a_ball_that_is_draining():
    one = bench(rule(on_ball='"drain"', if_running='"m"', save=0.1) + rule(**HIT, start='"m"'))
    one.wait(9 * SECOND)
    one.hit("side target")
    one.drain()
    assert one.kinds[-1] == "ball_saved"


def test_messages_and_cues_are_reported_with_their_texts():
    one = bench(rule(**HIT, message='"well done"', cue='"bell"'))
    one.hit("side target")
    assert [(event.kind.value, event.part) for event in one.said[-2:]] == [
        ("message", "well done"),
        ("cue", "bell"),
    ]


def test_multiball_brings_balls_until_so_many_are_in_play():
    one = bench(rule(**HIT, multiball=3))
    one.hit("side target")
    assert one.keeper.record["balls"] == 3
    assert one.kinds[-2:] == ["multiball", "double_on"]
    one.hit("side target")
    assert one.kinds[-2:] == ["multiball", "double_on"]


# --- effects at the table, with real balls ----------------------------------------------------------------


def with_ball(rules: str, position: tuple[float, float], velocity: tuple[float, float]) -> sb.Game:
    """A game with one ball that flies from a place."""
    game = sb.Game(with_rules(STATES + rules), 3)
    game.create_ball()
    game.world.records[0]["ball"]["id"][0] = 0
    ball = game.world.create_ball(position, velocity)
    game._keeper.record["ball"][0]["id"] = ball.id
    return game


def test_a_kick_sends_the_ball_off_with_its_velocity():
    game = with_ball(rule(on_hit='"left lane"', kick="[20.0, 1.0]", cue='"kick"'), (-2.9, -4.3), (-3.0, 0.0))
    while not any(event.kind is sb.GameEventKind.CUE for event in game.events):
        game.step()
        assert game.tick < SECOND
    (ball,) = game.world.balls
    assert ball.velocity == (20.0, 0.0, 1.0)


def test_a_locked_ball_leaves_the_table_and_another_one_comes():
    rules = rule(on_hit='"saucer"', lock="true") + rule(on_count="{ locked = 1 }", award=500)
    game = with_ball(rules, (2.3, 3.4), (5.0, 0.0))
    game.step(ticks=SECOND)
    assert game.score == 500
    (ball,) = game.world.balls
    assert ball.id == 3
    assert game.state.balls[0].id == 3
    assert game.world.records[0]["ball"]["motion"].max() == Motion.CAPTURED, "it lies on the plunger"


def test_a_hole_ejects_its_ball_at_once():
    slow = with_ball(rule(on_hit='"top"', award=1), (2.3, 3.4), (5.0, 0.0))
    fast = with_ball(rule(on_hit='"saucer"', eject='"saucer"'), (2.3, 3.4), (5.0, 0.0))
    left = []
    for game in (slow, fast):
        while not any(event.kind == "released" for event in game.take_world_events()):
            game.step()
            assert game.tick < 3 * SECOND
        left.append(game.tick)
    assert left[0] - left[1] == pytest.approx(SECOND, abs=2), "the saucer holds a ball for a second"


def test_a_bank_comes_back_when_a_rule_says_so():
    game = with_ball(rule(on_hit='"middle"', reset='"middle"', award=1), (1.0, -0.5), (9.0, 0.0))
    while game.score == 0:
        game.step()
        assert game.tick < SECOND
    game.step(ticks=SECOND // 4)
    assert int(game.world.records[0]["off"]) == 0


GATE = """
[[gate]]
name = "way"
start = [-1.0, -2.0]
end = [-1.0, -1.0]
held = true
"""


def test_gates_open_and_close_and_wait_until_no_ball_is_in_their_way():
    rules = GATE + rule(on_press='"left"', open='"way"') + rule(on_press='"right"', close='"way"')
    game = with_ball(rules, (6.6, -3.5), (0.0, 0.0))
    game.step(left=True)
    is_open = game.world.records[0]["off"]
    assert int(is_open) != 0
    game.step(right=True)
    assert int(game.world.records[0]["off"]) == 0
    game.step(left=True)
    game.world.create_ball((-1.0, -1.5))
    game.step(right=True)
    assert int(game.world.records[0]["off"]) != 0, "a ball lies in it"
    game.step(ticks=SECOND)
    assert int(game.world.records[0]["off"]) == 0, "it has fallen out of it"


def test_every_key_of_rules_is_tested_here():
    text = Path(__file__).read_text(encoding="utf-8")
    missing = [
        key for key in (*TRIGGERS, *CONDITIONS, *EFFECTS) if f'"{key}' not in text and f"{key}=" not in text
    ]
    assert missing == []


# --- a whole machine ----------------------------------------------------------------------------------------


def test_a_skill_shot_pays_more_every_time():
    one = Bench(comet())
    assert "skill" in one.game.modes
    one.press(RIGHT)
    assert one.game.lamps["skill B"] == "blinking"
    one.hit("lane B")
    assert "skill shot" in one.texts
    assert one.game.counters["skill value"] == 1
    assert "skill" not in one.game.modes
    assert one.score == 10_000 + expand_points(one, "lane B")


def test_a_mission_is_chosen_started_and_won():
    one = Bench(comet())
    one.hit("side target", "right orbit")
    assert list(one.game.modes) == ["skill", "land on the moon", "second chance"]
    before = one.score
    one.hit("saucer")
    assert one.score - before >= 100_000
    assert (one.game.lamps["Moon"], one.game.counters["rank"]) == ("on", 1)
    assert one.game.lamps["Comet"] == "blinking", "the next one is chosen"


def test_a_mission_that_takes_too_long_is_lost():
    one = Bench(comet())
    one.hit("right orbit")
    one.wait(40 * SECOND)
    assert "too late" in one.texts
    assert (one.game.lamps["Comet"], one.game.lamps["Moon"]) == ("off", "blinking")


def test_two_missions_give_an_extra_ball_and_all_five_light_the_wizard():
    one = Bench(comet())
    shots = {"Comet": "spinner", "Moon": "saucer", "Rings": "left mouth of the ramp", "Star": "top"}
    for lamp in ("Comet", "Moon", "Mars", "Rings", "Star"):
        assert one.game.lamps[lamp] == "blinking", lamp
        one.hit("right orbit")
        if lamp == "Mars":
            one.hit("left drop target", "middle drop target", "right drop target")
        else:
            one.hit(shots[lamp])
        assert one.texts.count("extra ball") == (one.game.counters["finished"] >= 2)
    assert one.game.lamps["wizard"] == "blinking"
    one.hit("saucer")
    assert "silver comet" in one.game.modes
    assert one.keeper.record["balls"] == 3


def test_two_locks_start_a_multiball_with_jackpots():
    one = Bench(comet())
    for _ in range(2):
        one.keeper.record["fallen"] = 0
        one.hit("left drop target", "middle drop target", "right drop target")
        one.hit("saucer")
    assert "multiball" in one.game.modes
    assert one.keeper.record["balls"] == 2
    before = one.score
    one.hit("spinner", "right orbit")
    assert one.score - before > 100_000
    assert one.game.lamps["super jackpot"] == "blinking"
    before = one.score
    one.hit("left mouth of the ramp")
    assert one.score - before >= 400_000, "times the balls in play"


def test_the_bonus_is_counted_out_at_the_end_of_a_ball():
    one = Bench(comet())
    one.hit("lane A", "lane B", "lane C")
    bonus, factor = one.game.counters["bonus"], one.game.counters["bonus factor"]
    assert (bonus, factor) == (30, 2)
    before = one.score
    one.wait(20 * SECOND)
    one.drain()
    assert one.score - before == 60
    assert one.game.counters["bonus"] == 0


# --- standard rules ---------------------------------------------------------------------------------------


def test_a_table_without_rules_has_the_standard_ones():
    plain = sb.Game(load_table("parts"), 5)
    factors = '["combo_factor", "ball_factor"]'
    text = rule(on_hit='"any"', add="{ combo = 1 }", award_part="true", times=factors)
    own = sb.Game(with_rules(text), 5)
    for game in (plain, own):
        game.create_ball()
        for tick in range(30 * SECOND):
            game.step(tick % 90 < 40, tick % 70 < 30, launch=tick % 500 < 200)
    assert plain.score == own.score > 0
    assert plain.state == own.state
    assert plain.world.digest() == own.world.digest()
