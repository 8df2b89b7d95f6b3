"""What the score display announces of a game's events, and which announcement goes before another.

A higher rank goes first: a jackpot before a mission, a mission before a combo. Whatever is on the display
gives way to a higher rank only; a lower one waits, and is dropped when it would come too late.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from typing import TYPE_CHECKING, NamedTuple

from silverball.drawing.dotmatrix import animations
from silverball.drawing.dotmatrix.canvas import WIDTH, Dots
from silverball.drawing.dotmatrix.fonts import BOLD
from silverball.game.view import GameEvent, GameEventKind
from silverball.plain import plain

if TYPE_CHECKING:
    from silverball.table import Table
    from silverball.table.rulebook import Rule

MAX_DELAY = 3.5  # [s] an announcement may wait before it is dropped
MIN_COMBO_SHOWN = 3  # hits in a row that are announced
MILESTONE_HITS = 5  # a combo of every so many hits is announced with an animation
MIN_AWARD_SHOWN = 1000  # points of a rule that are written below its message
BONUS_COUNT_TIME, BONUS_TIME = 1.2, 2.2  # [s] in which a bonus is counted out, and for which it is shown
JACKPOT = "jackpot"

Scene = Callable[[Dots, float], None]


class Rank(IntEnum):
    """How important an announcement is."""

    BALL_LOST = 1
    COMBO = 2
    NOTICE = 3
    MISSION = 4
    MULTIBALL = 5
    JACKPOT = 6
    WARNING = 7
    BALL_SAVED = 8
    BONUS = 9
    EXTRA_BALL = 10
    HIGH_SCORE = 11


class Announcement(NamedTuple):
    """An event to announce.

    Attributes:
        name: Identifier; a new announcement replaces a queued one with the same name.
        rank: Higher ranks go first.
        text: Written above the score.
        length: Total duration [s].
        full: Animation that fills the display at first, for `full_time`; None if there is none.
        full_time: Duration of that animation [s].
        draw_text: Draws the moving text.
        detail: Written below the text where there is room, such as the points.
    """

    name: str
    rank: Rank
    text: str
    length: float
    full: Scene | None = None
    full_time: float = 0.0
    draw_text: Callable[[Dots, float, str, int], None] = animations.growing_text
    detail: str = ""


class TableWords(NamedTuple):
    """What the messages and cues of a table's rules are about.

    Attributes:
        messages: The ranks of messages.
        cues: The ranks of cues that are announced by their names, because their rules have no message.
        missions: The modes with a time that rules start.
        announced: Those of them that are announced when they start, because the rule has no message.
    """

    messages: dict[str, Rank]
    cues: dict[str, Rank]
    missions: frozenset[str]
    announced: frozenset[str]

    @classmethod
    def of(cls, table: Table) -> TableWords:
        """Read the rules of a table."""
        timed = frozenset(mode.name for mode in table.mode if mode.seconds and mode.is_shown)
        messages: dict[str, Rank] = {}
        for rule in table.rule:
            if rule.message:
                rank = _rank_of_rule(rule, timed)
                messages[rule.message] = max(rank, messages.get(rule.message, rank))
        spoken = {rule.cue for rule in table.rule if rule.message}
        silent = {rule.cue for rule in table.rule if rule.cue and not rule.message}
        cues = {cue: Rank.JACKPOT for cue in silent - spoken if JACKPOT in cue.lower()}
        started = {mode for rule in table.rule if rule.message for mode in rule.start}
        return cls(messages, cues, timed, timed - started)


NO_WORDS = TableWords({}, {}, frozenset(), frozenset())


def _rank_of_rule(rule: Rule, missions: frozenset[str]) -> Rank:
    """Return what a rule's message is about."""
    if JACKPOT in f"{rule.message} {rule.cue}".lower():
        return Rank.JACKPOT
    if rule.extra_ball:
        return Rank.EXTRA_BALL
    if rule.multiball > 1:
        return Rank.MULTIBALL
    if "combo" in rule.message.lower():
        return Rank.COMBO
    spoken_of = {*rule.start, *rule.stop, *rule.if_running, *rule.on_time, *rule.on_end, *rule.on_start}
    return Rank.MISSION if spoken_of & missions else Rank.NOTICE


class Announcements:
    """The announcements of a game: the one on the display, and those that wait.

    Args:
        words: What the table's rules say.

    Attributes:
        current: The announcement on the display; None if there is none.
        began: When it appeared [s].
    """

    def __init__(self, words: TableWords = NO_WORDS) -> None:
        self._words = words
        self._queue: list[tuple[Announcement, float | None]] = []  # each with the time when it was queued
        self._award = (-1, 0)  # the tick of the last points, and how many
        self.current: Announcement | None = None
        self.began = 0.0

    def add_event(self, event: GameEvent) -> None:
        """Queue what announces an event, if anything does."""
        if event.kind is GameEventKind.SCORED:
            tick, points = self._award
            self._award = event.tick, max(event.value, points if tick == event.tick else 0)
            return
        announcement = _announcement_of(event, self._words)
        if announcement is None:
            return
        tick, points = self._award
        if tick == event.tick and points >= MIN_AWARD_SHOWN and announcement.rank >= Rank.NOTICE:
            announcement = announcement._replace(detail=f"{points:,}")
        self.add(announcement)

    def add(self, announcement: Announcement) -> None:
        """Queue an announcement."""
        self._queue = [entry for entry in self._queue if entry[0].name != announcement.name]
        self._queue.append((announcement, None))
        self._queue.sort(key=lambda entry: -entry[0].rank)  # stable: equal ranks stay in order

    def clear(self) -> None:
        """Drop all of them."""
        self.current, self._queue = None, []

    def advance(self, seconds: float) -> None:
        """End the current announcement if it is over, and begin the next or a more important one."""
        if self.current is not None and seconds - self.began >= self.current.length:
            self.current = None
        waiting = [(announcement, seconds if since is None else since) for announcement, since in self._queue]
        self._queue = [entry for entry in waiting if seconds - (entry[1] or 0.0) <= MAX_DELAY]
        if not self._queue:
            return
        first, now = self._queue[0][0], self.current
        if now is None or first.rank > now.rank or first.name == now.name:
            self.current, self.began = first, seconds
            self._queue.pop(0)


def _combo_scene(value: int) -> Scene:
    def scene(dots: Dots, at: float) -> None:
        animations.ring(dots, at, speed=170.0)
        animations.burst(dots, at)
        dots.text(f"{value} HITS", WIDTH // 2, 5, BOLD, "center", scale=2)

    return scene


def _jackpot_scene(dots: Dots, at: float) -> None:
    animations.burst(dots, at)
    animations.ring(dots, at, speed=220.0)
    animations.fireworks(dots, at + 0.3)


def _high_scene(dots: Dots, at: float) -> None:
    animations.fireworks(dots, at + 0.3)
    dots.box(14, 9, 132, 14, 0)
    animations.growing_text(dots, at, "HIGH SCORE!", 11)


HIGH_SCORE = Announcement(
    "high", Rank.HIGH_SCORE, text="HIGH SCORE!", length=3.2, full=_high_scene, full_time=0.8
)
_SAVED = Announcement(
    "saved", Rank.BALL_SAVED, text="BALL SAVED", length=2.2, full=animations.saved_ball, full_time=0.85
)
_DOUBLE = Announcement(
    "double", Rank.NOTICE, text="DOUBLE POINTS", length=2.2, full=animations.two_balls, full_time=0.8
)


def bonus(points: int) -> Announcement:
    """Return the bonus at the end of a ball, which is counted out."""

    def count(dots: Dots, at: float, text: str, y: int) -> None:
        share = min(at / BONUS_COUNT_TIME, 1.0)
        dots.text(f"BONUS {round(share * points):,}", WIDTH // 2, y, BOLD, "center")

    return Announcement("bonus", Rank.BONUS, f"BONUS {points:,}", BONUS_TIME, draw_text=count)


def _announcement_of(event: GameEvent, words: TableWords) -> Announcement | None:
    """Return how an event is announced; None if it is not."""
    kind, value = event.kind, event.value
    if kind is GameEventKind.COMBO and value >= MIN_COMBO_SHOWN:
        return _combo(value)
    if kind is GameEventKind.BALL_SAVED:
        return _SAVED
    if kind is GameEventKind.DOUBLE_ON:
        return _DOUBLE
    if kind is GameEventKind.WARNING:
        text = "WARNING" + "!" * min(value, 3)
        return Announcement("warning", Rank.WARNING, text, 1.2, draw_text=animations.shaking_text)
    if kind is GameEventKind.BALL_LOST and value:
        scene = animations.falling_ball
        return Announcement("lost", Rank.BALL_LOST, f"BALL {value} LOST", 1.4, scene, full_time=0.45)
    return _said_by_rules(event, words)


def _said_by_rules(event: GameEvent, words: TableWords) -> Announcement | None:
    """Return how an event of a table's own rules is announced; None if it is not."""
    kind, text = event.kind, plain(event.part).upper()
    if kind is GameEventKind.MESSAGE:
        rank = words.messages.get(event.part, Rank.NOTICE)
        scene = _jackpot_scene if rank is Rank.JACKPOT else None
        length = 1.6 if rank <= Rank.NOTICE else 2.4
        return Announcement(f"message {text}", rank, text, length, scene, 0.6 if scene else 0.0)
    if kind is GameEventKind.CUE and event.part in words.cues:
        return Announcement(f"message {text}", words.cues[event.part], text, 2.4, _jackpot_scene, 0.6)
    if kind is GameEventKind.MODE_STARTED and event.part in words.announced:
        return Announcement(f"message {text}", Rank.MISSION, text, 2.4)
    if kind is GameEventKind.BALL_LOCKED:
        return Announcement("locked", Rank.MISSION, f"BALL {event.value} LOCKED", 2.0)
    return None


def _combo(value: int) -> Announcement:
    is_milestone = value % MILESTONE_HITS == 0
    return Announcement(
        "combo",
        Rank.COMBO,
        text=f"COMBO {value}",
        length=1.2 if is_milestone else 0.8,
        full=_combo_scene(value) if is_milestone else None,
        full_time=0.55,
    )
