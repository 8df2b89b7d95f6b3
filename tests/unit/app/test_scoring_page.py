"""Does the page on how to score say what the table's own rules are?"""

import re

import pytest
from hypothesis import given, strategies as st

from rule_tables import comet
from silverball.app.scoring import how_to_score, quick_shoves
from silverball.game.builtin_rules import ArcadeRules
from silverball.game.rules import RuleState
from silverball.game.view import GameEventKind, Mode
from silverball.table import Arcade, Board, Cylinder, Table, TriangularPrism, generate_table, load_table

RATE = 240


def text_of(table: Table, title: str, mode: Mode = Mode.ARCADE) -> str:
    return next((rule.text for rule in how_to_score(table, mode) if rule.title == title), "")


def table_with(**arcade) -> Table:
    return Table(arcade=Arcade(**arcade), cylinder=(Cylinder(center=(3, 0), radius=1, points=70),))


def factor_of(table: Table, count: int, balls: int = 1) -> int:
    """By which the last of so many hits in a row is multiplied, by the rules of the game."""
    rules, state, events = ArcadeRules(), RuleState(), ()
    config = rules.configure(table, RATE)
    for ball in range(balls):
        state, _ = rules.started(config, state, 0, ball + 1)
    for _ in range(count):
        state, events = rules.hit(config, state, 1, 1, "cylinder[0]")
    return next(one.value for one in events if one.kind is GameEventKind.SCORED)


@given(
    step=st.integers(1, 100),
    limit=st.integers(1, 100),
    window=st.floats(0.0, 10.0).map(lambda seconds: round(seconds, 2)),
)
def test_the_factors_of_combos_are_those_of_the_rules(step, limit, window):
    table = table_with(combo_step=step, combo_limit=limit, combo_window=window)
    text = text_of(table, "Combo")
    if not window:
        assert "no combos" in text
        return
    assert f"{window:g} s" in text
    for place, factor in re.findall(r"from the (\d+)\w\w (?:hit )?on (?:they count )?×(\d+)", text):
        assert factor_of(table, int(place)) == int(factor)
        assert factor_of(table, int(place) - 1) == int(factor) - 1
    highest = max([1, *map(int, re.findall(r"×(\d+)", text))])
    assert highest == factor_of(table, 100 * 101 + 1) == limit


@pytest.mark.parametrize("double", [1, 2, 7])
def test_two_balls_double_as_the_rules_do(double):
    table = table_with(double=double)
    text = text_of(table, "Double")
    assert bool(text) == (double > 1)
    if text:
        assert f"×{factor_of(table, 1, balls=2)}" in text


@pytest.mark.parametrize("numbers", [{"balls": 1}, {"double": 1}])
def test_where_a_second_ball_gains_nothing_nothing_is_said_of_it(numbers):
    assert not text_of(table_with(**numbers), "Double")
    assert not text_of(Table(board=Board(max_balls=1)), "Double")


@given(
    warning=st.floats(0.0, 20.0), limit=st.floats(0.0, 20.0), warnings=st.integers(0, 5)
)  # fmt: skip
def test_the_shoves_that_warn_and_tilt_are_those_of_the_rules(warning, limit, warnings):
    arcade = Arcade(tilt_warning=warning, tilt_limit=limit, warnings=warnings)
    table = Table(arcade=arcade)
    rules, state = ArcadeRules(), RuleState()
    config = rules.configure(table, RATE)
    warned, count = None, 0
    while not state.tilted:
        count += 1
        state, events = rules.shoved(config, state, 0)
        if any(one.kind is GameEventKind.WARNING for one in events):
            warned = warned or count
    assert quick_shoves(arcade) == (warned, count)
    assert re.search(rf"{count}\w\w (of quick ones )?tilts", text_of(table, "Tilt"))


@pytest.mark.parametrize(("seconds", "times"), [(0.0, 1), (5.0, 0), (5.0, 1), (12.5, 2), (60.0, 9)])
def test_the_ball_save_is_that_of_the_table(seconds, times):
    text = text_of(table_with(ball_save=seconds, ball_saves=times), "Ball save")
    if seconds and times:
        assert f"{seconds:g} s" in text
        assert {1: "once", 2: "twice", 9: "9 times"}[times] in text
    else:
        assert text.startswith("This table has none")


@pytest.mark.parametrize("name", ["classic", "random", "rolling"])
def test_the_points_of_every_kind_of_part_are_told(name):
    recipe = load_table(name)
    table = generate_table(7, recipe) if recipe.random else recipe
    text = text_of(table, "Hits")
    for kind, parts in (("cylinder", table.cylinder), ("triangular prism", table.triangular_prism)):
        points = {part.points for part in parts if part.points}
        assert (kind in text.lower()) == bool(points)
        for value in points and {min(points), max(points)}:
            assert f"{value:,}" in text


def test_a_table_without_points_says_so():
    assert "gives points" in text_of(Table(), "Hits")
    prism = TriangularPrism(vertices=((0, 0), (0, 1), (1, 0)), points=0)
    assert "gives points" in text_of(Table(triangular_prism=(prism,)), "Hits")


def test_free_play_tells_of_no_rule_that_it_does_not_have():
    titles = [rule.title for rule in how_to_score(table_with(), Mode.FREE)]
    assert titles == ["Hits", "Free play"]
    for most in (1, 2):
        text = text_of(Table(board=Board(max_balls=most)), "Free play", Mode.FREE)
        assert ("one at a time" if most == 1 else f"at most {most}") in text


def test_the_key_that_shoves_is_named():
    assert how_to_score(table_with(), Mode.ARCADE, "Q")[-2].text.startswith("Q shoves")
    assert how_to_score(table_with(), Mode.ARCADE, "")[-2].text.startswith("A shove")


def test_a_table_with_rules_of_its_own_tells_its_missions_lights_and_rules_with_names():
    table = comet()
    told = {rule.title: rule.text for rule in how_to_score(table, Mode.ARCADE)}
    assert list(told) == ["Missions", "While lit", "Multiball", "Rules", "Ball save", "Tilt", "Game"]
    assert told["Missions"].startswith("chase the comet")
    assert ": right orbit, then 40 s; " in told["Missions"]
    assert "in chase the comet spinner brings 100,000" in told["Missions"]
    assert "saucer: locks the ball" in told["While lit"]
    assert "locks: 2 balls" in told["Multiball"]
    assert told["Rules"].startswith("a hit gives its points; the bonus is counted out; ")
    nameless = table.model_copy(update={"rule": (table.rule[2],)})
    assert how_to_score(nameless, Mode.ARCADE)[0].text == f"{table.name} has 1 rules of its own"
