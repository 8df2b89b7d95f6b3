"""The environment for one agent: `PinballEnv`, a `gymnasium.Env`."""

from __future__ import annotations

from operator import index
from typing import Any, NoReturn, SupportsFloat, cast

import gymnasium
import numpy as np
from gymnasium.envs.registration import EnvSpec
from numpy.typing import NDArray

from silverball.envs.actions import as_array, as_bits, keys_to_action
from silverball.envs.engine import HEAD, Engine
from silverball.envs.options import (
    SEED_RANGE,
    Options,
    checked_generator,
    checked_render_mode,
    checked_reset_options,
    checked_seed,
)
from silverball.envs.spaces import action_space, observation_space, shown_one
from silverball.envs.spec import own_spec
from silverball.envs.state import Mode
from silverball.envs.viewer import Screen, Viewer
from silverball.errors import StateError

REMADE = {
    "_engine", "_viewer", "_codes", "_weights", "_move", "_addresses", "_row", "_counts", "_copy_row",
    "_info", "_memory", "_heads", "_size", "_screen",
}  # fmt: skip
"""Attributes that follow from the options or look at the engine's arrays; a copy makes its own."""

_HEAD, _ALL = slice(HEAD), slice(None)  # of a state's bytes


class PinballEnv(gymnasium.Env[Any, Any]):
    """A pinball table as an environment; docs/agents.md describes it slot by slot.

    Args:
        render_mode: "human" (a window, at the speed of play), "rgb_array" or None.
        options: See `silverball.envs.options.OPTIONS`.

    Raises:
        TypeError: There is no option of that name.
        ValueError: An option cannot be.
        TableError: The table cannot be used.

    Example:
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
        self._engine = engine = Engine(self.options, 1, Mode.DISABLED, threads=1, owns_output=True)
        self.observation_space = observation_space(self.options, engine.pool)
        self.action_space = action_space(self.options)
        self.metadata = {**self.metadata, "render_fps": self.options.frames_per_second}
        self._viewer: Viewer | None = None
        self._screen: Screen | None = None
        self._is_rng_set = False  # by hand, since the last reset
        self._spec: EnvSpec | None = None
        self._codes = 1 << len(self.options.buttons)
        self._weights = 1 << np.arange(len(self.options.buttons))
        # What the step needs, ready to hand.
        self._move, self._addresses = engine.move, engine.addresses
        self._row, self._counts = engine.outputs.last.observations[0], engine.outputs.last.counts[0]
        is_plain = self.options.observation == "state" and self.render_mode != "human"
        is_plain = is_plain and not callable(engine.reward)
        self._copy_row = self._row.copy if is_plain else None
        self._info = info_of(self._counts.tolist())
        self._memory = memoryview(cast(Any, engine.memory))
        self._heads, self._size = engine.heads, len(engine.memory)

    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array"], "render_fps": 60}  # noqa: RUF012  (Gymnasium's own)

    @property
    def spec(self) -> EnvSpec | None:
        """How `gymnasium.make` made it, with the steps after which it truncates an episode by itself."""
        return self._spec

    @spec.setter
    def spec(self, spec: EnvSpec | None) -> None:
        self._spec = own_spec(spec, self.options.max_steps)

    @property
    def np_random(self) -> np.random.Generator:
        """Draws the seed of an environment that is reset without one; set another to use that."""
        return gymnasium.Env.np_random.fget(self)  # type: ignore[attr-defined, no-any-return]

    @np_random.setter
    def np_random(self, generator: np.random.Generator) -> None:
        self._np_random, self._np_random_seed, self._is_rng_set = checked_generator(generator), -1, True

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begin an episode: the first of a seed, or the next one of the seed before.

        Args:
            seed: Decides all boards, places and shoves of the episodes that follow.
            options: ``{"board": 12}`` plays this board: of a recipe the one of that seed, of a list of tables
                the one of that number. Without it one is drawn.

        Returns:
            The observation, and the counts of events, all zero but `created`.

        Raises:
            ValueError: The seed is no whole number, or negative; an unknown option, or no such board.
        """
        board = checked_reset_options(options, ("board",)).get("board")
        wanted = -1 if board is None else self._engine.pool.board_of_seed(board)
        key = None if seed is None else checked_seed(seed)
        super().reset(seed=None if seed is None else int(seed))
        if key is not None:
            self._engine.seed(key)
        elif self._is_rng_set or not self._engine.has_begun.all():
            self._engine.seed(self.np_random.integers(SEED_RANGE, dtype=np.uint64).astype(np.int64))
        self._is_rng_set = False
        self._engine.reset(wanted)
        self._info = info_of(self._counts.tolist())
        if self.render_mode == "human":
            self.render()
        return self._shown(), self._info.copy()

    def step(self, action: Any) -> tuple[Any, SupportsFloat, bool, bool, dict[str, Any]]:
        """Hold the action's buttons for one step.

        Args:
            action: A number whose bits are the buttons (1 left, 2 right, then jitter and create where they
                are), or with `actions="multibinary"` a bit for each.

        Returns:
            Observation, reward, whether the episode is over by its rules, whether by the time limit, and the
            counts of events of the episode so far. All are new objects, which no later step changes.

        Raises:
            ResetNeeded: The episode is over, or has never begun.
            ValueError: There is no such action.
        """
        try:
            number = index(action)
        except TypeError:
            number = self._number_of(action)
        if not 0 <= number < self._codes:
            self._refuse(action)
        if self._copy_row is not None:
            reward, ends = self._move(self._addresses, 0, 1, number)
            observation = self._copy_row()
        else:
            reward, ends = self._engine.step_one(number)
            observation = self._shown()
            if self.render_mode == "human":
                self.render()
        if ends == 0:
            return observation, reward, False, False, self._info.copy()
        if ends & 4:
            _refuse_to_go_on()
        if ends & 8:
            self._info = info_of(self._counts.tolist())
        return observation, reward, ends & 1 == 1, ends & 2 == 2, self._info.copy()

    def render(self) -> NDArray[np.uint8] | None:
        """The table as the game draws it, RGB [row, column, 3]; None without a render mode.

        In the mode "human" it is shown in a window instead, with every reset and step, at the speed of play.
        Whoever closes the window ends the showing; the environment goes on.

        Raises:
            NoDisplay: The mode is "human", and there is no screen.
        """
        if self.render_mode is None or (self._screen is not None and self._screen.is_closed):
            return None
        if self._viewer is None:
            self._viewer = Viewer(self._engine.batch)
        if self.render_mode == "rgb_array":
            return self._viewer.picture(0)
        if self._screen is None:
            self._screen = Screen(self.metadata["render_fps"])
        self._screen.show(self._viewer.picture(0))
        return None

    def close(self) -> None:
        """Close the window, if one is open."""
        if self._screen is not None:
            self._screen.close()

    # --- what wrappers for Atari and `gymnasium.utils.play` ask for

    def get_action_meanings(self) -> list[str]:
        """What each action of `Discrete` holds, in capitals; NOOP is the first."""
        return self.options.meanings

    def get_keys_to_action(self) -> dict[tuple[str, ...], Any]:
        """The action of each set of pressed keys: A and D, Z for jitter, the space bar for create."""
        return keys_to_action(self.options)

    @property
    def ale(self) -> PinballEnv:
        """Itself: wrappers that end an episode with a life ask `env.unwrapped.ale.lives()`."""
        return self

    def lives(self) -> int:
        """Balls of the episode that are not in the gutter yet."""
        return self.options.balls - int(self._engine.batch.state["drained"][0])

    # --- saving

    def save_state(self) -> bytes:
        """Everything that decides what happens next, for `restore_state`; other processes can read it too."""
        return self._memory.tobytes()

    def restore_state(self, state: bytes) -> None:
        """Go back to a saved state, bit for bit; `observe` gives its observation.

        Args:
            state: What `save_state` of an environment with the same boards, tick rate and stack returned. It
                is no file format: bytes that somebody has changed are not recognised.

        Raises:
            StateError: It is something else; nothing has changed.
        """
        if type(state) is not bytes:
            state = _as_bytes(state)
        if self._copy_row is None:
            self._engine.restore(np.frombuffer(state, np.uint8)[None], _ALL)
            self._engine.observe()
            self._info = info_of(self._counts.tolist())
            return
        if len(state) != self._size or state[_HEAD] not in self._heads:
            self._engine.refuse(len(state))
        self._memory[_ALL] = state

    def observe(self) -> Any:
        """The observation of the present state, as a new object."""
        self._engine.observe()
        self._info = info_of(self._counts.tolist())
        return self._shown()

    @property
    def is_over(self) -> bool:
        """Whether the episode has ended, or none has begun."""
        return bool(self._engine.episodes["over"][0])

    def __reduce__(self) -> tuple[Any, ...]:
        """How `copy` and `pickle` make another: the arrays are known by address and must be made anew."""
        chosen = self.options.kwargs()
        kept = {name: value for name, value in vars(self).items() if name not in REMADE}
        return _made_again, (type(self), self.render_mode, chosen, self.save_state(), kept)

    # --- helpers

    def _shown(self) -> Any:
        engine = self._engine
        raw = engine.window[0] if engine.shows_pictures else self._row
        return shown_one(self.options, engine.pool, raw.copy())

    def _number_of(self, action: Any) -> int:
        """A multibinary action as a number."""
        given = as_array(action)
        is_row = self.options.actions == "multibinary" and given.shape == self._weights.shape
        bits = as_bits(given) if is_row else None
        if bits is None:
            self._refuse(action)
        return int(bits @ self._weights)

    def _refuse(self, action: Any) -> NoReturn:
        raise ValueError(f"action must be in {self.action_space}, got {action!r}")


def _made_again(
    make: type[PinballEnv],
    render_mode: str | None,
    chosen: dict[str, Any],
    state: bytes,
    kept: dict[str, Any],
) -> PinballEnv:
    env = make(render_mode, **chosen)
    env.restore_state(state)
    vars(env).update(kept)
    return env


def _as_bytes(state: Any) -> bytes:
    """A saved state that came back as something like bytes."""
    if not isinstance(state, (bytes, bytearray, memoryview)):
        raise StateError(f"a state is the bytes that save_state returned, got {type(state).__name__}")
    return bytes(state)


def _refuse_to_go_on() -> NoReturn:
    raise gymnasium.error.ResetNeeded("the episode is over or has not begun: call reset before step")


def info_of(counts: list[int]) -> dict[str, Any]:
    """The info of one environment, by the names of `INFO`; written out, since a loop takes twice as long."""
    (
        score, created, drained, wall_hits, slant_wall_hits, paddle_hits, triangular_prism_hits,
        cylinder_hits, ball_hits, touches, jams, board, stalled,
    ) = counts  # fmt: skip
    return {
        "score": score,
        "created": created,
        "drained": drained,
        "wall_hits": wall_hits,
        "slant_wall_hits": slant_wall_hits,
        "paddle_hits": paddle_hits,
        "triangular_prism_hits": triangular_prism_hits,
        "cylinder_hits": cylinder_hits,
        "ball_hits": ball_hits,
        "touches": touches,
        "jams": jams,
        "board": board,
        "stalled": stalled == 1,
    }
