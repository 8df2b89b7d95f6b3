"""Write the reference of the environments into docs/environments.md, from the environments themselves.

    python docs/make_environments.py

Each environment has a card under Gymnasium's eight headings. Spaces and slots come from the environment,
options from `options.py`. A test fails when the page is not what this script would write.
"""

# ruff: noqa: E501  (it holds the text of a page)

from __future__ import annotations

from pathlib import Path
from typing import Any

from silverball.envs import IDS, OPTIONS, Options, PinballEnv
from silverball.envs.observations import Field, picture_shape
from silverball.envs.options import BUTTONS
from silverball.envs.rewards import POINT, TERMS
from silverball.envs.state import HAPPENINGS, INFO

PAGE = Path(__file__).parent / "environments.md"
MARKER = "<!-- The cards: written by docs/make_environments.py, which takes them from the code. -->\n"

HEADINGS = (
    "Description", "Action Space", "Observation Space", "Rewards", "Starting State", "Episode End",
    "Arguments", "Version History",
)  # fmt: skip
V0 = (
    "v0: the first version. A fixed rhythm of both paddles makes half of what a good player makes, so it is for "
    "playing and for tests; compare agents on v1."
)
V1 = (
    "v1: the [benchmark](benchmark.md). Fifteen decisions a second, sticky actions and one power supply for both coils, so that "
    "pressing without looking gains little more than pressing at random. "
)
ATARI = "v1: the first version, with sticky actions and one power supply for both coils."
MOST_COLUMNS = 8  # of a slot that are listed one by one
GOAL = "Keep the ball off the gutter and hit what scores."
DESCRIPTIONS = {
    "silverball/Pinball": "A random board for every episode: prisms slow the ball down, cylinders speed it up.",
    "silverball/PinballClassic": "The built-in table `classic`, the same in every episode.",
    "silverball/PinballPixels": "A random board for every episode, observed as pictures.",
    "silverball/PinballAtari": "The table `classic` as an Atari game: pictures of 210 × 160 in colour, three balls, which "
    '`info["lives"]` and `ale.lives()` count. A step is one frame of 1/60 s; the wrappers of programs for Atari make '
    "decisions of four frames.",
    "silverball/PinballMissions": "Whole games of three balls on the built-in table [`silver_comet`](silver_comet.md) "
    "by its rules: missions, locks, multiballs and a wizard mode pay a hundred times what hits do, and take shots in "
    "the right order. Its lamps, counters and modes are observed.",
}


def page() -> str:
    """The page with the cards as they should be."""
    before, _, _ = PAGE.read_text(encoding="utf-8").partition(MARKER)
    return before + MARKER + "\n" + "\n".join(card(id_) for id_ in IDS)


def card(id_: str) -> str:
    """The card of a registered environment, in Markdown."""
    given = IDS[id_]
    options = Options.of(given)
    sample = PinballEnv(**{**given, "boards": 1})  # one board, whatever the split
    texts = (
        f"{DESCRIPTIONS[id_.partition('-')[0]]} {GOAL}",
        _actions(sample),
        _observations(options, sample),
        _rewards(options, sample),
        _start(options),
        _end(options),
        _arguments(given),
        _history(id_, options),
    )
    parts = [f"### {id_}"]
    for heading, text in zip(HEADINGS, texts, strict=True):
        parts += [f"#### {heading}", text]
    return "\n\n".join(parts) + "\n"


def _history(id_: str, options: Options) -> str:
    if id_.endswith("-v0"):
        return V0
    if f"{id_[:-1]}0" in IDS:
        return V1 + V0
    return ATARI if options.frame_skip == 1 else V1


def slot_table(layout: tuple[Field, ...]) -> str:
    """The slots of an observation as a table, one row each."""
    rows = ["| group | columns | slot | range | meaning |", "| --- | --- | --- | --- | --- |"]
    for field in layout:
        width = len(field.group.slots)
        for slot, (least, meaning) in zip(field.group.slots, field.group.means, strict=True):
            numbers = [str(field.first + slot + item * width) for item in range(field.items)]
            if len(numbers) > MOST_COLUMNS:
                numbers[2:-1] = ["…"]
            columns = ", ".join(numbers) or "–"
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
        f"buttons take the next bits: {BUTTONS[2]} with `jitter=True` (on a table with `nudge`: "
        f'{", ".join(BUTTONS[3:6])}), {BUTTONS[6]} with `create="button"`, {BUTTONS[7]} on a table with a '
        "plunger. "
        'With `actions="multibinary"` an action has one bit for each button.'
    )


def _observations(options: Options, sample: PinballEnv) -> str:
    space = sample.observation_space
    if options.observation == "pixels":
        shape = " × ".join(map(str, picture_shape(options)))
        is_one = options.stack == 1
        last, order = (
            ("a picture", "") if is_one else (f"the last {options.stack} pictures", ", oldest first")
        )
        return (
            f"`Box(0, 255, {space.shape}, uint8)`: {last}, {shape}{order}. The "
            "board fills the picture; parts that were hit in the step are bright. `size`, `stack`, `rgb` and "
            "`channels` set the shape."
        )
    return (
        f"`Box(-1, 1, {space.shape}, float32)`, narrower where a slot has a smaller range; with "
        f'`observation="dict"` the same by group, [item, slot] each:\n\n{slot_table(sample._engine.pool.fields)}'
    )


def _rewards(options: Options, sample: PinballEnv) -> str:
    if options.rules:
        return _game_rewards(options)
    return (
        f'Points of the step × {POINT:g} (a cylinder is worth 100 points, a prism 50); with `reward="time"` the '
        "step's seconds if a ball is still on the board at its end; or weights of "
        f"{_code(TERMS)}, or a callable that receives these ([Rewards of your own](#rewards-of-your-own)). `info` has the "
        f"totals of the episode so far: {_code(INFO)} (`board`: the seed of the board, for a list of tables its "
        "number, −1 for a single table); with `sticky` or `recharge` also `action`, the one that was executed."
    )


def _game_rewards(options: Options) -> str:
    return (
        f"Points of the game, with all that its rules award, × {options.reward['points']:g}; or weights of "
        f"{_code(TERMS)}, of what happens in a game, {_code(HAPPENINGS)}, of the starts of a mode as "
        "`mode NAME` and of the growth of a counter as `counter NAME`; or a callable that receives these. `info` has "
        f"the totals of the episode so far, {_code(INFO)} and those of what happens, the score being that of the game, "
        "and `ball` (the number of the present one), `balls_in_play` and `action` (the one that was executed)."
    )


def _code(names: tuple[str, ...]) -> str:
    return ", ".join(f"`{name}`" for name in names)


def _start(options: Options) -> str:
    if options.rules:
        return (
            "The first ball lies on the plunger, which launches by itself, at a speed that varies. Everything random "
            "follows from the seed and the number of the episode: the same seed gives the same episodes."
        )
    board = "The table `classic`" if options.table == "classic" else "A board drawn from the pool"
    return (
        f"{board}, paddles at rest, a ball at rest at a random free place above them. Everything random follows "
        "from the seed and the number of the episode: the same seed gives the same episodes."
    )


def _end(options: Options) -> str:
    if options.rules:
        return (
            f"Terminated when the game is over: its {options.balls} balls are lost, extra balls included; balls that are "
            f"saved come back. Or when nothing has scored for {options.stall:g} s. Truncated after "
            f"{options.time_limit:g} s ({options.max_steps:,} steps)."
        )
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
