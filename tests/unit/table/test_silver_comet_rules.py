"""The rules of silver_comet: every part of a game, told to the referee hit by hit."""

from __future__ import annotations

import pytest

import silverball as sb
from rule_tables import Bench
from silverball.game.view import GameEventKind
from silverball.physics.records import LEFT, RIGHT, EventKind

TABLE = sb.load_table("silver_comet")
SECOND = 240  # ticks
GUARD = 3 * SECOND  # after which the next orbit counts as a shot
STARTS = ("mission at the left target", "mission at the ramp", "mission at the side target")
LANES = ("lane A", "lane B", "lane C")
BANK = ("left drop target", "middle drop target", "right drop target")
MISSIONS = {
    "chase the comet": "Comet",
    "land on the moon": "Moon",
    "storm of Mars": "Mars",
    "through the rings": "Rings",
    "birth of a star": "Star",
}


def bench() -> Bench:
    """A game after its skill shot, with a ball that is no longer saved."""
    one = Bench(TABLE)
    one.hit("left slingshot")
    one.wait(20 * SECOND)
    return one


def next_ball(one: Bench) -> None:
    one.record["ball"]["id"] = 0
    one.game.create_ball()


def left_orbit(one: Bench) -> None:
    one.happen(EventKind.SPIN, "spinner")
    one.happen(EventKind.PASS, "left orbit switch")
    one.wait(GUARD)


def right_orbit(one: Bench) -> None:
    one.happen(EventKind.PASS, "right orbit switch")
    one.wait(GUARD)


def ramp(one: Bench) -> None:
    one.happen(EventKind.PASS, "ramp")


def saucer(one: Bench) -> None:
    one.happen(EventKind.CAPTURED, "saucer")


def target(one: Bench) -> None:
    one.hit("left target")


def bank(one: Bench) -> None:
    one.hit(*BANK)
    one.happen(EventKind.RESET, "left drop target")


SHOTS = {
    "chase the comet": (left_orbit, right_orbit, left_orbit),
    "land on the moon": (ramp, saucer),
    "storm of Mars": (target, bank),
    "through the rings": (ramp, ramp, ramp),
    "birth of a star": (left_orbit, target, saucer, ramp),
}


def choose(one: Bench, mission: str) -> None:
    """Let the left inlane choose a mission."""
    for _ in range(5):
        if one.keeper.lamps[MISSIONS[mission]] == "blinking":
            return
        one.happen(EventKind.PASS, "left inlane")
    raise AssertionError(one.keeper.lamps)


def win(one: Bench, mission: str) -> None:
    choose(one, mission)
    ramp(one)
    assert mission in one.keeper.modes
    for shot in SHOTS[mission]:
        shot(one)
    assert mission not in one.keeper.modes
    assert one.keeper.lamps[MISSIONS[mission]] == "on"


def paid(one: Bench, action: object, *arguments: object) -> int:
    before = one.score
    action(one, *arguments)  # type: ignore[operator]
    return one.score - before


# --- The skill shot, the lanes, the spinner


def test_the_skill_shot_moves_with_the_paddles_and_grows_from_ball_to_ball():
    one = Bench(TABLE)
    assert one.keeper.lamps["skill A"] == "blinking"
    one.press(RIGHT)
    assert one.keeper.lamps["skill B"] == "blinking"
    one.press(LEFT)
    one.press(LEFT)
    assert one.keeper.lamps["skill C"] == "blinking"
    first = paid(one, lambda b: b.happen(EventKind.PASS, "lane C"))
    assert one.texts == ["skill shot"]
    assert "skill" not in one.keeper.modes
    one.wait(20 * SECOND)
    one.drain()
    next_ball(one)
    second = paid(one, lambda b: b.happen(EventKind.PASS, "lane A", ball=2))
    assert second == 2 * first - 100  # of which 100 are for the lane itself


def test_whatever_is_hit_first_ends_the_skill_shot():
    one = Bench(TABLE)
    one.hit("left bumper")
    assert "skill" not in one.keeper.modes
    one.happen(EventKind.PASS, "lane A")
    assert "skill shot" not in one.texts


def test_the_lanes_raise_the_bonus_and_light_the_kickback_which_works_once():
    one = bench()
    for lane in LANES:
        one.happen(EventKind.PASS, lane)
    assert one.keeper.counters["bonus factor"] == 2
    lamps = one.keeper.lamps
    assert (lamps["2x"], lamps["3x"], lamps["kickback"], lamps["A"]) == ("on", "off", "on", "off")
    one.happen(EventKind.PASS, "left outlane")
    assert one.keeper.lamps["kickback"] == "off"
    assert one.texts[-1] == "kickback"


def test_bumpers_raise_what_a_turn_of_the_spinner_pays():
    one = bench()
    left_orbit(one)

    def turn(b: Bench) -> None:
        b.happen(EventKind.SPIN, "spinner")

    turn(one)
    before = paid(one, turn)
    one.hit("left bumper", "right bumper", "lower bumper")
    assert paid(one, turn) == before + 3 * 10


def test_the_bonus_is_counted_out_times_its_factor():
    one = bench()
    for lane in LANES:
        one.happen(EventKind.PASS, lane)
    left_orbit(one)
    bonus = one.keeper.counters["bonus"]
    assert bonus > 0
    assert paid(one, lambda b: b.drain()) == 2 * bonus


# --- Shots


def test_a_ball_that_comes_round_an_orbit_has_shot_one_of_them_only():
    one = bench()
    one.happen(EventKind.PASS, "right orbit switch")
    one.wait(SECOND)
    one.happen(EventKind.PASS, "left orbit switch")
    one.happen(EventKind.SPIN, "spinner")
    assert "right orbit shot" in one.keeper.modes
    assert "left orbit shot" not in one.keeper.modes


def test_a_ball_that_falls_down_an_orbit_has_shot_nothing():
    one = bench()
    one.happen(EventKind.PASS, "left orbit switch")
    one.happen(EventKind.SPIN, "spinner")
    assert "left orbit shot" not in one.keeper.modes
    assert "combo" not in one.keeper.modes


def test_shots_in_a_row_pay_more_and_more():
    one = bench()
    ramp(one)
    first, second = paid(one, ramp), paid(one, ramp)
    assert second > first
    one.wait(5 * SECOND)
    ramp(one)
    assert paid(one, ramp) == first


# --- Missions


@pytest.mark.parametrize("mission", MISSIONS)
def test_a_mission_is_chosen_started_won_and_kept(mission: str):
    one = bench()
    win(one, mission)
    counters = one.keeper.counters
    assert (counters["finished"], counters["rank"]) == (1, 1)
    assert {one.keeper.lamps[lamp] for lamp in STARTS} == {"blinking"}
    assert not [name for name, lamp in one.keeper.lamps.items() if "arrow" in name and lamp != "off"]
    one.drain()
    assert one.keeper.lamps[MISSIONS[mission]] == "on"


def next_mission(mission: str) -> str:
    lamps = list(MISSIONS.values())
    return lamps[(lamps.index(MISSIONS[mission]) + 1) % len(lamps)]


@pytest.mark.parametrize("shot", [ramp, target, lambda one: one.hit("side target")])
def test_the_ramp_and_the_targets_at_the_sides_start_a_mission_with_a_ball_save(shot: object):
    one = bench()
    shot(one)  # type: ignore[operator]
    assert "storm of Mars" in one.keeper.modes
    assert {one.keeper.lamps[lamp] for lamp in STARTS} == {"off"}
    assert (one.keeper.lamps["kickback"], one.keeper.lamps["shoot again"]) == ("on", "blinking")
    one.drain()
    assert GameEventKind.BALL_SAVED.value in one.kinds


def test_a_mission_goes_on_with_the_next_ball():
    one = bench()
    target(one)
    one.wait(10 * SECOND)
    target(one)
    one.drain()
    next_ball(one)
    assert "storm of Mars" in one.keeper.modes
    one.happen(EventKind.HIT, "left target", ball=2)
    assert one.keeper.counters["goals"] == 2


def test_each_mission_pays_more_than_the_one_before():
    one = bench()
    first = paid(one, win, "chase the comet")
    assert paid(one, win, "birth of a star") > first
    assert one.keeper.counters["rank"] == 2


def test_a_ring_gives_time_for_the_next_one():
    one = bench()
    choose(one, "through the rings")
    ramp(one)
    one.wait(39 * SECOND)
    ramp(one)
    one.wait(9 * SECOND)
    assert "through the rings" in one.keeper.modes
    one.wait(3 * SECOND)
    assert "through the rings" not in one.keeper.modes


@pytest.mark.parametrize("mission", MISSIONS)
def test_a_mission_is_lost_after_40_s_and_another_one_is_next(mission: str):
    one = bench()
    choose(one, mission)
    ramp(one)
    one.wait(39 * SECOND)
    assert mission in one.keeper.modes
    one.wait(2 * SECOND)
    assert mission not in one.keeper.modes
    assert one.texts[-1] == "too late"
    assert one.keeper.lamps[MISSIONS[mission]] == "off"
    blinking = {name for name, lamp in one.keeper.lamps.items() if lamp == "blinking"}
    assert blinking == {next_mission(mission), "lock", *STARTS}
    assert one.keeper.counters["rank"] == 0


def test_two_missions_light_the_extra_ball_at_the_right_orbit():
    one = bench()
    win(one, "through the rings")
    assert one.keeper.lamps["extra ball"] == "off"
    win(one, "land on the moon")
    assert one.keeper.lamps["extra ball"] == "blinking"
    right_orbit(one)
    assert one.keeper.record["extra_balls"] == 1
    assert one.keeper.counters["extra balls won"] == 1
    one.drain()
    assert one.game.view.ball == 1  # the same ball again


def test_all_missions_light_the_wizard_mode_at_the_saucer():
    one = bench()
    for mission in MISSIONS:
        win(one, mission)
    assert one.keeper.lamps["wizard"] == "blinking"
    assert {one.keeper.lamps[lamp] for lamp in STARTS} == {"off"}
    assert one.keeper.counters["rank"] == 5
    end_multiball(one)  # the saucer, a shot of two missions, has locked two balls
    saucer(one)
    assert "silver comet" in one.keeper.modes
    assert one.keeper.record["balls"] == 3
    assert paid(one, ramp) >= 50_000 * 3
    one.wait(61 * SECOND)
    assert "silver comet" not in one.keeper.modes
    assert {one.keeper.lamps[lamp] for lamp in STARTS} == {"blinking"}
    assert one.keeper.counters["level"] == 2  # missions pay twice as much now
    assert [one.keeper.lamps[lamp] for lamp in MISSIONS.values()].count("blinking") == 1


# --- Locks and multiball


def with_multiball() -> Bench:
    one = bench()
    for _ in range(2):
        assert one.keeper.lamps["lock"] == "blinking"
        saucer(one)
    assert one.keeper.lamps["lock"] == "off"
    return one


def end_multiball(one: Bench) -> None:
    one.keeper.record["ball"][0]["id"], one.keeper.record["ball"][1]["id"] = 1, 2
    one.wait(30 * SECOND)
    one.drain(1)
    assert "multiball" not in one.keeper.modes


def test_two_locks_start_a_multiball_and_the_saucer_brings_the_third_ball():
    one = with_multiball()
    assert "multiball" in one.keeper.modes
    assert one.keeper.record["balls"] == 2
    saucer(one)
    assert one.keeper.record["balls"] == 3
    bank(one)
    assert one.keeper.lamps["lock"] == "off"  # not during a multiball


def test_the_orbits_are_jackpots_and_then_the_ramp_is_a_super_jackpot():
    one = with_multiball()
    assert paid(one, left_orbit) >= 2 * 30_000
    assert paid(one, left_orbit) < 30_000  # collected
    assert one.keeper.lamps["super jackpot"] == "off"
    assert paid(one, right_orbit) >= 2 * 30_000
    assert one.keeper.lamps["super jackpot"] == "blinking"
    assert paid(one, ramp) >= 2 * 200_000
    assert one.keeper.counters["super jackpots"] == 1
    lamps = one.keeper.lamps
    assert (lamps["left jackpot"], lamps["right jackpot"], lamps["super jackpot"]) == (
        "blinking",
        "blinking",
        "off",
    )


def test_a_multiball_ends_with_its_last_ball_but_one():
    one = with_multiball()
    end_multiball(one)
    assert one.keeper.counters["locks"] == 0
    assert one.keeper.lamps["left jackpot"] == "off"
    for lock in (1, 2):  # from now on the bank lights it, for one ball
        bank(one)
        assert one.keeper.lamps["lock"] == "blinking"
        saucer(one)
        assert one.keeper.lamps["lock"] == "off"
        assert one.keeper.counters["locks"] == lock
    assert one.keeper.counters["multiballs"] == 2


# --- The last chance


def test_the_last_ball_has_a_last_chance_after_its_ball_save():
    one = Bench(TABLE)
    for _ in range(2):
        one.wait(20 * SECOND)
        one.drain(one.keeper.record["ball"][0]["id"])
        next_ball(one)
    one.happen(EventKind.RELEASED, "plunger", int(one.keeper.record["ball"][0]["id"]))
    one.wait(10 * SECOND)
    one.drain(int(one.keeper.record["ball"][0]["id"]))
    assert one.texts[-1] == "last chance"
    assert GameEventKind.BALL_SAVED.value in one.kinds
    assert not one.game.is_over


def test_every_lamp_lies_on_the_playfield_and_apart_from_the_others():
    lamps = [lamp for lamp in TABLE.lamp if lamp.center is not None]
    assert len(lamps) == len(TABLE.lamp)
    for number, lamp in enumerate(lamps):
        assert abs(lamp.center[0]) < 0.5 * TABLE.board.length
        for other in lamps[:number]:
            away = max(abs(a - b) for a, b in zip(lamp.center, other.center, strict=True))
            assert away > 0.4, (lamp.name, other.name)
