"""What the rules card says is lit: shots whose conditions hold, what they bring, and in which order."""

import pytest

from rule_tables import comet, with_rules
from silverball.app.backglass.card import CardReader, short_labels
from silverball.app.rule_words import RuleWords, Standing
from silverball.table import load_table

TABLE = comet()
WORDS = RuleWords(TABLE)
COUNTERS = {counter.name: counter.begins for counter in TABLE.counter}


def standing(lamps=(), blinking=(), modes=None, **counters) -> Standing:
    states = {lamp.name: "off" for lamp in TABLE.lamp}
    states |= dict.fromkeys(lamps, "on") | dict.fromkeys(blinking, "blinking")
    return Standing(states, COUNTERS | counters, modes or {})


def told(now: Standing) -> dict[str, str]:
    return {shot.where: shot.what for shot in WORDS.shots(now)}


def test_nothing_is_told_while_nothing_is_lit():
    assert told(standing()) == {}


@pytest.mark.parametrize(
    ("lamps", "where", "what"),
    [
        (("lock",), "saucer", "lock · locks the ball"),
        (("kickback",), "left outlane", "kickback"),
        (("super jackpot",), "right mouth of the ramp or left mouth of the ramp", "super jackpot · 200,000"),
        (("wizard",), "saucer", "wizard · silver comet · 3 balls"),
    ],
)
def test_a_lit_lamp_tells_its_shot(lamps, where, what):
    assert told(standing(lamps)) == {where: what}


def test_an_orbit_is_a_shot_though_no_single_switch_tells_it():
    table = load_table("silver_comet")
    counters = {counter.name: counter.begins for counter in table.counter}
    arrows = ("left orbit arrow", "right orbit arrow")
    lamps = {lamp.name: "blinking" if lamp.name in arrows else "off" for lamp in table.lamp}
    now = Standing(lamps, counters, {"chase the comet": 31.0})
    left, right, *_ = RuleWords(table).shots(now)
    assert (left.where, right.where) == ("left orbit", "right orbit")
    assert left.what == right.what
    assert int(left.what.replace(",", "")) >= 1000


def test_a_word_that_all_lamps_of_a_group_share_is_left_out():
    assert short_labels(["left arrow", "right arrow"]) == ["left", "right"]
    assert short_labels(["left arrow", "lock"]) == ["left arrow", "lock"]
    assert short_labels(["A", "B"]) == ["A", "B"]


def test_a_jackpot_waits_for_its_multiball():
    assert told(standing(("left jackpot",))) == {}
    now = standing(("left jackpot",), modes={"multiball": None}, in_play=3)
    assert told(now)["spinner"] == "left jackpot · 50,000"


def test_a_worth_grows_with_its_counter():
    for value in (0, 1, 4):
        now = standing(blinking=("skill A",), modes={"skill": None}, **{"skill value": value})
        assert told(now)["lane A"] == f"skill A · {10000 * (value + 1):,}"  # the rule raises it first


def test_what_belongs_to_a_mission_comes_first_then_what_blinks():
    now = standing(("kickback",), blinking=("Moon",), modes={"chase the comet": 31.0})
    shots = WORDS.shots(now)
    assert [shot.where for shot in shots] == ["spinner", "right orbit", "left outlane"]
    assert shots[0].is_mission
    assert shots[1].is_blinking


def test_conditions_on_counters_hide_a_shot():
    assert "saucer" in told(standing(("lock",)))
    assert "saucer" not in told(standing(("lock",), locks=2))


def test_the_card_counts_seconds_down_and_shows_the_lamps_of_a_group():
    reader = CardReader(TABLE)
    card = reader.card(standing(("A",), modes={"chase the comet": 19.5, "skill": None}), ())
    assert [(mode.name, mode.seconds) for mode in card.modes] == [("chase the comet", 20)]
    assert card.modes[0].bar == round(60 * 19.5 / 40.0)
    assert [(group.name, group.lamps[0]) for group in card.groups] == [("letters", ("A", "on"))]


def test_a_table_without_rules_of_its_own_shows_how_to_score():
    card = CardReader(load_table("classic")).card(Standing({}, {}, {}), ("how to score",))
    assert card.rules == ("how to score",)
    assert not card.blinks


def test_names_from_a_file_cannot_reverse_the_writing():
    lamp = '[[lamp]]\nname = "a\u202eb"\nbegins = "on"\n'
    table = with_rules(f'{lamp}[[rule]]\non_hit = "spinner"\nif_lit = "a\u202eb"\naward = 5')
    (shot,) = RuleWords(table).shots(Standing({"a\u202eb": "on"}, {}, {}))
    assert "\u202e" not in shot.what
