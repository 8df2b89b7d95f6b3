"""How do Python's environments and the compiled step come together? An engine owns all arrays of both.

A single environment is an engine of one, a vector environment an engine of many; there is no second path.
The addresses of the arrays are written down once (see world/single_step.py), so that a step is one short
call, or
one for each slice of environments on threads.

An engine of one keeps all that changes in one run of bytes, so that saving it is copying them.
"""

from __future__ import annotations

import hashlib
import itertools
import sys
from concurrent.futures import Future
from functools import cache
from sys import byteorder
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from silverball.envs.board_pool import Pool, PooledBatch, pool_of
from silverball.envs.buffers import WRITTEN, Outputs
from silverball.envs.episode import move
from silverball.envs.options import Options
from silverball.envs.pictures import Pictures, pictures_of
from silverball.envs.pixels import draw_finals
from silverball.envs.pointers import ADDRESSES, ARRAYS
from silverball.envs.rewards import TERMS, called, called_for_many, resolve_reward
from silverball.envs.state import COUNTS, EPISODE, FILM, RULES, SCENE, End, Mode, Task
from silverball.errors import StateError
from silverball.physics import PHYSICS_VERSION
from silverball.physics.kernel import AGENTS, SETTINGS, cache_folder, is_compiled, straight
from silverball.physics.records import WORLD, Part, records
from silverball.world.threads import pool_of_threads

FORMAT = 3  # of saved states
MARK = 16  # bytes that say of which boards and which version a saved state is
HEAD = MARK + 8  # with the number of the board
LEAST_SLICE = 1000  # work below which a thread is not worth its start: environments, states of one tick each
PICTURE = 3  # that of a picture, of each that is copied
RING = 4  # windows in the ring of pictures that are shown where they are: more are moved more seldom
COUNT_ROWS = len(COUNTS) + 2


class Engine:
    """The arrays of some environments, and what moves them.

    Attributes:
        options: What was chosen.
        pool: The boards.
        batch: The worlds, with all that a `WorldBatch` can do.
        episodes: EPISODE records [env].
        outputs: The arrays that steps write to; `outputs.last` has those of the last one: observations,
            float32 [env, column], empty for pictures; rewards, terminated, truncated [env]; counts, the
            events so far, int64 [env, count]: `COUNTS`, then the board's seed and whether it stalled.
        window: The pictures of the last observation, uint8 [env, stacked, pixel]; empty for states.
        finals, final_counts: Observations and counts of episodes that ended in the last step.
    """

    def __init__(self, options: Options, count: int, mode: Mode, threads: int, owns_output: bool) -> None:
        """Make `count` environments; `owns_output`: observations stay in the same arrays for ever."""
        self.options, self.count, self.owns_output = options, count, owns_output
        self.pool: Pool = pool_of(options.table, options.boards, options.board_seed)
        self.shows_pictures = options.observation == "pixels"
        self.stack = options.stack if self.shows_pictures else 0
        self._allocate(threads)
        self.rules = _rules(options, self.pool, mode)
        self.reward = resolve_reward(options.reward)
        self.terms = np.zeros((count if self.rules["weighs_counts"][0] else 0, len(TERMS)))
        self.counts_before = np.zeros((len(self.terms), len(COUNTS)), np.int64)
        self._set_film()
        self.actions = np.zeros(count, np.int64)
        self.masks = np.ones(count, np.bool_)
        self.wanted = np.full(count, -1, np.int64)
        columns = 0 if self.shows_pictures else self.pool.columns
        self.outputs = self._first_outputs(columns)
        kept = count if mode == Mode.SAME_STEP else 0
        self.finals = np.zeros((kept, columns), np.float32)
        self.final_counts = np.zeros((kept, COUNT_ROWS), np.int64)
        self.final_scenes = records(kept * self.stack, SCENE).reshape(kept, self.stack)
        self._held = np.zeros((1, count, 3), np.bool_)
        pictures = max(1, self.stack * int(self.rules["copies"][0])) if self.shows_pictures else 0
        self._work = options.frame_skip + PICTURE * pictures
        self._write_addresses()
        _tell_of_compiling()
        self.move = straight(move, self.addresses, 0, 1, 0)
        self.forget()

    def _allocate(self, threads: int) -> None:
        """Make the arrays of all that changes; for one environment in one run of bytes."""
        sizes = (MARK, 8, WORLD.itemsize, EPISODE.itemsize, self.stack * SCENE.itemsize)
        edges = np.cumsum((0, *(size * self.count for size in sizes)))
        self.memory = np.zeros(edges[-1], np.uint8)
        marks, board_of, worlds, episodes, scenes = (
            self.memory[start:end] for start, end in itertools.pairwise(edges)
        )
        marks.reshape(self.count, MARK)[:] = np.frombuffer(self._mark(), np.uint8)
        self.episodes = _as_records(episodes, EPISODE)
        self.scenes = _as_records(scenes, SCENE).reshape(self.count, self.stack)
        state, board = _as_records(worlds, WORLD), board_of.view(np.int64)
        self.batch = PooledBatch(self.pool, self.count, self.options.tick_rate, threads, state, board)
        self.parts = [part.reshape(self.count, -1) for part in (marks, board_of, worlds, episodes, scenes)]

    def _mark(self) -> bytes:
        """What a state must share with the environments that it is restored into."""
        told = (FORMAT, PHYSICS_VERSION, self.options.tick_rate, self.stack, self.pool.boards.digests)
        return hashlib.sha256(repr(told).encode()).digest()[:MARK]

    def _set_film(self) -> None:
        if not self.shows_pictures:
            self.pictures = Pictures(records(1, FILM), *(np.zeros((1, 0), np.uint8) for _ in range(3)))
            self.ring = 0
        else:
            self.pictures = pictures_of(self.pool, self.options.size, self.options.rgb)
            self.ring = self.stack * (RING if self.stack > 1 and self.owns_output else 1)
        self.film = self.pictures.film.copy()
        self.film["stack"] = self.stack
        # One picture is drawn right where it goes; of several the window slides along a ring.
        self.draws_in_place = self.stack == 1 and not self.owns_output
        self.rules["copies"] = not self.owns_output and self.stack > 1
        self.rules["redraw"] = self.draws_in_place
        self.rules["mends"] = not self.draws_in_place
        self.drawn = records(self.count * self.ring, SCENE).reshape(self.count, self.ring)
        self.drawn["board"] = -1

    def _first_outputs(self, columns: int) -> Outputs:
        """The arrays that the first step writes to."""
        count, pixels = self.count, self.pictures.backgrounds.shape[1]
        shown = "observations"
        if self.shows_pictures:
            shown = "frames" if self.draws_in_place else "copies"
        copies = self.stack if self.rules["copies"][0] else 0
        arrays: dict[str, NDArray[Any]] = {
            "observations": np.zeros((count, columns), np.float32),
            "rewards": np.zeros(count),
            "terminated": np.zeros(count, np.bool_),
            "truncated": np.zeros(count, np.bool_),
            "counts": np.zeros((count, COUNT_ROWS), np.int64),
            "frames": np.zeros((count, self.ring, pixels), np.uint8),
            "copies": np.zeros((count, copies, pixels), np.uint8),
        }
        return Outputs(arrays, ("rewards", "terminated", "truncated", "counts", shown))

    def _write_addresses(self) -> None:
        """Write down where everything is."""
        boards, pictures, pool = self.pool.boards, self.pictures, self.pool
        self.addresses = records(1, ADDRESSES)
        first = ARRAYS.index(WRITTEN[0])
        self._places = self.addresses.view(np.int64)[first : first + len(WRITTEN)]
        self._point_at(
            worlds=self.batch.state, boards=boards.board, board_of=self.batch.board_of,
            board_seeds=pool.seeds, colliders=boards.collider, grid=boards.grid, places=boards.place,
            logs=self.batch.logs, tallies=self.batch.tallies, held=self._held, episodes=self.episodes,
            blanks=pool.blanks, layouts=pool.layouts, rules=self.rules, film=self.film, actions=self.actions,
            masks=self.masks, wanted=self.wanted, terms=self.terms,
            counts_before=self.counts_before, finals=self.finals, final_counts=self.final_counts,
            scenes=self.scenes, final_scenes=self.final_scenes, drawn=self.drawn,
            backgrounds=pictures.backgrounds, balls=pictures.balls, paddles=pictures.paddles,
            **self.outputs.last.arrays,
        )  # fmt: skip
        lengths = {
            "envs": self.count, "boards": len(boards.board),
            "colliders": len(boards.collider), "numbers": len(boards.grid), "places": len(boards.place),
            "parts": self.batch.tallies.shape[1], "columns": self.finals.shape[1],
            "layout_columns": pool.layouts.shape[1], "counts": COUNT_ROWS, "terms": len(TERMS),
            "stack": self.stack, "ring": self.ring, "pixels": pictures.backgrounds.shape[1],
            "ball_pixels": pictures.balls.size, "paddle_pixels": pictures.paddles.size,
        }  # fmt: skip
        for name, length in lengths.items():
            self.addresses[name] = length

    def _point_at(self, **arrays: NDArray[Any]) -> None:
        """Let the kernels read and write these arrays from now on."""
        row = self.addresses[0]
        for name, array in arrays.items():
            row[f"{name}_at"] = array.ctypes.data

    # --- what moves it

    def step_one(self, action: int) -> tuple[float, int]:
        """Move the one environment on; its reward and `End` bits. Nothing moves where the episode is over."""
        if self.episodes["over"][0]:
            return 0.0, End.WAS_OVER
        self._slide()
        reward, ends = self.move(self.addresses, 0, 1, action)
        if callable(self.reward):
            reward = called(self.reward, dict(zip(TERMS, self.terms[0].tolist(), strict=True)))
        return reward, ends

    def step(self) -> None:
        """Move all environments on by their `actions`."""
        self._slide()
        self._do(Task.STEP)
        if callable(self.reward):
            rewards = called_for_many(self.reward, self.terms)
            has_moved = self.rules["mode"] != Mode.NEXT_STEP or self.episodes["steps"] > 0
            self.outputs.last.rewards[:] = np.where(has_moved, rewards, 0.0)

    def reset(self, boards: NDArray[np.int64] | int = -1) -> None:
        """Begin the next episode of the environments in `masks`, on these boards of the pool; −1: any."""
        self.wanted[:] = boards
        self._do(Task.RESET)
        self.wanted[:] = -1

    def observe(self) -> None:
        """Write the observations anew, after states were changed."""
        self._do(Task.OBSERVE)

    def _do(self, task: Task) -> None:
        """Do a task in all environments, in slices on threads; this thread takes the first slice."""
        self._renew()
        number = int(task)
        threads = min(self.batch.threads, self.count * self._work // LEAST_SLICE)
        if threads < 2:
            self.move(self.addresses, 0, self.count, number)
            return
        edges = [self.count * slice_ // threads for slice_ in range(threads + 1)]
        workers = pool_of_threads(self.batch.threads)
        others: list[Future[Any]] = [
            workers.submit(self.move, self.addresses, first, end, number)
            for first, end in itertools.pairwise(edges[1:])
        ]
        self.move(self.addresses, 0, edges[1], number)
        for other in others:
            other.result()

    def _slide(self) -> None:
        """Let the window of pictures slide on by one."""
        if self.stack < 2:
            return
        film = self.film
        at = film["at"][0] + 1
        if self.ring == self.stack:
            film["at"] = at % self.ring
        else:
            film["wraps"] = wraps = at + self.stack > self.ring
            film["at"] = 0 if wraps else at

    def _renew(self) -> None:
        """Let the next step write to arrays that nobody sees, unless its output stays where it is."""
        if not self.owns_output:
            self.outputs.renew()
            self._places[:] = self.outputs.last.addresses

    def write_to(
        self, observations: NDArray[Any], terminated: NDArray[np.bool_], truncated: NDArray[np.bool_]
    ) -> bool:
        """Let the kernels write to these arrays for ever, if they can; see `PinballVectorEnv.write_to`."""
        last, name = self.outputs.last, "frames" if self.shows_pictures else "observations"
        own = last.arrays[name]
        pairs = ((observations, own), (terminated, last.terminated), (truncated, last.truncated))
        fits = all(
            given.dtype == mine.dtype and given.size == mine.size
            and given.flags.c_contiguous and given.flags.writeable
            for given, mine in pairs
        )  # fmt: skip
        if not (fits and self.owns_output and self.stack <= 1):
            return False
        shown = {name: observations.reshape(own.shape)}
        self.outputs.replace(terminated=terminated, truncated=truncated, **shown)
        self._places[:] = self.outputs.last.addresses
        self.rules["mends"], self.rules["redraw"] = 0, self.shows_pictures
        return True

    @property
    def window(self) -> NDArray[np.uint8]:
        """The pictures of the last observation, oldest first, uint8 [env, stacked, pixel]."""
        if self.rules["copies"][0]:
            return self.outputs.last.copies
        at = int(self.film["at"][0])
        return self.outputs.last.frames[:, at : at + self.stack]

    def final_pictures(self, rows: NDArray[np.int64]) -> NDArray[np.uint8]:
        """The last pictures of the episodes that ended in these environments, uint8 [row, stacked, pixel]."""
        drawn = np.empty((len(rows), self.stack, self.pictures.backgrounds.shape[1]), np.uint8)
        draw_finals(self.addresses, rows, drawn.ctypes.data)
        return drawn

    # --- beginning and saving

    @property
    def heads(self) -> frozenset[bytes]:
        """All that the first HEAD bytes of a state can be: the mark, then the number of the board."""
        boards = range(len(self.pool.tables))
        return frozenset(self._mark() + board.to_bytes(HEAD - MARK, byteorder) for board in boards)

    @property
    def has_begun(self) -> NDArray[np.bool_]:
        """In which environments an episode has begun since they were made or seeded, bool [env]."""
        begun: NDArray[np.bool_] = self.episodes["number"] >= 0
        return begun

    def forget(self) -> None:
        """Be as if never reset."""
        self.episodes["over"] = 1
        self.episodes["number"] = -1

    def seed(self, keys: Any, where: Any = slice(None)) -> None:
        """Give environments seeds; their next episode is their first."""
        self.episodes["key"][where] = keys
        self.episodes["number"][where] = -1

    def save(self, rows: Any) -> NDArray[np.uint8]:
        """The states of some environments, uint8 [row, byte]."""
        return np.concatenate([part[rows] for part in self.parts], axis=1)

    def restore(self, states: NDArray[np.uint8], rows: Any) -> None:
        """Put states into some environments, one for each or one for all; observations stay until `observe`.

        Raises:
            StateError: They are no states of such environments.
        """
        size = sum(part.shape[1] for part in self.parts)
        if states.ndim != 2 or states.shape[1] != size or (states[:, :MARK] != self.parts[0][0]).any():
            self.refuse(states.shape[-1] if states.ndim else 0)
        edges = np.cumsum((0, *(part.shape[1] for part in self.parts)))
        parts = [states[:, start:end] for start, end in itertools.pairwise(edges)]
        boards, scenes = (np.ascontiguousarray(parts[number]).reshape(-1) for number in (1, 4))
        for numbers in (boards.view(np.int64), scenes.view(SCENE)["board"]):
            if ((numbers < 0) | (numbers >= len(self.pool.tables))).any():
                self.refuse(size)
        for own, part in zip(self.parts, parts, strict=True):
            own[rows] = part

    def __reduce__(self) -> NoReturn:
        """Nothing to copy: the kernels know the arrays by their addresses. Environments copy themselves."""
        raise TypeError("an engine cannot be copied or pickled: copy the environment that it belongs to")

    def refuse(self, size: int) -> None:
        """Say what is wrong with a state that cannot be restored."""
        need = sum(part.shape[1] for part in self.parts)
        if size != need:
            raise StateError(
                f"a state of this environment has {need} bytes, as save_state made it; got {size}"
            )
        raise StateError(
            "the state belongs to other boards, another tick rate or stack, or another version; "
            "restore it into an environment made with the same options"
        )


@cache
def _tell_of_compiling() -> None:
    """Say why the first environment of a process takes its time, if it does."""
    if SETTINGS.DISABLE_JIT or is_compiled(move.__name__, AGENTS):
        return
    how_often = "once" if cache_folder(AGENTS) else "as at every start: its cache folder cannot be written"
    words = f"compiling the environments for this machine, {how_often}; this takes half a minute or so…"
    print("silverball:", words, file=sys.stderr, flush=True)


def _as_records(memory: NDArray[np.uint8], dtype: np.dtype[Any]) -> NDArray[Any]:
    """Bytes as records of a type."""
    array = memory.view(dtype)
    return array.view(np.recarray) if SETTINGS.DISABLE_JIT else array


def _rules(options: Options, pool: Pool, mode: Mode) -> NDArray[Any]:
    """The options as the numbers that the kernels read."""
    rules = records(1, RULES)
    row = rules[0]
    board = pool.tables[0].board
    row["ticks"], row["tick"] = options.frame_skip, 1.0 / options.tick_rate
    row["balls"], row["per_ball"] = options.balls, 1.0 / options.balls
    row["by_button"] = options.create == "button"
    reward = resolve_reward(options.reward)
    row["writes_terms"] = callable(reward)
    row["weighs_counts"] = callable(reward) or not reward.keys() <= {"points", "seconds"}
    for name, weight in {} if callable(reward) else reward.items():
        row["weights"][TERMS.index(name)] = weight
    row["stall"], row["limit"] = options.steps_in(options.stall), options.steps_in(options.time_limit)
    row["per_quiet"] = 0.0 if options.stall is None else 1.0 / row["stall"]
    for bit, name in enumerate(options.buttons):
        if name in ("jitter", "create"):
            row[f"{name}_bit"] = 1 << bit
    row["boards"], row["mode"] = len(pool.tables), mode
    row["per_x"], row["per_z"] = 2.0 / board.length, 2.0 / board.width
    row["per_speed"] = 1.0 / board.speed_cap
    for side, part in ((0, Part.LEFT_PADDLE), (1, Part.RIGHT_PADDLE)):
        collider = pool.boards.collider[pool.boards.board["collider_first"][0] + part]
        row["rest"][side], row["up"][side] = collider["angle_rest"], collider["angle_up"]
        swing = collider["angle_up"] - collider["angle_rest"]
        if swing > 0.0:
            row["per_angle"][side] = 1.0 / swing
            row["per_turn"][side] = 1.0 / max(collider["lift_speed"], collider["return_speed"])
    row["state"] = options.observation != "pixels"
    row["pictures"] = options.observation == "pixels"
    row["layout"] = 1
    return rules
