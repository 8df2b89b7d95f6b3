"""The gates that rules in Python open: worked as soon as no ball is in their way.

The referee works the gates that rules of a table open by itself.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from silverball.errors import SilverballError
from silverball.game.mechanisms import held_gates

if TYPE_CHECKING:
    from silverball.game.game_world import GameWorld


class RuleGates:
    """Opens and closes the gates of a world as rules say.

    Args:
        board: The world.
        has_own_rules: Whether the game has rules in Python; otherwise nothing happens here.

    Attributes:
        is_worked: Whether the table has such gates, and rules in Python work them.
        has_stuck: Whether a gate waits to close until no ball is in its way.
    """

    def __init__(self, board: GameWorld, *, has_own_rules: bool) -> None:
        self._board, self._has_own_rules = board, has_own_rules
        self._gates = held_gates(board.world.table)
        self.is_worked = has_own_rules and bool(self._gates)
        self.has_stuck = False
        self._open: tuple[str, ...] = ()  # those that are to be open

    def follow(self, open_gates: tuple[str, ...]) -> None:
        """Work the gates if other ones are to be open than before.

        Raises:
            SilverballError: The rules name a gate that the table does not have.
        """
        if self._has_own_rules and open_gates != self._open:
            self._open = open_gates
            self.work()

    def adopt(self, open_gates: tuple[str, ...]) -> None:
        """Note which gates are to be open at another moment, to which the world has jumped."""
        self._open = open_gates
        self.has_stuck = bool(self._wanted())

    def work(self) -> None:
        """Open and close the gates, as far as nothing is in their way.

        Raises:
            SilverballError: The rules name a gate that the table does not have.
        """
        unknown = sorted(set(self._open) - self._gates.keys())
        if unknown:
            raise SilverballError(
                f"the rules open {unknown[0]!r}, expected held gates of the table: {sorted(self._gates)}"
            )
        for part, is_open in self._wanted():
            self._board.world.open_gate(part, is_open)
        self.has_stuck = bool(self._wanted())

    def _wanted(self) -> list[tuple[str, bool]]:
        """The gates that are not as the rules say, and whether they are to be open."""
        if not self._has_own_rules:
            return []
        wanted = [(part, name in self._open) for name, part in self._gates.items()]
        return [(part, is_open) for part, is_open in wanted if self._board.is_gate_open(part) != is_open]
