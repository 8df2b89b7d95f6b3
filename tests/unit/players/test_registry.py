"""Players of one's own: registered in Python or by an installed package, and used like the built-in ones."""

from __future__ import annotations

import sys
import warnings

import numpy as np
import pytest

from boards import full_table
from own_players import LEFTY, Swatter, install
from silverball.errors import SilverballError
from silverball.metrics.ball_time import time_balls
from silverball.players import (
    PlayerError,
    make_player,
    player_names,
    register,
    registered_names,
    unregister,
)
from silverball.players.batch_policies import WorldView
from silverball.players.rollout import play
from silverball.world import World, WorldBatch
from silverball.world.saved_world import digest

pytestmark = pytest.mark.usefixtures("unregistered")

BUILT_IN = ("idle", "random", "blind", "reflex", "hold", "planner", "trained")


class FastSwatter(Swatter):
    """The same for a whole batch."""

    def press_batch(self, batch: WorldBatch) -> np.ndarray:
        self.decisions += 1
        balls = batch.state["ball"]
        low = (balls["id"] != 0) & (balls["x"] < -6.0)
        sides = (low & (balls["z"] < 0.0)).any(axis=1), (low & (balls["z"] >= 0.0)).any(axis=1)
        return np.stack(sides, axis=1)


def test_a_registered_player_is_made_by_name_until_it_is_removed() -> None:
    register("swatter", Swatter)
    assert player_names() == (*BUILT_IN, "swatter")
    assert registered_names() == ("swatter",)
    assert make_player("swatter").press(World("classic")) == (False, False)
    unregister("swatter")
    assert player_names() == BUILT_IN
    with pytest.raises(PlayerError, match="swatter"):
        unregister("swatter")


@pytest.mark.parametrize(
    ("name", "factory", "words"),
    [
        ("reflex", Swatter, "'reflex' is taken by a built-in player"),
        ("twice", Swatter, r"'twice' is taken; choose another name, or unregister\('twice'\)"),
        ("Upper", Swatter, "lower-case letter"),
        ("x" * 21, Swatter, "up to 19"),
        ("", Swatter, "got ''"),
        (7, Swatter, "got 7"),
        ("mine", Swatter(), "must be callable, got <"),
    ],
)
def test_a_name_that_is_taken_or_malformed_is_refused(name, factory, words) -> None:
    register("twice", Swatter)
    with pytest.raises(PlayerError, match=words):
        register(name, factory)
    assert registered_names() == ("twice",)


def test_an_unknown_name_is_refused_with_the_nearest_one_registered_ones_included() -> None:
    register("swatter", Swatter)
    with pytest.raises(PlayerError, match=r"'swater'; there are idle, .*, swatter; did you mean 'swatter'\?"):
        make_player("swater")
    with pytest.raises(SilverballError, match="did you mean 'reflex'"):
        play(WorldBatch("classic"), "reflexx", 1.0)


def raises() -> None:
    raise ZeroDivisionError("no\nluck")


class Answers:
    """A player that answers what it is made with."""

    def __init__(self, answer) -> None:
        self.answer = answer

    def press(self, world):
        return self.answer() if callable(self.answer) else self.answer

    press_batch = press


@pytest.mark.parametrize(
    ("factory", "words"),
    [
        (raises, "player 'mine': its factory raised ZeroDivisionError: no luck"),
        (dict, r"player 'mine': its factory must return an object with a method press\(world\), got dict"),
    ],
)
def test_a_factory_that_fails_is_one_sentence(factory, words) -> None:
    register("mine", factory)
    for use in (make_player, lambda name: play(WorldBatch("classic"), name, 1.0)):
        with pytest.raises(PlayerError, match=f"^{words}$"):
            use("mine")


@pytest.mark.parametrize("answer", [None, True, (True,), (True, 1), "no", (True,) * 3, [[True, False]]])
def test_a_player_that_returns_anything_but_two_booleans_is_one_sentence(answer) -> None:
    register("mine", lambda: Answers(answer))
    with pytest.raises(PlayerError, match=r"player 'mine': press\(\) must return two booleans .*, got "):
        make_player("mine").press(World("classic"))
    with pytest.raises(PlayerError, match=r"press_batch\(\) must return a boolean array of shape \(2, 2\)"):
        play(WorldBatch("classic", 2), "mine", 1.0)


@pytest.mark.parametrize("answer", [np.zeros((2, 2)), np.zeros((3, 2), bool), np.zeros(2, bool)])
def test_an_array_of_another_type_or_shape_is_one_sentence(answer) -> None:
    register("mine", lambda: Answers(answer))
    with pytest.raises(PlayerError, match=r"shape \(2, 2\), got (float64|bool) \("):
        play(WorldBatch("classic", 2), "mine", 1.0)


def test_a_player_that_raises_is_one_sentence_with_its_cause() -> None:
    register("mine", lambda: Answers(raises))
    with pytest.raises(
        PlayerError, match=r"^player 'mine': press\(\) raised ZeroDivisionError: no luck$"
    ) as why:
        make_player("mine").press(World("classic"))
    assert isinstance(why.value.__cause__, ZeroDivisionError)


@pytest.mark.parametrize("pressed", [(True, False), [True, False], np.array([True, False])])
def test_booleans_of_any_kind_are_accepted(pressed) -> None:
    register("mine", lambda: Answers(pressed))
    assert make_player("mine").press(World("classic")) == (True, False)


def test_a_factory_gets_the_seed_of_its_world_if_it_wants_one() -> None:
    seeds = []

    def seeded(seed: int) -> Swatter:
        seeds.append(seed)
        return Swatter()

    register("seeded", seeded)
    make_player("seeded", seed=7)
    play(WorldBatch("classic", 3, seed=20), "seeded", 0.1)
    assert seeds == [7, 20, 21, 22]


@pytest.mark.parametrize("player", [Swatter, FastSwatter])
def test_alone_and_in_a_batch_it_plays_the_same_game(player) -> None:
    register("mine", player)
    batch = WorldBatch(full_table(), count=3, seed=6, tick_rate=120)
    play(batch, "mine", 5.0, balls=2)
    for index in range(3):
        world, alone = World(full_table(), seed=6 + index, tick_rate=120), make_player("mine")
        for _ in range(5 * 120):
            if len(world.balls) < 2:
                world.create_ball()
            world.step(*alone.press(world))
        assert world.digest() == digest(batch.state[index])


@pytest.mark.parametrize(("player", "calls"), [(Swatter, 4 * 60), (FastSwatter, 60)])
def test_the_batch_form_is_called_once_per_tick_and_the_other_once_per_tick_and_world(player, calls) -> None:
    made = []

    def make():
        made.append(player())
        return made[-1]

    register("mine", make)
    times = time_balls(WorldBatch(full_table(), 4, 1, 60), "mine", 1.0)
    assert times.alive == 4
    assert sum(one.decisions for one in made) == calls


def test_both_forms_keep_balls_for_as_long() -> None:
    register("slow", Swatter)
    register("fast", FastSwatter)
    slow, fast = (
        time_balls(WorldBatch("random", 4, 9, 60), name, 20.0)._replace(wall_seconds=0.0)
        for name in ("slow", "fast")
    )
    assert slow == fast
    assert slow.score[0] > 0.0


def test_a_player_sees_the_events_and_hits_of_its_world_and_cannot_move_it() -> None:
    batch = WorldBatch("random", 2, seed=3, tick_rate=60)
    batch.create_balls()
    view, kinds = WorldView(batch, 1), set()
    for _ in range(600):
        batch.step(np.zeros((2, 3), bool))
        world = view.world()
        kinds |= {event.kind for event in world.events}
        assert world.digest() == digest(batch.state[1])
    assert "hit" in kinds
    assert list(world.hits.values()) == batch.tallies[1, : len(world.hits)].tolist()
    before = batch.digests()
    world.step(True, True, ticks=5)
    assert batch.digests() == before


# Installed packages


def test_the_player_of_an_installed_package_is_imported_when_it_is_asked_for(site) -> None:
    install(site, "left-hand", "lefty = left_hand:Lefty", LEFTY)
    assert registered_names() == ()
    assert "left_hand" not in sys.modules
    assert make_player("lefty").press(World("classic")) == (True, False)
    assert player_names() == (*BUILT_IN, "lefty")
    assert play(WorldBatch("classic", 2), "lefty", 1.0).seconds == 1.0


def test_the_list_of_names_imports_the_players_of_installed_packages(site) -> None:
    install(site, "left-hand", "lefty = left_hand:Lefty", LEFTY)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert player_names() == (*BUILT_IN, "lefty")


@pytest.mark.parametrize(
    ("entries", "module", "words"),
    [
        (
            "lefty = left_hand:Lefty",
            "import nowhere_at_all",
            "left_hand:Lefty cannot be imported, ModuleNotFound",
        ),
        ("lefty = left_hand:Righty", LEFTY, "left_hand:Righty cannot be imported, AttributeError"),
        ("reflex = left_hand:Lefty", LEFTY, "'reflex' is taken by a built-in player"),
        ("Lefty = left_hand:Lefty", LEFTY, "lower-case letter"),
        ("lefty = left_hand:NUMBER", "NUMBER = 7", "must be callable, got 7"),
    ],
)
def test_a_broken_package_is_skipped_with_one_warning(site, entries, module, words) -> None:
    install(site, "left-hand", entries, module)
    name = entries.split()[0]
    with pytest.warns(UserWarning, match=words) as told:
        assert player_names() == BUILT_IN
    assert len(told) == 1
    assert str(told[0].message).startswith(f"player {name!r} of left-hand: ")
    assert "\n" not in str(told[0].message)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert player_names() == BUILT_IN  # told once
    if name != "reflex":  # that name means the built-in player
        with pytest.raises(PlayerError, match=words):
            make_player(name)
