"""Idle menus: which pages wait forever, and what the others do."""

import pytest

from silverball.app.menus import Button, Menus, ReplayStatus, ScoreRow, TableEntry
from silverball.app.menus.commands import Attract, Initials
from silverball.app.menus.entry import SIGN_TIMEOUT
from silverball.app.menus.menus import ATTRACT_AFTER
from silverball.app.menus.transport import PAUSED_EXTRA_TIME
from silverball.app.settings import PlayerSettings, Settings
from silverball.game.view import Mode

LEFT, RIGHT, START, BACK = Button
TABLES = (TableEntry("classic", "Classic"), TableEntry("random", "Random", "", True))
ROWS = (ScoreRow("ABC", 1000, "2026-11-25", "k1"),)
STEP = 0.25  # [s]


def menus_at(root: str, *labels: str) -> Menus:
    """Menus with a page open, reached by the labels of items."""

    def scores(table: str, mode: Mode):
        return ROWS if mode is Mode.ARCADE else ()

    menus = Menus(PlayerSettings(Settings(initials="OLD")), TABLES, scores, themes=("neon", "night"))
    menus.context.last_seed = 7
    menus.context.has_last_game = True
    {
        "main": menus.open_main,
        "pause": menus.open_pause,
        "over": lambda: menus.open_over(4321),
        "initials": lambda: menus.open_over(4321, 3),
        "replay": lambda: menus.open_transport(ReplayStatus(3.0, 60.0)),
        "held replay": lambda: menus.open_transport(ReplayStatus(3.0, 60.0, is_paused=True)),
        "ended replay": lambda: menus.open_transport(ReplayStatus(60.0, 60.0)),
    }[root]()
    menus.tick(1.0)
    for label in labels:
        page = menus.context.pages[-1]
        found = [item.label for item in page._items()].index(label)
        for _ in range((found - page.index) % len(page._items())):
            press(menus, RIGHT)
        press(menus, START)
    return menus


def press(menus: Menus, *buttons: Button) -> None:
    for button in buttons:
        menus.press(button)
        menus.release(button)


def wait(menus: Menus, seconds: float) -> list[object]:
    """The commands that come while nobody touches anything."""
    start = menus.context.now
    ticks = (menus.tick(start + STEP * count) for count in range(1, round(seconds / STEP) + 1))
    return [command for command in ticks if command is not None]


FORSAKEN = [
    ("main",),
    ("main", "MODE"),
    ("main", "TABLE"),
    ("main", "TABLE", "BOARD SEED"),
    ("main", "TABLE", "BOARD SEED", "NUMBER"),
    ("main", "WATCH"),
    ("main", "WATCH", "HIGH SCORES"),
    ("main", "SCORES"),
    ("main", "SETTINGS"),
    ("main", "SETTINGS", "VOLUME"),
    ("main", "SETTINGS", "KEYS"),
    ("main", "SETTINGS", "KEYS", "NUDGE LEFT"),
    ("main", "SETTINGS", "KEYS", "NUDGE LEFT", "NEW KEY"),
    ("main", "SETTINGS", "GAMEPAD"),
    ("main", "SETTINGS", "GAMEPAD", "NUDGE LEFT", "NEW BUTTON"),
    ("over",),
    ("initials",),
    ("ended replay",),
]


@pytest.mark.parametrize("way", FORSAKEN, ids=" ".join)
def test_a_page_that_was_left_alone_gives_way_to_the_show(way):
    menus = menus_at(*way)
    if way != ("main",):
        assert menus.page != "main" or way[-1] == "MODE"
    assert not wait(menus, 0.8 * SIGN_TIMEOUT)
    assert wait(menus, ATTRACT_AFTER)[-1] == Attract(True)
    assert menus.page == "attract"
    assert not wait(menus, 20 * ATTRACT_AFTER)
    press(menus, RIGHT)
    assert menus.page == "main"


PAUSED = [
    ("pause",),
    ("pause", "RESTART"),
    ("pause", "END GAME"),
    ("pause", "SETTINGS"),
    ("pause", "SETTINGS", "VOLUME"),
    ("pause", "SETTINGS", "KEYS"),
    ("pause", "SETTINGS", "KEYS", "NUDGE LEFT"),
    ("pause", "SETTINGS", "GAMEPAD"),
]


@pytest.mark.parametrize("way", PAUSED, ids=" ".join)
def test_a_paused_game_waits_for_its_player_on_whatever_page(way):
    menus = menus_at(*way)
    page = menus.page
    assert not wait(menus, 100 * ATTRACT_AFTER)
    assert menus.page == page


def test_a_replay_waits_while_it_goes_on_and_for_minutes_while_it_is_held():
    menus = menus_at("replay")
    assert not wait(menus, 100 * ATTRACT_AFTER)
    menus = menus_at("held replay")
    assert not wait(menus, PAUSED_EXTRA_TIME)
    assert wait(menus, 2 * ATTRACT_AFTER) == [Attract(True)]


@pytest.mark.parametrize(
    ("buttons", "letters", "signed"),
    [
        ((), "", "OLD"),
        ((START,), "", "OLD"),
        ((RIGHT, START), "", "PLD"),
        ((RIGHT, START, START, RIGHT, START), "", "PLE"),
        ((), "m", "M  "),
        ((), "mia", "MIA"),
    ],
)
def test_initials_that_nobody_finishes_are_taken_as_they_stand_and_the_score_is_signed_once(
    buttons, letters, signed
):
    menus = menus_at("initials")
    press(menus, *buttons)
    for letter in letters:
        menus.type(letter, letter, is_button=False)
    assert not wait(menus, 0.9 * SIGN_TIMEOUT)
    assert wait(menus, ATTRACT_AFTER) == [Initials(signed), Attract(True)]
    assert menus.context.settings.current.initials == signed
    assert not wait(menus, 3 * ATTRACT_AFTER)


@pytest.mark.parametrize("touch", [lambda menus: press(menus, RIGHT), lambda menus: type_x(menus)])
def test_every_touch_gives_the_player_the_whole_time_again(touch):
    menus = menus_at("initials")
    for _ in range(5):
        assert not wait(menus, 0.9 * SIGN_TIMEOUT)
        touch(menus)
    assert menus.page == "initials"
    assert wait(menus, 1.1 * SIGN_TIMEOUT)


def test_a_paddle_that_is_held_is_a_touch():
    menus = menus_at("initials")
    menus.press(RIGHT)
    assert not wait(menus, 2 * SIGN_TIMEOUT)
    assert menus.page == "initials"


def type_x(menus: Menus) -> None:
    menus.type("x", "x", is_button=False)
