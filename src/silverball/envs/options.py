"""The options of an environment: their defaults, descriptions and checks.

The checks of seeds, render modes and reset options, which all environments share, are here too.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from operator import index
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, PlainValidator, SkipValidation, StrictBool, ValidationError

from silverball.envs.protocol import SPLITS, Level, Split, TableSource
from silverball.envs.rewards import POINT, Reward, did_you_mean, resolve_reward
from silverball.envs.sight import POSITIONS, checked_sight
from silverball.envs.variation import checked_ranges
from silverball.table.quantity import Count, FixedList, Quantity, refuse

BUTTONS = ("left", "right", "jitter", "nudge_left", "nudge_right", "nudge_up", "create", "launch")
VECTOR_ONLY = ("autoreset_mode", "zero_copy", "threads", "own_boards")
"""Arguments that vector environments take and single ones do not."""

MAX_BOARDS = 2**16
MAX_BALLS = 1000
MAX_SECONDS = 1e7
MAX_RECHARGE = 60.0  # [s]
MAX_STICKY = 0.99
MAX_PICTURE_SIDE = 1024  # [pixel]
MAX_STACK = 16
NO_LIMIT = 2**62  # [step] a limit that no episode reaches
SEED_RANGE = 2**63


def _seconds_or_none(value: Any) -> float | None:
    """None, or a time above zero [s]."""
    if value is None:
        return None
    seconds = Quantity(0.0, MAX_SECONDS, "s, or None").check(value)
    return seconds if seconds > 0.0 else refuse(f"must be None or above 0 s, got {value!r}")


def _reward(reward: Any) -> Any:
    """The reward option: checked, unchanged, with a copy of its weights."""
    resolved = resolve_reward(reward)
    return resolved if isinstance(reward, Mapping) else reward


def _vary(vary: Any) -> dict[str, tuple[float, float]] | None:
    """The ranges of the vary option; None if nothing varies."""
    return {key: (least, greatest) for key, least, greatest in checked_ranges(vary)} or None


def _boards(boards: Any) -> int | str:
    """A number of boards, or the name of a split."""
    if isinstance(boards, str):
        names = " or ".join(map(repr, SPLITS))
        return (
            boards if boards in SPLITS else refuse(f"must be a number of boards, or {names}, got {boards!r}")
        )
    return Count(1, MAX_BOARDS).check(boards)


def _split_words() -> str:
    """The splits as words."""
    return " or ".join(
        f'"{name}" ({split.boards:,} boards from the seed {split.first:,})' for name, split in SPLITS.items()
    )


class Options(BaseModel):
    """The options of an environment; `OPTIONS` describes each in a sentence."""

    model_config = ConfigDict(frozen=True, arbitrary_types_allowed=True)

    table: Annotated[TableSource | Sequence[TableSource], SkipValidation] = Field(
        "random",
        description="a built-in name, a path, a table, or the keys of a table file as a dict; a recipe gives "
        "every episode a random board, a list of finished tables with the same board and paddles one of them",
    )
    boards: Annotated[int | str, PlainValidator(_boards)] = Field(
        64,
        description="of a recipe: how many boards are made in advance; every episode draws one of them; "
        f"or a split of the benchmark, {_split_words()}",
    )
    board_seed: Annotated[int, Count(0, 2**62)] = Field(
        0,
        description="of a recipe: the boards have the seeds board_seed, board_seed + 1, …; "
        "choose others to evaluate",
    )
    level: Level = Field(
        "normal",
        description='"easy" (gravity × 0.75, no triangular prisms), "normal" or "hard" (gravity × 1.5)',
    )
    vary: Annotated[Mapping[str, tuple[float, float]] | None, PlainValidator(_vary)] = Field(
        None,
        description='physics that differ from board to board, evenly from ranges: {"board.gravity": (8, 12), '
        '"paddle.stroke": (0.09, 0.12)}; a single table then has `boards` boards, with seeds as of a recipe',
    )
    observation: Literal["state", "dict", "pixels"] = Field(
        "state", description='"state" (one row), "dict" (the same by name) or "pixels"'
    )
    actions: Literal["discrete", "multibinary"] = Field(
        "discrete",
        description='"discrete" (a number whose bits are the buttons) or "multibinary" (a bit for each one)',
    )
    jitter: StrictBool = Field(
        False,
        description="whether there is a button that shoves the balls; on a table with `nudge` "
        "there are three, which nudge it to the left, to the right and up",
    )
    create: Literal["auto", "button"] = Field(
        "auto",
        description='"auto": a ball is created when none is on the board; "button": a button creates one',
    )
    launch: Literal["button", "auto"] = Field(
        "button",
        description='on a table with a plunger: "button": a button pulls it back and launches; '
        '"auto": it launches by itself, at speeds that vary',
    )
    rules: StrictBool = Field(
        False,
        description="whether an episode is an arcade game by the rules of the table, with their points, ball "
        "save, lamps, counters and modes; else hits give the points of the parts",
    )
    balls: Annotated[int, Count(1, MAX_BALLS)] = Field(
        1, description="balls of an episode: 1, or 3 for a game"
    )
    reward: Annotated[Reward, PlainValidator(_reward)] = Field(
        "score",
        description=f'"score": points × {POINT}; "time": the seconds that a ball stays on the board; '
        "weights of terms as a dict; a callable, or its import path",
    )
    stall: Annotated[float | None, PlainValidator(_seconds_or_none)] = Field(
        15.0, description="[s] without a scoring hit after which the episode ends as stalled; None: never"
    )
    time_limit: Annotated[float | None, PlainValidator(_seconds_or_none)] = Field(
        300.0, description="[s] of play after which an episode is truncated; None: never"
    )
    tick_rate: Annotated[int, Count(10, 100_000)] = Field(60, description="physics ticks per second")
    frame_skip: Annotated[int, Count(1, 10_000)] = Field(
        1, description="ticks of one step, in which the buttons are held"
    )
    sticky: Annotated[float, Quantity(0.0, MAX_STICKY, "(a probability)")] = Field(
        0.0,
        description="probability that a step executes the action of the last one again; "
        '`info["action"]` is the one that was executed',
    )
    recharge: Annotated[float, Quantity(0.0, MAX_RECHARGE, "s")] = Field(
        0.0,
        description="[s] from one stroke of a paddle until the next one of any paddle",
    )
    sight: Annotated[float | str | None, PlainValidator(checked_sight)] = Field(
        None,
        description="what is seen of the balls: None (everything), a distance from the nearest paddle [u], "
        'beyond which a ball is hidden, or "positions" (velocities are 0)',
    )
    size: Annotated[tuple[int, int], FixedList(Count(8, MAX_PICTURE_SIDE), 2, "(height, width)")] = Field(
        (84, 84), description="of pictures: height and width [pixel]"
    )
    rgb: StrictBool = Field(False, description="of pictures: in colour instead of grey")
    stack: Annotated[int, Count(1, MAX_STACK)] = Field(
        4, description="of pictures: how many of the last ones an observation shows, oldest first"
    )
    channels: Literal[None, "first", "last"] = Field(
        None,
        description='of pictures: "first" or "last" puts pictures and colours on one axis, there, as image '
        "networks take them; None: an axis for the pictures in front, one for the colours at the end",
    )
    lives: StrictBool = Field(
        False, description='whether `info["lives"]` is the number of balls left, as with Atari'
    )

    @classmethod
    def of(cls, given: Mapping[str, Any], others: tuple[str, ...] = ()) -> Options:
        """The options of these keyword arguments.

        Args:
            given: The keyword arguments.
            others: Names of further arguments of the caller, suggested for misspelled names.

        Raises:
            TypeError: An option is unknown.
            ValueError: An option has an invalid value.
        """
        known = (*cls.model_fields, *others)
        for name in given:
            if name in cls.model_fields:
                continue
            # Trainers probe for options of other environments and match this text (TorchRL: frameskip).
            unexpected = f"got an unexpected keyword argument {name!r}"
            if name in VECTOR_ONLY and name not in others:
                raise TypeError(f"{unexpected}: only vector environments take it, use gymnasium.make_vec")
            raise TypeError(f"{unexpected}; {did_you_mean(name, known)}expected one of {', '.join(known)}")
        values = {
            name: value.item() if isinstance(value, np.generic) else value for name, value in given.items()
        }
        try:
            options = cls.model_validate(values)
        except ValidationError as error:
            raise ValueError("; ".join(map(_sentence, error.errors(include_url=False)))) from None
        if options.rules and options.create == "button":
            raise ValueError('create must be "auto" with rules=True: the rules say when a ball comes')
        if options.sight == POSITIONS and options.observation == "pixels":
            raise ValueError(
                f"sight must be None or a distance, got {POSITIONS!r}: a picture shows no velocities; "
                "with stack=1 an observation is a single picture"
            )
        if isinstance(options.boards, str) and options.board_seed != 0:
            raise ValueError(
                f"board_seed must be 0 with boards={options.boards!r}, which names the boards, "
                f"got {options.board_seed}"
            )
        return options

    def kwargs(self) -> dict[str, Any]:
        """The options as keyword arguments that make the same environment."""
        return {name: getattr(self, name) for name in type(self).model_fields}

    def buttons(self, has_plunger: bool = False, has_nudge: bool = False) -> tuple[str, ...]:
        """The buttons on a table with or without a plunger and nudge, in the order of an action's bits."""
        nudges = (self.jitter and has_nudge,) * 3
        present = (
            True, True, self.jitter and not has_nudge, *nudges, self.create == "button",
            has_plunger and self.launch == "button",
        )  # fmt: skip
        return tuple(name for name, is_present in zip(BUTTONS, present, strict=True) if is_present)

    @property
    def split(self) -> Split:
        """The boards of a recipe: the named split, or as many as `boards` from `board_seed` on."""
        boards = self.boards
        return SPLITS[boards] if isinstance(boards, str) else Split(self.board_seed, boards)

    @property
    def max_steps(self) -> int | None:
        """The steps after which an episode is truncated; None: never."""
        return None if self.time_limit is None else self.steps_in(self.time_limit)

    @property
    def step_seconds(self) -> float:
        """Duration of a step [s]."""
        return self.frame_skip / self.tick_rate

    @property
    def frames_per_second(self) -> int:
        """Rendered pictures per second of play, one for each step; at least 1."""
        return max(1, round(1.0 / self.step_seconds))

    def steps_in(self, seconds: float | None) -> int:
        """The least number of whole steps that last this long [s]; NO_LIMIT for None."""
        return NO_LIMIT if seconds is None else max(1, math.ceil(seconds / self.step_seconds - 1e-9))


OPTIONS = tuple(
    (name, field.default, field.description or "") for name, field in Options.model_fields.items()
)
"""Name, default and description of every option."""


def _sentence(detail: Any) -> str:
    """One of pydantic's errors as a sentence: where, what was expected, what was got."""
    name, context = detail["loc"][0], detail.get("ctx", {})
    match detail["type"]:
        case "silverball":
            return f"{name} {context['message']}"
        case "literal_error":
            return f"{name} must be {context['expected']}, got {detail['input']!r}"
        case "bool_type":
            return f"{name} must be True or False, got {detail['input']!r}"
        case "value_error":  # these sentences name the option
            return str(context["error"])
        case _:
            return f"{name}: {detail['msg']}, got {detail['input']!r}"


def refuse_options(given: Mapping[str, Any], names: tuple[str, ...], reason: str) -> None:
    """Reject options that a trainer's adapter sets, with Python's message for an unknown argument."""
    for name in names:
        if name in given:
            raise TypeError(f"got an unexpected keyword argument {name!r}: {reason}")


def checked_seed(seed: Any) -> int:
    """A seed as an integer ≥ 0, modulo 2⁶³.

    Raises:
        ValueError: It is not an integer, or negative.
    """
    try:
        number = index(seed)
    except TypeError:
        number = -1
    if number < 0:
        raise ValueError(f"seed must be an integer ≥ 0, got {seed!r}")
    return number % SEED_RANGE


def checked_render_mode(render_mode: str | None, modes: tuple[str, ...]) -> str | None:
    """The render mode, if it is None or one of these.

    Raises:
        ValueError: It is neither.
    """
    if render_mode is not None and render_mode not in modes:
        raise ValueError(f"render_mode must be {' or '.join(map(repr, modes))} or None, got {render_mode!r}")
    return render_mode


def checked_generator(generator: np.random.Generator) -> np.random.Generator:
    """The random generator, if it is one.

    Raises:
        TypeError: It is not a generator.
    """
    if not isinstance(generator, np.random.Generator):
        raise TypeError(f"np_random must be a numpy.random.Generator, got {generator!r}")
    return generator


def checked_reset_options(options: dict[str, Any] | None, known: tuple[str, ...]) -> dict[str, Any]:
    """The options of a reset, if their names are known; an empty dict for None.

    Raises:
        TypeError: They are not a dict.
        ValueError: One is unknown.
    """
    if options is not None and not isinstance(options, dict):
        raise TypeError(f"options must be a dict or None, got {options!r}")
    for name in options or {}:
        if name not in known:
            raise ValueError(f"unknown reset option {name!r}; expected {' or '.join(map(repr, known))}")
    return options or {}
