"""Episodes of a player in the environments, as arrays: what data sets for learning are made of.

Episode i is the first one of the seed `seed + i`, with a player of its own, so it does not depend on how many
others are recorded, nor on how many are played side by side.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from typing import Any, NamedTuple

import gymnasium
import numpy as np
from numpy.typing import NDArray

from silverball.envs import IDS, PinballVectorEnv
from silverball.envs.player_actions import PlayerActions
from silverball.envs.spec import with_step_limit
from silverball.errors import SilverballError

MOST_SIDE_BY_SIDE = 64
MEMORY = 256 * 2**20  # [B] of the observations of episodes that are played side by side
USUAL_STEPS = 20_000  # the longest episode with the usual limit, where there is none

Observations = Any
"""An array [step, …], or a dict of them."""


class Recorded(NamedTuple):
    """One episode of T steps.

    Attributes:
        seed: `env.reset(seed=seed)` begins it again.
        observations: T + 1, the first and those after each step: an array, or a dict of arrays.
        actions: int64 [T], or bits [T, button].
        rewards: float64 [T].
        terminated: bool [T]; true at most in the last step.
        truncated: bool [T]; likewise.
        counts: The events of the episode so far, int64 [T + 1] each.
    """

    seed: int
    observations: Observations
    actions: NDArray[np.int64]
    rewards: NDArray[np.float64]
    terminated: NDArray[np.bool_]
    truncated: NDArray[np.bool_]
    counts: dict[str, NDArray[np.int64]]

    def add_to(self, digest: Any) -> None:
        """Feed everything to a hash of hashlib."""
        digest.update(str(self.seed).encode())
        shown = self.observations if isinstance(self.observations, dict) else {"": self.observations}
        for array in (*(shown[name] for name in sorted(shown)), *self[2:6]):
            digest.update(np.ascontiguousarray(array).tobytes())


class Recording:
    """Plays the episodes of a player in one kind of environment.

    Args:
        id_: The id of a registered environment of Silverball.
        options: Its options.
        player: The name of a player.
        seed: Seed of the first episode; the others get the seeds after it.

    Raises:
        SilverballError: There is no such environment, an option is wrong, or no player has that name.

    Examples:
        >>> recording = Recording("silverball/PinballClassic-v0", {"time_limit": 1.0}, "reflex", 7)
        >>> [len(episode.rewards) for episode in recording.episodes(2)]
        [60, 60]
    """

    def __init__(self, id_: str, options: dict[str, Any], player: str, seed: int) -> None:
        self.id, self.options, self.player, self.seed = id_, options, player, seed
        first = self._made(1)
        space = first.single_observation_space
        spaces = space.values() if isinstance(space, gymnasium.spaces.Dict) else [space]
        step_bytes = sum(one.sample().nbytes for one in spaces)
        steps = first.options.max_steps or USUAL_STEPS
        self.side_by_side = min(MOST_SIDE_BY_SIDE, max(1, MEMORY // (steps * step_bytes)))
        self.observation_space, self.action_space = space, first.single_action_space
        self.table_digests = first.table_digests
        spec = with_step_limit(gymnasium.spec(id_), first.options.max_steps)
        assert spec is not None
        spec.kwargs = {**spec.kwargs, **options}
        self.spec = with_step_limit(spec, first.options.max_steps)
        PlayerActions(first, player)  # refuses an unknown name

    def episodes(self, count: int) -> Iterator[Recorded]:
        """Play this many episodes, in the order of their seeds."""
        for first in range(0, count, self.side_by_side):
            yield from self._played(self.seed + first, min(self.side_by_side, count - first))

    def digest(self, count: int) -> str:
        """The hash of the first episodes, as a data set of them has it."""
        digest = hashlib.sha256()
        for episode in self.episodes(count):
            episode.add_to(digest)
        return digest.hexdigest()

    def _made(self, count: int) -> PinballVectorEnv:
        if self.id not in IDS:
            raise SilverballError(f"{self.id!r} is no environment: choose one of {', '.join(IDS)}")
        try:
            envs: Any = gymnasium.make_vec(self.id, count, **self.options).unwrapped
        except (TypeError, ValueError) as error:
            raise SilverballError(f"{self.id}: {error}") from None
        if not isinstance(envs, PinballVectorEnv):
            raise SilverballError(f"{self.id}: the players of the game cannot play it; choose another id")
        return envs

    def _played(self, seed: int, count: int) -> Iterator[Recorded]:
        """Play episodes side by side until the last of them has ended."""
        envs = self._made(count)
        observations, infos = envs.reset(seed=seed)
        player = PlayerActions(envs, self.player)
        length = np.zeros(count, np.int64)  # 0: it has not ended
        seen, counted, steps = [observations], [infos], []
        while not length.all():
            actions = player.choose()
            observations, rewards, terminated, truncated, infos = envs.step(actions)
            steps.append((actions, rewards, terminated, truncated))
            length[(length == 0) & (terminated | truncated)] = len(steps)
            seen.append(observations)
            counted.append(infos)
        for index in range(count):
            yield _episode(seed + index, index, int(length[index]), seen, counted, steps)


def _episode(
    seed: int, index: int, length: int, seen: list[Any], counted: list[Any], steps: list[tuple[Any, ...]]
) -> Recorded:
    """The episode of one environment, of what all of them have shown."""
    if isinstance(seen[0], dict):
        observations: Any = {
            name: np.stack([one[name][index] for one in seen[: length + 1]]) for name in seen[0]
        }
    else:
        observations = np.stack([one[index] for one in seen[: length + 1]])
    columns = [np.stack([step[column][index] for step in steps[:length]]) for column in range(4)]
    names = [name for name in counted[0] if not name.startswith("_")]
    counts = {name: np.stack([one[name][index] for one in counted[: length + 1]]) for name in names}
    return Recorded(seed, observations, columns[0], columns[1], columns[2], columns[3], counts)
