"""The score display during a game: the score, the ball, and recent events.

Most events are shown beside the score. A few animations fill the display, but never for longer than
`MAX_HIDDEN_TIME`; then the score must be visible again before anything else may hide it. Time comes only from
`frame`, so the same events at the same times draw the same dots.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

from silverball.drawing.dotmatrix import animations
from silverball.drawing.dotmatrix.canvas import FULL, HEIGHT, WIDTH, Dots
from silverball.drawing.dotmatrix.fonts import BOLD, NORMAL, TINY, fitting
from silverball.game.view import GameEvent, GameEventKind, GameView, Mode, Phase

MAX_HIDDEN_TIME = 0.85  # [s] without the score
MIN_VISIBLE_TIME = 0.6  # [s] with the score before it may be hidden again
COUNT_TIME = 0.25  # [s] in which the score counts up to a new value
POINTS_TIME = 0.7  # [s] for which the points of a hit are shown
MESSAGE_TIME = 2.5  # [s]
SCROLL_SPEED = 45.0  # [dot/s] of long messages
MAX_MESSAGES = 4  # in the queue; late messages are useless
MAX_DELAY = 3.5  # [s] an announcement may wait before it is dropped
MIN_COMBO_SHOWN = 3  # hits in a row that are announced
COMBO_FULL = 8  # hits in a row that fill the meters

STATUS_Y = 24  # [dot] top of the status line
HALF = 130  # brightness of secondary text

Scene = Callable[[Dots, float], None]


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
    """

    name: str
    rank: int
    text: str
    length: float
    full: Scene | None = None
    full_time: float = 0.0
    draw_text: Callable[[Dots, float, str, int], None] = animations.growing_text


class ScoreDisplay:
    """The score display of one game.

    Attributes:
        start_key: Label of the key that creates a ball.
        player_label: Name of the player of a demo, written beside the balls.
        is_calm: Whether full-display animations are off, for sensitive eyes.
    """

    def __init__(self, start_key: str = "SPACE", is_calm: bool = False) -> None:
        self.start_key = start_key
        self.player_label = ""
        self.is_calm = is_calm
        self._queue: list[tuple[Announcement, float | None]] = []  # each with the time when it was queued
        self._current: Announcement | None = None
        self._began = 0.0
        self._messages = _Messages()
        self._points = 0  # of the last hit; shown from the next frame on
        self._points_began: float | None = None
        self._score_from, self._score_to, self._score_changed = 0, -1, 0.0  # nothing shown yet
        self._hidden_since: float | None = None
        self._seen_since = -MIN_VISIBLE_TIME
        self._tilted_since: float | None = None
        self._phase_since = (Phase.READY, 0.0)
        self._beats_high_score = False
        self._best = 0

    def add_events(self, events: Iterable[GameEvent]) -> None:
        """Add events of the game, shown from the next frame on."""
        for event in events:
            if event.kind is GameEventKind.SCORED and event.value:
                self._points, self._points_began = event.value, None
            elif event.kind is GameEventKind.UNSTUCK:
                self.show_message("STUCK BALL SHOVED")
            else:
                announcement = _announcement_of(event)
                if announcement is not None:
                    self._enqueue(announcement)

    def show_message(self, text: str, *, replace: bool = False) -> None:
        """Show a short message below the score, in capitals; a long one scrolls.

        Args:
            text: The message.
            replace: Whether it replaces all queued messages; otherwise it is queued.
        """
        if replace:
            self._messages = _Messages()
        self._messages.add(text.upper())

    def frame(self, view: GameView, seconds: float, high_score: int = 0) -> Dots:
        """Draw a frame.

        Args:
            view: The state of the game.
            seconds: Time of a monotonic clock [s].
            high_score: The best score so far; 0 if there is none.

        Returns:
            A new picture.
        """
        self._start_counting(view.score, seconds)
        self._best = high_score
        if view.phase is not self._phase_since[0]:
            self._phase_since = (view.phase, seconds)
        if 0 < high_score < view.score and not self._beats_high_score and view.phase is not Phase.OVER:
            self._beats_high_score = True
            self._enqueue(_HIGH_SCORE)
        if not view.tilted:
            self._tilted_since = None
        elif self._tilted_since is None:
            self._tilted_since, self._current, self._queue = seconds, None, []
        self._advance(seconds)
        message = self._messages.at(seconds)
        dots = self._picture(view, seconds, message is not None)
        if message is not None:
            dots.box(0, STATUS_Y - 1, WIDTH, HEIGHT - STATUS_Y + 1, 0)
            dots.text(message[0], message[1], STATUS_Y, NORMAL)
        return dots

    def _picture(self, view: GameView, seconds: float, has_message: bool) -> Dots:
        """Draw a full-display animation if one is due, otherwise the score and the announcements."""
        dots = Dots()
        scene = self._scene(seconds)
        if scene is not None and self._may_hide(seconds):
            scene(dots)
            return dots
        if self._hidden_since is not None:
            self._hidden_since, self._seen_since = None, seconds
        headline, is_lit = self._headline(view, seconds)
        if not headline:
            self._draw_play(dots, view, seconds)
        elif has_message:
            # Three lines, with the message in the lowest.
            dots.text(headline, WIDTH // 2, 0, NORMAL, "center", FULL if is_lit else HALF)
            self._draw_score(dots, 10, seconds)
        elif self._current is not None:
            at = seconds - self._began
            if self._current is _HIGH_SCORE:
                animations.fireworks(dots, at % 2.4, bottom=16)
            self._current.draw_text(dots, at, headline, 2)
            self._draw_score(dots, 19, seconds)
        elif view.tilted:
            dots.text(headline, WIDTH // 2, 2, BOLD, "center", FULL if is_lit else HALF)
            self._draw_score(dots, 19, seconds)
        elif view.phase is Phase.READY:
            self._draw_ready(dots, view, headline if is_lit else "", seconds)
        else:
            dots.text(headline, WIDTH // 2, 1, NORMAL, "center", FULL if is_lit else HALF)
            dots.number(self._displayed_score(seconds), WIDTH // 2, 10)
        return dots

    def _headline(self, view: GameView, seconds: float) -> tuple[str, bool]:
        """Return the text above the score, and whether it is bright; empty during normal play."""
        if self._current is not None:
            return self._current.text, True
        if view.tilted:
            return "TILT", seconds % 0.5 < 0.25
        if view.phase is Phase.READY:
            return f"PRESS {self.start_key}", (seconds - self._phase_since[1]) % 1.0 < 0.65
        return ("GAME OVER", seconds % 1.0 < 0.6) if view.phase is Phase.OVER else ("", True)

    def _draw_score(self, dots: Dots, y: int, seconds: float) -> None:
        """Draw the score below a headline."""
        dots.number(self._displayed_score(seconds), WIDTH // 2, y, WIDTH, (BOLD, NORMAL, TINY))

    def _scene(self, seconds: float) -> Callable[[Dots], None] | None:
        """Return the animation that should fill the display now; None if there is none."""
        if self.is_calm:
            return None
        if self._tilted_since is not None:
            at = seconds - self._tilted_since
            period = MAX_HIDDEN_TIME + MIN_VISIBLE_TIME
            return (lambda dots: animations.tilt(dots, at)) if at % period < MAX_HIDDEN_TIME else None
        announcement = self._current
        if (
            announcement is None
            or announcement.full is None
            or seconds - self._began >= announcement.full_time
        ):
            return None
        full, since = announcement.full, seconds - self._began
        return lambda dots: full(dots, since)

    def _may_hide(self, seconds: float) -> bool:
        """Return whether the score may be hidden in this frame."""
        if self._hidden_since is not None:
            return seconds - self._hidden_since < MAX_HIDDEN_TIME
        if seconds - self._seen_since < MIN_VISIBLE_TIME:
            return False
        self._hidden_since = seconds
        return True

    def _draw_play(self, dots: Dots, view: GameView, seconds: float) -> None:
        dots.number(self._displayed_score(seconds), WIDTH // 2, 1, WIDTH - 12)
        _draw_combo_meters(dots, view.combo, seconds)
        _draw_balls(dots, view)
        if self.player_label:
            dots.text(self.player_label, 7 * view.max_balls + 4, STATUS_Y, NORMAL, brightness=HALF)
        if view.multiplier > 1:
            text = f"×{view.multiplier}"
            width = NORMAL.width(text) + 4
            is_lit = seconds % 0.6 < 0.4
            dots.box(WIDTH - width, STATUS_Y - 1, width, 8, FULL if is_lit else 0)
            dots.text(text, WIDTH - 2, STATUS_Y, NORMAL, "right", 0 if is_lit else FULL)
        middle, light = self._middle(view, seconds)
        dots.text(middle, WIDTH // 2 + 4, STATUS_Y, NORMAL, "center", light)

    def _middle(self, view: GameView, seconds: float) -> tuple[str, int]:
        """Return the text in the middle of the lowest line, and its brightness."""
        if view.save_left > 0.0:
            fast = view.save_left < 2.0
            return ("BALL SAVE", FULL if seconds % (0.25 if fast else 0.5) < (0.15 if fast else 0.3) else 0)
        if self._points_began is not None and seconds - self._points_began < POINTS_TIME:
            fraction = (seconds - self._points_began) / POINTS_TIME
            return f"+{self._points:,}", round(FULL * (1.0 - 0.7 * fraction))
        if view.combo > 1:
            return f"COMBO {view.combo}", 200
        return "", 0

    def _draw_ready(self, dots: Dots, view: GameView, headline: str, seconds: float) -> None:
        dots.text(headline, WIDTH // 2, 4, fitting(headline, WIDTH), "center")
        text = f"BALL {view.ball} OF {view.balls}" if view.balls else "FREE PLAY"
        if self._best and not view.score and (seconds - self._phase_since[1]) % 4.0 >= 2.0:
            text = f"BEST {self._best:,}"
        dots.text(text, 1, STATUS_Y, NORMAL, "left", HALF)
        available = WIDTH - NORMAL.width(text) - 8
        dots.number(self._displayed_score(seconds), WIDTH - 1, 20, available, (BOLD, NORMAL, TINY), "right")

    def _start_counting(self, score: int, seconds: float) -> None:
        """Start counting up to a new score; a lower score belongs to another game and is shown directly."""
        if score == self._score_to:
            return
        now = self._displayed_score(seconds)
        self._score_from = now if 0 <= now < score and self._score_to >= 0 else score
        self._score_to, self._score_changed = score, seconds
        if score == 0:
            self._beats_high_score = False

    def _displayed_score(self, seconds: float) -> int:
        """Return the displayed score, which counts up."""
        fraction = min(max((seconds - self._score_changed) / COUNT_TIME, 0.0), 1.0)
        return self._score_from + round(fraction * (self._score_to - self._score_from))

    def _enqueue(self, announcement: Announcement) -> None:
        self._queue = [entry for entry in self._queue if entry[0].name != announcement.name]
        self._queue.append((announcement, None))
        self._queue.sort(key=lambda entry: -entry[0].rank)  # stable: equal ranks stay in order

    def _advance(self, seconds: float) -> None:
        """End the current announcement if it is over, and begin the next or a more important one."""
        if self._points_began is None and self._points:
            self._points_began = seconds
        if self._current is not None and seconds - self._began >= self._current.length:
            self._current = None
        self._queue = [
            (announcement, seconds if since is None else since) for announcement, since in self._queue
        ]
        self._queue = [
            (announcement, since)
            for announcement, since in self._queue
            if seconds - (since or 0.0) <= MAX_DELAY
        ]
        if not self._queue:
            return
        first = self._queue[0][0]
        now = self._current
        if now is None or first.rank > now.rank or first.name == now.name:
            self._current, self._began = first, seconds
            self._queue.pop(0)


class _Messages:
    """A queue of short messages, shown one after the other."""

    def __init__(self) -> None:
        self._texts: list[str] = []
        self._began: float | None = None

    def add(self, text: str) -> None:
        """Add a message unless it repeats the last one; a full queue drops its oldest waiting message."""
        if not self._texts or self._texts[-1] != text:
            del self._texts[1 : max(len(self._texts) - MAX_MESSAGES + 2, 1)]
            self._texts.append(text)

    def at(self, seconds: float) -> tuple[str, int] | None:
        """Return the message at a time, and the column where it begins; None if there is none."""
        while self._texts:
            if self._began is None:
                self._began = seconds
            text, at = self._texts[0], seconds - self._began
            width = NORMAL.width(text)
            if width <= WIDTH and at < MESSAGE_TIME:
                return text, (WIDTH - width) // 2
            if width > WIDTH and at < (WIDTH + width) / SCROLL_SPEED:
                return text, WIDTH - round(at * SCROLL_SPEED)
            self._texts.pop(0)
            self._began = None
        return None


def _combo_scene(value: int) -> Scene:
    def scene(dots: Dots, at: float) -> None:
        animations.ring(dots, at, speed=170.0)
        animations.burst(dots, at)
        dots.text(f"{value} HITS", WIDTH // 2, 5, BOLD, "center", scale=2)

    return scene


def _high_scene(dots: Dots, at: float) -> None:
    animations.fireworks(dots, at + 0.3)
    dots.box(14, 9, 132, 14, 0)
    animations.growing_text(dots, at, "HIGH SCORE!", 11)


MILESTONE_HITS = 5  # a combo of every so many hits is announced with an animation
_HIGH_SCORE = Announcement("high", rank=6, text="HIGH SCORE!", length=3.2, full=_high_scene, full_time=0.8)
_SAVED = Announcement(
    "saved", rank=5, text="BALL SAVED", length=2.2, full=animations.saved_ball, full_time=0.85
)
_DOUBLE = Announcement(
    "double", rank=3, text="DOUBLE POINTS", length=2.2, full=animations.two_balls, full_time=0.8
)


def _announcement_of(event: GameEvent) -> Announcement | None:
    """Return how an event is announced; None if it is not."""
    if event.kind is GameEventKind.COMBO and event.value >= MIN_COMBO_SHOWN:
        is_milestone = event.value % MILESTONE_HITS == 0
        scene = _combo_scene(event.value) if is_milestone else None
        return Announcement(
            "combo",
            rank=2,
            text=f"COMBO {event.value}",
            length=1.2 if is_milestone else 0.8,
            full=scene,
            full_time=0.55,
        )
    if event.kind is GameEventKind.BALL_SAVED:
        return _SAVED
    if event.kind is GameEventKind.DOUBLE_ON:
        return _DOUBLE
    if event.kind is GameEventKind.WARNING:
        return Announcement(
            "warning",
            rank=4,
            text="WARNING" + "!" * min(event.value, 3),
            length=1.2,
            draw_text=animations.shaking_text,
        )
    if event.kind is GameEventKind.BALL_LOST and event.value:
        return Announcement(
            "lost",
            rank=1,
            text=f"BALL {event.value} LOST",
            length=1.4,
            full=animations.falling_ball,
            full_time=0.45,
        )
    return None


def _draw_combo_meters(dots: Dots, combo: int, seconds: float) -> None:
    """Draw the hits in a row as meters on both sides of the score."""
    lit = min(combo, COMBO_FULL) if combo > 1 else 0
    for cell in range(COMBO_FULL):
        y = 21 - 3 * cell
        light = FULL if lit < COMBO_FULL or seconds % 0.2 < 0.1 else HALF
        if cell < lit:
            dots.box(0, y, 4, 2, light)
            dots.box(WIDTH - 4, y, 4, 2, light)


def _draw_balls(dots: Dots, view: GameView) -> None:
    """Draw the current ball's number, or in free play one dot for each ball."""
    if view.mode is Mode.ARCADE and view.balls:
        dots.text(f"BALL {view.ball}/{view.balls}", 0, STATUS_Y, NORMAL, brightness=HALF)
        return
    for ball in range(view.max_balls):
        dots.text("●" if ball < view.on_board else "○", 7 * ball, STATUS_Y, NORMAL)
