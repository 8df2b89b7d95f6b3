"""Every page can be reached and left with three buttons, and drawn at any time.

The whole graph is walked, breadth first: from each page that a window can open, every button is pressed in
every state. Since states hold functions they cannot be copied; each is reached anew by its presses.
"""

from collections import deque

import numpy as np
import pytest

from silverball.app.menus import Button, Menus, ReplayStatus, ScoreRow, TableEntry
from silverball.app.menus.commands import (
    EndReplay,
    Play,
    Quit,
    Restart,
    Resume,
    WatchDemo,
    WatchLast,
    WatchScore,
)
from silverball.app.settings import PlayerSettings, Settings
from silverball.drawing.dotmatrix.canvas import HEIGHT, WIDTH
from silverball.game.view import Mode

THREE = (Button.LEFT, Button.RIGHT, Button.START)
TABLES = (
    TableEntry("classic", "Classic", "drawn by hand"),
    TableEntry("random", "Random", "new for every seed", True),
    TableEntry("tables/long.toml", "A table whose name is longer than any display", "Größe: 中"),
)
ROWS = (ScoreRow("ABC", 123_456_789, "2026-11-25", "k1"), ScoreRow("D.F", 4_560, "2026-11-24", "k2"))
LEAVES = (Play, Resume, Restart, Quit, EndReplay, WatchLast, WatchDemo, WatchScore)


def fresh(root: str, with_scores: bool = True) -> Menus:
    """Menus in which a window has opened a page."""

    def scores(table: str, mode: Mode):
        return ROWS if with_scores and table in ("classic", "random") and mode is Mode.ARCADE else ()

    menus = Menus(PlayerSettings(Settings()), TABLES, scores, themes=("neon", "night"))
    if with_scores:
        menus.context.last_seed = 77
        menus.context.has_last_game = True
    {
        "main": menus.open_main,
        "attract": menus.open_attract,
        "pause": menus.open_pause,
        "over": lambda: menus.open_over(4321),
        "initials": lambda: menus.open_over(4321, 3),
        "transport": lambda: menus.open_transport(ReplayStatus(3.0, 60.0)),
        "held transport": lambda: menus.open_transport(ReplayStatus(3.0, 60.0, is_paused=True)),
        "ended transport": lambda: menus.open_transport(ReplayStatus(60.0, 60.0)),
    }[root]()
    return menus


def reached(root: str, presses: tuple[Button, ...], with_scores: bool = True) -> tuple[Menus, object]:
    """Menus after presses, and what the last one asked for."""
    menus, command, now = fresh(root, with_scores), None, 0.0
    for button in presses:
        now += 0.2
        command = menus.tick(now) or menus.press(button)
        menus.release(button)
    return menus, command


def walked(root: str, with_scores: bool = True):
    """All states: what follows from each, and presses that lead there. "out" is where no menu is open."""
    first = reached(root, (), with_scores)[0].signature
    edges: dict[object, set[object]] = {"out": set()}
    ways: dict[object, tuple[Button, ...]] = {first: ()}
    queue = deque([first])
    while queue:
        state = queue.popleft()
        edges[state] = set()
        for button in THREE:
            way = (*ways[state], button)
            menus, command = reached(root, way, with_scores)
            after = "out" if isinstance(command, LEAVES) else menus.signature
            edges[state].add(after)
            if after != "out" and after not in ways:
                ways[after] = way
                queue.append(after)
    return edges, ways


def leading_to(edges: dict, goal) -> set:
    """All states from which one can get to states that satisfy `goal`."""
    found = {state for state in edges if goal(state)}
    while True:
        more = {state for state, afters in edges.items() if state not in found and afters & found}
        if not more:
            return found
        found |= more


@pytest.fixture(scope="module")
def main_walk():
    return walked("main")


def test_every_page_of_the_main_menu_is_reached_and_left_with_three_buttons(main_walk):
    edges, _ = main_walk
    pages = {page for state in edges if state != "out" for page, _ in state}
    assert pages == {
        "main", "table", "board", "seed", "watch", "high_scores", "scores", "settings", "challenges",
        "keys", "keys of an action", "pad", "pad of an action", "capture",
    }  # fmt: skip
    back = leading_to(edges, lambda state: state != "out" and len(state) == 1 and state[0][0] == "main")
    assert set(edges) - back == {"out"}


def test_the_whole_menu_can_be_left_for_a_game(main_walk):
    edges, _ = main_walk
    assert leading_to(edges, lambda state: state == "out") == set(edges)


@pytest.mark.parametrize(
    ("root", "pages"),
    [
        ("pause", {"pause", "sure", "settings", "capture", "main"}),
        ("initials", {"initials", "over", "main"}),
        ("ended transport", {"transport"}),
    ],
)
def test_the_pages_around_a_game_have_no_dead_end(root, pages):
    edges, _ = walked(root)
    assert pages <= {page for state in edges if state != "out" for page, _ in state}
    assert leading_to(edges, lambda state: state == "out") == set(edges)


@pytest.mark.parametrize("root", ["main", "pause", "over", "transport", "held transport"])
def test_both_paddles_held_for_a_second_go_back_once(root):
    menus = fresh(root)
    presses = 3 if root == "main" else 0
    for _ in range(presses):
        menus.press(Button.RIGHT)
        menus.release(Button.RIGHT)
    if root == "main":
        menus.press(Button.START)
        assert menus.page == "watch"
    menus.tick(1.0)
    menus.press(Button.LEFT)
    menus.tick(1.2)
    menus.press(Button.RIGHT)
    assert menus.tick(2.1) is None
    command = menus.tick(2.3)
    if root == "pause":
        assert isinstance(command, Resume)
    elif "transport" in root:
        assert isinstance(command, EndReplay)
    else:
        assert menus.page == "main"
    after = menus.signature
    for now in (2.6, 3.4, 5.0):
        assert menus.tick(now) is None
    assert menus.signature == after


def test_the_attract_pages_lead_to_the_main_menu_and_with_space_to_a_game():
    for button in Button:
        menus, command = reached("attract", (button,))
        if button is Button.START:
            assert (menus.page, command) == ("", Play(Mode.ARCADE, "silver_comet"))
        else:
            assert menus.page == "main"


def test_without_scores_or_a_last_game_there_is_no_dead_end_either():
    for presses, page in (
        ((Button.RIGHT,) * 4 + (Button.START,), "scores"),
        ((Button.RIGHT,) * 3 + (Button.START,), "watch"),
    ):
        menus, _ = reached("main", presses, with_scores=False)
        assert menus.page == page
        menus, _ = reached("main", (*presses, Button.LEFT, Button.START), with_scores=False)
        assert menus.page == "main"


@pytest.mark.parametrize(
    "root", ["main", "attract", "pause", "over", "initials", "transport", "held transport"]
)
def test_a_page_that_a_window_opens_can_be_drawn_at_any_time(root):
    check_drawing(root, ())


def test_every_page_can_be_drawn_at_any_time(main_walk):
    _, ways = main_walk
    # One state of each page and each place in it is enough; the other letters of a seed draw the same way.
    seen = {}
    for state, way in ways.items():
        seen.setdefault(tuple((page, str(place)) for page, place in state[-1:]), way)
    for way in list(seen.values())[::2]:
        check_drawing("main", way)


def check_drawing(root: str, way: tuple[Button, ...]) -> None:
    menus, _ = reached(root, way)
    now = 0.2 * len(way)
    before = menus.signature
    is_dark = True
    for seconds in (now, now + 0.03, now + 0.4, now + 1.7, now + 4.6, now + 13.0, now + 47.0, now - 1.0, 1e6):
        dots = menus.draw(seconds)
        assert dots.pixels.shape == (HEIGHT, WIDTH)
        assert dots.pixels.dtype == np.uint8
        assert (menus.draw(seconds).pixels == dots.pixels).all()
        is_dark = is_dark and not dots.pixels.any()
    assert not is_dark
    assert menus.signature == before
