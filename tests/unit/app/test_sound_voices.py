"""The notes of events: strengths, panning, steps of the scale, and limits."""

from __future__ import annotations

import math
import re
from itertools import pairwise
from pathlib import Path

import pytest

from silverball.app.sound.calls import CALLS, CUES, seconds_of
from silverball.app.sound.levels import FULL_SPEED, pan, strength_of
from silverball.app.sound.rolling import _SILENT, LANES, ROLL_SPEEDS, Rolling
from silverball.app.sound.synth import BELL_STEPS
from silverball.app.sound.voices import (
    MAX_AT_ONCE,
    MAX_NEW,
    MENU,
    REPEAT_SECONDS,
    RUN_SECONDS,
    Voices,
    step_of,
)
from silverball.game.view import GameEvent, GameEventKind
from silverball.table import Cylinder, SlantWall, Table, TriangularPrism, load_table
from silverball.table.rulebook import PlayMode
from silverball.world.events import Event

RATE, WIDTH = 240, 10.0
TABLE = Table(
    name="Every kind of part",
    paddle=load_table("classic").paddle,
    slant_wall=tuple(SlantWall(start=(0.0, 0.0), end=(1.0, 0.0)) for _ in range(8)),
    triangular_prism=tuple(TriangularPrism(vertices=((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))) for _ in range(8)),
    cylinder=tuple(Cylinder(center=(0.0, 0.0), radius=1.0) for _ in range(8)),
)
FRAME = 1.0 / 60.0


def event(kind="hit", part="board.left", *, ball=1, tick=0, z=0.0, speed=10.0) -> Event:
    return Event(kind, part, ball, tick, 0.0, (0.0, 1.0, z), (1.0, 0.0, 0.0), speed)


def notes_of(*events: Event, voices: Voices | None = None):
    return (voices or Voices(TABLE)).world_events(events, RATE, WIDTH)


def strength(note) -> float:
    return math.hypot(note.left, note.right)


# --- hits -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kind", "part", "name"),
    [
        ("hit", "board.top", "wall"),
        ("hit", "slant_wall[3]", "slant_wall"),
        ("hit", "triangular_prism[0]", "prism"),
        ("hit", "cylinder[2]", "cylinder"),
        ("hit", "paddle.right", "paddle_hit"),
        ("ball_hit", "ball", "balls"),
        ("created", "", "created"),
        ("gutter", "gutter", "drain"),
        ("jitter", "", "shove"),
    ],
)
def test_every_event_has_its_sound(kind, part, name):
    (note,) = notes_of(event(kind, part))
    assert note.key.name == name


def test_every_part_of_a_real_game_is_heard():
    import silverball as sb

    table = sb.generate_table(seed=7)
    world = sb.World(table, seed=7)
    kinds, heard = set(), set()
    voices = Voices(TABLE)
    for tick in range(240 * 20):
        if len(world.balls) < 2:
            world.create_ball()
            voices.world_events(world.events[-1:], RATE, WIDTH)
        world.step(left=tick % 100 < 40, right=tick % 130 < 50)
        for one in world.events:
            if one.kind in ("hit", "ball_hit") and one.speed > 3.0:
                kinds.add(one.part.partition("[")[0].partition(".")[0])
        heard |= {note.key.name for note in voices.world_events(world.events, RATE, WIDTH)}
    sound = {"board": "wall", "triangular_prism": "prism", "paddle": "paddle_hit", "ball": "balls"}
    assert len(kinds) >= 5
    assert {sound.get(kind, kind) for kind in kinds} <= heard


def test_a_harder_hit_is_louder_up_to_full_speed():
    strengths = [strength_of(speed) for speed in (0.0, 0.5, 1.0, 4.0, 12.0, FULL_SPEED, 40.0)]
    assert strengths == sorted(strengths)
    assert strengths[0] == 0.0
    assert strengths[-2:] == [1.0, 1.0]
    assert 20.0 * math.log10(strength_of(8.0) / strength_of(4.0)) == pytest.approx(4.2, abs=0.05)
    heard = [strength(notes_of(event(speed=speed))[0]) for speed in (1.0, 4.0, 12.0)]
    assert heard == sorted(heard)


def test_a_hard_hit_has_another_layer_than_a_soft_one():
    assert [notes_of(event(speed=speed))[0].key.layer for speed in (1.0, 15.0)] == [0, 1]


@pytest.mark.parametrize("z", [-5.0, -2.0, 0.0, 1.0, 5.0])
def test_power_is_the_same_wherever_a_hit_is_heard(z):
    left, right = pan(z, WIDTH)
    assert left**2 + right**2 == pytest.approx(1.0)
    assert math.copysign(1.0, right - left + 1e-12) == math.copysign(1.0, z)


def test_left_is_left_and_nothing_is_heard_in_one_ear_only():
    left, right = pan(-5.0, WIDTH)
    assert left > 4.0 * right > 0.0
    assert pan(5.0, WIDTH) == pytest.approx((right, left))
    assert pan(-50.0, WIDTH) == (left, right)


def test_a_touch_is_silent_or_very_soft():
    assert notes_of(event("touch", speed=0.05)) == []
    (note,) = notes_of(event("touch", speed=0.45))
    assert strength(note) < 0.1


def test_a_touched_cylinder_does_not_ring_as_one_that_kicks():
    (kick,) = notes_of(event("hit", "cylinder[0]", speed=0.6))
    (touch,) = notes_of(event("touch", "cylinder[0]", speed=0.4))
    assert strength(kick) > 4.0 * strength(touch)


def test_blows_in_a_row_take_turns_of_the_variations():
    voices = Voices(TABLE)
    keys = [notes_of(event(tick=240 * number), voices=voices)[0].key for number in range(6)]
    assert all(one != other for one, other in pairwise(keys))


def test_a_shove_of_two_balls_is_heard_once():
    notes = notes_of(event("jitter", "", ball=1), event("jitter", "", ball=2))
    assert len(notes) == 1


# --- runs ---------------------------------------------------------------------------------------------


def steps(voices: Voices, ticks, part="cylinder[0]") -> list[int]:
    return [notes_of(event(part=part, tick=tick), voices=voices)[0].key.layer for tick in ticks]


def test_hits_in_a_row_climb_the_scale():
    gap = round(0.5 * RUN_SECONDS * RATE)
    assert steps(Voices(TABLE), range(0, 10 * gap, gap)) == list(range(10))


def test_a_run_ends_when_the_next_hit_is_late():
    late = round(1.1 * RUN_SECONDS * RATE)
    assert steps(Voices(TABLE), [0, 100, 200, 200 + late]) == [0, 1, 2, 0]


def test_prisms_climb_too_but_walls_do_not():
    voices = Voices(TABLE)
    notes_of(event(part="triangular_prism[1]", tick=0), event(part="board.left", tick=50), voices=voices)
    assert steps(voices, [100]) == [1]


def test_the_game_knows_better_how_many_hits_were_in_a_row():
    voices = Voices(TABLE)
    assert steps(voices, [0]) == [0]
    voices.game_events([GameEvent(GameEventKind.COMBO, 100, 7)])
    assert steps(voices, [100, 150]) == [6, 7]


def test_a_long_run_goes_round_the_upper_octave():
    assert [step_of(run) for run in range(1, 21)] == [*range(10), *range(5, 10), *range(5, 10)]
    assert max(step_of(run) for run in range(1000)) < BELL_STEPS


def test_another_game_begins_at_the_bottom_of_the_scale():
    voices = Voices(TABLE)
    assert steps(voices, [0, 100]) == [0, 1]
    voices.begin_game(TABLE)
    assert steps(voices, [150]) == [0]


# --- limits -------------------------------------------------------------------------------------------


def test_of_many_hits_in_a_frame_the_loudest_are_heard():
    events = [event(part=f"cylinder[{number}]", ball=number, speed=1.0 + number) for number in range(12)]
    events += [event("ball_hit", "ball", ball=99, speed=21.0)]
    notes = notes_of(*events)
    assert len(notes) == MAX_NEW
    assert notes[0].key.name == "balls"


def test_the_hits_of_a_frame_never_add_up_to_more_than_fits():
    notes = notes_of(*(event(part=f"slant_wall[{number}]", ball=number, speed=22.0) for number in range(4)))
    assert sum(map(strength, notes)) == pytest.approx(MAX_AT_ONCE)


def test_a_ball_that_rattles_in_a_corner_gets_softer_and_makes_no_storm():
    voices = Voices(TABLE)
    frames = []
    for frame in range(60):
        events = [
            event(part=f"board.{('left', 'top')[tick % 2]}", tick=tick, speed=6.0)
            for tick in range(4 * frame, 4 * frame + 4)
        ]
        frames.append(notes_of(*events, voices=voices))
    notes = [note for frame in frames for note in frame]
    assert len(notes) <= 2 / REPEAT_SECONDS + 2  # two walls for a second
    assert strength(notes[-1]) < 0.3 * strength(notes[0])


def test_a_much_harder_hit_on_the_same_part_is_heard_at_once():
    notes = notes_of(event(speed=1.0, tick=0), event(speed=15.0, tick=2))
    assert len(notes) == 2


def test_a_world_that_begins_again_is_heard_again():
    voices = Voices(TABLE)
    notes_of(event(tick=100_000), voices=voices)
    assert len(notes_of(event(tick=1), voices=voices)) == 1


# --- paddles ------------------------------------------------------------------------------------------


def names(notes) -> list[str]:
    return [f"{note.key.name} {'left' if note.left > note.right else 'right'}" for note in notes]


def test_a_button_pulls_the_coil_and_the_paddle_reaches_its_stop_after_its_stroke():
    voices = Voices(TABLE)
    voices.begin_game(
        Table.model_validate({"paddle": [{"side": "left", "pivot": [-7.0, -2.5], "stroke": 0.05}]})
    )
    assert names(voices.buttons(True, False)) == ["coil left"]
    assert voices.buttons(True, False) == []
    assert voices.advance(0.04) == []
    (stop,) = voices.advance(0.04)
    assert names([stop]) == ["stop left"]
    assert stop.ago == pytest.approx(0.03)
    assert voices.advance(10.0) == []


def test_a_paddle_that_falls_back_stops_more_softly():
    voices = Voices(TABLE)
    voices.buttons(False, True)
    (up,) = voices.advance(1.0)
    voices.buttons(False, False)
    (back,) = voices.advance(1.0)
    assert names([up, back]) == ["stop right", "stop right"]
    assert strength(back) < 0.7 * strength(up)
    assert (up.key.layer, back.key.layer) == (1, 0)


def test_a_button_let_go_halfway_makes_only_the_way_back():
    voices = Voices(TABLE)
    voices.buttons(True, False)
    voices.advance(0.03)
    voices.buttons(False, False)
    (back,) = voices.advance(0.05)
    assert back.ago == pytest.approx(0.02)


def test_a_table_without_a_paddle_has_no_coil_on_that_side():
    voices = Voices(TABLE)
    voices.begin_game(load_table("classic").model_copy(update={"paddle": ()}))
    assert voices.buttons(True, True) == []
    assert voices.advance(1.0) == []


def test_dead_paddles_are_silent_until_the_next_ball():
    voices = Voices(TABLE)
    voices.game_events([GameEvent(GameEventKind.TILT, 5)])
    assert voices.buttons(True, True) == []
    voices.buttons(False, False)
    voices.game_events([GameEvent(GameEventKind.BALL_READY, 500, 2)])
    assert names(voices.buttons(True, True)) == ["coil left", "coil right"]


# --- news and menus -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kind", "name"),
    [
        (GameEventKind.BALL_SAVED, "ball_saved"),
        (GameEventKind.WARNING, "warning"),
        (GameEventKind.TILT, "tilt"),
        (GameEventKind.UNSTUCK, "unstuck"),
        (GameEventKind.DOUBLE_ON, "double_on"),
        (GameEventKind.OVER, "game_over"),
    ],
)
def test_news_has_its_sound(kind, name):
    (note,) = Voices(TABLE).game_events([GameEvent(kind, 1)])
    assert note.key.name == name
    assert note.left == pytest.approx(note.right)


def test_points_alone_make_no_sound_of_their_own():
    quiet = [
        GameEventKind.SCORED,
        GameEventKind.COMBO,
        GameEventKind.BALL_READY,
        GameEventKind.BALL_LOST,
        GameEventKind.DOUBLE_OFF,
    ]
    assert Voices(TABLE).game_events([GameEvent(kind, 1) for kind in quiet]) == []


def test_menus_have_their_sounds_and_anything_else_is_silent():
    voices = Voices(TABLE)
    assert [voices.menu(what)[0].key.name for what in MENU] == list(MENU.values())
    assert voices.menu("dance") == []


# --- rolling ------------------------------------------------------------------------------------------


def rolled(speed: float, seconds: float = 2.0, z: float = 0.0):
    rolling = Rolling()
    for _ in range(round(seconds / FRAME)):
        gains = rolling.update([(1, 0.0, z, speed)], FRAME, WIDTH)
    return gains


def power(gains) -> float:
    return sum(left**2 + right**2 for left, right in gains.values())


def test_a_ball_that_lies_still_is_silent():
    assert rolled(0.0) == {}
    assert rolled(0.1) == {}


@pytest.mark.parametrize("number", range(len(ROLL_SPEEDS)))
def test_a_speed_of_a_loop_plays_that_loop_alone(number):
    (one,) = rolled(ROLL_SPEEDS[number] * (1.0 + 1e-9))
    assert one == (0, number)


def test_a_faster_ball_is_louder_and_higher():
    speeds = [0.5, 1.5, 4.0, 9.0, 18.0]
    powers = [power(rolled(speed)) for speed in speeds]
    middles = [max(rolled(speed).items(), key=lambda item: sum(item[1]))[0][1] for speed in speeds]
    assert powers == sorted(powers)
    assert middles == sorted(middles)


def test_between_two_loops_the_power_stays_even():
    low, high = ROLL_SPEEDS[5], ROLL_SPEEDS[6]
    middle = rolled(math.sqrt(low * high))
    assert {loop for _, loop in middle} == {5, 6}
    assert sum(middle[0, 5]) == pytest.approx(sum(middle[0, 6]), rel=1e-6)
    assert power(rolled(low)) < power(middle) < power(rolled(high))


def test_rolling_follows_the_ball_across_the_table():
    ((left, right),) = rolled(ROLL_SPEEDS[4], z=-4.0).values()
    assert left > 2.0 * right


def test_nothing_jumps_when_a_ball_comes_bounces_and_goes():
    rolling = Rolling()
    speeds = [0.0] * 5 + [18.0] * 30 + [1.0] * 30 + [22.0] * 30 + [None] * 90
    before: dict = {}
    for speed in speeds:
        gains = rolling.update([] if speed is None else [(1, 0.0, 0.0, speed)], FRAME, WIDTH)
        change = max(
            (abs(gains.get(key, (0.0, 0.0))[0] - before.get(key, (0.0, 0.0))[0]) for key in gains | before),
            default=0.0,
        )
        assert change <= 0.25 + _SILENT  # of its way, or the whole of the little that is left
        before = gains
    assert before == {}


def test_every_ball_has_a_lane_and_there_are_never_more():
    rolling = Rolling()
    for frame in range(100):
        balls = [(frame + number, 0.0, 0.0, 10.0) for number in range(20)]
        gains = rolling.update(balls, FRAME, WIDTH)
    assert len({lane for lane, _ in gains}) <= LANES
    assert len(gains) <= LANES * len(ROLL_SPEEDS)


# --- calls ------------------------------------------------------------------------------------------


def called(voices: Voices, *events: tuple[GameEventKind, str]) -> list[str]:
    """The calls of a frame's events."""
    notes = voices.game_events([GameEvent(kind, 1, 0, part) for kind, part in events])
    return [note.key.name for note in notes if note.key.name in CALLS]


def cue(name: str) -> tuple[GameEventKind, str]:
    return GameEventKind.CUE, name


@pytest.mark.parametrize(
    ("name", "call"),
    [
        ("jackpot", "jackpot"),
        ("Jackpot, left", "jackpot"),
        ("super jackpot", "super_jackpot"),
        ("super jackpot lit", "lit"),
        ("mission lost", "mission_lost"),
        ("mission won", "mission_won"),
        ("mission", "mission_start"),
        ("lost", "mission_lost"),
        ("rainbow", ""),
        ("jackpots", ""),
    ],
)
def test_a_cue_plays_the_call_whose_words_are_in_it(name, call):
    assert called(Voices(TABLE), cue(name)) == ([call] if call else [])


def test_every_call_is_played_by_a_cue_and_every_cue_plays_a_call():
    assert {call for _, call in CUES} == CALLS.keys()


def test_events_of_the_game_have_calls():
    for kind, call in (
        (GameEventKind.EXTRA_BALL, "extra_ball"),
        (GameEventKind.MULTIBALL, "multiball"),
        (GameEventKind.BALL_LOCKED, "lock"),
    ):
        assert called(Voices(TABLE), (kind, "")) == [call]


def test_a_mission_that_starts_is_called_and_a_short_mode_is_not():
    table = TABLE.replace(mode=(PlayMode(name="long", seconds=40.0), PlayMode(name="short", seconds=3.0)))
    voices = Voices(table)
    assert called(voices, (GameEventKind.MODE_STARTED, "short")) == []
    assert called(voices, (GameEventKind.MODE_STARTED, "long")) == ["mission_start"]


def test_of_several_calls_the_highest_is_heard_and_no_lower_one_while_it_sounds():
    voices = Voices(TABLE)
    assert called(voices, cue("combo"), cue("super jackpot"), cue("jackpot")) == ["super_jackpot"]
    assert called(voices, cue("jackpot")) == []
    voices.advance(seconds_of("super_jackpot") + 0.1)
    assert called(voices, cue("jackpot")) == ["jackpot"]
    assert called(voices, cue("super jackpot")) == ["super_jackpot"]


def test_the_page_about_sound_has_every_cue_with_its_call():
    page = (Path(__file__).parents[3] / "docs" / "sound.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| ([a-z; ]+) \| `(\w+)` \|$", page, re.MULTILINE)
    assert {(words, call) for cell, call in rows for words in cell.split("; ")} == set(CUES)
