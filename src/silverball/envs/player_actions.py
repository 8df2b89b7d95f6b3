"""A player of the game as an agent: its buttons as actions of a vector environment."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from silverball.envs.vector import PinballVectorEnv
from silverball.players.batch_policies import batch_policy, kernel_player
from silverball.players.simple import press_all, press_launch


class PlayerActions:
    """Chooses the actions of a named player in all environments.

    The player reads the worlds, not the observations. It decides before a step, at most as often as it does
    in a game; its buttons are held during the whole step. Beside the paddles only the launch button is
    pressed, where there is one.

    Args:
        envs: The environments.
        player: The name of a player.

    Raises:
        PlayerError: No player has that name, or it cannot be created.

    Examples:
        >>> import silverball.envs
        >>> envs = silverball.envs.PinballVectorEnv(2, table="classic")
        >>> _ = envs.reset(seed=7)
        >>> PlayerActions(envs, "hold").choose().tolist()
        [3, 3]
    """

    def __init__(self, envs: PinballVectorEnv, player: str) -> None:
        self._batch, self._options = envs.batch, envs.options
        self._policy, self._kind = (
            batch_policy(player, envs.batch, games=envs.games),
            int(kernel_player(player)),
        )
        buttons = envs.button_names
        self._launch = buttons.index("launch") if "launch" in buttons else None
        self._held = np.zeros((1, envs.num_envs, 4), np.bool_)
        self._bits = np.zeros((envs.num_envs, len(buttons)), np.bool_)
        self._weights = 1 << np.arange(len(buttons))
        self._elapsed = 0  # ticks since the last decision
        self._has_decided = False

    def choose(self) -> NDArray[np.int64]:
        """The actions of the next step, in the action space: int64 [env], or bits [env, button]."""
        self._decide()
        self._bits[:, :2] = self._held[0, :, :2]
        if self._launch is not None:
            batch, tick = self._batch, 1.0 / self._options.tick_rate
            press_launch(batch.state, batch.boards.board, batch.board_of, tick, self._held)
            self._bits[:, self._launch] = self._held[0, :, 3]
        if self._options.actions == "multibinary":
            return self._bits.astype(np.int64)
        actions: NDArray[np.int64] = self._bits @ self._weights
        return actions

    def _decide(self) -> None:
        """Decide anew if it is time."""
        batch = self._batch
        if self._policy is None:
            boards = batch.boards
            press_all(
                self._kind, batch.state, boards.board, batch.board_of, boards.collider,
                1.0 / self._options.tick_rate, self._held,
            )  # fmt: skip
        elif not self._has_decided or self._elapsed >= self._policy.every:
            self._policy.decide()
            self._held[0, :, :2] = self._policy.buttons
            self._has_decided, self._elapsed = True, 0
        self._elapsed += self._options.frame_skip
