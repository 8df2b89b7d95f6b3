"""The arrays of one or many environments of shots, and the calls on them.

An `Engine` moves the tables; after each of its steps the shots are judged. It never begins episodes by
itself, since goals and balls are placed here.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from silverball.envs.engine import Engine
from silverball.envs.observations import observation_space
from silverball.envs.options import Options, refuse_options
from silverball.envs.shots.goal_rewards import INFO_OF_SHOTS, goal_rows
from silverball.envs.shots.one_shot import SHOT_STATE, ShotArrays, begin_shots, judge_shots
from silverball.envs.shots.targets import checked_shots, parts_of
from silverball.envs.state import ResetMode
from silverball.errors import StateError
from silverball.physics.kernel import bind_types
from silverball.physics.records import records

TIME_LIMIT = 20.0  # [s] by default. Source: chosen; a shot takes 1 to 4 s
FIXED = ("reward", "stall", "balls", "create", "observation", "jitter", "rules", "lives")
"""Options of other environments that this one sets itself."""
LEFT_AND_RIGHT = 4  # actions: the two buttons as bits


class ShotEngine:
    """The tables and shots of some environments, with methods that step, reset, save and restore.

    Attributes:
        engine: The tables.
        names: The names of the shots.
        shots: SHOT_STATE records [env].
    """

    def __init__(
        self, given: Mapping[str, Any], shots: Sequence[str] | None, count: int, threads: int
    ) -> None:
        """Make `count` environments with these options.

        Raises:
            TypeError: An option is unknown, or one that shots do not have.
            ValueError: An option has an invalid value, or the table is a recipe or several.
            TableError: The table has problems, or there is no such table.
        """
        refuse_options(given, FIXED, "shots set it themselves")
        options = Options.of(
            {"table": "classic", "time_limit": TIME_LIMIT, **given, "stall": None, "create": "button"},
            ("shots", "render_mode"),
        )
        if options.actions != "discrete":
            raise ValueError(f"actions must be 'discrete' for shots, got {options.actions!r}")
        self.options, self.count = options, count
        table = options.table if isinstance(options.table, str) else None
        self.names = checked_shots(shots, table)
        self.engine = Engine(options, count, ResetMode.DISABLED, threads, has_fixed_output=True)
        if len(self.engine.pool.tables) != 1 or self.engine.pool.seeds[0] >= 0:
            raise ValueError("table must be one finished table for shots: goals name its parts")
        self.shots = records(count, SHOT_STATE)
        self._arrays = ShotArrays(
            self.shots,
            self.engine.episodes,
            parts_of(self.engine.pool.tables[0], self.names),
            np.full(count, -1, np.int64),
            np.ones(count, np.bool_),
            np.array([len(self.names)]),
        )
        batch = self.engine.batch
        self._lanes = (batch.lanes, batch.geometries)
        self._begin = bind_types(begin_shots, *self._lanes, batch.boards.place, self._arrays, 0, count)
        self._judge = bind_types(judge_shots, *self._lanes, self._arrays, 0, count)

    @property
    def over(self) -> NDArray[np.int64]:
        """Whether episodes are over or have not begun, int64 [env]."""
        over: NDArray[np.int64] = self.engine.episodes["over"]
        return over

    def spaces(self) -> tuple[spaces.Dict, spaces.Discrete]:
        """The spaces of observations and actions of one environment."""
        goal = spaces.Box(0.0, 1.0, (len(self.names),), np.float32)
        state = observation_space(self.options, self.engine.pool.fields)
        seen = {"achieved_goal": goal, "desired_goal": goal, "observation": state}
        return spaces.Dict(dict[str, spaces.Space[Any]](seen)), spaces.Discrete(LEFT_AND_RIGHT)

    def step(self) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Make a step in all environments with the engine's `actions`; returns which ended and were cut off.

        Environments whose episodes were over before are not judged.
        """
        was_over = self.over != 0
        before = self.shots[was_over].copy()
        self.engine.step()
        self._judge(*self._lanes, self._arrays, 0, self.count)
        self.shots[was_over] = before
        last = self.engine.outputs.last
        terminated = (last.terminated | (self.shots["made"] >= 0)) & ~was_over
        truncated = last.truncated & ~terminated & ~was_over
        self.engine.episodes["over"][terminated | truncated] = 1
        return terminated, truncated

    def reset(self, mask: NDArray[np.bool_], goals: NDArray[np.int64]) -> None:
        """Begin the next episode in the masked environments, with these goals [env]; −1: drawn."""
        self.engine.reset_mask[:] = mask
        self.engine.reset()
        self._arrays.mask[:], self._arrays.goals[:] = mask, goals
        self._begin(*self._lanes, self.engine.batch.boards.place, self._arrays, 0, self.count)
        self.engine.observe()

    def observations(self) -> dict[str, NDArray[Any]]:
        """The observations [env, …], as new arrays."""
        return {
            "achieved_goal": goal_rows(self.shots["made"], len(self.names)),
            "desired_goal": goal_rows(self.shots["goal"], len(self.names)),
            "observation": self.engine.outputs.last.observations.copy(),
        }

    def infos(self) -> dict[str, NDArray[Any]]:
        """The values of `INFO_OF_SHOTS` [env], as new arrays."""
        made, world = self.shots["made"].copy(), self.engine.batch.state
        limit = self.engine.rules["max_steps"][0]
        values = (
            (made >= 0) & (made == self.shots["goal"]),
            made,
            self.shots["struck"] != 0,
            world["drained"] > 0,
            (self.engine.episodes["steps"] >= limit) | (world["fault"] != 0),
        )
        return dict(zip(INFO_OF_SHOTS, values, strict=True))

    def goal_number(self, goal: Any) -> int:
        """The number of a shot by its name or number; −1 for None.

        Raises:
            ValueError: There is no such shot.
        """
        if goal is None:
            return -1
        if goal in self.names:
            return self.names.index(goal)
        if isinstance(goal, (int, np.integer)) and not isinstance(goal, bool) and 0 <= goal < len(self.names):
            return int(goal)
        names = ", ".join(map(repr, self.names))
        raise ValueError(f"goal must be one of {names}, or its number, got {goal!r}")

    def save(self, row: int) -> bytes:
        """Everything that determines what happens next in an environment."""
        return bytes(self.engine.save([row]).tobytes()) + bytes(self.shots[row].tobytes())

    def restore(self, state: Any, row: int) -> None:
        """Restore a saved state, and write the observations again.

        Raises:
            StateError: It is not a state of an environment with the same options.
        """
        if not isinstance(state, bytes) or len(state) < SHOT_STATE.itemsize:
            raise StateError(f"state must be the bytes that save_state returned, got {type(state).__name__}")
        shot = np.frombuffer(state[-SHOT_STATE.itemsize :], SHOT_STATE)[0]
        if not (0 <= shot["goal"] < len(self.names) and -1 <= shot["made"] < len(self.names)):
            raise StateError("the state belongs to other shots; restore it where the same ones are named")
        self.engine.restore(np.frombuffer(state[: -SHOT_STATE.itemsize], np.uint8)[None].copy(), [row])
        self.shots[row] = shot
        self.engine.observe()
