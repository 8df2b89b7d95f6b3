"""The plan of a study: what is played, by whom, how often; and its split into chunks of games.

A study compares *arms*: a table under a player. All arms play the same seeds (common random numbers), so
differences between them are sharper than the figures. A plan splits into *chunks*, each some games of one
arm; a chunk is a pure function of its table, player and seeds, so chunks can be played in any order, on any
machine, and again.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from typing import Any, NamedTuple

from silverball.errors import SilverballError
from silverball.physics import PHYSICS_VERSION
from silverball.physics.kernel import STUDY
from silverball.source_digest import source_digest
from silverball.table import Table, table_digest
from silverball.world.arguments import checked_int

LONGEST = 600.0  # [s] after which a game is cut short
LONGEST_AIMED = 120.0  # [s] the same for the planner, whose games hardly end
FIRST_GAMES = 40  # of the first chunk of an arm, so that there is a first estimate soon
CHUNK_GAMES = 250  # half a second of one core, or a few seconds where each game has a board of its own
CHUNK_GAMES_OF = {"idle": 2000, "random": 1000, "planner": 2, "trained": 64}
MOST_GAMES = 10**9
FORMAT = 1
CODE = (*STUDY, "table", "game", "studies")  # the packages that decide results


class Arm(NamedTuple):
    """What is compared: a table under a player.

    Attributes:
        label: What it is called; unique in its plan.
        table: A table, or a recipe, of which every game gets a board of its own.
        player: The name of a player, or "beginner".
        change: What was changed in the table, by path; empty outside of sweeps.
    """

    label: str
    table: Table
    player: str
    change: tuple[tuple[str, Any], ...] = ()


class Chunk(NamedTuple):
    """Some games of an arm: everything that their results depend on.

    Attributes:
        number: Of all chunks of the plan, from 0.
        arm: The number of the arm.
        table: The table or recipe.
        player: The name of the player.
        first_seed: Of the first game; the next one has the next seed.
        games: Games.
        longest: [s] after which a game is cut short.
        keeps_events: Whether a row is kept for every event.
    """

    number: int
    arm: int
    table: Table
    player: str
    first_seed: int
    games: int
    longest: float
    keeps_events: bool


class Plan(NamedTuple):
    """A study before it is played.

    Attributes:
        arms: What is compared.
        games: Games of each arm.
        seed: Of the first game of every arm.
        longest: [s] after which a game is cut short; None: 600, with the planner 120.
        keeps_events: Whether a row is kept for every event.
        chunk_games: Games of a chunk; None: what takes about a second. Results do not depend on it.

    Examples:
        >>> from silverball import load_table
        >>> from silverball.studies.study_plan import Plan, arms_of
        >>> plan = Plan(arms_of([("classic", load_table("classic"))], ["reflex"]), games=500)
        >>> [(chunk.first_seed, chunk.games) for chunk in plan.chunks()]
        [(0, 40), (40, 250), (290, 210)]
    """

    arms: tuple[Arm, ...]
    games: int
    seed: int = 0
    longest: float | None = None
    keeps_events: bool = False
    chunk_games: int | None = None

    def chunks(self) -> Iterator[Chunk]:
        """All chunks, in the order of their numbers: the same seeds of all arms follow each other."""
        number, done, size = 0, 0, min(FIRST_GAMES, self.chunk_size)
        while done < self.games:
            count = min(size, self.games - done)
            for index, arm in enumerate(self.arms):
                yield Chunk(
                    number, index, arm.table, arm.player, self.seed + done, count,
                    self.seconds(arm.player), self.keeps_events,
                )  # fmt: skip
                number += 1
            done, size = done + count, self.chunk_size

    def chunk_count(self) -> int:
        """How many chunks there are."""
        size = self.chunk_size
        return len(self.arms) * (1 + -(-max(self.games - min(FIRST_GAMES, size), 0) // size))

    @property
    def chunk_size(self) -> int:
        """Games of a chunk, of all arms alike; the first one has fewer."""
        return self.chunk_games or min(map(_usual_size, self.arms))

    def seconds(self, player: str) -> float:
        """[s] after which a game of a player is cut short."""
        if self.longest is not None:
            return self.longest
        return LONGEST_AIMED if player == "planner" else LONGEST

    def as_dict(self) -> dict[str, Any]:
        """What decides the results, as plain data; tables by their digests."""
        return {
            "format": FORMAT,
            "physics": PHYSICS_VERSION,
            "code": source_digest(CODE),
            "arms": [
                {
                    "label": arm.label,
                    "table": table_digest(arm.table),
                    "player": arm.player,
                    "longest": self.seconds(arm.player),
                }
                for arm in self.arms
            ],
            "games": self.games,
            "seed": self.seed,
            "events": self.keeps_events,
            "chunk_games": self.chunk_size,
        }

    def digest(self) -> str:
        """A hash of the plan, 16 hexadecimal digits."""
        text = json.dumps(self.as_dict(), sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:16]


def _usual_size(arm: Arm) -> int:
    """Games of a chunk of an arm alone."""
    size = CHUNK_GAMES_OF.get(arm.player, CHUNK_GAMES)
    return size if arm.table.random is None else min(size, CHUNK_GAMES)


def arms_of(tables: list[tuple[str, Table]], players: list[str]) -> tuple[Arm, ...]:
    """Every table under every player, with short labels.

    Args:
        tables: Labels and tables.
        players: Names of players.
    """
    arms = []
    for label, table in tables:
        for player in players:
            name = player if len(tables) == 1 else label if len(players) == 1 else f"{label}, {player}"
            arms.append(Arm(name, table, player))
    return tuple(arms)


def checked_plan(plan: Plan) -> Plan:
    """The plan, if it can be played.

    Raises:
        ValueError: A number is out of range.
        SilverballError: It has no arm, or two of one label.
    """
    checked_int("games", plan.games, 2, MOST_GAMES)
    checked_int("seed", plan.seed, 0, 2**63 - 1 - MOST_GAMES)
    labels = [arm.label for arm in plan.arms]
    if not labels or len(set(labels)) < len(labels):
        raise SilverballError(f"a study needs arms with different labels, got {labels}")
    return plan
