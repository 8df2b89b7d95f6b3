"""The missions network: what the trained player presses in games by the rules of `silver_comet`.

`examples/train_missions.py` trains it. It has learnt one table, of which it sees the lamps, counters and
modes, so it plays only tables that have the same ones; `fits` says which. Its sums are exact, as those of
the network for random boards are.

It draws its actions: the one that seems best every time may be to hold a ball for ever. Chance is a function
of the world's seed and tick, so a game is the same again.
"""

from __future__ import annotations

import zipfile
from functools import cache
from importlib import resources
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.errors import SilverballError
from silverball.physics.records import Colliders
from silverball.players.exact_layers import (
    ExactLayers,
    Layer,
    arrays_of,
    read_layers,
    rounded_layers,
)
from silverball.players.mission_features import HAS_FREE_BALL, feature_count, mission_features
from silverball.referee.compile_rules import RuleBooks

ACTIONS = 4  # none, left, right, both
SHARPNESS = 2.0  # of the draw of an action; see `ExactLayers.drawn`
NAMED = ("lamps", "counters", "modes")  # what a table must have the same of

Names = dict[str, tuple[str, ...]]


class MissionPolicy:
    """A network from the features of a game to the buttons.

    Args:
        layers: From the features to ACTIONS outputs.
        names: The names of the lamps, counters and modes that it has learnt.
        switches: Drop targets and gates of the table.
        command: The command that trained it.

    Raises:
        ValueError: The layers do not fit, or hold anything but small 32-bit integers.
    """

    def __init__(self, layers: list[Layer], names: Names, switches: int, command: str = "") -> None:
        self.sizes = (*(len(names[kind]) for kind in NAMED), switches)
        lamps, counters, modes, _ = self.sizes
        self._network = ExactLayers(layers, feature_count(lamps, counters, modes, switches), ACTIONS)
        self.layers, self.names, self.switches, self.command = layers, names, switches, command

    @classmethod
    def rounded(cls, layers: list[Any], names: Names, switches: int, command: str = "") -> MissionPolicy:
        """A policy of floating-point layers, rounded."""
        return cls(rounded_layers(layers), names, switches, command)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> MissionPolicy:
        """Read a policy from a file that `save` has written.

        Raises:
            SilverballError: The file cannot be read, or is not a policy.
        """
        try:
            with np.load(path, allow_pickle=False) as file:
                names = {kind: tuple(file[kind].tolist()) for kind in NAMED}
                return cls(read_layers(file), names, int(file["switches"]), str(file["command"]))
        except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile, IndexError, TypeError) as error:
            raise SilverballError(
                f"{path} is not a policy written by `examples/train_missions.py --out`: {error}"
            ) from None

    def save(self, path: str | PathLike[str]) -> None:
        """Write the policy to a file, whose name ends in .npz."""
        arrays = arrays_of(self.layers) | {kind: np.array(self.names[kind]) for kind in NAMED}
        arrays |= {"switches": np.array(self.switches), "command": np.array(self.command)}
        np.savez_compressed(path, **arrays)

    def fits(self, books: RuleBooks, boards: Any) -> NDArray[np.bool_]:
        """Which tables it has learnt: those with the same lamps, counters, modes and switches, bool [table].

        Args:
            books: The compiled rules of the tables.
            boards: Their BOARD records [table].
        """
        same = [
            all(getattr(books, kind)[table] == self.names[kind] for kind in NAMED)
            for table in range(len(boards))
        ]
        found: NDArray[np.bool_] = np.array(same) & (boards["switches"] == self.switches)
        return found

    def check(self, books: RuleBooks, boards: Any) -> None:
        """Refuse tables that it has not learnt.

        Raises:
            SilverballError: One of them is not such a table.
        """
        for kind in NAMED:
            for names in getattr(books, kind):
                if names != self.names[kind]:
                    raise SilverballError(
                        f"the policy has learnt a table with {len(self.names[kind])} {kind} "
                        f"({', '.join(self.names[kind][:2])}, …), and this one has "
                        f"{len(names)}{f' ({names[0]}, …)' if names else ''}: train one for this table"
                    )
        if not self.fits(books, boards).all():
            raise SilverballError(
                f"the policy has learnt a table with {self.switches} drop targets and gates, and this one "
                f"has {int(boards['switches'][0])}: train one for this table"
            )

    def actions(
        self, state: Any, games: Any, boards: Any, colliders: Colliders, rate: int, charge: Any = 1.0
    ) -> NDArray[np.int64]:
        """The actions in some games: bits [game], 1 left, 2 right; none where no ball moves freely.

        Args:
            state: World records [game].
            games: GAME records [game].
            boards: The BOARD record of each [game].
            colliders: COLLIDER records of all boards.
            rate: Ticks per second.
            charge: How far the power supply of the coils is charged, where an environment has one: one
                number, or [game].
        """
        features = mission_features(state, games, boards, colliders, self.sizes, rate, charge)
        drawn = self._network.drawn(features, _chance(state["seed"], state["tick"]), SHARPNESS)
        return np.where(features[:, HAS_FREE_BALL] != 0.0, drawn, 0)


def _chance(seeds: Any, ticks: Any) -> NDArray[np.float64]:
    """A random number from 0 to below 1 for each world: a function of its seed and its tick [world].

    Source: the finalizer of SplitMix64 (Steele, Lea & Flood 2014), which passes BigCrush on a counter.
    """
    mixed = seeds.astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15)
    for addend in (ticks.astype(np.uint64), np.uint64(0)):
        mixed = mixed + addend
        mixed = (mixed ^ (mixed >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        mixed = (mixed ^ (mixed >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        mixed = mixed ^ (mixed >> np.uint64(31))
    found: NDArray[np.float64] = (mixed >> np.uint64(11)) * 2.0**-53
    return found


@cache
def mission_policy() -> MissionPolicy:
    """The policy that comes with the program."""
    with resources.as_file(resources.files("silverball.players") / "missions.npz") as path:
        return MissionPolicy.load(path)
