"""The voices: notes for the sounds that events, game events and buttons trigger.

This module has no sound device and no clock: the window plays the notes immediately, a film places them at
their times.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from silverball.app.sound import part_sounds
from silverball.app.sound.bank import RECIPES, Key
from silverball.app.sound.calls import CALLS, call_of_cue, seconds_of
from silverball.app.sound.levels import pan, strength_of
from silverball.app.sound.moods import missions_of
from silverball.app.sound.synth import BELL_STEPS, SCALE
from silverball.game.mechanisms import primitives_by_part
from silverball.game.view import GameEvent, GameEventKind
from silverball.table.primitive import Finish

if TYPE_CHECKING:  # the window opens before the physics is loaded
    from silverball.table import Table
    from silverball.world import Event

MAX_NEW = 4
"""Hits that begin to sound in one frame; the loudest are chosen."""

MAX_AT_ONCE = 1.6
"""Limit for the sum of strengths in one frame; a greater sum is scaled down to it, to prevent clipping."""

HARD = 6.0
"""Impact speed [u/s] from which a hit sounds hard."""

RUN_SECONDS = 2.0
"""Hits on cylinders and prisms within this time climb the scale, one step each."""

REPEAT_SECONDS = 0.04
"""A repeated hit of the same part within this time is silent, unless it is twice as strong."""

SOFTEST = 0.02  # strength below which nothing is played
PADDLE_PLACE = 0.25  # of the width, left and right of the middle
PLUNGER_PLACE = 0.45  # of the width, to the right of the middle
SIDES = {"left": -1.0, "right": 1.0}
"""The side on which the paddles of a button are heard."""

_RATTLE_DECAY = 0.25  # [s] time constant of a ball's hit count
_RATTLE_LIMIT = 3.0  # decayed hit count above which a ball gets softer

EAR_PLACE = pan(0.0, 1.0)  # of what has no place on the table
GAME_SOUNDS = {
    GameEventKind.BALL_SAVED: "ball_saved",
    GameEventKind.WARNING: "warning",
    GameEventKind.TILT: "tilt",
    GameEventKind.UNSTUCK: "unstuck",
    GameEventKind.DOUBLE_ON: "double_on",
    GameEventKind.OVER: "game_over",
}
GAME_CALLS = {
    GameEventKind.EXTRA_BALL: "extra_ball",
    GameEventKind.MULTIBALL: "multiball",
    GameEventKind.BALL_LOCKED: "lock",
}
MENU = {
    "move": "menu_move",
    "choose": "menu_choose",
    "back": "menu_back",
    "refuse": "menu_refuse",
    "high_score": "high_score",
    "attract": "attract",
}
"""The sounds of the menus."""


class Note(NamedTuple):
    """A sound to play.

    Attributes:
        key: Key of the wave.
        left: Strength in the left ear, 0 to 1.
        right: Strength in the right ear.
        ago: Time from the note to the end of the frame [s].
    """

    key: Key
    left: float
    right: float
    ago: float = 0.0


class Voices:
    """Turns events into notes, and remembers recent ones to vary them and to limit repetition."""

    def __init__(self, table: Table | None = None) -> None:
        self._next_variation: Counter[tuple[str, int]] = Counter()
        self.begin_game(table)

    def begin_game(self, table: Table | None) -> None:
        """Begin another game on a table; None: one with two default paddles and nothing else."""
        self._parts = {} if table is None else part_sounds.sounds_of_parts(table)
        self._paddles = default_paddles() if table is None else paddles_of(table)
        self._down: set[str] = set()  # the buttons that are down and do something
        self._has_plunger = any(part.finish is Finish.PLUNGER for part in self._parts.values())
        self._last: dict[tuple[int, str], tuple[float, float]] = {}  # ball, part → time [s], strength
        self._rattle: dict[int, tuple[float, float]] = {}  # ball → time [s], decayed hit count
        self._run, self._run_time = 0, -math.inf
        self._combos: dict[int, int] = {}  # tick → hits in a row, from the game
        self._is_tilted = False
        self._missions = frozenset(() if table is None else missions_of(table))
        self._call_rank, self._call_left = 0, 0.0  # of the call that sounds, and how long it still does [s]

    # --- events of the board ------------------------------------------------------------------------

    def world_events(
        self, events: Sequence[Event], tick_rate: int, width: float, now: float | None = None
    ) -> list[Note]:
        """Return the notes of a frame's events.

        Args:
            events: Events in order of time.
            tick_rate: Ticks per second.
            width: Width of the table [u].
            now: Time of the world at the end of the frame [s]; None: that of the last event.
        """
        if not events:
            return []
        end = now if now is not None else _time(events[-1], tick_rate)
        chosen = []
        for event in events:
            time = _time(event, tick_rate)
            found = self._sound_of(event, time)
            if found is not None:
                name, layer, strength = found
                chosen.append((strength, time, name, layer, event.position[2]))
        self._combos.clear()
        chosen.sort(key=lambda one: (-one[0], one[1]))
        del chosen[MAX_NEW:]
        total = sum(one[0] for one in chosen)
        less = min(1.0, MAX_AT_ONCE / total) if total else 1.0
        return [
            self._note(name, layer, less * strength, pan(z, width), max(end - time, 0.0))
            for strength, time, name, layer, z in chosen
        ]

    def _sound_of(self, event: Event, time: float) -> tuple[str, int, float] | None:
        """Return name, layer and strength of an event's sound; None if it has none."""
        if event.kind in part_sounds.BLOWS:
            return self._blow(event, time)
        part = self._parts.get(event.part)
        sound = part_sounds.event_sound(event.kind, None if part is None else part.finish)
        is_once = event.kind in part_sounds.ONCE
        if sound is None or (is_once and self._is_repeat(0, event.kind, time, sound.strength)):
            return None
        return sound.name, 0, sound.strength

    def _blow(self, event: Event, time: float) -> tuple[str, int, float] | None:
        """Return name, layer and strength of the sound of a hit or touch; None if it is not heard."""
        part = self._parts.get(event.part)
        if event.part == "ball":
            sound = part_sounds.BALL
        elif part is not None:
            sound = part.blow
        else:
            return None  # the sounds are those of another table
        is_hit = event.kind in ("hit", "ball_hit")
        strength = max(strength_of(event.speed), sound.least if is_hit else 0.0)
        strength *= self._rattle_factor(event.ball, time)
        if strength < SOFTEST or self._is_repeat(event.ball, event.part, time, strength):
            return None
        layer = 1 if event.speed >= HARD else 0
        if is_hit and sound.climbs:
            self._climb(event.tick, time)
        if RECIPES[sound.name].layers == BELL_STEPS:
            layer = step_of(self._run) if is_hit else 0
        return sound.name, min(layer, RECIPES[sound.name].layers - 1), strength

    def _is_repeat(self, ball: int, part: str, time: float, strength: float) -> bool:
        before, as_strong = self._last.get((ball, part), (-math.inf, 0.0))
        is_repeat = 0.0 <= time - before < REPEAT_SECONDS and strength < 2.0 * as_strong
        if not is_repeat:
            self._last[ball, part] = (time, strength)
        return is_repeat

    def _rattle_factor(self, ball: int, time: float) -> float:
        """Return 1 for a ball that was quiet, less for one that rattles."""
        before, load = self._rattle.get(ball, (time, 0.0))
        load = load * math.exp(-max(time - before, 0.0) / _RATTLE_DECAY) + 1.0
        self._rattle[ball] = (time, load)
        return min(1.0, (_RATTLE_LIMIT / load) ** 2)

    def _climb(self, tick: int, time: float) -> None:
        continues = 0.0 <= time - self._run_time < RUN_SECONDS
        self._run = self._combos.get(tick, self._run + 1 if continues else 1)
        self._run_time = time

    # --- events of the game and the menus -----------------------------------------------------------

    def game_events(self, events: Sequence[GameEvent]) -> list[Note]:
        """Return the notes of game events; combos are remembered for the bells of the same ticks."""
        notes = []
        for event in events:
            if event.kind is GameEventKind.COMBO:
                self._combos[event.tick] = event.value
            elif event.kind is GameEventKind.TILT:
                self._is_tilted = True
            elif event.kind in (GameEventKind.BALL_READY, GameEventKind.OVER):
                self._is_tilted = False
            if event.kind in GAME_SOUNDS:
                notes.append(self._note(GAME_SOUNDS[event.kind], 0, 1.0, EAR_PLACE))
        return notes + self._calls(events)

    def _calls(self, events: Sequence[GameEvent]) -> list[Note]:
        """Return the note of the call of the highest rank, unless one of a higher rank still sounds."""
        names = [name for event in events if (name := self._call_of(event))]
        name = max(names, key=lambda one: CALLS[one].rank, default="")
        if not name or (self._call_left > 0.0 and CALLS[name].rank < self._call_rank):
            return []
        self._call_rank, self._call_left = CALLS[name].rank, seconds_of(name)
        return [self._note(name, 0, 1.0, EAR_PLACE)]

    def _call_of(self, event: GameEvent) -> str:
        if event.kind is GameEventKind.CUE:
            return call_of_cue(event.part)
        if event.kind is GameEventKind.MODE_STARTED:
            return "mission_start" if event.part in self._missions else ""
        return GAME_CALLS.get(event.kind, "")

    def menu(self, name: str) -> list[Note]:
        """Return the note of a menu sound, a key of `MENU`; other names are silent."""
        return [self._note(MENU[name], 0, 1.0, EAR_PLACE)] if name in MENU else []

    # --- the paddles --------------------------------------------------------------------------------

    def buttons(self, left: bool, right: bool, launch: bool = False) -> list[Note]:
        """Return the notes of the buttons: coils, which are silent after a tilt, and the plunger."""
        notes = []
        down = set()
        for button, is_down in (("left", left), ("right", right)):
            paddles = [paddle for paddle in self._paddles if paddle.button == button]
            if is_down and paddles and not self._is_tilted:
                down.add(button)
                if button not in self._down:
                    notes.append(self._note("coil", 0, 0.8, pan(SIDES[button] * PADDLE_PLACE, 1.0)))
            for paddle in paddles:
                paddle.is_down = button in down
        if launch and self._has_plunger:
            down.add("launch")
            if "launch" not in self._down:
                notes.append(self._note("plunger_pull", 0, 0.7, pan(PLUNGER_PLACE, 1.0)))
        self._down = down
        return notes

    def advance(self, seconds: float) -> list[Note]:
        """Return the notes of some seconds: paddles that reach their stops, more softly on their return."""
        self._call_left = max(self._call_left - seconds, 0.0)
        notes = []
        for paddle in self._paddles:
            ago = paddle.move(seconds)
            if ago is not None:
                layer, strength = (1, 0.75) if paddle.is_down else (0, 0.45)
                ears = pan(SIDES[paddle.button] * PADDLE_PLACE, 1.0)
                notes.append(self._note("stop", layer, strength, ears, ago))
        return notes

    def _note(
        self, name: str, layer: int, strength: float, ears: tuple[float, float], ago: float = 0.0
    ) -> Note:
        count = RECIPES[name].variations
        turn = self._next_variation[name, layer]
        self._next_variation[name, layer] = (turn + 1) % count
        return Note(Key(name, layer, turn), strength * ears[0], strength * ears[1], ago)


class _Paddle:
    """The position of a paddle between its stops, 0 to 1, accurate enough for sounds."""

    def __init__(self, button: str, stroke: float, return_stroke: float) -> None:
        self.button = button
        self.strokes = (stroke, return_stroke)  # up and back [s]
        self.is_down = False
        self._position = 0.0

    def move(self, seconds: float) -> float | None:
        """Move for some seconds; if a stop is reached, return how long before their end [s]."""
        goal = 1.0 if self.is_down else 0.0
        if self._position == goal:
            return None
        stroke = self.strokes[0 if self.is_down else 1]
        left = abs(goal - self._position) * stroke
        if left > seconds:
            self._position += math.copysign(seconds / stroke, goal - self._position)
            return None
        self._position = goal
        return seconds - left


def default_paddles() -> list[_Paddle]:
    """Return the paddles of a table that is not known yet."""
    return [_Paddle(button, 0.1, 0.1) for button in SIDES]


def paddles_of(table: Table) -> list[_Paddle]:
    """Return the paddles of a table at rest."""
    return [
        _Paddle(mover.button, mover.stroke, mover.return_stroke)
        for primitives in primitives_by_part(table).values()
        for primitive in primitives
        if (mover := primitive.mover) is not None
    ]


def step_of(run: int) -> int:
    """Return the step of the bell for the n-th hit in a row: up the scale, then around its upper octave."""
    step = max(run, 1) - 1
    upper = BELL_STEPS - len(SCALE)
    return step if step < BELL_STEPS else upper + (step - upper) % len(SCALE)


def _time(event: Event, tick_rate: int) -> float:
    return event.tick / tick_rate + event.offset
