"""What can be chosen about an environment, and what does each choice mean? Checked once, here."""

from __future__ import annotations

import dataclasses
import math
import os
from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np

from silverball.envs.rewards import POINT, Reward, did_you_mean, resolve_reward
from silverball.table import Table

Named = Table | str | os.PathLike[str] | Mapping[str, Any]
"""A table, the name of a built-in one, a path, or the keys of a table file."""

BUTTONS = ("left", "right", "jitter", "create")
OF_VECTORS = (
    "autoreset_mode",
    "zero_copy",
    "threads",
    "own_boards",
)  # what a vector environment takes besides
MOST_BOARDS = 2**16
MOST_BALLS = 1000
LONGEST = 1e7  # [s]
LARGEST_PICTURE = 1024  # [pixel] a side
MOST_STACKED = 16
NEVER = 2**62  # [step] a limit that no episode reaches


def option(default: Any, text: str) -> Any:
    """A field with its description."""
    return dataclasses.field(default=default, metadata={"text": text})


@dataclasses.dataclass(frozen=True)
class Options:
    """The choices; `OPTIONS` describes each in a sentence.

    Raises:
        ValueError: One of them cannot be.
    """

    table: Named | Sequence[Named] = option(
        "random",
        "a built-in name, a path, a table, or the keys of a table file as a dict; a recipe "
        "gives every episode a random board, a list of finished "
        "tables with the same board and paddles one of them",
    )
    boards: int = option(
        64, "of a recipe: how many boards are made beforehand, for the episodes to draw from"
    )
    board_seed: int = option(
        0, "of a recipe: the boards have the seeds board_seed, board_seed + 1, …; take others to evaluate"
    )
    observation: Literal["state", "dict", "pixels"] = option(
        "state", '"state" (one row), "dict" (the same by name) or "pixels"'
    )
    actions: Literal["discrete", "multibinary"] = option(
        "discrete",
        '"discrete" (a number whose bits are the buttons) or "multibinary" (a bit for each button)',
    )
    jitter: bool = option(False, "whether there is a button that shoves the balls")
    create: Literal["auto", "button"] = option(
        "auto", '"auto": a ball comes by itself when none is on the board; "button": a button brings it'
    )
    balls: int = option(1, "balls of an episode: 1, or 3 for a game")
    reward: Reward = option(
        "score",
        f'"score": points × {POINT}; "time": the seconds that a ball stays on the board; '
        "weights of terms as a dict; a callable, or its import path",
    )
    stall: float | None = option(
        15.0, "[s] without a scoring hit after which the episode ends as stalled; None: never"
    )
    time_limit: float | None = option(300.0, "[s] of play after which an episode is truncated; None: never")
    tick_rate: int = option(60, "ticks of the physics a second")
    frame_skip: int = option(1, "ticks of one step, in which the buttons are held")
    size: tuple[int, int] = option((84, 84), "of pictures: height and width [pixel]")
    rgb: bool = option(False, "of pictures: in colour instead of grey")
    stack: int = option(4, "of pictures: how many of the last ones an observation shows, oldest first")

    def __post_init__(self) -> None:
        """Refuse what cannot be."""
        _whole("boards", self.boards, 1, MOST_BOARDS)
        _whole("board_seed", self.board_seed, 0, 2**62)
        _one_of("observation", self.observation, ("state", "dict", "pixels"))
        _one_of("actions", self.actions, ("discrete", "multibinary"))
        _one_of("create", self.create, ("auto", "button"))
        resolved = resolve_reward(self.reward)
        if isinstance(self.reward, Mapping):
            object.__setattr__(self, "reward", resolved)
        _flag("jitter", self.jitter)
        _flag("rgb", self.rgb)
        _whole("balls", self.balls, 1, MOST_BALLS)
        _whole("tick_rate", self.tick_rate, 10, 100_000)
        _whole("frame_skip", self.frame_skip, 1, 10_000)
        _seconds("stall", self.stall)
        _seconds("time_limit", self.time_limit)
        size = tuple(self.size) if isinstance(self.size, (tuple, list)) else ()
        if len(size) != 2:
            raise ValueError(f"size must be a height and a width such as (84, 84), got {self.size!r}")
        for side in size:
            _whole("size", side, 8, LARGEST_PICTURE)
        object.__setattr__(self, "size", size)
        _whole("stack", self.stack, 1, MOST_STACKED)

    @classmethod
    def of(cls, given: dict[str, Any], others: tuple[str, ...] = ()) -> Options:
        """The options of these keyword arguments.

        Args:
            given: By their names.
            others: What else the caller takes: a name that is mistyped may mean one of these.

        Raises:
            TypeError: There is no option of that name.
        """
        names = [field.name for field in dataclasses.fields(cls)]
        for name in given:
            if name in names:
                continue
            # Trainers try options of other environments and look for these words (TorchRL: frameskip).
            unexpected = f"got an unexpected keyword argument {name!r}"
            if name in OF_VECTORS and name not in others:
                raise TypeError(f"{unexpected}: it is for many environments, gymnasium.make_vec takes it")
            known = (*names, *others)
            raise TypeError(f"{unexpected}; {did_you_mean(name, known)}The options are {', '.join(known)}")
        return cls(**given)

    @property
    def buttons(self) -> tuple[str, ...]:
        """The buttons there are, in the order of an action's bits."""
        present = (True, True, self.jitter, self.create == "button")
        return tuple(name for name, is_there in zip(BUTTONS, present, strict=True) if is_there)

    @property
    def meanings(self) -> list[str]:
        """What each discrete action holds, in capitals: NOOP, LEFT, RIGHT, LEFT+RIGHT and so on."""
        names = [name.upper() for name in self.buttons]
        codes = range(1 << len(names))
        held = [[name for bit, name in enumerate(names) if code >> bit & 1] for code in codes]
        return ["+".join(those) or "NOOP" for those in held]

    @property
    def steps(self) -> int | None:
        """The steps after which an episode is truncated; None: never."""
        return None if self.time_limit is None else self.steps_in(self.time_limit)

    @property
    def step_seconds(self) -> float:
        """Time of a step [s]."""
        return self.frame_skip / self.tick_rate

    @property
    def frames_per_second(self) -> int:
        """Pictures for people in a second of play, one for each step; at least 1."""
        return max(1, round(1.0 / self.step_seconds))

    def steps_in(self, seconds: float | None) -> int:
        """The least number of whole steps that last so long; NEVER for None."""
        return NEVER if seconds is None else max(1, math.ceil(seconds / self.step_seconds - 1e-9))


def refuse_options(given: dict[str, Any], names: tuple[str, ...], reason: str) -> None:
    """Refuse options that a trainer's adapter decides, in Python's words for what a function lacks."""
    for name in names:
        if name in given:
            raise TypeError(f"got an unexpected keyword argument {name!r}: {reason}")


OPTIONS = tuple((field.name, field.default, field.metadata["text"]) for field in dataclasses.fields(Options))
"""Name, default and description of every option."""


def _whole(name: str, value: Any, least: int, greatest: int) -> None:
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not least <= value <= greatest:
        raise ValueError(f"{name} must be a whole number from {least} to {greatest}, got {value!r}")


def _one_of(name: str, value: Any, choices: tuple[str, ...]) -> None:
    if value not in choices:
        raise ValueError(f"{name} must be one of {', '.join(map(repr, choices))}, got {value!r}")


def _flag(name: str, value: Any) -> None:
    if not isinstance(value, (bool, np.bool_)):
        raise ValueError(f"{name} must be True or False, got {value!r}")


def _seconds(name: str, value: Any) -> None:
    if value is None:
        return
    number = isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)
    if not number or not 0.0 < value <= LONGEST:
        raise ValueError(f"{name} must be None or seconds above 0, at most {LONGEST:g}, got {value!r}")
