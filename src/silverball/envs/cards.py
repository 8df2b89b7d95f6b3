"""What would a person want to know of an environment? Its card, under Gymnasium's eight headings.

A card is made from the code: spaces and slots from the environment itself, options from `options.py`. So it
cannot say anything else than what holds. docs/make_agents.py writes the cards into docs/agents.md.
"""

from __future__ import annotations

from typing import Any

from silverball.envs import IDS
from silverball.envs.board_pool import pool_of
from silverball.envs.options import BUTTONS, OPTIONS, Options
from silverball.envs.rewards import POINT, TERMS
from silverball.envs.single import PinballEnv
from silverball.envs.slots import slot_table
from silverball.envs.spaces import INFO, picture_shape

HEADINGS = (
    "Description", "Action Space", "Observation Space", "Rewards", "Starting State", "Episode End",
    "Arguments", "Version History",
)  # fmt: skip
DESCRIPTIONS = {
    "silverball/Pinball-v0": "A random board for every episode: prisms take speed away, cylinders give it. Keep "
    "the ball off the gutter and make it hit what gives points.",
    "silverball/PinballClassic-v0": "The drawn table, always the same. Keep the ball off the gutter and make it "
    "hit what gives points.",
    "silverball/PinballPixels-v0": "A random board for every episode, seen as pictures. Keep the ball off the "
    "gutter and make it hit what gives points.",
}


def card(id_: str) -> str:
    """The card of a registered environment, in Markdown."""
    given = IDS[id_]
    options = Options.of(given)
    sample = PinballEnv(**{**given, "boards": 1})
    texts = (
        DESCRIPTIONS[id_],
        _actions(options, sample),
        _observations(options, sample),
        _rewards(),
        _start(options),
        _end(options),
        _arguments(given),
        "v0: the first version.",
    )
    parts = [f"### {id_}"]
    for heading, text in zip(HEADINGS, texts, strict=True):
        parts += [f"#### {heading}", text]
    return "\n\n".join(parts) + "\n"


def _actions(options: Options, sample: PinballEnv) -> str:
    names = [" and ".join(held) or "nothing" for held in _held(options)]
    listed = ", ".join(f"{number}: {name}" for number, name in enumerate(names))
    return (
        f"`{sample.action_space}`: the buttons that are held for the step, as bits ({listed}). Further buttons "
        f'take the next bits: {BUTTONS[2]} with `jitter=True`, {BUTTONS[3]} with `create="button"`. With '
        '`actions="multibinary"` a bit for each button.'
    )


def _held(options: Options) -> list[list[str]]:
    """For every action the buttons that it holds."""
    buttons = options.buttons
    return [
        [name for bit, name in enumerate(buttons) if action >> bit & 1] for action in range(1 << len(buttons))
    ]


def _observations(options: Options, sample: PinballEnv) -> str:
    if options.observation == "pixels":
        shape = " × ".join(map(str, picture_shape(options)))
        return (
            f"`Box(0, 255, {sample.observation_space.shape}, uint8)`: the last {options.stack} pictures, {shape}, oldest first. The board "
            "fills the picture; what was hit in the step is bright. `size`, `stack` and `rgb` choose others."
        )
    pool = pool_of(options.table, 1, options.board_seed)
    return (
        f"`Box(-1, 1, {sample.observation_space.shape}, float32)`, narrower where a slot says so; with "
        f'`observation="dict"` the same by group, [item, slot] each:\n\n{slot_table(pool.fields)}'
    )


def _rewards() -> str:
    return (
        f'Points of the step × {POINT:g} (a cylinder is worth 100 points, a prism 50); with `reward="time"` the '
        "step's seconds if a ball is still on the board at its end; weights of "
        f"{', '.join(f'`{term}`' for term in TERMS)}, or a callable that receives them. "
        "`info` carries the totals of the episode so "
        f"far: {', '.join(f'`{name}`' for name in INFO)} (`board`: the seed of the board, in a list of tables its number, −1 for a single one)."
    )


def _start(options: Options) -> str:
    board = "The drawn board" if options.table == "classic" else "A board drawn from the pool"
    return (
        f"{board}, paddles at rest, a ball at rest at a random free place above them. Everything random follows "
        "from the seed and the number of the episode: the same seed gives the same episodes."
    )


def _end(options: Options) -> str:
    return (
        f"Terminated when the {'ball is' if options.balls == 1 else 'balls are'} in the gutter, or when no hit "
        f"has given points for {options.stall:g} s: the ball has *stalled*, as it does when both paddles are held "
        f"up for ever. Truncated after {options.time_limit:g} s ({options.steps_in(options.time_limit):,} steps)."
    )


def _arguments(given: dict[str, Any]) -> str:
    rows = ["| option | default | meaning |", "| --- | --- | --- |"]
    for name, default, text in OPTIONS:
        rows.append(f"| `{name}` | `{given.get(name, default)!r}` | {text} |")
    return "\n".join(rows)
