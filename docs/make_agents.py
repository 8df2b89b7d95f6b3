"""Write the reference of the environments into docs/agents.md, from the environments themselves.

    python docs/make_agents.py

Each environment has a card under Gymnasium's eight headings. Spaces and slots come from the environment,
options from `options.py`. A test fails when the page is not what this script would write.
"""

# ruff: noqa: E501  (it holds the text of a page)

from __future__ import annotations

from pathlib import Path
from typing import Any

from silverball.envs import IDS, OPTIONS, Options, PinballEnv
from silverball.envs.board_pool import make_pool
from silverball.envs.observations import Field, picture_shape
from silverball.envs.options import BUTTONS
from silverball.envs.rewards import POINT, TERMS
from silverball.envs.state import INFO

PAGE = Path(__file__).parent / "agents.md"
MARKER = "<!-- The cards: written by docs/make_agents.py, which takes them from the code. -->\n"

HEADINGS = (
    "Description", "Action Space", "Observation Space", "Rewards", "Starting State", "Episode End",
    "Arguments", "Version History",
)  # fmt: skip
GOAL = "Keep the ball off the gutter and hit what scores."
DESCRIPTIONS = {
    "silverball/Pinball-v0": "A random board for every episode: prisms slow the ball down, cylinders speed it up.",
    "silverball/PinballClassic-v0": "The built-in table `classic`, the same in every episode.",
    "silverball/PinballPixels-v0": "A random board for every episode, observed as pictures.",
}


def page() -> str:
    """The page with the cards as they should be."""
    before, _, _ = PAGE.read_text(encoding="utf-8").partition(MARKER)
    return before + MARKER + "\n" + "\n".join(card(id_) for id_ in IDS)


def card(id_: str) -> str:
    """The card of a registered environment, in Markdown."""
    given = IDS[id_]
    options = Options.of(given)
    sample = PinballEnv(**{**given, "boards": 1})
    texts = (
        f"{DESCRIPTIONS[id_]} {GOAL}",
        _actions(sample),
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


def slot_table(layout: tuple[Field, ...]) -> str:
    """The slots of an observation as a table, one row each."""
    rows = ["| group | columns | slot | range | meaning |", "| --- | --- | --- | --- | --- |"]
    for field in layout:
        width = len(field.group.slots)
        for slot, (least, meaning) in zip(field.group.slots, field.group.means, strict=True):
            columns = ", ".join(str(field.first + slot + item * width) for item in range(field.items)) or "–"
            name = f"`{slot.name.lower()}`"
            rows.append(f"| `{field.group.name}` | {columns} | {name} | {least:g} … 1 | {meaning} |")
    return "\n".join(rows)


def _actions(sample: PinballEnv) -> str:
    names = [
        name.lower().replace("+", " and ").replace("noop", "nothing") for name in sample.get_action_meanings()
    ]
    listed = ", ".join(f"{number}: {name}" for number, name in enumerate(names))
    return (
        f"`{sample.action_space}`: the buttons that are held during the step, as bits ({listed}). Further "
        f'buttons take the next bits: {BUTTONS[2]} with `jitter=True`, {BUTTONS[3]} with `create="button"`, '
        f"{BUTTONS[4]} on a table with a plunger. "
        'With `actions="multibinary"` an action has one bit for each button.'
    )


def _observations(options: Options, sample: PinballEnv) -> str:
    space = sample.observation_space
    if options.observation == "pixels":
        shape = " × ".join(map(str, picture_shape(options)))
        return (
            f"`Box(0, 255, {space.shape}, uint8)`: the last {options.stack} pictures, {shape}, oldest first. The "
            "board fills the picture; parts that were hit in the step are bright. `size`, `stack` and `rgb` set "
            "the shape."
        )
    pool = make_pool(options.table, 1, options.board_seed)
    return (
        f"`Box(-1, 1, {space.shape}, float32)`, narrower where a slot has a smaller range; with "
        f'`observation="dict"` the same by group, [item, slot] each:\n\n{slot_table(pool.fields)}'
    )


def _rewards() -> str:
    return (
        f'Points of the step × {POINT:g} (a cylinder is worth 100 points, a prism 50); with `reward="time"` the '
        "step's seconds if a ball is still on the board at its end; or weights of "
        f"{_code(TERMS)}, or a callable that receives these (see *Rewards of your own* above). `info` has the "
        f"totals of the episode so far: {_code(INFO)} (`board`: the seed of the board, for a list of tables its "
        "number, −1 for a single table)."
    )


def _code(names: tuple[str, ...]) -> str:
    return ", ".join(f"`{name}`" for name in names)


def _start(options: Options) -> str:
    board = "The table `classic`" if options.table == "classic" else "A board drawn from the pool"
    return (
        f"{board}, paddles at rest, a ball at rest at a random free place above them. Everything random follows "
        "from the seed and the number of the episode: the same seed gives the same episodes."
    )


def _end(options: Options) -> str:
    return (
        f"Terminated when the {'ball is' if options.balls == 1 else 'balls are'} in the gutter, or when no hit "
        f"has scored for {options.stall:g} s: the ball has *stalled*, as it does when both paddles are held up "
        f"forever. Truncated after {options.time_limit:g} s ({options.max_steps:,} steps)."
    )


def _arguments(given: dict[str, Any]) -> str:
    rows = ["| option | default | meaning |", "| --- | --- | --- |"]
    for name, default, text in OPTIONS:
        rows.append(f"| `{name}` | `{given.get(name, default)!r}` | {text} |")
    return "\n".join(rows)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
