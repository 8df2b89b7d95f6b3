"""Many environments stepped together: `PinballVectorEnv`, a `gymnasium.vector.VectorEnv`.

One compiled call for each slice of environments does everything: actions, physics, rewards, ends, resets,
observations and counts. Environment i equals, bit for bit, the single environment with the seed of
environment i.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium.envs.registration import EnvSpec
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from silverball.envs.actions import action_space, as_array, as_bits
from silverball.envs.engine import Engine
from silverball.envs.lives import lives_of
from silverball.envs.observations import as_observation, as_observations, observation_space
from silverball.envs.options import (
    NO_LIMIT,
    VECTOR_ONLY,
    Options,
    checked_generator,
    checked_render_mode,
    checked_reset_options,
)
from silverball.envs.spec import with_step_limit
from silverball.envs.vector_arguments import (
    RESET_MODES,
    checked_mask,
    checked_mode,
    draw_missing,
    refuse_ended,
    seeds_of,
)
from silverball.envs.viewer import Viewer
from silverball.errors import StateError
from silverball.players.trained import Games
from silverball.world import WorldBatch
from silverball.world.arguments import Index, checked_int, resolve_index
from silverball.world.threads import cores

REBUILT = {"_engine", "_viewer"}
"""Attributes that refer to the engine's arrays; a copy rebuilds them."""


class PinballVectorEnv(VectorEnv[Any, Any, NDArray[Any]]):
    """Many pinball tables that step together.

    Args:
        num_envs: The number of environments.
        autoreset_mode: When an environment begins its next episode: `AutoresetMode.NEXT_STEP`, `SAME_STEP` or
            `DISABLED`, or their names or values as text.
        zero_copy: Whether every step writes to the same memory: faster, for trainers that copy what they
            keep. The caller must not write to what a step returns. Without it every step returns new arrays.
        threads: How many threads a step may use; None: one for each core. Results do not depend on it.
        render_mode: "rgb_array" or None.
        max_episode_steps: Steps after which an episode is truncated, if fewer than `time_limit` allows; None
            or −1: only `time_limit` counts.
        own_boards: Whether environment i always plays board i instead of one drawn for every episode. A
            recipe must then have as many `boards`; the tables of a list are assigned in turn.
        options: See `silverball.envs.options.OPTIONS`.

    Raises:
        TypeError: An option is unknown.
        ValueError: An option has an invalid value.
        TableError: The table has problems, or there is no such table.

    Examples:
        >>> import gymnasium as gym
        >>> import numpy as np
        >>> import silverball.envs
        >>> envs = gym.make_vec("silverball/PinballClassic-v0", num_envs=1000)
        >>> observations, infos = envs.reset(seed=7)
        >>> observations, rewards, terminated, truncated, infos = envs.step(np.ones(1000, int))
        >>> rewards.shape
        (1000,)
    """

    def __init__(
        self,
        num_envs: int = 1,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        zero_copy: bool = False,
        threads: int | None = None,
        render_mode: str | None = None,
        max_episode_steps: int | None = None,
        own_boards: bool = False,
        **options: Any,
    ) -> None:
        self.num_envs = checked_int("num_envs", num_envs, 1, 2**22)
        self.options = Options.of(options, ("num_envs", "render_mode", "max_episode_steps", *VECTOR_ONLY))
        self.autoreset_mode = checked_mode(autoreset_mode)
        self.metadata = {
            "render_modes": ["rgb_array"], "render_fps": self.options.frames_per_second,
            "autoreset_mode": self.autoreset_mode,
        }  # fmt: skip
        self.render_mode = checked_render_mode(render_mode, ("rgb_array",))
        threads = cores() if threads is None else checked_int("threads", threads, 1, 4096)
        mode = RESET_MODES[self.autoreset_mode]
        self._engine = engine = Engine(self.options, self.num_envs, mode, threads, bool(zero_copy))
        engine.rules["own_boards"] = bool(own_boards)
        boards = len(engine.pool.tables)
        if own_boards and 1 < boards < self.num_envs and not isinstance(self.options.table, (list, tuple)):
            raise ValueError(
                f"own_boards=True needs a board for each of the {self.num_envs} environments, and there are "
                f"{boards}: pass boards={self.num_envs}"
            )
        if max_episode_steps not in (None, -1):
            limit = checked_int("max_episode_steps", max_episode_steps, 1, 2**62)
            engine.rules["max_steps"] = min(limit, int(engine.rules["max_steps"][0]))
        self.single_observation_space = observation_space(self.options, engine.pool.fields)
        self.single_action_space = action_space(self.options, self._engine.buttons)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self._codes = 1 << len(self._engine.buttons)
        self._weights = 1 << np.arange(len(self._engine.buttons))
        self._has_begun = False  # whether every environment has begun an episode
        self._draws_seed = np.zeros(self.num_envs, np.bool_)  # at the next reset, after np_random was set
        self._spec: EnvSpec | None = None
        self._viewer: Viewer | None = None

    @property
    def spec(self) -> EnvSpec | None:
        """The spec from `gymnasium.make_vec`, with the number of steps after which episodes are truncated."""
        return self._spec

    @spec.setter
    def spec(self, spec: EnvSpec | None) -> None:
        limit = int(self._engine.rules["max_steps"][0])
        self._spec = with_step_limit(spec, limit if limit < NO_LIMIT else None)

    @property
    def np_random(self) -> np.random.Generator:
        """The generator that draws seeds when environments are reset without any; it can be set."""
        return VectorEnv.np_random.fget(self)  # type: ignore[attr-defined, no-any-return]

    @np_random.setter
    def np_random(self, generator: np.random.Generator) -> None:
        self._np_random, self._np_random_seed = checked_generator(generator), -1
        self._draws_seed[:] = True

    @property
    def varied(self) -> dict[str, NDArray[np.float64]]:
        """The numbers that the option `vary` drew for the current boards, by key, float64 [env] each.

        Examples:
            >>> import silverball.envs
            >>> vary = {"board.gravity": (8, 12)}
            >>> envs = silverball.envs.PinballVectorEnv(64, table="classic", vary=vary, own_boards=True)
            >>> observations, infos = envs.reset(seed=0)
            >>> envs.varied["board.gravity"][:3].round(2)
            array([11.57,  9.36, 11.61])
        """
        pool = self._engine.pool
        return {key: numbers[self._engine.batch.board_of] for key, numbers in pool.varied.items()}

    @property
    def rule_names(self) -> dict[str, tuple[str, ...]]:
        """The names of the table's lamps, counters and modes, in the order of their observation groups."""
        return self._engine.games.names if self._engine.games else {}

    @property
    def batch(self) -> WorldBatch:
        """The worlds; after changing them call `observe`."""
        return self._engine.batch

    @property
    def games(self) -> Games | None:
        """The games that the worlds play, with `rules=True`; only to be read."""
        engine = self._engine
        return Games(engine.game_records, engine.games.books) if engine.games else None

    @property
    def charge(self) -> NDArray[np.float64]:
        """How far the power supply of the coils is charged in each environment [env]; 1 without one."""
        engine, ticks = self._engine, self.options.recharge * self.options.tick_rate
        if ticks == 0:
            return np.ones(self.num_envs)
        left = engine.controls["ready"] - engine.batch.state["tick"]
        charged: NDArray[np.float64] = 1.0 - np.clip(left / ticks, 0.0, 1.0)
        return charged

    @property
    def button_names(self) -> tuple[str, ...]:
        """The buttons, in the order of an action's bits."""
        return self._engine.buttons

    @property
    def table_digests(self) -> tuple[str, ...]:
        """The hash of every board that can be drawn."""
        return self._engine.pool.boards.digests

    def reset(
        self,
        *,
        seed: int | list[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Any, dict[str, Any]]:
        """Begin episodes.

        Args:
            seed: Environment i gets seed + i, or the i-th seed of a list. None continues the current seed.
            options: ``{"reset_mask": mask}``, bool [env], begins episodes only in these environments;
                ``{"board": 12}``, or one for each [env], plays these boards (see `PinballEnv.reset`); for
                None in the list a board is drawn.

        Returns:
            The observations, and the counts of events.

        Raises:
            ValueError: The mask or the list of seeds has the wrong length, the mask is empty, a seed is not
                an integer ≥ 0, there is no such board, or an option is unknown.
            TypeError: The mask is not a boolean array.
        """
        given = checked_reset_options(options, ("reset_mask", "board"))
        mask = checked_mask(given.get("reset_mask"), self.num_envs)
        boards = self._requested_boards(given.get("board"))
        seeds = seeds_of(seed, self.num_envs)
        super().reset(seed=int(seed) if isinstance(seed, (int, np.integer)) else None)
        self._seed(seeds, mask)
        self._engine.reset_mask[:] = mask
        self._engine.reset(boards)
        self._has_begun = bool(self._engine.has_begun.all())
        counts = self._engine.outputs.last.counts
        return self._observations(), self._infos() if mask.all() else self._masked_infos(counts, mask)

    def step(
        self, actions: Any
    ) -> tuple[Any, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Hold each environment's buttons for one step.

        Args:
            actions: int [env], a number each, whose bits are the buttons; or bits [env, button].

        Returns:
            Observations, rewards, terminations, truncations, each [env], and `infos`: the counts of events so
            far, as arrays [env]. With SAME_STEP also `final_obs` and `final_info` of episodes that have
            ended.

        Raises:
            ValueError: The actions have the wrong shape, one is not in the action space, or a reward callable
                does not return numbers [env].
            ResetNeeded: An episode is over and was not reset.
        """
        engine = self._engine
        self._set_actions(actions)
        if self.autoreset_mode is AutoresetMode.DISABLED or not self._has_begun:
            refuse_ended(engine.episodes["over"])
        engine.step()
        output = engine.outputs.last
        infos = self._infos()
        if self.autoreset_mode is AutoresetMode.SAME_STEP:
            self._add_finals(infos, output.terminated | output.truncated)
        return self._observations(), output.rewards, output.terminated, output.truncated, infos

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """All tables as the window draws them, RGB [row, column, 3] each; None without a render mode."""
        if self.render_mode is None:
            return None
        if self._viewer is None:
            self._viewer = Viewer(
                self._engine.batch, self._engine.game_records if self._engine.games else None
            )
        return tuple(self._viewer.picture(index) for index in range(self.num_envs))

    def __reduce__(self) -> tuple[Any, ...]:
        """Make `copy` and `pickle` rebuild the environments, since kernels hold addresses of their arrays."""
        engine = self._engine
        options = self.options.kwargs()
        arguments = (
            self.num_envs, self.autoreset_mode, engine.has_fixed_output, engine.batch.threads,
            self.render_mode, None, bool(engine.rules["own_boards"][0]),
        )  # fmt: skip
        attributes = {name: value for name, value in vars(self).items() if name not in REBUILT}
        return _rebuild, (
            type(self),
            arguments,
            options,
            int(engine.rules["max_steps"][0]),
            self.save_state(),
            attributes,
        )

    # --- saving and branching

    def save_state(self, index: Index = None) -> NDArray[np.uint8]:
        """Copy the states of some environments.

        Args:
            index: The environments: None (all), a number, a slice, numbers, or a mask.

        Returns:
            uint8 [saved, byte]; a row's bytes are what `PinballEnv.save_state` returns.
        """
        return self._engine.save(resolve_index(index, self.num_envs))

    def restore_state(self, state: bytes | NDArray[np.uint8], index: Index = None) -> None:
        """Restore saved states, bit for bit; `observe` returns the observations.

        A single state is restored into all chosen environments, which makes them branches of it.

        Args:
            state: Result of `save_state` of this or of a single environment.
            index: The environments, as for `save_state`.

        Raises:
            StateError: They are not states, or belong to other boards, another tick rate or stack. Changed
                bytes are not detected.
            ValueError: The index is invalid, or selects another number of environments.
        """
        if isinstance(state, (bytes, bytearray, memoryview)):
            rows = np.frombuffer(state, np.uint8)[None]
        elif isinstance(state, np.ndarray) and state.dtype == np.uint8:
            rows = np.atleast_2d(state)
        else:
            raise StateError(f"state must be what save_state returned, got {type(state).__name__}")
        where = resolve_index(index, self.num_envs)
        count = len(range(*where.indices(self.num_envs))) if isinstance(where, slice) else len(where)
        if len(rows) not in (1, count):
            raise ValueError(
                f"state must be one state or {count} of them, one for each environment, got {len(rows)}"
            )
        self._engine.restore(rows, where)
        self._has_begun = bool(self._engine.has_begun.all())
        if self._engine.shows_pictures:
            self._engine.observe()

    def observe(self) -> Any:
        """The observations of the current states."""
        self._engine.observe()
        return self._observations()

    def write_to(
        self, observations: NDArray[Any], terminated: NDArray[np.bool_], truncated: NDArray[np.bool_]
    ) -> bool:
        """Make all further steps write to these arrays, for trainers that have their own (`zero_copy`).

        Args:
            observations: Array of the type and shape of a step's observations.
            terminated: bool [env].
            truncated: bool [env].

        Returns:
            True if steps write to them now. False, without any change, if the arrays have other types or
            shapes, are read-only or not contiguous, or if an observation is a dict or several pictures.
        """
        count = (self.num_envs,)
        if (observations.shape, terminated.shape, truncated.shape) != (
            self.observation_space.shape, count, count,
        ):  # fmt: skip
            return False
        return self._engine.write_to(observations, terminated, truncated)

    # --- helpers

    def _observations(self) -> Any:
        engine = self._engine
        rows = engine.window if engine.shows_pictures else engine.outputs.last.observations
        return as_observations(self.options, engine.pool.fields, rows)

    def _set_actions(self, actions: Any) -> None:
        """Check actions and store them as numbers."""
        array = as_array(actions)
        buttons = len(self._weights)
        if self.options.actions == "multibinary" and array.shape == (self.num_envs, buttons):
            bits = as_bits(array)
            if bits is None:
                wrong = next(bit for bit in array.flat if bit not in (0, 1))
                raise ValueError(f"every bit of the actions must be 0 or 1, got {wrong!r}")
            array = bits @ self._weights
        elif array.dtype.kind not in "iub":
            raise ValueError(f"actions must be integers, got {array.dtype} of the shape {array.shape}")
        if array.shape != (self.num_envs,):
            raise ValueError(f"actions must have the shape {self.action_space.shape}, got {array.shape}")
        # The bitwise or of all actions is in range exactly if each is: _codes is a power of two.
        if not 0 <= np.bitwise_or.reduce(array) < self._codes:
            raise ValueError(
                f"every action must be from 0 to {self._codes - 1}, got {array.min()} to {array.max()}"
            )
        self._engine.actions[:] = array

    def _seed(self, seeds: NDArray[np.int64], mask: NDArray[np.bool_]) -> None:
        """Seed the masked environments; those without a seed get random ones."""
        draw_missing(seeds, mask & (self._draws_seed | ~self._engine.has_begun), self.np_random)
        self._draws_seed &= ~mask
        where = mask & (seeds >= 0)
        self._engine.seed(seeds[where], where)

    def _requested_boards(self, requested: Any) -> NDArray[np.int64]:
        """The board of each environment's next episode, int64 [env]; −1: it is drawn."""
        if requested is None:
            return np.full(self.num_envs, -1, np.int64)
        each = [requested] * self.num_envs if np.ndim(requested) == 0 else list(requested)
        if len(each) != self.num_envs:
            raise ValueError(f"board must be one number or {self.num_envs} of them, got {len(each)}")
        pool = self._engine.pool
        return np.array([-1 if one is None else pool.board_of_seed(one) for one in each], np.int64)

    def _infos(self) -> dict[str, Any]:
        """The counts of the last step as Gymnasium's infos, of all environments."""
        infos = self._engine.outputs.last.infos_copy()
        return self._with_lives(infos) if self.options.lives else infos

    def _masked_infos(self, counts: NDArray[np.int64], mask: NDArray[np.bool_]) -> dict[str, Any]:
        """Counts [env, count] as Gymnasium's infos: for each key an array and its mask."""
        counts = np.where(mask[:, None], counts, 0)
        infos: dict[str, Any] = {}
        for name, row in zip(self._engine.info, counts.T, strict=True):
            infos[name], infos[f"_{name}"] = row if name != "stalled" else row != 0, mask.copy()
        return self._with_lives(infos) if self.options.lives else infos

    def _with_lives(self, infos: dict[str, Any]) -> dict[str, Any]:
        infos["lives"], infos["_lives"] = lives_of(infos, self.options.balls), infos["_created"]
        return infos

    def _add_finals(self, infos: dict[str, Any], ended: NDArray[np.bool_]) -> None:
        """Add the last observations and counts of the episodes that ended in this step."""
        engine = self._engine
        rows = np.flatnonzero(ended)
        if not len(rows):
            return
        final = np.full(self.num_envs, None, object)
        raw = engine.final_pictures(rows) if engine.shows_pictures else engine.finals[rows]
        for number, row in enumerate(rows):
            final[row] = as_observation(self.options, engine.pool.fields, raw[number])
        infos["final_obs"], infos["_final_obs"] = final, ended
        infos["final_info"] = self._masked_infos(engine.final_counts, ended)
        infos["_final_info"] = ended.copy()


def _rebuild(
    make: type[PinballVectorEnv],
    arguments: tuple[Any, ...],
    options: dict[str, Any],
    max_steps: int,
    states: NDArray[np.uint8],
    attributes: dict[str, Any],
) -> PinballVectorEnv:
    envs = make(*arguments, **options)
    envs._engine.rules["max_steps"] = max_steps
    envs.restore_state(states)
    vars(envs).update(attributes)
    return envs
