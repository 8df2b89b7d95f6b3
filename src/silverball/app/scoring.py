"""The scoring rules of a table as sentences with its own numbers, for the help."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from typing import NamedTuple

from silverball.app.rule_words import RuleWords
from silverball.game.mechanisms import points_by_part
from silverball.game.view import Mode
from silverball.plain import plain
from silverball.referee import tilt
from silverball.table import Arcade, Table

FIRST_KINDS = ("cylinder", "triangular_prism", "slant_wall", "paddle")
"""The order in which kinds of parts are listed; others follow in the order of the table file."""
TIMES = {1: "once", 2: "twice"}
MAX_NAMED = 6  # of each kind of a table's own rules that are listed
MAX_SHOVES = 1002  # more than any table allows


class Rule(NamedTuple):
    """One rule.

    Attributes:
        title: One or two words.
        text: A sentence.
    """

    title: str
    text: str


def how_to_score(table: Table, mode: Mode, shove_key: str = "Z") -> list[Rule]:
    """Return the scoring rules of a table, the most useful first.

    Args:
        table: A board.
        mode: Mode of the game.
        shove_key: Label of the key that shoves the table, or labels of those that nudge it; empty if there is
            none.
    """
    hits = Rule("Hits", _hits(table))
    most = table.board.max_balls
    if mode is Mode.FREE:
        balls = "one at a time" if most == 1 else f"at most {most} at a time"
        more = "Shoves cost nothing. Combos, tilt and high scores belong to arcade"
        return [hits, Rule("Free play", f"As many balls as you like, {balls}. {more}")]
    arcade = table.arcade
    rules = _own_rules(table) if table.rule else [hits, Rule("Combo", _combo(arcade))]
    if not table.rule and arcade.double > 1 and arcade.balls > 1 and most > 1:
        two = "two" if most == 2 else "two or more"
        text = f"While {two} balls are on the board every hit counts ×{arcade.double}"
        rules.append(Rule("Double", f"{text}; the second ball is one of your {arcade.balls}"))
    balls = "One ball" if arcade.balls == 1 else f"{arcade.balls} balls"
    return [
        *rules,
        Rule("Ball save", _ball_save(arcade)),
        Rule("Tilt", _tilt(arcade, shove_key, "table" if table.board.nudge else "balls")),
        Rule("Game", f"{balls}. The ten best scores of a table are saved with their replays"),
    ]


def _own_rules(table: Table) -> list[Rule]:
    """The rules of a table in words: missions, what lamps promise, multiballs, and rules that have a name."""
    words = RuleWords(table)
    names = [plain(rule.name) for rule in table.rule if rule.name]
    titled = {
        "Missions": words.goals(),
        "While lit": words.lit_shots(),
        "Multiball": words.multiballs(),
        "Rules": names,
    }
    rules = [Rule(title, "; ".join(lines[:MAX_NAMED])) for title, lines in titled.items() if lines]
    return rules or [Rule("Rules", f"{table.name} has {len(table.rule)} rules of its own")]


def _hits(table: Table) -> str:
    points: dict[str, list[int]] = {kind: [] for kind in FIRST_KINDS}
    for path, worth_of_part in points_by_part(table).items():
        if worth_of_part:
            points.setdefault(re.split(r"[\[.]", path)[0], []).append(worth_of_part)
    worth = [f"{kind.replace('_', ' ')} {_range(some)}" for kind, some in points.items() if some]
    if not worth:
        return "Nothing on this table gives points"
    words = _joined(worth)
    return f"{words[0].upper()}{words[1:]} points. A gentle touch is not a hit"


def _range(values: Collection[int]) -> str:
    least, most = min(values), max(values)
    return f"{least:,}" if least == most else f"{least:,} to {most:,}"


def _combo(arcade: Arcade) -> str:
    if not arcade.combo_window:
        return "This table has no combos"
    within = f"Hits at most {arcade.combo_window:g} s apart make a combo"
    if arcade.combo_limit == 1:
        return f"{within}, which is counted but earns no extra points"
    second = f"from the {_ordinal(arcade.combo_step + 1)} hit on they count ×2"
    if arcade.combo_limit == 2:
        return f"{within}: {second}"
    third = f"from the {_ordinal(2 * arcade.combo_step + 1)} on ×3"
    more = f", up to ×{arcade.combo_limit}" if arcade.combo_limit > 3 else ""
    return f"{within}: {second}, {third}{more}"


def _ball_save(arcade: Arcade) -> str:
    if not arcade.ball_save or not arcade.ball_saves:
        return "This table has none"
    times = TIMES.get(arcade.ball_saves, f"{arcade.ball_saves} times")
    return f"A ball lost within {arcade.ball_save:g} s of its start comes back, {times}"


def _tilt(arcade: Arcade, shove_key: str, what: str) -> str:
    shove = f"{shove_key} shoves the {what}" if shove_key else f"A shove moves the {what}"
    warns, tilts = quick_shoves(arcade)
    if warns is None:
        words = f"the {_ordinal(tilts)} of quick ones tilts"
    else:
        words = f"the {_ordinal(warns)} of quick ones warns, the {_ordinal(tilts)} tilts"
        if arcade.warnings:
            warnings = "1 warning" if arcade.warnings == 1 else f"{arcade.warnings} warnings"
            words += f", and so does one after {warnings}"
    return f"{shove}; {words}. Then the paddles are dead and nothing scores until the board is empty"


def quick_shoves(arcade: Arcade) -> tuple[int | None, int]:
    """Return which one of quick shoves gives the first warning (None: none does), and which one tilts."""
    warns: int | None = None
    warnings = 0
    for count in range(1, MAX_SHOVES):
        swing = count * tilt.SHOVE
        verdict = tilt.shove_result(swing, warnings, arcade.tilt_warning, arcade.tilt_limit, arcade.warnings)
        if verdict is tilt.ShoveResult.TILT:
            return warns, count
        if verdict is tilt.ShoveResult.WARNING:
            warnings += 1
            warns = warns or count
    return warns, MAX_SHOVES


def _ordinal(number: int) -> str:
    ending = "th" if number % 100 in (11, 12, 13) else {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{ending}"


def _joined(words: Sequence[str]) -> str:
    return " and ".join([", ".join(words[:-1]), words[-1]]) if len(words) > 1 else words[0]
