"""Which sounds does a moment of the game call for? From events, news and buttons to notes to be played.

No sound device in here, and no clock: the window plays the notes at once, a film puts them where they belong.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, NamedTuple

from silverball.app.sound.bank import Key
from silverball.app.sound.panning import pan, strength_of
from silverball.app.sound.recipes import RECIPES
from silverball.app.sound.scale import BELL_STEPS, SCALE
from silverball.game.view import GameEvent, GameEventKind

if TYPE_CHECKING:  # the window opens before the physics is loaded
    from silverball.table import Table
    from silverball.world import Event

MOST_NEW = 4
"""Hits that begin to sound in one frame; the loudest are taken."""

MOST_AT_ONCE = 1.6
"""All strengths of one frame added up; what is more is made softer, so that nothing has to be cut off."""

HARD = 6.0
"""Impact speed [u/s] from which on a hit sounds hard."""

RUN_SECONDS = 2.0
"""A hit on a cylinder or a prism that comes so soon after the last one climbs a step of the scale."""

AGAIN_SECONDS = 0.04
"""A ball that meets the same part again so soon is not heard, unless it is twice as strong."""

SOFTEST = 0.02  # strength below which nothing is played
PADDLE_PLACE = 0.25  # of the width, to either side of the middle: where the paddles are heard

_TIRING = 0.25  # [s] in which the memory of a ball's hits fades by 63 %
_RATTLE = 3.0  # hits in memory above which a ball gets softer

_HITS = {  # part → sound, least strength (a cylinder kicks by itself, however softly it is touched)
    "board": ("wall", 0.0),
    "slant_wall": ("slant_wall", 0.0),
    "triangular_prism": ("prism", 0.15),
    "cylinder": ("cylinder", 0.35),
    "paddle": ("paddle_hit", 0.0),
    "ball": ("balls", 0.0),
}
_NEWS = {
    GameEventKind.BALL_SAVED: "ball_saved",
    GameEventKind.WARNING: "warning",
    GameEventKind.TILT: "tilt",
    GameEventKind.UNSTUCK: "un_stuck",
    GameEventKind.DOUBLE_ON: "double_on",
    GameEventKind.OVER: "game_over",
}
MENU = {
    "move": "menu_move",
    "choose": "menu_choose",
    "back": "menu_back",
    "refuse": "menu_refuse",
    "high_score": "high_score",
    "attract": "attract",
}
"""What a menu can say, and the sound that says it."""


class Note(NamedTuple):
    """A sound to be played.

    Attributes:
        key: Which wave.
        left: Strength in the left ear, 0 to 1.
        right: Strength in the right ear.
        ago: How long before the end of the frame it was due [s].
    """

    key: Key
    left: float
    right: float
    ago: float = 0.0


class Voices:
    """Turns what happens into notes; remembers what is needed to keep them varied, musical and few."""

    def __init__(self) -> None:
        self._turn: Counter[tuple[str, int]] = Counter()
        self.begin(None)

    def begin(self, table: Table | None) -> None:
        """Another game, on a table; None: one with two usual paddles."""
        self._paddles = (_Paddle(), _Paddle())
        if table is not None:
            for paddle, side in zip(self._paddles, ("left", "right"), strict=True):
                found = [one for one in table.paddle if one.side == side]
                paddle.is_there = bool(found)
                if found:
                    paddle.strokes = (found[0].stroke, found[0].return_stroke)
        self._last: dict[tuple[int, str], tuple[float, float]] = {}  # ball, part → time [s], strength
        self._rattle: dict[int, tuple[float, float]] = {}  # ball → time [s], hits in memory
        self._run, self._run_time = 0, -math.inf
        self._told: dict[int, int] = {}  # tick → hits in a row, as the game says
        self._is_tilted = False

    # --- what happened on the board -----------------------------------------------------------------

    def hits(
        self, events: Sequence[Event], tick_rate: int, width: float, now: float | None = None
    ) -> list[Note]:
        """The notes of a frame's events.

        Args:
            events: In the order of time.
            tick_rate: Ticks per second.
            width: Of the table [u].
            now: The world's time at the end of the frame [s]; None: that of the last event.
        """
        if not events:
            return []
        end = now if now is not None else _time(events[-1], tick_rate)
        heard = []
        for event in events:
            time = _time(event, tick_rate)
            found = self._sound_of(event, time)
            if found is not None:
                name, layer, strength = found
                heard.append((strength, time, name, layer, event.position[2]))
        self._told.clear()
        heard.sort(key=lambda one: (-one[0], one[1]))
        del heard[MOST_NEW:]
        total = sum(one[0] for one in heard)
        less = min(1.0, MOST_AT_ONCE / total) if total else 1.0
        return [
            self._note(name, layer, less * strength, pan(z, width), max(end - time, 0.0))
            for strength, time, name, layer, z in heard
        ]

    def _sound_of(self, event: Event, time: float) -> tuple[str, int, float] | None:
        """Name, layer and strength of an event's sound, or None if it has none."""
        if event.kind == "created":
            return "created", 0, 0.8
        if event.kind == "jitter":
            # Every ball is shoved, but the hand strikes once.
            return None if self._is_again(0, "jitter", time, 0.8) else ("shove", 0, 0.8)
        if event.kind == "gutter":
            return "drain", 0, 0.9
        name, least = _HITS.get(event.part.partition("[")[0].partition(".")[0], ("", 0.0))
        if not name or event.kind == "jam":
            return None
        is_hit = event.kind in ("hit", "ball_hit")
        strength = max(strength_of(event.speed), least if is_hit else 0.0) * self._freshness(event.ball, time)
        if strength < SOFTEST or self._is_again(event.ball, event.part, time, strength):
            return None
        layer = 1 if event.speed >= HARD else 0
        if is_hit and name in ("cylinder", "prism"):
            self._climb(event.tick, time)
            if name == "cylinder":
                layer = step_of(self._run)
        return name, layer, strength

    def _is_again(self, ball: int, part: str, time: float, strength: float) -> bool:
        before, as_strong = self._last.get((ball, part), (-math.inf, 0.0))
        is_again = 0.0 <= time - before < AGAIN_SECONDS and strength < 2.0 * as_strong
        if not is_again:
            self._last[ball, part] = (time, strength)
        return is_again

    def _freshness(self, ball: int, time: float) -> float:
        """1 for a ball that has been quiet, less for one that rattles."""
        before, load = self._rattle.get(ball, (time, 0.0))
        load = load * math.exp(-max(time - before, 0.0) / _TIRING) + 1.0
        self._rattle[ball] = (time, load)
        return min(1.0, (_RATTLE / load) ** 2)

    def _climb(self, tick: int, time: float) -> None:
        goes_on = 0.0 <= time - self._run_time < RUN_SECONDS
        self._run = self._told.get(tick, self._run + 1 if goes_on else 1)
        self._run_time = time

    # --- what the game says -------------------------------------------------------------------------

    def news(self, news: Iterable[GameEvent]) -> list[Note]:
        """The notes of a game's news; hits in a row are remembered for the bells of the same ticks."""
        notes = []
        for one in news:
            if one.kind is GameEventKind.COMBO:
                self._told[one.tick] = one.value
            elif one.kind is GameEventKind.TILT:
                self._is_tilted = True
            elif one.kind in (GameEventKind.BALL_READY, GameEventKind.OVER):
                self._is_tilted = False
            if one.kind in _NEWS:
                notes.append(self._note(_NEWS[one.kind], 0, 1.0, pan(0.0, 1.0)))
        return notes

    def menu(self, what: str) -> list[Note]:
        """The note of a menu; `what` is a key of `MENU`, anything else is silent."""
        return [self._note(MENU[what], 0, 1.0, pan(0.0, 1.0))] if what in MENU else []

    # --- the paddles --------------------------------------------------------------------------------

    def buttons(self, left: bool, right: bool) -> list[Note]:
        """The notes of the buttons: a coil that pulls; dead paddles are silent."""
        notes = []
        for paddle, is_down, side in zip(self._paddles, (left, right), (-1.0, 1.0), strict=True):
            is_down = is_down and paddle.is_there and not self._is_tilted  # noqa: PLW2901
            if is_down and not paddle.is_down:
                notes.append(self._note("coil", 0, 0.8, pan(side * PADDLE_PLACE, 1.0)))
            paddle.is_down = is_down
        return notes

    def pass_time(self, seconds: float) -> list[Note]:
        """The notes of the next seconds: paddles that reach their stops, more softly when they fall back."""
        notes = []
        for paddle, side in zip(self._paddles, (-1.0, 1.0), strict=True):
            ago = paddle.turn(seconds)
            if ago is not None:
                layer, strength = (1, 0.75) if paddle.is_down else (0, 0.45)
                notes.append(self._note("stop", layer, strength, pan(side * PADDLE_PLACE, 1.0), ago))
        return notes

    def _note(
        self, name: str, layer: int, strength: float, ears: tuple[float, float], ago: float = 0.0
    ) -> Note:
        count = RECIPES[name].variations
        turn = self._turn[name, layer]
        self._turn[name, layer] = (turn + 1) % count
        return Note(Key(name, layer, turn), strength * ears[0], strength * ears[1], ago)


class _Paddle:
    """Where a paddle is between its stops, 0 to 1, as far as can be heard."""

    def __init__(self) -> None:
        self.is_there = True
        self.is_down = False
        self.strokes = (0.1, 0.1)  # up and back [s]
        self._place = 0.0

    def turn(self, seconds: float) -> float | None:
        """Turn on; if a stop is reached, how long before the end of these seconds [s]."""
        goal = 1.0 if self.is_down else 0.0
        if self._place == goal:
            return None
        stroke = self.strokes[0 if self.is_down else 1]
        left = abs(goal - self._place) * stroke
        if left > seconds:
            self._place += math.copysign(seconds / stroke, goal - self._place)
            return None
        self._place = goal
        return seconds - left


def step_of(run: int) -> int:
    """The step of the bell for the n-th hit in a row: up the scale, then round its upper octave."""
    step = max(run, 1) - 1
    upper = BELL_STEPS - len(SCALE)
    return step if step < BELL_STEPS else upper + (step - upper) % len(SCALE)


def _time(event: Event, tick_rate: int) -> float:
    return event.tick / tick_rate + event.offset
