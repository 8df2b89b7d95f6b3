"""What a page needs of a replay: its inputs, and the digests to compare with.

The page plays the game itself, rules and all. It is played here too, once, to say at once whether it differs.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from silverball.game.core import GameCore
from silverball.game.replay.digest import CHARACTERS, GROUPS, full_digest, record_bytes, short_digests
from silverball.game.replay.format import Replay
from silverball.game.replay.player import InputRefusedError, Playback
from silverball.physics import PHYSICS_VERSION

SIZE = CHARACTERS * len(GROUPS)  # of the digests of a second


class Recording(NamedTuple):
    """A replay as a page plays it.

    Attributes:
        ticks: Its length.
        inputs: The inputs of every second, as in the replay.
        digests: The short digests after every second.
        ended: How it ended.
        score: The points at the end.
        digest: The digest of the whole state at the end.
        differs: What Python found to differ from the replay; empty if nothing does.
        players: How many took turns.
    """

    ticks: int
    inputs: list[str]
    digests: list[str]
    ended: str
    score: int
    digest: str
    differs: str
    players: int


def recording_of(replay: Replay, progress: Callable[[int], None] = lambda ticks: None) -> Recording:
    """Play a replay and return what a page needs of it.

    A replay of an earlier version of the physics has digests of records in another layout. Those of the game
    as it is played here take their place.

    Args:
        replay: The replay, scored by built-in rules.
        progress: Called after every second of play with the ticks so far.

    Raises:
        SilverballError: It needs custom rules, or its table cannot be played.
    """
    playback, rate = Playback(replay), replay.tick_rate
    game, is_old = playback.game, replay.physics != PHYSICS_VERSION
    recorded = [line[:SIZE] for line in replay.lines]
    digests, differs = [], ""
    try:
        while game.tick < replay.ticks and not game.is_over:
            playback.play(rate - game.tick % rate)
            if game.tick % rate == 0:
                second, got = game.tick // rate, _short(game)
                digests.append(got if is_old else recorded[second - 1])
                if digests[-1] != got and not differs:
                    differs = f"second {second} differs from the replay's"
            progress(game.tick)
        playback.finish()
    except InputRefusedError as error:
        differs = differs or str(error)
    end = full_digest(record_bytes(game.world, PHYSICS_VERSION), game.rules_text)
    expected = end if is_old else replay.digest
    if (game.tick, game.ended, game.score, end) != (replay.ticks, replay.ended, replay.score, expected):
        differs = differs or "its end differs from the replay's"
    inputs = [*(line[SIZE:].strip() for line in replay.lines), replay.tail]
    digests += recorded[len(digests) :]
    return Recording(
        replay.ticks, inputs, digests, replay.ended, replay.score, expected, differs, replay.players
    )


def _short(game: GameCore) -> str:
    return short_digests(record_bytes(game.world, PHYSICS_VERSION), game.rules_text)
