"""The trained player: a small neural network chooses the buttons.

There are two: one was trained on random boards (`examples/train_sb3.py`) and plays any table; another one has
learnt the missions of `silver_comet` (`mission_policy.py`) and plays the games by those rules. Both are
evaluated with NumPy alone, and press the same on every machine (`exact_layers.py`).
"""

from __future__ import annotations

import zipfile
from functools import cache
from importlib import resources
from os import PathLike
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.errors import SilverballError
from silverball.physics.records import LEFT, RIGHT, BoardRecord, Colliders, Part
from silverball.players.exact_layers import ExactLayers, Layer, arrays_of, read_layers, rounded_layers
from silverball.players.features import ENCODED, MIRRORED, Rows, encode, first_paddles, raw_features
from silverball.players.mission_policy import ACTIONS, MissionPolicy, mission_policy
from silverball.referee.compile_rules import RuleBooks
from silverball.world import World, WorldBatch

if TYPE_CHECKING:
    from silverball.game.core import GameCore

DECISIONS = 15  # decisions per second


class Policy:
    """A network of a few layers with ReLU between them; it presses the action with the largest output.

    Args:
        layers: From ENCODED features to ACTIONS outputs.
        command: The command that trained it.

    Raises:
        ValueError: The layers do not fit each other, or hold anything but small 32-bit integers.
    """

    def __init__(self, layers: list[Layer], command: str = "") -> None:
        self._network = ExactLayers(layers, ENCODED, ACTIONS)
        self.layers, self.command = layers, command

    @classmethod
    def rounded(cls, layers: list[tuple[Any, Any]], command: str = "") -> Policy:
        """A policy of floating-point layers, rounded."""
        return cls(rounded_layers(layers), command)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Policy:
        """Read a policy from a file that `save` has written.

        Raises:
            SilverballError: The file cannot be read, or is not a policy.
        """
        try:
            with np.load(path, allow_pickle=False) as file:
                return cls(read_layers(file), str(file["command"]))
        except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile, IndexError, TypeError) as error:
            raise SilverballError(
                f"{path} is not a policy written by `examples/train_sb3.py --policy`: {error}"
            ) from None

    def save(self, path: str | PathLike[str]) -> None:
        """Write the policy to a file, whose name ends in .npz."""
        np.savez_compressed(path, command=np.array(self.command), **arrays_of(self.layers))

    def actions(self, raw: Rows) -> NDArray[np.int64]:
        """The actions for raw features [row, Raw]: bits [row], 1 left, 2 right."""
        values, is_mirrored = encode(raw)
        chosen = self._network.best(values)
        return np.where(is_mirrored, MIRRORED[chosen], chosen)


@cache
def stored_policy() -> Policy:
    """The policy that comes with the program."""
    with resources.as_file(resources.files("silverball.players") / "trained.npz") as path:
        return Policy.load(path)


def ticks_per_decision(tick_rate: int) -> int:
    """Ticks between two decisions."""
    return max(1, round(tick_rate / DECISIONS))


class Games(NamedTuple):
    """The games that are played in some worlds.

    Attributes:
        records: GAME records [world].
        books: The rules of all tables.
    """

    records: Any
    books: RuleBooks


class Trained:
    """The trained player for a single world.

    It has no state of its own: between two decisions it holds what the paddles are commanded, so a game can
    be continued from any snapshot.

    Args:
        policy: The network for any table; None: the one that comes with the program.
        missions: The network for games by the rules that it has learnt; None: that of the program.
    """

    name = "trained"

    def __init__(self, policy: Policy | None = None, missions: MissionPolicy | None = None) -> None:
        self._policy = policy or stored_policy()
        self._missions = missions or mission_policy()
        self._world: World | None = None
        self._games: Any = None

    def watch(self, game: GameCore) -> None:
        """Play a game for its missions, if it is one that the network has learnt."""
        rows, (_, board, _) = game.rule_rows, game.world.records
        boards = np.array([board])
        fits = rows is not None and bool(self._missions.fits(rows[1], boards)[0])
        self._world, self._games = (game.world, rows[0]) if rows is not None and fits else (None, None)

    def press(self, world: World) -> tuple[bool, bool]:
        """The buttons (left, right) to hold in the world's next tick."""
        state, board, colliders = world.records
        if world.tick % ticks_per_decision(world.tick_rate) != 0:
            return is_lifted(state, board, colliders, LEFT), is_lifted(state, board, colliders, RIGHT)
        worlds, boards = np.array([state]), np.array([board])
        if world is self._world:
            found = self._missions.actions(worlds, self._games, boards, colliders, world.tick_rate)
        else:
            found = self._policy.actions(raw_features(worlds, boards, colliders))
        bits = int(found[0])
        return bits & 1 != 0, bits & 2 != 0


def is_lifted(state: Any, board: BoardRecord, colliders: Colliders, button: int) -> bool:
    """Whether the paddles of a button, LEFT or RIGHT, are commanded to be up."""
    number = int(first_paddles(np.array([board]), colliders, button)[0])
    if number < 0:
        return False
    collider = colliders[board["collider_first"] + Part.FIRST_PADDLE + number]
    commanded = state["paddle"][number]["angle_commanded"]
    return bool(commanded == collider["angle_up"] != collider["angle_rest"])


def press_batch(batch: WorldBatch, policy: Policy | None = None) -> NDArray[np.bool_]:
    """The buttons (left, right) to hold until the next decision in every world, bool [world, 2]."""
    boards = batch.boards
    raw = raw_features(batch.state, boards.board[batch.board_of], boards.collider)
    return _buttons((policy or stored_policy()).actions(raw))


class MissionBatch:
    """The missions network for those games of a batch that it has learnt.

    Args:
        batch: The worlds.
        games: Their games.
        policy: The network; None: the one that comes with the program.

    Attributes:
        rows: The games that it plays [game].
    """

    def __init__(self, batch: WorldBatch, games: Games, policy: MissionPolicy | None = None) -> None:
        self._batch, self._games, self._policy = batch, games.records, policy or mission_policy()
        fits = self._policy.fits(games.books, batch.boards.board)
        self.rows = np.flatnonzero(fits[batch.board_of])
        self._step = np.full(len(self.rows), -1)  # the last decision of each

    def press(self, buttons: NDArray[np.bool_], charge: Any = 1.0) -> None:
        """Write the buttons of its games into `buttons`, bool [world, 2]; between two decisions none change.

        Args:
            buttons: What is held.
            charge: As for `MissionPolicy.actions`: one number, or [world].
        """
        batch, every = self._batch, ticks_per_decision(self._batch.tick_rate)
        step = batch.state["tick"][self.rows] // every
        rows = self.rows[step != self._step]
        self._step = step
        if len(rows):
            boards = batch.boards
            charges = np.broadcast_to(charge, batch.count)[rows]
            bits = self._policy.actions(
                batch.state[rows], self._games[rows], boards.board[batch.board_of[rows]], boards.collider,
                batch.tick_rate, charges,
            )  # fmt: skip
            buttons[rows] = _buttons(bits)


def _buttons(bits: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Bits as buttons [world, 2]: left, right."""
    return np.stack((bits & 1 != 0, bits & 2 != 0), axis=1)
