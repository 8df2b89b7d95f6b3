"""The engine: the arrays of one or many environments, and the calls of the compiled step on them.

A single environment is an engine of one, a vector environment an engine of many; both use the same code. The
addresses of the arrays are written once (see world/single_step.py), so a step is one short call, or one per
slice of environments on threads.

The state of an engine of one is contiguous in memory, so saving it is one copy.
"""

from __future__ import annotations

import hashlib
import itertools
import math
import sys
from concurrent.futures import Future
from functools import cache
from sys import byteorder
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from silverball.envs.board_pool import Pool, PooledBatch, make_pool
from silverball.envs.buffers import OutputPool
from silverball.envs.episode import run_task
from silverball.envs.for_games import GAMES
from silverball.envs.game_arrays import compile_games
from silverball.envs.observations import field_named, with_items
from silverball.envs.options import Options
from silverball.envs.pixels import draw_finals
from silverball.envs.pointers import ADDRESSES, GAME_ADDRESSES, OUTPUTS, write_addresses
from silverball.envs.protocol import at_level
from silverball.envs.rewards import TERMS, call_batch_reward, call_reward, check_terms, resolve_reward
from silverball.envs.sight import POSITIONS, reach_of
from silverball.envs.sprites import empty_pictures, make_pictures
from silverball.envs.state import (
    ALL_INFO,
    CONTROL,
    COUNTS,
    EPISODE,
    GAME_COUNTS,
    INFO,
    PICTURE_STATE,
    RULES,
    ResetMode,
    StepFlag,
    Task,
)
from silverball.envs.variation import checked_ranges
from silverball.errors import StateError
from silverball.physics import PHYSICS_VERSION
from silverball.physics.kernel import AGENTS, SETTINGS, bind_types, cache_folder, is_compiled
from silverball.physics.records import LEFT, MAX_PADDLES, RIGHT, Part, records
from silverball.physics.step import ACTION_COLUMNS
from silverball.referee.game_records import GAME
from silverball.world.single_step import addresses_of, layout_name
from silverball.world.threads import thread_pool

STATE_FORMAT = 3
SIGNATURE_SIZE = 16  # [B] start of a saved state: a hash of the settings that it depends on
PREFIX_SIZE = SIGNATURE_SIZE + 8  # [B] with the number of the board
MIN_SLICE_WORK = 1000  # ticks of one environment, below which another thread costs more than it saves
PICTURE_WORK = 3  # [tick] cost of drawing or copying a picture, in the same unit
RING_FACTOR = (
    4  # length of the ring in windows, if the window is the observation; a longer one moves less often
)


class Engine:
    """The arrays of some environments, with methods that step, reset, save and restore them.

    Attributes:
        options: The options of the environments.
        pool: The boards.
        batch: The worlds, a `WorldBatch`.
        episodes: EPISODE records [env].
        rules: One RULES record [1].
        outputs: The arrays that steps write to; `outputs.last` has those of the last one: observations,
            float32 [env, column], empty for pictures; rewards, terminated, truncated [env]; counts, the
            events so far, int64 [env, count], in the order of `info`.
        info: The keys of `info`.
        games: The rules of episodes that are games, or None.
        game_records, happened: The games, GAME records [env], and what has happened in them; see
            `pointers.GAME_ARRAYS`.
        window: The pictures of the last observation, uint8 [env, stacked, pixel]; empty for states.
        finals, final_counts: Observations and counts of episodes that ended in the last step.
    """

    def __init__(
        self, options: Options, count: int, mode: ResetMode, threads: int, has_fixed_output: bool
    ) -> None:
        """Make `count` environments; with `has_fixed_output` every step writes to the same arrays."""
        self.options, self.count, self.has_fixed_output = options, count, has_fixed_output
        self.pool: Pool = make_pool(
            at_level(options.table, options.level),
            options.split.boards,
            options.split.first,
            checked_ranges(options.vary),
            options.rules,
        )
        self.games = compile_games(options, self.pool) if options.rules else None
        self.terms_named: tuple[str, ...] = (*TERMS, *(self.games.own_terms if self.games else ()))
        self.buttons = options.buttons(self.pool.has_plunger, self.pool.has_nudge)
        self.reward = resolve_reward(options.reward)
        if not callable(self.reward):
            check_terms(self.reward, self.terms_named[len(TERMS) :])
        self.shows_pictures = options.observation == "pixels"
        self.has_controls = options.sticky > 0.0 or options.recharge > 0.0
        known = ALL_INFO if self.has_controls else INFO
        self.info: tuple[str, ...] = (*known, *(GAME_COUNTS if self.games else ()))
        if options.recharge > 0.0:
            self.pool = self.pool._replace(fields=with_items(self.pool.fields, "supply", 1))
        self.stack = options.stack if self.shows_pictures else 0
        self._allocate_state(threads)
        self.rules = _rules(options, self.pool, mode, self.buttons)
        if self.games:
            self.rules["par"] = self.games.par
        self._prepare_pictures()
        self.actions = np.zeros(count, np.int64)
        self.reset_mask = np.ones(count, np.bool_)
        self.requested_boards = np.full(count, -1, np.int64)
        rewarded = count if self.rules["weighs_counts"][0] else 0
        self.terms = np.zeros((rewarded, len(self.terms_named)))
        self.counts_before = np.zeros((rewarded, len(COUNTS)), np.int64)
        columns = 0 if self.shows_pictures else self.pool.columns
        self.outputs = self._first_outputs(columns)
        ended = count if mode == ResetMode.SAME_STEP else 0
        self.finals = np.zeros((ended, columns), np.float32)
        self.final_counts = np.zeros((ended, len(self.info)), np.int64)
        self.final_picture_states = records(ended * self.stack, PICTURE_STATE).reshape(ended, self.stack)
        columns = ACTION_COLUMNS[2 if "nudge_up" in self.buttons else self.pool.has_plunger]
        self._held = np.zeros((1, count, columns), np.bool_)
        pictures = max(1, self.stack * int(self.rules["copies_stack"][0])) if self.shows_pictures else 0
        self._work_per_env = options.frame_skip + PICTURE_WORK * pictures
        self._write_addresses()
        announce_compilation((GAMES if self.games else "") + layout_name(self.batch.state.dtype))
        self.run_task = bind_types(run_task, self.addresses, 0, 1, 0)
        self.set_unstarted()

    def _allocate_state(self, threads: int) -> None:
        """Allocate the state; that of a single environment is contiguous."""
        layout = self.pool.boards.layout
        sizes = (
            SIGNATURE_SIZE, 8, layout.itemsize, EPISODE.itemsize, self.stack * PICTURE_STATE.itemsize,
            CONTROL.itemsize * self.has_controls,
            *((GAME.itemsize, 8 * self.games.happenings) if self.games else (0, 0)),
        )  # fmt: skip
        edges = np.cumsum((0, *(size * self.count for size in sizes)))
        self.memory = np.zeros(edges[-1], np.uint8)
        signatures, board_of, worlds, episodes, picture_states, controls, games, happened = (
            self.memory[start:end] for start, end in itertools.pairwise(edges)
        )
        signatures.reshape(self.count, SIGNATURE_SIZE)[:] = np.frombuffer(self._signature(), np.uint8)
        self.episodes = _as_records(episodes, EPISODE)
        self.picture_states = _as_records(picture_states, PICTURE_STATE).reshape(self.count, self.stack)
        self.controls = _as_records(controls, CONTROL)
        state, board = _as_records(worlds, layout), board_of.view(np.int64)
        self.batch = PooledBatch(self.pool, self.options.tick_rate, threads, state, board)
        self.game_records = _as_records(games, GAME)
        self.happened = happened.view(np.int64).reshape(self.count, -1)
        parts = (signatures, board_of, worlds, episodes, picture_states, controls, games, happened)
        self.state_parts = [part.reshape(self.count, -1) for part in parts]

    def _signature(self) -> bytes:
        """A hash of the settings that a state depends on: it can only be restored where they are equal."""
        shared: tuple[Any, ...] = (
            STATE_FORMAT, PHYSICS_VERSION, self.options.tick_rate, self.stack, self.pool.boards.digests,
        )  # fmt: skip
        if self.games:
            shared = (*shared, self.games.digest)
        return hashlib.sha256(repr(shared).encode()).digest()[:SIGNATURE_SIZE]

    def _prepare_pictures(self) -> None:
        """Choose how pictures are drawn, and allocate their ring and records."""
        if not self.shows_pictures:
            self.pictures = empty_pictures(self.pool)
            self.ring = 0
        else:
            self.pictures = make_pictures(self.pool, self.options.size, self.options.rgb)
            self.ring = self.stack * (RING_FACTOR if self.stack > 1 and self.has_fixed_output else 1)
        self.raster = self.pictures.raster.copy()
        self.raster["stack"] = self.stack
        # A single picture is drawn directly into the output; a window of several moves along a ring.
        self.draws_into_output = self.stack == 1 and not self.has_fixed_output
        self.rules["copies_stack"] = not self.has_fixed_output and self.stack > 1
        self.rules["must_redraw"] = self.draws_into_output
        self.rules["can_repair"] = not self.draws_into_output
        self.drawn = records(self.count * self.ring, PICTURE_STATE).reshape(self.count, self.ring)
        self.drawn["board"] = -1

    def _first_outputs(self, columns: int) -> OutputPool:
        """The arrays that the first step writes to."""
        count, pixels = self.count, self.pictures.backgrounds.shape[1]
        shown = "observations"
        if self.shows_pictures:
            shown = "frames" if self.draws_into_output else "copies"
        copied = self.stack if self.rules["copies_stack"][0] else 0
        arrays: dict[str, NDArray[Any]] = {
            "observations": np.zeros((count, columns), np.float32),
            "rewards": np.zeros(count),
            "terminated": np.zeros(count, np.bool_),
            "truncated": np.zeros(count, np.bool_),
            "counts": np.zeros((count, len(self.info)), np.int64),
            "frames": np.zeros((count, self.ring, pixels), np.uint8),
            "copies": np.zeros((count, copied, pixels), np.uint8),
        }
        return OutputPool(arrays, ("rewards", "terminated", "truncated", "counts", shown), self.info)

    def _write_addresses(self) -> None:
        """Write the addresses of all arrays; arrays that are attributes of the engine are found by name."""
        boards, pictures, pool, batch = self.pool.boards, self.pictures, self.pool, self.batch
        arrays = {
            "worlds": batch.state, "board_of": batch.board_of, "logs": batch.logs, "tallies": batch.tallies,
            "boards": boards.board, "colliders": boards.collider, "grid": boards.grid, "places": boards.place,
            "board_seeds": pool.seeds, "blanks": pool.blanks, "layouts": pool.layouts, "held": self._held,
            "backgrounds": pictures.backgrounds, "ball_sprites": pictures.balls,
            "paddle_sprites": pictures.paddles, "pictured_boards": pictures.pictured_boards,
            "lamp_of": pictures.lamp_of, "pieces": pictures.pieces, "masks": pictures.masks,
        }  # fmt: skip
        named = ADDRESSES
        if self.games:
            weights = {} if callable(self.reward) else self.reward
            self.game_arrays = self.games.arrays(weights, self.count, len(self.counts_before))
            arrays |= {"games": self.game_records, "happened": self.happened, **self.game_arrays}
            named = GAME_ADDRESSES
        self.addresses = records(1, addresses_of(self.batch.state.dtype, named))
        write_addresses(self.addresses, {**vars(self), **arrays, **self.outputs.last.arrays})
        self._output_addresses = self.addresses.view(np.int64)[: len(OUTPUTS)]

    # --- steps and resets

    def step_one(self, action: int) -> tuple[float, int]:
        """Step the only environment, unless its episode is over; returns its reward and `StepFlag` bits."""
        if self.episodes["over"][0]:
            return 0.0, StepFlag.WAS_OVER
        self._advance_window()
        reward, flags = self.run_task(self.addresses, 0, 1, action)
        if callable(self.reward):
            reward = call_reward(
                self.reward, dict(zip(self.terms_named, self.terms[0].tolist(), strict=True))
            )
        return reward, flags

    def step(self) -> None:
        """Make a step in all environments with their `actions`."""
        self._advance_window()
        self._run(Task.STEP)
        if callable(self.reward):
            rewards = call_batch_reward(self.reward, self.terms_named, self.terms)
            has_moved = self.rules["mode"] != ResetMode.NEXT_STEP or self.episodes["steps"] > 0
            self.outputs.last.rewards[:] = np.where(has_moved, rewards, 0.0)

    def reset(self, boards: NDArray[np.int64] | int = -1) -> None:
        """Begin the next episode of the environments in `reset_mask` on these boards of the pool; −1: any."""
        self.requested_boards[:] = boards
        self._run(Task.RESET)
        self.requested_boards[:] = -1

    def observe(self) -> None:
        """Write the observations again, after states were changed."""
        self._run(Task.OBSERVE)

    def _run(self, task: Task) -> None:
        """Do a task in all environments, in slices on threads; this thread takes the first slice."""
        if not self.has_fixed_output:
            self.outputs.advance()
            self._output_addresses[:] = self.outputs.last.addresses
        code = int(task)
        threads = min(self.batch.threads, self.count * self._work_per_env // MIN_SLICE_WORK)
        if threads < 2:
            self.run_task(self.addresses, 0, self.count, code)
            return
        edges = [self.count * number // threads for number in range(threads + 1)]
        workers = thread_pool(self.batch.threads)
        others: list[Future[Any]] = [
            workers.submit(self.run_task, self.addresses, first, end, code)
            for first, end in itertools.pairwise(edges[1:])
        ]
        self.run_task(self.addresses, 0, edges[1], code)
        for other in others:
            other.result()

    def _advance_window(self) -> None:
        """Move the window of pictures along the ring by one."""
        if self.stack < 2:
            return
        raster = self.raster
        start = raster["start"][0] + 1
        if self.ring == self.stack:
            raster["start"] = start % self.ring
        else:
            raster["wraps"] = wraps = start + self.stack > self.ring
            raster["start"] = 0 if wraps else start

    def write_to(
        self, observations: NDArray[Any], terminated: NDArray[np.bool_], truncated: NDArray[np.bool_]
    ) -> bool:
        """Make all further steps write to these arrays, if possible; see `PinballVectorEnv.write_to`."""
        last, name = self.outputs.last, "frames" if self.shows_pictures else "observations"
        current = last.arrays[name]
        pairs = ((observations, current), (terminated, last.terminated), (truncated, last.truncated))
        is_in_order = self.options.channels != "first" or not self.options.rgb
        fits = is_in_order and all(
            new.dtype == old.dtype and new.size == old.size
            and new.flags.c_contiguous and new.flags.writeable
            for new, old in pairs
        )  # fmt: skip
        if not (fits and self.has_fixed_output and self.stack <= 1):
            return False
        shown = {name: observations.reshape(current.shape)}
        self.outputs.replace(terminated=terminated, truncated=truncated, **shown)
        self._output_addresses[:] = self.outputs.last.addresses
        self.rules["can_repair"], self.rules["must_redraw"] = 0, self.shows_pictures
        return True

    @property
    def window(self) -> NDArray[np.uint8]:
        """The pictures of the last observation, oldest first, uint8 [env, stacked, pixel]."""
        if self.rules["copies_stack"][0]:
            return self.outputs.last.copies
        start = int(self.raster["start"][0])
        return self.outputs.last.frames[:, start : start + self.stack]

    def final_pictures(self, rows: NDArray[np.int64]) -> NDArray[np.uint8]:
        """The last pictures of the episodes that ended in these environments, uint8 [row, stacked, pixel]."""
        drawn = np.empty((len(rows), self.stack, self.pictures.backgrounds.shape[1]), np.uint8)
        draw_finals(self.addresses, rows, drawn.ctypes.data)
        return drawn

    # --- seeds and saved states

    @property
    def state_prefixes(self) -> frozenset[bytes]:
        """All valid values of the first PREFIX_SIZE bytes of a state: the signature and a board's number."""
        boards, size = range(len(self.pool.tables)), PREFIX_SIZE - SIGNATURE_SIZE
        return frozenset(self._signature() + board.to_bytes(size, byteorder) for board in boards)

    @property
    def has_begun(self) -> NDArray[np.bool_]:
        """Whether an episode has begun since the environment was made or seeded, bool [env]."""
        begun: NDArray[np.bool_] = self.episodes["number"] >= 0
        return begun

    def set_unstarted(self) -> None:
        """Mark all environments as never reset."""
        self.episodes["over"] = 1
        self.episodes["number"] = -1

    def seed(self, seeds: Any, where: Any = slice(None)) -> None:
        """Seed environments; their next episode is the first of the seed."""
        self.episodes["seed"][where] = seeds
        self.episodes["number"][where] = -1

    def save(self, rows: Any) -> NDArray[np.uint8]:
        """The states of some environments, uint8 [row, byte]."""
        return np.concatenate([part[rows] for part in self.state_parts], axis=1)

    def restore(self, states: NDArray[np.uint8], rows: Any) -> None:
        """Restore states, one for each of these environments or one for all; `observe` writes observations.

        Raises:
            StateError: They are not states of environments with the same options.
        """
        signature_part = self.state_parts[0]
        size = sum(part.shape[1] for part in self.state_parts)
        if states.ndim != 2 or states.shape[1] != size:
            self.refuse_state(states.shape[-1] if states.ndim else 0)
        if (states[:, :SIGNATURE_SIZE] != signature_part[0]).any():
            self.refuse_state(size)
        edges = np.cumsum((0, *(part.shape[1] for part in self.state_parts)))
        parts = [states[:, start:end] for start, end in itertools.pairwise(edges)]
        boards, picture_states = (np.ascontiguousarray(parts[number]).reshape(-1) for number in (1, 4))
        for numbers in (boards.view(np.int64), picture_states.view(PICTURE_STATE)["board"]):
            if ((numbers < 0) | (numbers >= len(self.pool.tables))).any():
                self.refuse_state(size)
        for own, part in zip(self.state_parts, parts, strict=True):
            own[rows] = part
        if self.games:  # no hit is counted that the game was not told of
            self.batch.tallies[rows] = 0
            self.game_arrays["seen"][rows] = 0

    def __reduce__(self) -> NoReturn:
        """Refuse to be copied: kernels hold addresses of the arrays. Environments implement copying."""
        raise TypeError("an engine cannot be copied or pickled: copy the environment that owns it")

    def refuse_state(self, size: int) -> NoReturn:
        """Raise the error of a state of this size [B] that cannot be restored."""
        expected = sum(part.shape[1] for part in self.state_parts)
        if size != expected:
            raise StateError(
                f"a state of this environment has {expected} bytes, as save_state made it; got {size}"
            )
        raise StateError(
            "the state belongs to other boards, another tick rate or stack, or another version; "
            "restore it into an environment made with the same options"
        )


@cache
def announce_compilation(layout: str, kernel: str = run_task.__name__) -> None:
    """Print a notice if the first environment of a layout compiles this kernel, for half a minute."""
    if SETTINGS.DISABLE_JIT or is_compiled(kernel, AGENTS, layout=layout):
        return
    often = "once" if cache_folder(AGENTS) else "at every start: its cache folder cannot be written"
    notice = f"compiling the environments for this machine, {often}; this takes about half a minute …"
    print("silverball:", notice, file=sys.stderr, flush=True)


def _as_records(memory: NDArray[np.uint8], dtype: np.dtype[Any]) -> NDArray[Any]:
    """Bytes as records of a type."""
    array = memory.view(dtype)
    return array.view(np.recarray) if SETTINGS.DISABLE_JIT else array


def _rules(options: Options, pool: Pool, mode: ResetMode, buttons: tuple[str, ...]) -> NDArray[Any]:
    """The options as the numbers that the kernels read."""
    rules = records(1, RULES)
    row = rules[0]
    board = pool.tables[0].board
    row["ticks"], row["tick"] = options.frame_skip, 1.0 / options.tick_rate
    row["balls"], row["ball_scale"] = options.balls, 1.0 / options.balls
    row["creates_by_button"] = options.create == "button"
    reward = resolve_reward(options.reward)
    row["writes_terms"] = callable(reward)
    row["weighs_counts"] = callable(reward) or not reward.keys() <= {"points", "seconds"}
    for name, weight in {} if callable(reward) else reward.items():
        if name in TERMS:
            row["weights"][TERMS.index(name)] = weight
    row["sticky_below"] = round(options.sticky * 2**32)
    row["recharge_ticks"] = math.ceil(options.recharge * options.tick_rate - 1e-9)
    row["supply_at"] = field_named(pool.fields, "supply").first
    row["stall_steps"] = options.steps_in(options.stall)
    row["max_steps"] = options.steps_in(options.time_limit)
    row["idle_scale"] = 0.0 if options.stall is None else 1.0 / row["stall_steps"]
    for bit, name in enumerate(buttons):
        if name not in ("left", "right"):  # these have the first two bits
            row[f"{name}_bit"] = 1 << bit
    row["boards"], row["mode"] = len(pool.tables), mode
    row["x_scale"], row["z_scale"] = 2.0 / board.length, 2.0 / board.width
    row["speed_scale"] = 1.0 / board.speed_cap
    first = pool.boards.board["collider_first"][0] + Part.FIRST_PADDLE
    for number in range(pool.boards.board["paddles"][0]):
        collider = pool.boards.collider[first + number]
        row["rest_angle"][number], row["raised_angle"][number] = collider["angle_rest"], collider["angle_up"]
        swing = collider["angle_up"] - collider["angle_rest"]
        if swing > 0.0:
            row["angle_scale"][number] = 1.0 / swing
            of_all = pool.boards.collider[pool.boards.board["collider_first"] + Part.FIRST_PADDLE + number]
            row["turn_scale"][number] = 1.0 / max(of_all["lift_speed"].max(), of_all["return_speed"].max())
    row["paddle_of"] = _shown_paddles(pool)
    balls, paddles, game = (field_named(pool.fields, name) for name in ("balls", "paddles", "game"))
    row["reach"], row["hides_velocities"] = reach_of(options.sight), options.sight == POSITIONS
    row["balls_shown"], row["paddles_shown"] = balls.items, paddles.items
    row["paddles_at"], row["game_at"] = paddles.first, game.first
    row["layout_at"] = pool.columns - pool.layouts.shape[1]
    _write_devices_shown(row, pool)
    row["launches_itself"] = pool.has_plunger and options.launch == "auto"
    for name in ("play", "lamps", "counters", "modes"):
        row[f"{name}_at"] = field_named(pool.fields, name).first
    row["writes_state"] = options.observation != "pixels"
    row["draws_pictures"] = options.observation == "pixels"
    return rules


def _write_devices_shown(row: Any, pool: Pool) -> None:
    """Write which slots of devices there are, and how far a tick pulls the plunger back."""
    devices = (("ball_places", "places"), ("switches", "switches"), ("spinners", "spinners"))
    for name, shown in devices:
        field = field_named(pool.fields, name)
        row[f"{shown}_shown"], row[f"{shown}_at"] = field.items, field.first
    plunger = field_named(pool.fields, "plunger")
    row["plungers_shown"], row["plunger_at"] = plunger.items, plunger.first
    row["shows_devices"] = any(
        row[f"{name}_shown"] for name in ("places", "switches", "spinners", "plungers")
    )
    if plunger.items:
        board_row = pool.boards.board[0]
        collider = pool.boards.collider[board_row["collider_first"] + board_row["plunger_row"]]
        row["charge_scale"] = row["tick"] / collider["charge_time"]


def _shown_paddles(pool: Pool) -> list[int]:
    """The paddle in each slot: the first of the left button, the first of the right one, then the others."""
    board = pool.boards.board[0]
    first = board["collider_first"] + Part.FIRST_PADDLE
    buttons = pool.boards.collider["button"][first : first + board["paddles"]].tolist()
    main = [buttons.index(button) if button in buttons else -1 for button in (LEFT, RIGHT)]
    shown = [*main, *(number for number in range(len(buttons)) if number not in main)]
    return [*shown, *[-1] * MAX_PADDLES][:MAX_PADDLES]
