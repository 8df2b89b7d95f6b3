"""The score display during a game: the score, the ball, and recent events.

`frame` draws the display above a board. Most events are shown beside the score. A few animations fill the
display, but never for longer than `MAX_HIDDEN_TIME`; then the score must be visible again before anything
else may hide it. `wide_frame` draws the large display of a backglass in two halves: the upper one always
shows the score, the lower one whatever has the highest rank.

Time comes only from these two, so the same events at the same times draw the same dots.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple

import numpy as np

from silverball.app.announcements import HIGH_SCORE, NO_WORDS, Announcements, Rank, TableWords, bonus
from silverball.drawing.dotmatrix import animations
from silverball.drawing.dotmatrix.canvas import FULL, HEIGHT, WIDTH, Dots, Levels
from silverball.drawing.dotmatrix.fonts import BOLD, HUGE, NORMAL, TINY, fitting
from silverball.game.view import GameEvent, GameEventKind, GameView, Mode, Phase
from silverball.plain import plain

MAX_HIDDEN_TIME = 0.85  # [s] without the score
MIN_VISIBLE_TIME = 0.6  # [s] with the score before it may be hidden again
COUNT_TIME = 0.25  # [s] in which the score counts up to a new value
POINTS_TIME = 0.7  # [s] for which the points of a hit are shown
MESSAGE_TIME = 2.5  # [s]
SCROLL_SPEED = 45.0  # [dot/s] of long messages
MAX_MESSAGES = 4  # in the queue; late messages are useless
COMBO_FULL = 8  # hits in a row that fill the meters

STATUS_Y = 24  # [dot] top of the status line
HALF = 130  # brightness of secondary text
SCORE_ROWS = 23  # [dot] height of the upper half of the wide display
WIDE_ROWS = SCORE_ROWS + HEIGHT  # [dot] height of the wide display
HURRY = 5.5  # [s] before the end of a mode, in which its time blinks
RULE = 60  # brightness of the line between its halves


class _Mission(NamedTuple):
    """A mission that runs, and the time that it has left [s]."""

    left: float
    name: str

    @property
    def clock(self) -> int:
        """The seconds on its clock."""
        return int(self.left) + 1

    def is_lit(self, seconds: float) -> bool:
        """Whether its clock is bright now: it blinks at the end."""
        return self.left > HURRY or seconds % 0.5 < 0.3


class ScoreDisplay:
    """The score display of one game.

    Attributes:
        start_key: Label of the key that creates a ball.
        player_label: Name of the player of a demo, written beside the balls.
        is_calm: Whether full-display animations are off, for sensitive eyes.
        note: What stands in the lowest line while nothing happens: a rival's score, or who is up.

    Args:
        words: What the messages of the table's rules are about.
    """

    def __init__(self, start_key: str = "SPACE", is_calm: bool = False, words: TableWords = NO_WORDS) -> None:
        self.start_key = start_key
        self.player_label = ""
        self.is_calm = is_calm
        self.note = ""
        self._words = words
        self._announcements = Announcements(words)
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
        self._mission: _Mission | None = None  # on the display above a board

    def add_events(self, events: Iterable[GameEvent]) -> None:
        """Add events of the game, shown from the next frame on."""
        for event in events:
            if event.kind is GameEventKind.SCORED and event.value:
                self._points, self._points_began = event.value, None
            if event.kind is GameEventKind.UNSTUCK:
                self.show_message("STUCK BALL SHOVED")
            elif event.kind is GameEventKind.PLAYER_UP:
                self.show_message(f"PLAYER {event.value}", replace=True)
            else:
                self._announcements.add_event(event)

    def count_bonus(self, points: int) -> None:
        """Count out the bonus at the end of a ball."""
        self._announcements.add(bonus(points))

    def show_message(self, text: str, *, replace: bool = False) -> None:
        """Show a short message below the score, in capitals; a long one scrolls.

        Args:
            text: The message.
            replace: Whether it replaces all queued messages; otherwise it is queued.
        """
        if replace:
            self._messages = _Messages()
        self._messages.add(text.upper())

    @property
    def is_telling(self) -> bool:
        """Whether a message below the score is shown, or waits."""
        return self._messages.are_left

    def frame(
        self,
        view: GameView,
        seconds: float,
        high_score: int = 0,
        modes: Mapping[str, float | None] | None = None,
    ) -> Dots:
        """Draw a frame.

        Args:
            view: The state of the game.
            seconds: Time of a monotonic clock [s].
            high_score: The best score so far; 0 if there is none.
            modes: The modes that run, and how long they still do [s]; the missions among them are shown.

        Returns:
            A new picture.
        """
        self._advance(view, seconds, high_score)
        message = self._messages.at(seconds)
        self._mission = next(iter(self._timed_missions(modes)), None)
        dots = self._picture(view, seconds, message is not None)
        self._draw_message(dots, message, seconds)
        return dots

    def wide_frame(
        self,
        view: GameView,
        seconds: float,
        high_score: int = 0,
        modes: Mapping[str, float | None] | None = None,
    ) -> Levels:
        """Draw a frame of the wide display: the score, and below it what has the highest rank.

        Args:
            view: The state of the game.
            seconds: Time of a monotonic clock [s].
            high_score: The best score so far; 0 if there is none.
            modes: The modes that run, and how long they still do [s]; the missions among them are shown.

        Returns:
            Brightness of `WIDE_ROWS` rows of dots.
        """
        self._advance(view, seconds, high_score)
        message = self._messages.at(seconds)
        below = self._news(view, seconds, self._timed_missions(modes), message is not None)
        self._draw_message(below, message, seconds)
        return stacked(self._displayed_score(seconds), below)

    def _timed_missions(self, modes: Mapping[str, float | None] | None) -> list[_Mission]:
        """The missions that run and end by themselves, the one that ends first at the beginning."""
        return sorted(
            _Mission(left, name)
            for name, left in (modes or {}).items()
            if name in self._words.missions and left is not None
        )

    def _advance(self, view: GameView, seconds: float, high_score: int) -> None:
        """Bring what is shown up to date."""
        self._start_counting(view.score, seconds)
        self._best = high_score
        if view.phase is not self._phase_since[0]:
            self._phase_since = (view.phase, seconds)
        if 0 < high_score < view.score and not self._beats_high_score and view.phase is not Phase.OVER:
            self._beats_high_score = True
            self._announcements.add(HIGH_SCORE)
        if not view.tilted:
            self._tilted_since = None
        elif self._tilted_since is None:
            self._tilted_since = seconds
            self._announcements.clear()
        if self._points_began is None and self._points:
            self._points_began = seconds
        self._announcements.advance(seconds)

    def _draw_message(self, dots: Dots, message: tuple[str, int] | None, seconds: float) -> None:
        """Draw a message in the lowest line, left of the clock of a mission."""
        if message is None:
            return
        text, x = message
        dots.box(0, STATUS_Y - 1, WIDTH, HEIGHT - STATUS_Y + 1, 0)
        end = WIDTH
        if self._mission is not None:
            end -= self._draw_time(dots, self._mission, WIDTH, seconds) + 4
            x = min(x, max((end - NORMAL.width(text)) // 2, 0))
        dots.text(text, x, STATUS_Y, NORMAL, window=(0, end))

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
        if not headline or self._is_minor:
            self._draw_play(dots, view, seconds)
        elif has_message:
            # Three lines, with the message in the lowest.
            dots.text(headline, WIDTH // 2, 0, NORMAL, "center", FULL if is_lit else HALF)
            self._draw_score(dots, 10, seconds)
        elif self._announcements.current is not None:
            at = seconds - self._announcements.began
            if self._announcements.current is HIGH_SCORE:
                animations.fireworks(dots, at % 2.4, bottom=16)
            self._announcements.current.draw_text(dots, at, headline, 2)
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

    @property
    def _is_minor(self) -> bool:
        """Whether the announcement is written beside the clock of a mission, which is worth more."""
        current = self._announcements.current
        return current is not None and self._mission is not None and current.rank < Rank.MISSION

    def _news(self, view: GameView, seconds: float, timed: list[_Mission], has_message: bool) -> Dots:
        """Draw the lower half of the wide display: the announcement of the highest rank, or how it stands."""
        dots = Dots()
        scene, current = self._scene(seconds), self._announcements.current
        if current is not None and timed and current.rank < Rank.MISSION:
            self._draw_mission(dots, timed[0], seconds)
            dots.text(current.text, 2, STATUS_Y, NORMAL)
        elif scene is not None:
            scene(dots)
        elif current is not None:
            at = seconds - self._announcements.began
            if current is HIGH_SCORE:
                animations.fireworks(dots, at % 2.4)
            current.draw_text(dots, at, current.text, 3 if current.detail or has_message else 10)
            if current.detail and not has_message:
                dots.text(current.detail, WIDTH // 2, 18, BOLD, "center")
        elif view.tilted or view.phase is not Phase.PLAY:
            headline, is_lit = self._headline(view, seconds)
            font = fitting(headline, WIDTH)
            dots.text(headline, WIDTH // 2, 4, font, "center", FULL if is_lit else HALF // 2)
            dots.text(self._foot(view, seconds), WIDTH // 2, STATUS_Y, NORMAL, "center", HALF)
        else:
            text, light = self._middle(view, seconds)
            if timed:
                self._draw_mission(dots, timed[0], seconds)
                dots.text(text, 2, STATUS_Y, NORMAL, "left", light)
            else:
                self._draw_standing(dots, view, seconds)
        return dots

    def _draw_mission(self, dots: Dots, mission: _Mission, seconds: float) -> None:
        """Draw a mission and the time that it has left."""
        text = plain(mission.name).upper()
        font = fitting(text, WIDTH - 44)
        dots.text(text, 2, 4 + (11 - font.height) // 2, font, window=(0, WIDTH - 42))
        light = FULL if mission.is_lit(seconds) else HALF
        dots.number(mission.clock, WIDTH - 2, 1, 40, (HUGE, BOLD), "right", light)

    def _draw_standing(self, dots: Dots, view: GameView, seconds: float) -> None:
        """Draw combos and points."""
        text, light = self._middle(view, seconds)
        _draw_combo_meters(dots, view.combo, seconds)
        if text:
            dots.text(text, WIDTH // 2, 10, fitting(text, WIDTH), "center", light)
        elif self.player_label:
            dots.text(self.player_label, WIDTH // 2, 12, NORMAL, "center", HALF)

    def _foot(self, view: GameView, seconds: float) -> str:
        """Return the line below a headline while no ball is in play."""
        if self._best and (seconds - self._phase_since[1]) % 4.0 >= 2.0:
            return f"BEST {self._best:,}"
        if view.phase is Phase.OVER:
            return ""
        return f"BALL {view.ball} OF {view.balls}" if view.balls else "FREE PLAY"

    def _headline(self, view: GameView, seconds: float) -> tuple[str, bool]:
        """Return the text above the score, and whether it is bright; empty during normal play."""
        if self._announcements.current is not None:
            return self._announcements.current.text, True
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
        announcement = self._announcements.current
        if (
            announcement is None
            or announcement.full is None
            or seconds - self._announcements.began >= announcement.full_time
        ):
            return None
        full, since = announcement.full, seconds - self._announcements.began
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
        right = WIDTH
        if view.multiplier > 1:
            text = f"×{view.multiplier}"
            width = NORMAL.width(text) + 4
            is_lit = seconds % 0.6 < 0.4
            dots.box(WIDTH - width, STATUS_Y - 1, width, 8, FULL if is_lit else 0)
            dots.text(text, WIDTH - 2, STATUS_Y, NORMAL, "right", 0 if is_lit else FULL)
            right -= width + 3
        middle, light = self._middle(view, seconds)
        if self._mission is None:
            dots.text(middle, WIDTH // 2 + 4, STATUS_Y, NORMAL, "center", light)
        else:
            self._draw_clock(dots, self._mission, right, middle, light, seconds)

    def _draw_time(self, dots: Dots, mission: _Mission, right: int, seconds: float) -> int:
        """Draw the time that a mission has left, which ends at a column; return its width."""
        light = FULL if mission.is_lit(seconds) else HALF // 2
        return dots.text(str(mission.clock), right, STATUS_Y, NORMAL, "right", light)

    def _draw_clock(
        self, dots: Dots, mission: _Mission, right: int, text: str, light: int, seconds: float
    ) -> None:
        """Draw the time that a mission has left, and beside it a text or else its name."""
        width = self._draw_time(dots, mission, right, seconds)
        current = self._announcements.current
        if current is not None:
            text, light = current.text, FULL
        elif not text:
            text, light = plain(mission.name).upper(), HALF
        left, end = NORMAL.width("BALL 0/0") + 4, right - width - 4
        x = max(end - NORMAL.width(text), left)
        dots.text(text, x, STATUS_Y, NORMAL, "left", light, window=(left, end))

    def _middle(self, view: GameView, seconds: float) -> tuple[str, int]:
        """Return the text in the middle of the lowest line, and its brightness."""
        if view.save_left > 0.0:
            fast = view.save_left < 2.0
            return ("BALL SAVE", FULL if seconds % (0.25 if fast else 0.5) < (0.15 if fast else 0.3) else 0)
        if self._points_began is not None and seconds - self._points_began < POINTS_TIME:
            fraction = (seconds - self._points_began) / POINTS_TIME
            return f"+{self._points:,}", round(FULL * (1.0 - 0.7 * fraction))
        if view.combo > 1 and not self.note:
            return f"COMBO {view.combo}", 200
        return self.note, HALF

    def _draw_ready(self, dots: Dots, view: GameView, headline: str, seconds: float) -> None:
        dots.text(headline, WIDTH // 2, 4, fitting(headline, WIDTH), "center")
        text = f"BALL {view.ball} OF {view.balls}" if view.balls else "FREE PLAY"
        if view.scores:
            text = f"PLAYER {view.player}, BALL {view.ball}"
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


def stacked(score: int | None, below: Dots) -> Levels:
    """Return the wide display with a score (None: no score) above other dots."""
    above = Dots()
    if score is not None:
        above.number(score, WIDTH // 2, 1, WIDTH - 2)
    above.box(0, SCORE_ROWS - 1, WIDTH, 1, RULE)
    return np.concatenate((above.pixels[:SCORE_ROWS], below.pixels))


class _Messages:
    """A queue of short messages, shown one after the other."""

    def __init__(self) -> None:
        self._texts: list[str] = []
        self._began: float | None = None

    @property
    def are_left(self) -> bool:
        """Whether there is a message that is shown or waits."""
        return bool(self._texts)

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
