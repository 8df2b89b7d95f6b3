"""A game whose buttons one of the program's players presses: a demo, or a rival beside the player."""

from __future__ import annotations

from typing import TYPE_CHECKING

from silverball.app.demo_players import introduce
from silverball.game.mechanisms import plungers

if TYPE_CHECKING:
    from silverball.game.core import GameCore
    from silverball.players import Player


class AutomaticGame:
    """A game with a player of the program.

    Args:
        game: The game.
        player: The player.

    Attributes:
        game: The game.
    """

    def __init__(self, game: GameCore, player: Player) -> None:
        self.game = game
        self.player = player
        self._has_plunger = bool(plungers(game.table))

    @property
    def player(self) -> Player:
        """Presses the paddle buttons; may be replaced at any time."""
        return self._player

    @player.setter
    def player(self, player: Player) -> None:
        self._player = player
        introduce(player, self.game)

    def play_tick(self) -> None:
        """Play a tick; the plunger is pulled for the player, who presses the paddle buttons only."""
        from silverball.players.simple import holds_launch

        world = self.game.world
        launch = self._has_plunger and bool(holds_launch(world.records[0], 1.0 / world.tick_rate))
        self.game.step(*self.player.press(world), 1, launch=launch)
