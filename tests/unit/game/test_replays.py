"""Replays lead to the same game; everything else is refused in words."""

from __future__ import annotations

import os
import re
from dataclasses import replace
from pathlib import Path

import pytest
from games import IN_POCKET, POCKET, bare, bumper, frantic_game, put, reflex_game
from hypothesis import given, strategies as st

from boards import CLASSIC, PADDLES
from silverball.errors import StateError
from silverball.game.game import Game
from silverball.game.replay import recording
from silverball.game.replay.digest import GROUPS, OLDEST_PHYSICS
from silverball.game.replay.format import Replay
from silverball.game.replay.player import InputRefusedError, ReplayPlayer
from silverball.game.replay.reader import TEXT_LIMIT, checksum
from silverball.game.replay.verify import Verdict, compare, verify
from silverball.game.rules import RULES_VERSION
from silverball.game.view import GameEventKind, Mode
from silverball.physics import PHYSICS_VERSION
from silverball.table import Cylinder, generate_table

GAME = reflex_game(CLASSIC, 2, seconds=50.3)
REPLAY = GAME.replay
TEXT = REPLAY.to_text()
LINES = TEXT.split("\n")


def resealed(text: str) -> str:
    """The text with the checksum that belongs to it."""
    body = text[: text.rindex("checksum = ")]
    return f"{body}checksum = {checksum(body)}\n"


def line_of(text: str) -> int:
    return LINES.index(text)


inputs = st.lists(st.tuples(st.integers(0, 999), st.sampled_from("LR+!")), max_size=30)


@given(inputs)
def test_inputs_round_trip_through_their_line(given_inputs):
    ordered = sorted(given_inputs, key=lambda one: one[0])
    last, line = 0, ""
    for tick, kind in ordered:
        line += recording.format_input(kind, tick - last)
        last = tick
    assert [tuple(one) for one in recording.parse_inputs(line)] == ordered
    assert not line or recording.TAIL.fullmatch(f"= {line}")


@pytest.mark.parametrize(
    "game", [GAME, reflex_game(generate_table(4), 4, Mode.FREE, 12.3)], ids=["arcade", "free"]
)
def test_a_replay_round_trips_through_its_text_and_verifies(game: Game):
    replay = game.replay
    again = Replay.from_text(replay.to_text())
    assert again == replay
    assert again.to_text() == replay.to_text()
    verdict = verify(again)
    assert verdict.ok, verdict
    assert verdict.score == game.score > 0
    assert verdict.seen == game.tick


def test_a_replay_has_a_line_for_each_second_and_one_for_the_rest():
    play = LINES[line_of("--- play") + 1 : line_of("--- end")]
    assert len(play) == GAME.tick // 240 + 1
    assert play[-1].startswith("=")


def test_a_minute_of_play_takes_no_more_than_two_kilobytes():
    for game in (reflex_game("random", 1, seconds=60), frantic_game(1, seconds=60)):
        text = game.replay.to_text()
        play = text[text.index("--- play") : text.index("--- end")]
        assert len(play.encode()) / (game.tick / 240 / 60) <= 2000


@pytest.mark.parametrize("ticks", [0, 1, 239, 240, 241, 480])
def test_games_of_any_length_can_be_played_again(ticks: int):
    game = Game("classic", 3)
    game.create_ball()
    game.step(ticks=ticks)
    game.jitter()
    assert verify(Replay.from_text(game.replay.to_text())).ok
    game.end()
    replay = Replay.from_text(game.replay.to_text())
    assert replay.ended == "stopped"
    assert verify(replay).ok


@pytest.mark.parametrize("rate", [10, 37, 60, 1000])
def test_games_of_any_tick_rate_can_be_played_again(rate: int):
    game = Game("classic", 3, tick_rate=rate)
    game.create_ball()
    for left, right, ticks in ((True, False, 3 * rate), (False, True, rate - 1), (False, False, 2 * rate)):
        game.step(left, right, ticks)
    replay = Replay.from_text(game.replay.to_text())
    assert (replay.tick_rate, replay.ticks) == (rate, 6 * rate - 1)
    assert verify(replay).ok


def test_a_replay_whose_last_inputs_come_after_its_last_tick_needs_them():
    game = Game("classic", 3)
    game.create_ball()
    assert verify(game.replay).ok
    assert verify(replace(game.replay, tail="")).field == "digest"


def test_the_fault_of_a_world_is_played_again_as_far_as_it_went():
    replay = replace(REPLAY, ended="outside")
    verdict = verify(replay)
    assert (verdict.field, verdict.expected, verdict.got) == ("ended", "outside", "running")


def test_a_changed_input_is_found_in_its_second():
    number, line = next((n, line) for n, line in enumerate(REPLAY.lines) if re.search(r" .*[b-y]$", line))
    changed = line[:-1] + chr(ord(line[-1]) + 1)
    lines = (*REPLAY.lines[:number], changed, *REPLAY.lines[number + 1 :])
    verdict = verify(replace(REPLAY, lines=lines))
    assert not verdict.ok
    assert (verdict.tick, verdict.seen) == (number * 240, (number + 1) * 240)
    assert verdict.field in GROUPS
    assert f"tick {verdict.seen}" in verdict.message
    compared = compare(REPLAY, replace(REPLAY, lines=lines))
    assert verdict.tick <= compared.tick < compared.seen <= verdict.seen
    assert compared.seen == compared.tick + 1
    assert compared.expected != compared.got
    assert "rules" in compared.field or "paddle" in compared.field


@pytest.mark.parametrize("number", range(len(GROUPS)))
def test_a_changed_digest_is_named_with_its_group(number: int):
    line = REPLAY.lines[7]
    at = 2 * number
    other = "A" if line[at] != "A" else "B"
    lines = (*REPLAY.lines[:7], line[:at] + other + line[at + 1 :], *REPLAY.lines[8:])
    verdict = verify(replace(REPLAY, lines=lines))
    assert (verdict.field, verdict.tick, verdict.seen) == (GROUPS[number], 7 * 240, 8 * 240)
    assert (verdict.expected, verdict.got) == (other + line[at + 1], line[at : at + 2])


def test_a_wrong_score_is_reported():
    text = resealed(TEXT.replace(f"score = {GAME.score}\n", f"score = {GAME.score + 1}\n"))
    verdict = verify(Replay.from_text(text))
    assert (verdict.field, verdict.expected, verdict.got) == ("score", str(GAME.score + 1), str(GAME.score))
    assert verdict.score == GAME.score


def test_a_longer_replay_than_its_game_says_when_the_game_ended():
    game = Game(bare(balls=1, ball_save=0.0))
    game.create_ball()
    game.step(ticks=1000)
    assert game.is_over
    longer = replace(game.replay, ticks=game.tick + 10)
    verdict = verify(longer)
    assert (verdict.field, verdict.expected) == ("ticks", str(game.tick + 10))
    assert verdict.got == f"{game.tick} (over)"


@pytest.mark.parametrize(
    ("extra", "reason"), [("+a+a+a", "no ball is left|already holds"), ("!a!a", "shoved")]
)
def test_an_input_that_the_rules_refuse_is_named_with_its_tick(extra: str, reason: str):
    lines = (f"{REPLAY.lines[0]}", f"{REPLAY.lines[1][:12]} {extra}", *REPLAY.lines[2:])
    verdict = verify(replace(REPLAY, lines=lines))
    assert verdict.field == "inputs"
    assert (verdict.tick, verdict.seen) == (240, 240)
    assert re.search(reason, verdict.got)
    assert compare(REPLAY, replace(REPLAY, lines=lines)).field


def test_two_replays_of_different_boards_differ_in_the_header():
    other = replace(REPLAY, seed=REPLAY.seed + 1)
    assert compare(REPLAY, other) == Verdict(
        False, 0, 0, 0, "seed", "2", "3", "tick 0, seed: expected 2, got 3"
    )
    assert compare(REPLAY, replace(REPLAY, table=generate_table(1))).field == "table"
    assert compare(REPLAY, REPLAY).ok


def test_a_shorter_replay_of_the_same_game_differs_where_it_ends():
    count = 5
    shorter = replace(REPLAY, lines=REPLAY.lines[:count], tail="", ticks=count * 240)
    verdict = compare(REPLAY, shorter)
    assert (verdict.field, verdict.tick) == ("ticks", count * 240 - 1)


def test_a_game_ends_when_its_recording_is_full(monkeypatch):
    monkeypatch.setattr(recording, "SECONDS_LIMIT", 3)
    game = Game(bare(*POCKET))
    game.create_ball()
    put(game, *IN_POCKET)
    game.step(ticks=5000)
    assert (game.tick, game.ended) == (3 * 240, "stopped")


def test_a_replay_of_a_table_with_a_mesh_needs_no_other_file(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    post = trimesh.creation.cylinder(radius=0.6, height=1.0)
    post.apply_transform([[1, 0, 0, 2.0], [0, 0, 1, 0], [0, 1, 0, 1.0], [0, 0, 0, 1]])
    post.export(tmp_path / "post.stl")
    game = Game(bare(Cylinder(mesh=str(tmp_path / "post.stl"))))
    game.create_ball()
    game.step(ticks=300)
    text = game.replay.to_text()
    (tmp_path / "post.stl").unlink()
    assert verify(Replay.from_text(text)).ok


def states(replay: Replay, ticks: list[int]) -> dict[int, str]:
    """The digests at some ticks, played straight on."""
    player = ReplayPlayer(replay)
    seen = {}
    for tick in sorted(set(ticks)):
        player.advance(tick - player.tick)
        seen[tick] = player.game.digest()
    return seen


def test_playing_reaches_the_recorded_end():
    player = ReplayPlayer(REPLAY)
    assert (player.tick, player.ticks, player.at_end) == (0, REPLAY.ticks, False)
    player.advance(REPLAY.ticks + 1000)
    assert (player.tick, player.at_end) == (REPLAY.ticks, True)
    assert player.game.digest() == REPLAY.digest
    player.advance(10)
    assert player.tick == REPLAY.ticks


def test_seeking_anywhere_shows_the_same_moment_as_playing_there():
    ticks = [
        5000,
        17,
        960,
        961,
        959,
        8000,
        7999,
        0,
        240,
        11_999,
        3,
        REPLAY.ticks,
        4800,
        4801,
        REPLAY.ticks - 1,
    ]
    expected = states(REPLAY, ticks)
    player = ReplayPlayer(REPLAY)
    game = player.game
    for tick in ticks:
        player.seek(tick)
        assert player.tick == tick
        assert player.game is game
        assert game.digest() == expected[tick], tick
        assert game.take_world_events() == []
    player.seek(-5)
    assert player.tick == 0
    player.seek(10**9)
    assert player.at_end
    player.seek(100)
    player.advance(REPLAY.ticks)
    assert game.digest() == REPLAY.digest


def test_a_button_that_is_held_stays_held_after_seeking():
    game = Game(bare(*PADDLES, *POCKET))
    game.create_ball()
    put(game, *IN_POCKET)
    game.step(True, False, 6 * 240)
    game.step(False, False, 240)
    player = ReplayPlayer(game.replay)
    expected = states(player.replay, [1100, 1500])
    player.seek(1500)
    player.seek(1100)
    assert player.game.held == (True, False)
    assert player.game.digest() == expected[1100]
    player.advance(400)
    assert player.game.held == (False, False)
    assert player.game.digest() == expected[1500]


def test_preparing_plays_ahead_in_the_background():
    player = ReplayPlayer(REPLAY)
    shares = []
    while not shares or shares[-1] < 1.0:
        shares.append(player.prepare(1000))
    assert shares == sorted(shares)
    assert len(shares) >= REPLAY.ticks // 1000
    assert player.tick == 0
    player.seek(9000)
    assert player.game.digest() == states(REPLAY, [9000])[9000]


def test_watching_gives_the_events_of_the_game():
    game = Game(bare(bumper(), *POCKET), 5)
    game.create_ball()
    game.step(True, False, 700)
    player = ReplayPlayer(game.replay)
    player.advance(700)
    events = game.take_game_events()
    assert GameEventKind.BALL_READY in [one.kind for one in events]
    assert player.game.take_game_events() == events
    assert player.game.take_world_events() == game.take_world_events()


def test_watching_a_replay_of_another_game_stops_with_a_sentence():
    player = ReplayPlayer(replace(REPLAY, lines=(f"{REPLAY.lines[0][:12]} !a", *REPLAY.lines[1:])))
    with pytest.raises(InputRefusedError, match="tick 0: a shove was recorded, but there is no ball"):
        player.advance(240)


def changed(line: int, to: str) -> str:
    """The replay with one line changed, and the checksum put right."""
    return resealed("\n".join([*LINES[:line], to, *LINES[line + 1 :]]))


PLAY, END = line_of("--- play"), line_of("--- end")
REFUSED = {
    "empty": ("", "the file is empty"),
    "foreign": ('{"format": 1}\n', r"line 1: this is not a replay: it begins with '\{"),
    "newer format": (TEXT.replace("replay 1", "replay 4", 1), "line 1: .*format 4.*newer Silverball"),
    "newer physics": (changed(2, "physics = 999"), "line 3: .*physics 999.*newer Silverball"),
    "older physics": (changed(2, "physics = 0"), r"line 3: .*physics 0.*play it with Silverball \d"),
    "newer rules": (changed(3, "rules = 99"), "line 4: .*rules 99.*newer Silverball"),
    "physics no number": (
        changed(2, "physics = nan"),
        f"line 3: expected an integer from {OLDEST_PHYSICS} to {PHYSICS_VERSION}, got 'nan'",
    ),
    "rules no number": (changed(3, f"rules = {'9' * 400}"), f"line 4: expected {RULES_VERSION}, got '9999"),
    "leading zero": (changed(5, "seed = 02"), "line 6: expected an integer from 0 to 92.*got '02'"),
    "unknown mode": (changed(4, "mode = chess"), "line 5: expected one of free, arcade, got 'chess'"),
    "seed too large": (changed(5, f"seed = {2**63}"), "line 6: expected an integer from 0 to 92"),
    "seed no number": (changed(5, "seed = -1"), "line 6: expected an integer"),
    "absurd tick rate": (changed(6, "tick_rate = 999999"), "line 7: expected an integer from 10 to 1000"),
    "table digest": (changed(7, "table = abc"), "line 8: expected 64 hexadecimal digits, got 'abc'"),
    "no such key": (changed(5, "sead = 1"), "line 6: expected 'seed = …', got 'sead = 1'"),
    "extra head": (changed(7, f"{LINES[7]}\nmore = 1"), "line 9: expected '--- table'"),
    "edited": (
        TEXT.replace(LINES[PLAY + 3], LINES[PLAY + 3] + "b"),
        r"line \d+: the text was changed or damaged",
    ),
    "cut off in play": ("\n".join(LINES[: PLAY + 5]), "cut off or damaged: there is no line '--- end'"),
    "cut off in the table": ("\n".join(LINES[:12]), "there is no line '--- play'"),
    "cut off at the end": ("\n".join(LINES[:-2]) + "\n", "the last lines are missing"),
    "bad checksum": (TEXT[:-10] + "zzz\n", r"expected 'checksum = ' and 32 hexadecimal digits"),
    "more behind": (TEXT + "more\n", "more text after the checksum"),
    "another table": (changed(10, "name = 'Other'"), "line 10: this is not the table that was played"),
    "table nonsense": (changed(9, "name = ]"), "line 10: the table is not valid TOML"),
    "table unusable": (changed(9, "nome = 'x'"), "line 10: the table cannot be used: nome: unknown key"),
    "table recipe": (changed(PLAY - 1, LINES[PLAY - 1] + "\n[random]"), "line 10: the table is a recipe"),
    "table deep": (changed(9, "x = " + "[" * 5000), "nested too deeply|not valid TOML"),
    "table mesh": (changed(9, "[[cylinder]]\nmesh = '/etc/passwd'"), "names a mesh"),
    "table parts": (
        changed(9, "[[slant_wall]]\nstart=[0,0]\nend=[1,1]\n" * 5000),
        "at most 4,096|at most 4096",
    ),
    "billion ticks": (changed(END + 1, "ticks = 1000000000"), "expected an integer from 0 to 20736240"),
    "other ticks": (changed(END + 1, "ticks = 240"), rf"line {PLAY + 2}: 240 ticks need 1 lines, .* got"),
    "unknown end": (changed(END + 3, "ended = won"), "expected one of running, over, stopped"),
    "score": (changed(END + 2, "score = 1e5"), "expected an integer from 0"),
    "a line gone": (changed(PLAY + 4, LINES[PLAY + 4] + "\n" + LINES[PLAY + 4]), "ticks need"),
    "bad line": (changed(PLAY + 4, "abc"), rf"line {PLAY + 5}: expected 12 characters of digests"),
    "bad inputs": (changed(PLAY + 4, LINES[PLAY + 4][:12] + " 0a"), "expected inputs like"),
    "capital mark": (changed(PLAY + 4, LINES[PLAY + 4][:12] + " +A"), "expected inputs like"),
    "late inputs": (changed(PLAY + 4, LINES[PLAY + 4][:12] + " 9999a"), "up to tick 239 of the second"),
    "surrogates": (changed(9, "name = '\ud800'"), "line 10"),
    "huge number": (changed(5, "seed = " + "9" * 5000), "line 6: expected an integer"),
    "digits of elsewhere": (changed(5, "seed = ٣"), "line 6: expected an integer"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_played_is_refused_in_one_sentence_that_says_where(name: str):
    text, message = REFUSED[name]
    with pytest.raises(StateError, match=message) as caught:
        Replay.from_text(text, "game.replay")
    said = str(caught.value)
    assert said.startswith("game.replay")
    assert "\n" not in said
    assert len(said) < 400


def test_no_two_kinds_of_damage_give_the_same_sentence():
    said = {}
    for name, (text, _) in REFUSED.items():
        with pytest.raises(StateError) as caught:
            Replay.from_text(text)
        said[name] = str(caught.value)
    assert sorted(set(said.values())) == sorted(said.values())


@pytest.mark.parametrize("start", range(7))
def test_a_file_that_is_cut_off_anywhere_is_refused(start: int):
    for end in range(start, len(TEXT) - 1, 7):
        with pytest.raises(StateError):
            Replay.from_text(TEXT[:end])


def test_an_endless_text_is_refused_without_reading_it():
    with pytest.raises(StateError, match=f"at most {TEXT_LIMIT:,} characters, this has 100,000,000"):
        Replay.from_text("x" * 10**8)


def test_windows_line_ends_are_accepted():
    assert Replay.from_text(TEXT.replace("\n", "\r\n")) == REPLAY


def test_files_that_are_not_replays_are_refused(tmp_path: Path):
    good = tmp_path / "good.replay"
    good.write_text(TEXT, encoding="utf-8")
    assert Replay.load(good) == REPLAY
    (tmp_path / "latin.replay").write_bytes(b"silverball replay 1\nprogram = caf\xe9\n")
    with open(tmp_path / "huge.replay", "wb") as file:
        file.truncate(100 * 10**6)
    os.mkfifo(tmp_path / "pipe.replay")
    for name, message in {
        "latin.replay": "not UTF-8 text .byte 34",
        "huge.replay": "100,000,000 bytes long",
        "pipe.replay": "not a regular file",
        "missing.replay": "no such file",
        ".": "a folder",
        "a\0b": "cannot be read",
    }.items():
        with pytest.raises(StateError, match=message):
            Replay.load(os.path.join(tmp_path, name))
