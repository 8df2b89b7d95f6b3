"""The environment for one agent: `PinballEnv`, a `gymnasium.Env`."""

from __future__ import annotations

from operator import index
from typing import Any, NoReturn, SupportsFloat, cast

import gymnasium
import numpy as np
from gymnasium.envs.registration import EnvSpec

from silverball.envs.actions import action_space, as_array, as_bits, keys_to_action, meanings
from silverball.envs.engine import PREFIX_SIZE, Engine
from silverball.envs.lives import lives_of
from silverball.envs.observations import as_observation, observation_space
from silverball.envs.options import (
    SEED_RANGE,
    Options,
    checked_generator,
    checked_render_mode,
    checked_reset_options,
    checked_seed,
)
from silverball.envs.spec import with_step_limit
from silverball.envs.state import ResetMode, StepFlag
from silverball.envs.viewer import RendersOne, Viewer
from silverball.errors import StateError

REBUILT = {
    "_engine", "_viewer", "_codes", "_weights", "_run_task", "_addresses", "_row", "_counts", "_copy_row",
    "_info", "_memory", "_prefixes", "_size", "_screen",
}  # fmt: skip
"""Attributes that a copy rebuilds, since they follow from the options or refer to the engine's arrays."""

# Plain integers, since a step tests them.
TERMINATED, TRUNCATED = int(StepFlag.TERMINATED), int(StepFlag.TRUNCATED)
WAS_OVER, COUNTS_CHANGED = int(StepFlag.WAS_OVER), int(StepFlag.COUNTS_CHANGED)

_PREFIX, _ALL = slice(PREFIX_SIZE), slice(None)  # of a state's bytes


class PinballEnv(RendersOne, gymnasium.Env[Any, Any]):
    """A pinball table as an environment; docs/environments.md describes every slot of its observations.

    Args:
        render_mode: "human" (a window, at the speed of play), "rgb_array" or None.
        options: See `silverball.envs.options.OPTIONS`.

    Raises:
        TypeError: An option is unknown.
        ValueError: An option has an invalid value.
        TableError: The table has problems, or there is no such table.

    Examples:
        >>> import gymnasium as gym
        >>> import silverball.envs
        >>> env = gym.make("silverball/PinballClassic-v0")
        >>> observation, info = env.reset(seed=7)
        >>> observation, reward, terminated, truncated, info = env.step(1)  # 1: left, 2: right, 3: both
        >>> info["created"]
        1
    """

    def __init__(self, render_mode: str | None = None, **options: Any) -> None:
        self.options = Options.of(options, ("render_mode",))
        self.render_mode = checked_render_mode(render_mode, ("human", "rgb_array"))
        self._engine = engine = Engine(self.options, 1, ResetMode.DISABLED, threads=1, has_fixed_output=True)
        self.observation_space = observation_space(self.options, engine.pool.fields)
        self.action_space = action_space(self.options, self._engine.buttons)
        self.metadata = {**self.metadata, "render_fps": self.options.frames_per_second}
        self._is_rng_set = False  # whether the caller has set np_random since the last reset
        self._spec: EnvSpec | None = None
        self._codes = 1 << len(self._engine.buttons)
        self._weights = 1 << np.arange(len(self._engine.buttons))
        # Everything that a step needs, to save lookups.
        self._run_task, self._addresses = engine.run_task, engine.addresses
        self._row, self._counts = engine.outputs.last.observations[0], engine.outputs.last.counts[0]
        is_plain = self.options.observation == "state" and self.render_mode != "human"
        is_plain = is_plain and not callable(engine.reward)
        self._copy_row = self._row.copy if is_plain else None
        self._lives = self.options.balls if self.options.lives else None
        self._info = self._new_info()
        self._memory = memoryview(cast(Any, engine.memory))
        self._prefixes, self._size = engine.state_prefixes, len(engine.memory)

    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array"], "render_fps": 60}  # noqa: RUF012  (Gymnasium's own)

    @property
    def spec(self) -> EnvSpec | None:
        """The spec from `gymnasium.make`, with the number of steps after which episodes are truncated."""
        return self._spec

    @spec.setter
    def spec(self, spec: EnvSpec | None) -> None:
        self._spec = with_step_limit(spec, self.options.max_steps)

    @property
    def np_random(self) -> np.random.Generator:
        """The generator that draws a seed when an environment is reset without one; it can be set."""
        return gymnasium.Env.np_random.fget(self)  # type: ignore[attr-defined, no-any-return]

    @np_random.setter
    def np_random(self, generator: np.random.Generator) -> None:
        self._np_random, self._np_random_seed, self._is_rng_set = checked_generator(generator), -1, True

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begin an episode: the first one of `seed`, or without it the next one of the current seed.

        Args:
            seed: Determines all boards, starting places and shoves of the episodes that follow.
            options: ``{"board": 12}`` selects the board with that seed of a recipe, or with that number of a
                list of tables. Without it a board is drawn.

        Returns:
            The observation, and the counts of events, all zero but `created`.

        Raises:
            ValueError: The seed is not an integer ≥ 0, an option is unknown, or there is no such board.
        """
        board = checked_reset_options(options, ("board",)).get("board")
        requested = -1 if board is None else self._engine.pool.board_of_seed(board)
        number = None if seed is None else checked_seed(seed)
        super().reset(seed=None if seed is None else int(seed))
        if number is not None:
            self._engine.seed(number)
        elif self._is_rng_set or not self._engine.has_begun.all():
            self._engine.seed(self.np_random.integers(SEED_RANGE, dtype=np.uint64).astype(np.int64))
        self._is_rng_set = False
        self._engine.reset(requested)
        self._info = self._new_info()
        if self.render_mode == "human":
            self.render()
        return self._observation(), self._info.copy()

    def step(self, action: Any) -> tuple[Any, SupportsFloat, bool, bool, dict[str, Any]]:
        """Hold the action's buttons for one step.

        Args:
            action: A number whose bits are the buttons (1 left, 2 right, then jitter or the nudges, and
                create if the options have them, then launch on a table with a plunger), or with
                `actions="multibinary"` a bit for each.

        Returns:
            Observation, reward, terminated (by the rules), truncated (by the time limit), and the counts of
            events of the episode so far. All are new objects that no later step changes.

        Raises:
            ResetNeeded: The episode is over, or has never begun.
            ValueError: The action is not in the action space, or a reward callable does not return a number.
        """
        try:
            number = index(action)
        except TypeError:
            number = self._number_of(action)
        if not 0 <= number < self._codes:
            self._refuse(action)
        if self._copy_row is not None:
            reward, flags = self._run_task(self._addresses, 0, 1, number)
            observation = self._copy_row()
        else:
            reward, flags = self._engine.step_one(number)
            observation = self._observation()
            if self.render_mode == "human":
                self.render()
        if flags == 0:
            return observation, reward, False, False, self._info.copy()
        if flags & WAS_OVER:
            _refuse_step()
        if flags & COUNTS_CHANGED:
            self._info = self._new_info()
        return observation, reward, flags & TERMINATED != 0, flags & TRUNCATED != 0, self._info.copy()

    def _new_viewer(self) -> Viewer:
        return Viewer(self._engine.batch, self._engine.game_records if self._engine.games else None)

    @property
    def varied(self) -> dict[str, float]:
        """The numbers that the option `vary` drew for the current board, by key."""
        board = int(self._engine.batch.board_of[0])
        return {key: float(numbers[board]) for key, numbers in self._engine.pool.varied.items()}

    @property
    def rule_names(self) -> dict[str, tuple[str, ...]]:
        """The names of the table's lamps, counters and modes, in the order of their observation groups."""
        return self._engine.games.names if self._engine.games else {}

    # --- for Atari wrappers and `gymnasium.utils.play`

    def get_action_meanings(self) -> list[str]:
        """The buttons of each action of `Discrete`, in capitals; the first is NOOP."""
        return meanings(self._engine.buttons)

    def get_keys_to_action(self) -> dict[tuple[str, ...], Any]:
        """The action of each set of pressed keys: A and D for the paddles, Z, space, Return for the rest."""
        return keys_to_action(self.options, self._engine.buttons)

    @property
    def ale(self) -> PinballEnv:
        """The environment itself, for wrappers that call `env.unwrapped.ale.lives()`."""
        return self

    def lives(self) -> int:
        """The number of balls of the episode that have not been lost yet."""
        engine = self._engine
        game = engine.game_records[0] if engine.games else None
        counts = (
            {"drained": engine.batch.state["drained"][0]}
            if game is None
            else {"ball": game["used"], "balls_in_play": game["balls"]}
        )
        return int(lives_of(counts, self.options.balls))

    # --- saving

    def save_state(self) -> bytes:
        """Everything that determines what happens next, for `restore_state` in this or another process."""
        return self._memory.tobytes()

    def restore_state(self, state: bytes) -> None:
        """Restore a saved state, bit for bit; `observe` returns its observation.

        Args:
            state: Result of `save_state` of an environment with the same boards, tick rate and stack. It is
                not a file format: changed bytes are not detected.

        Raises:
            StateError: It is not such a state. The environment is unchanged.
        """
        if type(state) is not bytes:
            state = _as_bytes(state)
        if self._copy_row is None or self._engine.games:
            self._engine.restore(np.frombuffer(state, np.uint8)[None], _ALL)
            self._engine.observe()
            self._info = self._new_info()
            return
        if len(state) != self._size or state[_PREFIX] not in self._prefixes:
            self._engine.refuse_state(len(state))
        self._memory[_ALL] = state

    def observe(self) -> Any:
        """The observation of the current state, as a new object."""
        self._engine.observe()
        self._info = self._new_info()
        return self._observation()

    @property
    def is_over(self) -> bool:
        """Whether the episode has ended or has not begun."""
        return bool(self._engine.episodes["over"][0])

    def __reduce__(self) -> tuple[Any, ...]:
        """Make `copy` and `pickle` rebuild the environment, since kernels hold addresses of its arrays."""
        options = self.options.kwargs()
        attributes = {name: value for name, value in vars(self).items() if name not in REBUILT}
        return _rebuild, (type(self), self.render_mode, options, self.save_state(), attributes)

    # --- helpers

    def _new_info(self) -> dict[str, Any]:
        return _info_of(self._engine.info, self._counts.tolist(), self._lives)

    def _observation(self) -> Any:
        engine = self._engine
        raw = engine.window[0] if engine.shows_pictures else self._row
        return as_observation(self.options, engine.pool.fields, raw.copy())

    def _number_of(self, action: Any) -> int:
        """The number of a multibinary action."""
        given = as_array(action)
        is_row = self.options.actions == "multibinary" and given.shape == self._weights.shape
        bits = as_bits(given) if is_row else None
        if bits is None:
            self._refuse(action)
        return int(bits @ self._weights)

    def _refuse(self, action: Any) -> NoReturn:
        raise ValueError(f"action must be in {self.action_space}, got {action!r}")


def _rebuild(
    make: type[PinballEnv],
    render_mode: str | None,
    options: dict[str, Any],
    state: bytes,
    attributes: dict[str, Any],
) -> PinballEnv:
    env = make(render_mode, **options)
    env.restore_state(state)
    vars(env).update(attributes)
    return env


def _as_bytes(state: Any) -> bytes:
    """A state given as any bytes-like object."""
    if not isinstance(state, (bytes, bytearray, memoryview)):
        raise StateError(f"state must be the bytes that save_state returned, got {type(state).__name__}")
    return bytes(state)


def _refuse_step() -> NoReturn:
    raise gymnasium.error.ResetNeeded("the episode is over or has not begun: call reset before step")


def _info_of(names: tuple[str, ...], counts: list[int], balls: int | None) -> dict[str, Any]:
    """The info of one environment from its counts, with the lives left of so many balls."""
    info: dict[str, Any] = dict(zip(names, counts, strict=True))
    info["stalled"] = info["stalled"] == 1
    if balls is not None:
        info["lives"] = int(lives_of(info, balls))
    return info
