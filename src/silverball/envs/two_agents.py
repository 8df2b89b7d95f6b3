"""Two agents on one table, a paddle each: `TwoPaddlesEnv`, with the parallel interface of PettingZoo.

    from silverball.envs.two_agents import parallel_env

    env = parallel_env()
    observations, infos = env.reset(seed=0)
    observations, rewards, terminations, truncations, infos = env.step({"left": 1, "right": 0})

Both see the table and share its rewards, so that they must learn to leave a ball to each other.
"""

from __future__ import annotations

from collections.abc import Mapping
from operator import index
from typing import Any, Final

import gymnasium
from gymnasium import spaces
from numpy.typing import NDArray

from silverball.envs.options import refuse_options
from silverball.envs.protocol import BENCHMARK
from silverball.envs.single import PinballEnv
from silverball.errors import MissingExtra

try:
    from pettingzoo import ParallelEnv
except ModuleNotFoundError:
    raise MissingExtra("silverball.envs.two_agents", "pettingzoo") from None

AGENTS: Final = ("left", "right")
LAUNCH = 2  # bit of the right agent's action, on a table with a plunger


def parallel_env(render_mode: str | None = None, **options: Any) -> TwoPaddlesEnv:
    """Make the environment; PettingZoo's modules have a function of this name.

    Args:
        render_mode: "human", "rgb_array" or None.
        options: As of `TwoPaddlesEnv`.

    Examples:
        >>> from silverball.envs.two_agents import parallel_env
        >>> env = parallel_env()
        >>> observations, infos = env.reset(seed=0)
        >>> sorted(observations), env.action_space("left")
        (['left', 'right'], Discrete(2))
    """
    return TwoPaddlesEnv(render_mode, **options)


class TwoPaddlesEnv(ParallelEnv):  # type: ignore[misc, unused-ignore]
    """A table for two agents, "left" and "right", that press a paddle button each.

    An action is 1 while the button is held, else 0. On a table with a plunger the right agent has another
    bit: 2 pulls it back. Both agents get the table's observation and its whole reward.

    Args:
        render_mode: "human", "rgb_array" or None.
        options: Those of `silverball.envs.options.OPTIONS` but for jitter, create and actions; the defaults
            are those of the v1 ids, on the table `classic`.

    Raises:
        TypeError: An option is unknown, or gives a third button.
        ValueError: An option has an invalid value.
        TableError: The table has problems, or there is no such table.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012  (PettingZoo's own)
        "name": "silverball_two_paddles_v1",
        "render_modes": ["human", "rgb_array"],
        "is_parallelizable": True,
    }

    def __init__(self, render_mode: str | None = None, **options: Any) -> None:
        refuse_options(options, ("jitter", "create", "actions"), "each agent has the button of its paddle")
        self.env = PinballEnv(render_mode, **{"table": "classic", **BENCHMARK, **options})
        self.render_mode = render_mode
        self.metadata = {**self.metadata, "render_fps": self.env.metadata["render_fps"]}
        self.possible_agents = list(AGENTS)
        self.agents: list[str] = []
        self._has_plunger = "launch" in self.env.get_action_meanings()[-1].lower()
        own = {"left": spaces.Discrete(2), "right": spaces.Discrete(4 if self._has_plunger else 2)}
        self.action_spaces: dict[str, spaces.Discrete] = own
        self.observation_spaces = dict.fromkeys(AGENTS, self.env.observation_space)
        self.state_space = self.env.observation_space
        self._last: Any = None

    def observation_space(self, agent: str) -> spaces.Space[Any]:
        """The space of an agent's observations, which is the table's."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Space[Any]:
        """The space of an agent's actions."""
        return self.action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
        """Begin an episode, as `PinballEnv.reset` does; returns observations and infos by agent.

        Args:
            seed: Determines the episodes that follow.
            options: ``{"board": 12}`` selects the board. Others are ignored, as PettingZoo's test demands.
        """
        self.agents = list(AGENTS)
        known = {name: value for name, value in (options or {}).items() if name == "board"}
        self._last, info = self.env.reset(seed=seed, options=known)
        return self._for_both(self._last), {agent: info.copy() for agent in AGENTS}

    def step(
        self, actions: Mapping[str, Any]
    ) -> tuple[dict[str, Any], dict[str, float], dict[str, bool], dict[str, bool], dict[str, dict[str, Any]]]:
        """Hold the buttons of both agents for one step.

        Args:
            actions: The action of each agent by its name.

        Returns:
            Observations, rewards, terminations, truncations and infos, by agent. When the episode is over
            no agents are left.

        Raises:
            ResetNeeded: The episode is over, or has never begun.
            ValueError: An agent is missing or unknown, or an action is not in its space.
        """
        if not self.agents:
            raise gymnasium.error.ResetNeeded("the episode is over or has not begun: call reset before step")
        if set(actions) != set(AGENTS):
            raise ValueError(f"actions must name the agents 'left' and 'right', got {sorted(actions)}")
        left, right = (self._checked(agent, actions[agent]) for agent in AGENTS)
        number = left + 2 * (right & 1) + (4 if right & LAUNCH else 0)
        self._last, reward, terminated, truncated, info = self.env.step(number)
        if terminated or truncated:
            self.agents = []
        return (
            self._for_both(self._last),
            dict.fromkeys(AGENTS, float(reward)),
            dict.fromkeys(AGENTS, terminated),
            dict.fromkeys(AGENTS, truncated),
            {agent: info.copy() for agent in AGENTS},
        )

    def state(self) -> Any:
        """The observation of the table, which both agents see."""
        return self._copied(self._last)

    def render(self) -> NDArray[Any] | None:
        """The table, as `PinballEnv.render` draws it."""
        return self.env.render()

    def close(self) -> None:
        """Close the window, if one is open."""
        self.env.close()

    def _checked(self, agent: str, action: Any) -> int:
        """An action as a number, if it is in the space of its agent."""
        try:
            number = index(action)
        except TypeError:
            number = -1
        if not 0 <= number < self.action_spaces[agent].n:
            raise ValueError(
                f"the action of {agent!r} must be in {self.action_spaces[agent]}, got {action!r}"
            )
        return number

    def _for_both(self, observation: Any) -> dict[str, Any]:
        """The observation for each agent, in arrays of its own."""
        return {agent: self._copied(observation) for agent in AGENTS}

    @staticmethod
    def _copied(observation: Any) -> Any:
        if isinstance(observation, dict):
            return {name: part.copy() for name, part in observation.items()}
        return observation.copy()
