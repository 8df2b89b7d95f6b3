"""Mistakes in rules are all found at once, each with its place, what was expected, and a remedy."""

from __future__ import annotations

import random

import pytest

from rule_tables import COMET_RULES, comet, with_rules
from silverball.errors import TableError
from silverball.game.game import Game
from silverball.table import check_table, dump_table, load_table, table_digest
from silverball.table.file import parse_table
from silverball.table.standard_rules import standard_rules

BASE = """
[[lamp]]
name = "one"
group = "both"
begins = "on"
[[lamp]]
name = "two"
group = "both"
begins = "blinking"
[[counter]]
name = "locks"
most = 3
[[mode]]
name = "hunt"
seconds = 20.0
begins = "ball"
[[mode]]
name = "party"
begins = "game"
"""

MISTAKES = {
    'on_hit = "saucr"\naward = 1': ("rule[0].on_hit", "must name a part", 'did you mean \'saucer\'?'),
    'on_release = "spinner"\naward = 1': ("rule[0].on_release", "a hole or a plunger", "'saucer'"),
    'on_down = "midle"\naward = 1': ("rule[0].on_down", "a bank of drop targets", "'middle'"),
    'on_complete = "one"\naward = 1': ("rule[0].on_complete", "a group of lamps", "'both'"),
    'on_count = { lock = 2 }\naward = 1': ("rule[0].on_count", "a counter", "'locks'"),
    'on_count = { locks = 4 }\naward = 1': ("rule[0].on_count", "goes to 3 only", "lower it"),
    'on_count = { locks = 2 }\naward = 1': ("rule[0].on_count", "no rule adds to it", "add one"),
    'on_count = { in_play = 2 }\naward = 1': ("rule[0].on_count", "the machine sets", "your own"),
    'on_start = "hunting"\naward = 1': ("rule[0].on_start", "a mode", "'hunt'"),
    'on_time = "party"\naward = 1': ("rule[0].on_time", "a mode with `seconds`", "give it some"),
    'on_press = "lft"\naward = 1': ("rule[0].on_press", "a button", "'left'"),
    'on_ball = "drained"\naward = 1': ("rule[0].on_ball", "a moment of a ball", "'drain'"),
    'on_hit = "any"\nlight = "on"': ("rule[0].light", "a lamp or a group", "did you mean"),
    'on_hit = "any"\nadvance = "one"': ("rule[0].advance", "a group of lamps", "'both'"),
    'on_hit = "any"\nstart = "hnt"': ("rule[0].start", "a mode", "'hunt'"),
    'on_hit = "any"\nextend = { party = 5 }': ("rule[0].extend", "a mode with `seconds`", "give it some"),
    'on_hit = "any"\nadd = { ball = 1 }': ("rule[0].add", "the machine sets", "your own"),
    'on_hit = "any"\naward = 5\ntimes = "lock"': ("rule[0].times", "a counter", "'locks'"),
    'on_hit = "any"\neject = "top"': ("rule[0].eject", "a hole that holds balls", "'saucer'"),
    'on_hit = "any"\nopen = "lane gate"': ("rule[0].open", "a held gate", "the table has none"),
    'on_hit = "any"\nreset = "saucer"': ("rule[0].reset", "a bank", "'middle'"),
    "award = 1": ("rule[0]", "needs a trigger", "on_hit"),
    'on_hit = "any"': ("rule[0]", "needs an effect", "award"),
    'on_hit = "any"\ntimes = "locks"\ncue = "x"': ("rule[0].times", "multiplies nothing", "award"),
    'on_press = "left"\naward_part = true': ("rule[0].award_part", "a part that was hit", "on_hit"),
    'on_press = "left"\nkick = [5, 0]': ("rule[0].kick", "needs a ball", "on_hit"),
    'on_hit = "any"\nkick = [50, 0]': ("rule[0].kick", "speed cap", "slower"),
    'on_press = "left"\nlock = true': ("rule[0].lock", "needs a ball", "on_hit"),
    'on_hit = "any"\nmultiball = 5': ("rule[0].multiball", "board.max_balls, 3", "raise"),
    'on_hit = "any"\nmultiball = 1': ("rule[0].multiball", "2 or more", "already"),
    'on_hit = "any"\naward = 1\nif_lit = "one"\nif_unlit = "one"': ("rule[0].if_lit", "never acts", "remove"),
    'on_hit = "any"\naward = 1\nif_running = "hunt"\nif_stopped = "hunt"': ("rule[0].if_running", "never"),
    'on_hit = "any"\naward = 1\nif_at_least = { locks = 3 }\nif_below = { locks = 2 }': (
        "rule[0].if_at_least", "never acts", "change",
    ),
    'on_hit = "any"\naward = -5': ("rule[0].award", "must be 0 to", "got -5"),
    'on_hit = "any"\naward = 1.5': ("rule[0].award", "must be an integer", "got 1.5"),
    'on_hit = 7\naward = 1': ("rule[0].on_hit", "a name in quotes", "got 7"),
    'on_hit = ["any", "any"]\naward = 1': ("rule[0].on_hit", "twice", "any"),
    'on_hits = "any"\naward = 1': ("rule[0].on_hits", "unknown key", "`on_hit`"),
}  # fmt: skip


@pytest.mark.parametrize("text", MISTAKES)
def test_a_mistake_in_a_rule_is_named_with_its_place_and_a_remedy(text: str):
    path, *words = MISTAKES[text]
    with pytest.raises(TableError) as refused:
        with_rules(f"{BASE}[[rule]]\n{text}\n")
    assert [problem.path for problem in refused.value.problems] == [path]
    message = refused.value.problems[0].message
    assert all(word in message for word in words), message


STATES = {
    '[[lamp]]\nname = "x"\n[[lamp]]\nname = "x"': ("lamp[1].name", "lamp[0] has this name already"),
    '[[lamp]]\nname = "x"\ngroup = "x"': ("lamp[0].name", "the name of a group"),
    '[[lamp]]\nname = "x"\ncenter = [50.0, 0.0]': ("lamp[0].center", "must lie on the board"),
    '[[lamp]]\nname = ""': ("lamp[0].name", "must not be empty"),
    '[[lamp]]\nname = "x"\nbegins = "dim"': ("lamp[0].begins", "'off', 'on' or 'blinking'"),
    '[[lamp]]\nname = "x"\nshape = "heart"': ("lamp[0].shape", "must be 'round'"),
    '[[lamp]]\nname = "x"\ncolor = "puce"': ("lamp[0].color", "'green'"),
    '[[lamp]]\nname = "x"\nsize = 9.0': ("lamp[0].size", "must be 0.05 to 2 u, got 9"),
    '[[lamp]]\nname = "x"\nangle = 200.0': ("lamp[0].angle", "must be -180 to 180 deg, got 200"),
    '[[counter]]\nname = "combo"': ("counter[0].name", "a counter of the machine"),
    '[[counter]]\nname = "x"\nbegins = 9\nmost = 5': ("counter[0].begins", "at most `most`, 5"),
    '[[counter]]\nname = "x"\n[[counter]]\nname = "x"': ("counter[1].name", "already"),
    '[[mode]]\nname = "x"\nseconds = 0': ("mode[0].seconds", "0.1 to 600 s, got 0"),
    '[[mode]]\nname = "x"\n[[mode]]\nname = "x"': ("mode[1].name", "already"),
    "".join(f'[[lamp]]\nname = "{number}"\n' for number in range(129)): (
        "lamp",
        "not be more than 128, got 129",
    ),
    "".join(f'[[mode]]\nname = "{number}"\n' for number in range(33)): (
        "mode",
        "not be more than 32, got 33",
    ),
}


@pytest.mark.parametrize("number", range(len(STATES)))
def test_a_mistake_in_a_lamp_a_counter_or_a_mode_is_named(number: int):
    text, (path, words) = list(STATES.items())[number]
    with pytest.raises(TableError) as refused:
        with_rules(f'{text}\n[[rule]]\non_hit = "any"\naward = 1\n')
    assert [problem.path for problem in refused.value.problems] == [path]
    assert words in refused.value.problems[0].message


RULE = '[[rule]]\non_hit = "any"\n'
NEVER = {
    '[[lamp]]\nname = "x"\n' + RULE + 'award = 1\nif_lit = "x"': ("rule[0].if_lit", "no rule brings about"),
    '[[lamp]]\nname = "x"\n' + RULE + 'light = "x"\nif_blinking = "x"': ("rule[0].if_blinking", "no rule"),
    '[[mode]]\nname = "x"\n' + RULE + 'award = 1\nif_running = "x"': ("mode[0]", "is started by no rule"),
    '[[mode]]\nname = "x"\n' + RULE + 'start = "x"\n[[rule]]\non_start = "x"\nstop = "x"\n'
    '[[rule]]\non_end = "x"\nstart = "x"': ("rule[1]", "without an end (rule[1] → rule[2] → rule[1])"),
    '[[counter]]\nname = "x"\n[[rule]]\non_count = { x = 1 }\nadd = { x = -1 }\nset = { x = 1 }\n': (
        "rule[0]", "sets itself off without an end",
    ),
}  # fmt: skip


@pytest.mark.parametrize("number", range(len(NEVER)))
def test_rules_that_never_act_and_rules_that_loop_are_found(number: int):
    text, (path, words) = list(NEVER.items())[number]
    with pytest.raises(TableError) as refused:
        with_rules(text)
    assert [problem.path for problem in refused.value.problems] == [path]
    assert words in refused.value.problems[0].message


ENDING = (
    RULE + "add = { x = 1 }\n[[rule]]\non_count = { x = 3 }\naward = 1\nset = { x = 0 }",
    RULE + "add = { x = 1 }\n[[rule]]\non_count = { x = 3 }\nset = { x = 0 }\nadd = { x = 1 }",
    RULE + "add = { x = 1 }\n[[rule]]\non_count = { x = 3 }\nadd = { x = 5 }",
    RULE + "add = { x = 1 }\n[[counter]]\nname = 'y'\n"
    "[[rule]]\non_count = { x = 3 }\nadd = { y = 1 }\n[[rule]]\non_count = { y = 1 }\nset = { x = 0 }",
)


@pytest.mark.parametrize("number", range(len(ENDING)))
def test_a_counter_that_grows_or_goes_back_only_sets_nothing_off_again(number: int):
    assert check_table(with_rules('[[counter]]\nname = "x"\n' + ENDING[number])) == []


RINGS = (
    "[[rule]]\non_count = { x = 2 }\nset = { x = 0 }\nadd = { y = 1 }\n"
    "[[rule]]\non_count = { y = 1 }\nset = { x = 2, y = 0 }\n",
    "[[rule]]\non_count = { x = 2 }\nadd = { x = -2, y = 1 }\n"
    "[[rule]]\non_count = { y = 1 }\nadd = { x = 2, y = -1 }\n",
)


@pytest.mark.parametrize("number", range(len(RINGS)))
def test_counters_that_fill_each_other_up_loop(number: int):
    with pytest.raises(TableError, match="without an end"):
        with_rules('[[counter]]\nname = "x"\n[[counter]]\nname = "y"\n' + RINGS[number])


def test_a_mode_that_nobody_starts_or_asks_for_and_states_without_rules_are_warnings():
    table = with_rules('[[mode]]\nname = "x"\n' + RULE + "award = 1")
    assert [(one.path, one.severity) for one in check_table(table)] == [("mode[0]", "warning")]
    table = with_rules('[[lamp]]\nname = "x"\n')
    assert [(one.path, one.severity) for one in check_table(table)] == [("lamp[0]", "warning")]


def test_a_lens_without_a_place_and_lenses_over_each_other_are_warnings():
    rule = '[[rule]]\non_hit = "any"\nlight = "x"\n'
    alone = with_rules('[[lamp]]\nname = "x"\nshape = "star"\n' + rule)
    assert [(one.path, one.severity) for one in check_table(alone)] == [("lamp[0].shape", "warning")]
    pair = '[[lamp]]\nname = "{}"\ncenter = [1.0, {}]\nsize = 0.3\n'
    for gap, count in ((0.2, 1), (0.6, 0)):
        table = with_rules(pair.format("x", 0.0) + pair.format("y", gap) + rule)
        problems = check_table(table)
        assert [(one.path, one.severity) for one in problems] == [("lamp[1].center", "warning")] * count
        assert all("0.2 u from that of lamp[0]" in one.message for one in problems)


def test_all_mistakes_are_found_at_once():
    texts = [
        text
        for text, (path, *_) in MISTAKES.items()
        if "on_count = { locks" not in text and "party" not in text
    ]
    with pytest.raises(TableError) as refused:
        with_rules(BASE + "".join(f"[[rule]]\n{text}\n" for text in texts))
    assert len({problem.path for problem in refused.value.problems}) >= 30


def test_rules_need_format_2_and_do_not_change_the_digests_of_other_tables():
    with pytest.raises(TableError, match="is new in format 2"):
        parse_table('name = "old"\n[[rule]]\non_hit = "any"\naward = 1\n')
    assert table_digest(load_table("classic")) == table_digest(load_table("classic").replace(name="Classic"))
    assert table_digest(comet()) != table_digest(load_table("parts").replace(name=comet().name))


def test_a_whole_machine_has_no_problems_and_survives_writing():
    table = comet()
    assert check_table(table) == []
    again = parse_table(dump_table(table))
    assert (again, table_digest(again), dump_table(again)) == (table, table_digest(table), dump_table(table))


def test_the_standard_rules_are_valid_and_their_file_can_be_read():
    assert standard_rules().rule
    text = dump_table(standard_rules()).partition("[[rule]]")[2]
    assert check_table(with_rules("[[rule]]" + text)) == []


def mutated(text: str, draw: random.Random) -> str:
    """Rules with some mistakes."""
    lines = text.split("\n")
    for _ in range(draw.randint(1, 8)):
        at = draw.randrange(len(lines))
        match draw.randrange(6):
            case 0:
                del lines[at]
            case 1:
                lines.insert(at, draw.choice(lines))
            case 2:
                other = draw.randrange(len(lines))
                lines[at], lines[other] = lines[other], lines[at]
            case 3:
                key = lines[at].partition("=")[0]
                values = (
                    "-1",
                    "[]",
                    '"any"',
                    "{ locks = 99999999999 }",
                    "true",
                    "nan",
                    '[["x"]]',
                    '"' + "x" * 99 + '"',
                )
                lines[at] = f"{key}= {draw.choice(values)}" if key.strip() and "[" not in key else lines[at]
            case 4:
                lines[at] = lines[at].replace(draw.choice("aeiou "), draw.choice("xyz\\"), 1)
            case _:
                value = draw.choice(lines).partition("=")[2]
                lines[at] = (
                    f"{lines[at].partition('=')[0]}={value}" if "=" in lines[at] and value else lines[at]
                )
    return "\n".join(lines)


def test_mutated_rules_are_refused_in_sentences_or_can_be_played():
    draw, played, said = random.Random(14), 0, []
    for _ in range(120):
        text = mutated(COMET_RULES, draw)
        try:
            table = with_rules(text)
        except TableError as error:
            said += [problem.message for problem in error.problems]
            continue
        played += 1
        game = Game(table, 1)
        game.create_ball()
        for tick in range(240):
            game.step(tick % 40 < 20, tick % 30 < 10, ticks=4, launch=tick % 60 < 30)
        assert game.score >= 0
    assert played > 5
    assert len(said) > 50
    assert all(message and "Traceback" not in message for message in said)
