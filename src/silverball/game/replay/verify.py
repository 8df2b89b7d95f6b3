"""Verification of replays: play one and compare it with its record, or play two and find where they differ.

`verify` compares the digests of every second and the end. `compare` plays two replays side by side and, in
the second in which they first differ, tick by tick, so that it reports the first tick, the field and both
values.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

from silverball.errors import SilverballError
from silverball.game.replay.digest import (
    CHARACTERS,
    GROUPS,
    differing_groups,
    full_digest,
    record_bytes,
    short_digests,
    values,
)
from silverball.game.replay.player import InputRefusedError, Playback, check_rules
from silverball.table import table_digest
from silverball.world.saved_world import world_bytes

if TYPE_CHECKING:
    from silverball.game.core import GameCore
    from silverball.game.replay.format import Replay
    from silverball.game.rules import Rules


class Verdict(NamedTuple):
    """The result of verifying a replay, or of comparing two.

    Attributes:
        ok: Whether nothing differs.
        score: The score of the game that was played, as far as it was played.
        tick: Everything was equal up to this tick; the difference arose between it and `seen`.
        seen: The tick at which the difference was found.
        field: The first field that differs; empty if none does.
        expected: Its value in the replay, or in the first of two replays.
        got: Its value in the game that was played, or in the second replay.
        message: The result in one sentence.

    Examples:
        >>> import silverball as sb
        >>> game = sb.Game("classic", seed=7)
        >>> game.create_ball()
        >>> game.step(ticks=120)
        >>> game.replay.verify().message
        'equal in all 120 ticks (0.5 s), score 0'
    """

    ok: bool
    score: int
    tick: int
    seen: int
    field: str = ""
    expected: str = ""
    got: str = ""
    message: str = ""


def verify(
    replay: Replay,
    progress: Callable[[int], None] = lambda _: None,
    on_second: Callable[[GameCore], None] = lambda _: None,
    *,
    rules: Rules | None = None,
) -> Verdict:
    """Play a replay and compare the result with the record.

    Args:
        replay: The replay.
        progress: Called after every second of play with the ticks so far.
        on_second: Called after every second of play, and at the end, with the game.
        rules: The rules that scored the game, if they are not built in.

    Returns:
        The verdict. A game that cannot be played, for example because its table is impossible, differs too.

    Raises:
        StateError: The rules are missing, or are not those of the replay.
    """
    check_rules(replay, rules)
    try:
        playback = Playback(replay, rules)
    except SilverballError as error:
        return _differs(0, 0, 0, "table", "a board that can be played", str(error).replace("\n", " "))
    game, rate = playback.game, replay.tick_rate
    for number, line in enumerate(replay.lines):
        before = game.tick
        try:
            playback.play(rate)
        except InputRefusedError as error:
            return _differs(game.score, game.tick, game.tick, "inputs", "the recorded ones", str(error))
        if game.tick != (number + 1) * rate:
            return _ended_early(playback)
        record = record_bytes(game.world, replay.physics)
        expected = line[: CHARACTERS * len(GROUPS)]
        got = short_digests(record, game.rules_text, replay.physics)
        if expected != got:
            return _differs_in_second(game.score, before, game.tick, expected, got)
        progress(game.tick)
        on_second(game)
    try:
        playback.play(replay.ticks - game.tick)
        playback.finish()
    except InputRefusedError as error:
        return _differs(game.score, game.tick, game.tick, "inputs", "the recorded ones", str(error))
    on_second(game)
    if game.tick != replay.ticks:
        return _ended_early(playback)
    equal_until = len(replay.lines) * rate
    record = record_bytes(game.world, replay.physics)
    ends = (
        ("ended", replay.ended, game.ended),
        ("score", str(replay.score), str(game.score)),
        ("digest", replay.digest, full_digest(record, game.rules_text)),
    )
    for field, expected, got in ends:
        if expected != got:
            return _differs(game.score, equal_until, game.tick, field, expected, got)
    return Verdict(True, game.score, game.tick, game.tick, message=_equal_message(replay))


def compare(first: Replay, second: Replay) -> Verdict:
    """Play two replays side by side and find the first tick at which they differ.

    Returns:
        The verdict: `expected` is the value of the first replay, `got` that of the second.

    Raises:
        StateError: A replay was scored by rules that are not built in.
    """
    heads = (
        ("mode", first.mode, second.mode),
        ("tick_rate", first.tick_rate, second.tick_rate),
        ("players", first.players, second.players),
        ("seed", first.seed, second.seed),
        ("table", table_digest(first.table), table_digest(second.table)),
    )
    for field, one, other in heads:
        if one != other:
            return _differs(0, 0, 0, field, str(one), str(other))
    plays = Playback(first), Playback(second)
    games = tuple(play.game for play in plays)
    while not (plays[0].at_end and plays[1].at_end):
        snapshots = [game.save() for game in games]
        start = games[0].tick
        _advance(plays, first.tick_rate)
        if _states(games[0]) == _states(games[1]) and plays[0].at_end == plays[1].at_end:
            continue
        for play, snapshot in zip(plays, snapshots, strict=True):
            play.jump(snapshot)
        for _ in range(first.tick_rate + 1):
            start = games[0].tick
            refused = _advance(plays, 1)
            verdict = _first_difference(plays, start, refused)
            if verdict is not None:
                return verdict
    return Verdict(
        True, games[0].score, games[0].tick, games[0].tick, message="both replays are the same game"
    )


def _advance(plays: tuple[Playback, Playback], ticks: int) -> list[str]:
    """Advance both; return for each the refusal of an input, or an empty text."""
    refused = []
    for play in plays:
        try:
            play.advance(ticks)
            refused.append("")
        except InputRefusedError as error:
            play.at_end = True
            refused.append(str(error))
    return refused


def _states(game: GameCore) -> tuple[bytes, str]:
    return world_bytes(game.world.records[0]), game.rules_text


def _first_difference(plays: tuple[Playback, Playback], tick: int, refused: list[str]) -> Verdict | None:
    """The verdict if two games differ that were equal before this tick; else None."""
    one, other = (play.game for play in plays)
    if _states(one) != _states(other):
        pairs = zip(
            values(one.world.records[0], one.rules_text),
            values(other.world.records[0], other.rules_text),
            strict=False,
        )
        for (field, expected), (path, got) in pairs:
            if field != path or repr(expected) != repr(got):
                name = field if field == path else f"{field} and {path}"
                return _differs(one.score, tick, one.tick, name, repr(expected), repr(got))
    if refused[0] != refused[1]:
        expected, got = (text or "accepted" for text in refused)
        return _differs(one.score, tick, one.tick, "inputs", expected, got)
    if plays[0].at_end != plays[1].at_end:
        ends = [f"{play.replay.ticks} ticks" for play in plays]
        return _differs(one.score, tick, one.tick, "ticks", *ends)
    return None


def _ended_early(playback: Playback) -> Verdict:
    """The verdict on a game that ended before the replay did."""
    game, replay = playback.game, playback.replay
    got = f"{game.tick} ({game.ended})"
    return _differs(game.score, game.tick, game.tick, "ticks", str(replay.ticks), got)


def _differs_in_second(score: int, before: int, seen: int, expected: str, got: str) -> Verdict:
    groups = differing_groups(expected, got)
    at = GROUPS.index(groups[0]) * CHARACTERS
    short = [text[at : at + CHARACTERS] for text in (expected, got)]
    verdict = _differs(score, before, seen, groups[0], *short)
    if len(groups) > 1:
        others = " and ".join(part for part in (", ".join(groups[1:-1]), groups[-1]) if part)
        verdict = verdict._replace(
            message=f"{verdict.message}; {others} differ{'s' * (len(groups) == 2)} too"
        )
    return verdict


def _differs(score: int, tick: int, seen: int, field: str, expected: str, got: str) -> Verdict:
    where = f"tick {seen}" if tick == seen else f"tick {seen} (equal up to tick {tick})"
    message = f"{where}, {field}: expected {expected}, got {got}"
    return Verdict(False, score, tick, seen, field, expected, got, message)


def _equal_message(replay: Replay) -> str:
    return f"equal in all {replay.ticks} ticks ({replay.seconds:.1f} s), score {replay.score}"
