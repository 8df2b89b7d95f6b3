"""What does the score display show during a game? The score, the ball, and what has just happened.

Most of what happens is shown beside the score. A few animations fill the display, but never for longer than
`HIDDEN_AT_MOST`; then the score is seen again before anything else may hide it. The only time is what `frame`
is given, so the same news at the same times show the same dots.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

from silverball.drawing.dotmatrix import animations as dotshows
from silverball.drawing.dotmatrix.canvas import FULL, HEIGHT, WIDTH, Dots
from silverball.drawing.dotmatrix.fonts import BOLD, NORMAL, TINY, fitting
from silverball.game.view import GameEvent, GameEventKind, GameView, Mode, Phase

HIDDEN_AT_MOST = 0.85  # [s] without the score
SEEN_AT_LEAST = 0.6  # [s] with the score, before it is hidden again
COUNT_TIME = 0.25  # [s] in which the score counts up to its new value
POINTS_TIME = 0.7  # [s] for which the points of a hit are shown
SAY_TIME = 2.5  # [s] for which a message stands
SAY_SPEED = 45.0  # [dot/s] of messages that are too long
MOST_MESSAGES = 4  # that wait; a message that comes too late tells nothing
PATIENCE = 3.5  # [s] after which a show that could not begin is out of date
COMBO_SHOWN = 3  # hits in a row from which they are announced
COMBO_FULL = 8  # hits in a row at which the meters are full

STATUS_Y = 24
HALF = 130  # brightness of what is less important

Scene = Callable[[Dots, float], None]


class Show(NamedTuple):
    """Something to announce.

    Attributes:
        name: What it is; a new one takes the place of one with the same name.
        rank: The higher goes first.
        text: Written above the score.
        length: How long it takes altogether [s].
        full: Fills the display to begin with, for `full_time`; None if nothing does.
        full_time: [s]
        look: How the text moves.
    """

    name: str
    rank: int
    text: str
    length: float
    full: Scene | None = None
    full_time: float = 0.0
    look: Callable[[Dots, float, str, int], None] = dotshows.grown


class Display:
    """The score display of one game.

    Attributes:
        start_key: The key that brings a ball, as the display is to write it.
        performer: Who plays if nobody does: written beside the balls.
        is_calm: Nothing fills the display or flashes over all of it, for sensitive eyes.
    """

    def __init__(self, start_key: str = "SPACE", is_calm: bool = False) -> None:
        self.start_key = start_key
        self.performer = ""
        self.is_calm = is_calm
        self._queue: list[tuple[Show, float | None]] = []  # with the time since when it waits
        self._show: Show | None = None
        self._began = 0.0
        self._messages = _Messages()
        self._points = 0  # of the last hit, shown from the next frame on
        self._points_began: float | None = None
        self._score_from, self._score_to, self._score_changed = 0, -1, 0.0  # nothing seen yet
        self._hidden_since: float | None = None
        self._seen_since = -SEEN_AT_LEAST
        self._tilted_since: float | None = None
        self._phase_since = (Phase.READY, 0.0)
        self._is_beaten = False
        self._best = 0

    def tell(self, news: Iterable[GameEvent]) -> None:
        """Take note of what has happened; it is shown from the next frame on."""
        for one in news:
            if one.kind is GameEventKind.SCORED and one.value:
                self._points, self._points_began = one.value, None
            elif one.kind is GameEventKind.UNSTUCK:
                self.say("A SHOVE FOR A STILL BALL")
            else:
                show = _show_of(one)
                if show is not None:
                    self._enqueue(show)

    def say(self, text: str, *, at_once: bool = False) -> None:
        """Show a short message below the score, in capitals; a long one scrolls.

        Args:
            text: The message.
            at_once: Whether it takes the place of all that wait; else it comes after them.
        """
        if at_once:
            self._messages = _Messages()
        self._messages.add(text.upper())

    def frame(self, face: GameView, seconds: float, high_score: int = 0) -> Dots:
        """What is to be seen.

        Args:
            face: What the game shows of itself.
            seconds: By a clock that never goes back [s].
            high_score: The best score so far; 0 if there is none to beat.

        Returns:
            A picture of its own.
        """
        self._count(face.score, seconds)
        self._best = high_score
        if face.phase is not self._phase_since[0]:
            self._phase_since = (face.phase, seconds)
        if 0 < high_score < face.score and not self._is_beaten and face.phase is not Phase.OVER:
            self._is_beaten = True
            self._enqueue(_HIGH_SCORE)
        if not face.tilted:
            self._tilted_since = None
        elif self._tilted_since is None:
            self._tilted_since, self._show, self._queue = seconds, None, []
        self._advance(seconds)
        message = self._messages.at(seconds)
        dots = self._picture(face, seconds, message is not None)
        if message is not None:
            dots.box(0, STATUS_Y - 1, WIDTH, HEIGHT - STATUS_Y + 1, 0)
            dots.text(message[0], message[1], STATUS_Y, NORMAL)
        return dots

    def _picture(self, face: GameView, seconds: float, has_message: bool) -> Dots:
        """What fills the display if something may, else the score and what there is to say."""
        dots = Dots()
        scene = self._scene(seconds)
        if scene is not None and self._may_hide(seconds):
            scene(dots)
            return dots
        if self._hidden_since is not None:
            self._hidden_since, self._seen_since = None, seconds
        headline, is_lit = self._headline(face, seconds)
        if not headline:
            self._draw_play(dots, face, seconds)
        elif has_message:
            # Three lines: the message has the lowest.
            dots.text(headline, WIDTH // 2, 0, NORMAL, "center", FULL if is_lit else HALF)
            self._draw_score(dots, 10, seconds)
        elif self._show is not None:
            at = seconds - self._began
            if self._show is _HIGH_SCORE:
                dotshows.fireworks(dots, at % 2.4, bottom=16)
            self._show.look(dots, at, headline, 2)
            self._draw_score(dots, 19, seconds)
        elif face.tilted:
            dots.text(headline, WIDTH // 2, 2, BOLD, "center", FULL if is_lit else HALF)
            self._draw_score(dots, 19, seconds)
        elif face.phase is Phase.READY:
            self._draw_ready(dots, face, headline if is_lit else "", seconds)
        else:
            dots.text(headline, WIDTH // 2, 1, NORMAL, "center", FULL if is_lit else HALF)
            dots.number(self._score(seconds), WIDTH // 2, 10)
        return dots

    def _headline(self, face: GameView, seconds: float) -> tuple[str, bool]:
        """What is written above the score, and whether it is bright now; empty while a game just goes on."""
        if self._show is not None:
            return self._show.text, True
        if face.tilted:
            return "TILT", seconds % 0.5 < 0.25
        if face.phase is Phase.READY:
            return f"PRESS {self.start_key}", (seconds - self._phase_since[1]) % 1.0 < 0.65
        return ("GAME OVER", seconds % 1.0 < 0.6) if face.phase is Phase.OVER else ("", True)

    def _draw_score(self, dots: Dots, y: int, seconds: float) -> None:
        """The score below a headline."""
        dots.number(self._score(seconds), WIDTH // 2, y, WIDTH, (BOLD, NORMAL, TINY))

    def _scene(self, seconds: float) -> Callable[[Dots], None] | None:
        """What wants to fill the display now."""
        if self.is_calm:
            return None
        if self._tilted_since is not None:
            at = seconds - self._tilted_since
            period = HIDDEN_AT_MOST + SEEN_AT_LEAST
            return (lambda dots: dotshows.tilt(dots, at)) if at % period < HIDDEN_AT_MOST else None
        show = self._show
        if show is None or show.full is None or seconds - self._began >= show.full_time:
            return None
        full, since = show.full, seconds - self._began
        return lambda dots: full(dots, since)

    def _may_hide(self, seconds: float) -> bool:
        """Whether the score may be hidden in this frame."""
        if self._hidden_since is not None:
            return seconds - self._hidden_since < HIDDEN_AT_MOST
        if seconds - self._seen_since < SEEN_AT_LEAST:
            return False
        self._hidden_since = seconds
        return True

    def _draw_play(self, dots: Dots, face: GameView, seconds: float) -> None:
        dots.number(self._score(seconds), WIDTH // 2, 1, WIDTH - 12)
        _draw_combo_meters(dots, face.combo, seconds)
        _draw_balls(dots, face)
        if self.performer:
            dots.text(self.performer, 7 * face.max_balls + 4, STATUS_Y, NORMAL, brightness=HALF)
        if face.multiplier > 1:
            text = f"×{face.multiplier}"
            width = NORMAL.width(text) + 4
            is_lit = seconds % 0.6 < 0.4
            dots.box(WIDTH - width, STATUS_Y - 1, width, 8, FULL if is_lit else 0)
            dots.text(text, WIDTH - 2, STATUS_Y, NORMAL, "right", 0 if is_lit else FULL)
        middle, light = self._middle(face, seconds)
        dots.text(middle, WIDTH // 2 + 4, STATUS_Y, NORMAL, "center", light)

    def _middle(self, face: GameView, seconds: float) -> tuple[str, int]:
        """What stands in the middle of the lowest line, and how bright."""
        if face.save_left > 0.0:
            fast = face.save_left < 2.0
            return ("BALL SAVE", FULL if seconds % (0.25 if fast else 0.5) < (0.15 if fast else 0.3) else 0)
        if self._points_began is not None and seconds - self._points_began < POINTS_TIME:
            share = (seconds - self._points_began) / POINTS_TIME
            return f"+{self._points:,}", round(FULL * (1.0 - 0.7 * share))
        if face.combo > 1:
            return f"COMBO {face.combo}", 200
        return "", 0

    def _draw_ready(self, dots: Dots, face: GameView, headline: str, seconds: float) -> None:
        dots.text(headline, WIDTH // 2, 4, fitting(headline, WIDTH), "center")
        text = f"BALL {face.ball} OF {face.balls}" if face.balls else "FREE PLAY"
        if self._best and not face.score and (seconds - self._phase_since[1]) % 4.0 >= 2.0:
            text = f"BEST {self._best:,}"
        dots.text(text, 1, STATUS_Y, NORMAL, "left", HALF)
        room = WIDTH - NORMAL.width(text) - 8
        dots.number(self._score(seconds), WIDTH - 1, 20, room, (BOLD, NORMAL, TINY), "right")

    def _count(self, score: int, seconds: float) -> None:
        """Let the score count up, or jump where it has become less: that is another game."""
        if score == self._score_to:
            return
        now = self._score(seconds)
        self._score_from = now if 0 <= now < score and self._score_to >= 0 else score
        self._score_to, self._score_changed = score, seconds
        if score == 0:
            self._is_beaten = False

    def _score(self, seconds: float) -> int:
        """The score as far as it has counted."""
        share = min(max((seconds - self._score_changed) / COUNT_TIME, 0.0), 1.0)
        return self._score_from + round(share * (self._score_to - self._score_from))

    def _enqueue(self, show: Show) -> None:
        self._queue = [entry for entry in self._queue if entry[0].name != show.name]
        self._queue.append((show, None))
        self._queue.sort(key=lambda entry: -entry[0].rank)  # equal ranks stay in their order

    def _advance(self, seconds: float) -> None:
        """End what is over, and begin what is next or more important."""
        if self._points_began is None and self._points:
            self._points_began = seconds
        if self._show is not None and seconds - self._began >= self._show.length:
            self._show = None
        self._queue = [(show, seconds if since is None else since) for show, since in self._queue]
        self._queue = [(show, since) for show, since in self._queue if seconds - (since or 0.0) <= PATIENCE]
        if not self._queue:
            return
        first = self._queue[0][0]
        now = self._show
        if now is None or first.rank > now.rank or first.name == now.name:
            self._show, self._began = first, seconds
            self._queue.pop(0)


class _Messages:
    """Short messages, one after the other."""

    def __init__(self) -> None:
        self._texts: list[str] = []
        self._began: float | None = None

    def add(self, text: str) -> None:
        """One more, unless it is the last one again; of too many only the newest are kept."""
        if not self._texts or self._texts[-1] != text:
            del self._texts[1 : max(len(self._texts) - MOST_MESSAGES + 2, 1)]
            self._texts.append(text)

    def at(self, seconds: float) -> tuple[str, int] | None:
        """The message at a time, and the column where it begins; None if there is nothing to say."""
        while self._texts:
            if self._began is None:
                self._began = seconds
            text, at = self._texts[0], seconds - self._began
            width = NORMAL.width(text)
            if width <= WIDTH and at < SAY_TIME:
                return text, (WIDTH - width) // 2
            if width > WIDTH and at < (WIDTH + width) / SAY_SPEED:
                return text, WIDTH - round(at * SAY_SPEED)
            self._texts.pop(0)
            self._began = None
        return None


def _combo_scene(value: int) -> Scene:
    def scene(dots: Dots, at: float) -> None:
        dotshows.ring(dots, at, speed=170.0)
        dotshows.burst(dots, at)
        dots.text(f"{value} HITS", WIDTH // 2, 5, BOLD, "center", scale=2)

    return scene


def _high_scene(dots: Dots, at: float) -> None:
    dotshows.fireworks(dots, at + 0.3)
    dots.box(14, 9, 132, 14, 0)
    dotshows.grown(dots, at, "HIGH SCORE!", 11)


_HIGH_SCORE = Show("high", 6, "HIGH SCORE!", 3.2, _high_scene, 0.8)
_SAVED = Show("saved", 5, "BALL SAVED", 2.2, dotshows.saved_ball, 0.85)
_DOUBLE = Show("double", 3, "DOUBLE POINTS", 2.2, dotshows.two_balls, 0.8)


def _show_of(news: GameEvent) -> Show | None:
    """How a piece of news is announced; None if it is not."""
    if news.kind is GameEventKind.COMBO and news.value >= COMBO_SHOWN:
        is_great = news.value % 5 == 0
        scene = _combo_scene(news.value) if is_great else None
        return Show("combo", 2, f"COMBO {news.value}", 1.2 if is_great else 0.8, scene, 0.55)
    if news.kind is GameEventKind.BALL_SAVED:
        return _SAVED
    if news.kind is GameEventKind.DOUBLE_ON:
        return _DOUBLE
    if news.kind is GameEventKind.WARNING:
        return Show("warning", 4, "WARNING" + "!" * min(news.value, 3), 1.2, look=dotshows.shaken)
    if news.kind is GameEventKind.BALL_LOST and news.value:
        return Show("lost", 1, f"BALL {news.value} LOST", 1.4, dotshows.falling_ball, 0.45)
    return None


def _draw_combo_meters(dots: Dots, combo: int, seconds: float) -> None:
    """Hits in a row climb on both sides of the score."""
    lit = min(combo, COMBO_FULL) if combo > 1 else 0
    for cell in range(COMBO_FULL):
        y = 21 - 3 * cell
        light = FULL if lit < COMBO_FULL or seconds % 0.2 < 0.1 else HALF
        if cell < lit:
            dots.box(0, y, 4, 2, light)
            dots.box(WIDTH - 4, y, 4, 2, light)


def _draw_balls(dots: Dots, face: GameView) -> None:
    """Which ball of how many is played; in free play those on the board."""
    if face.mode is Mode.ARCADE and face.balls:
        dots.text(f"BALL {face.ball}/{face.balls}", 0, STATUS_Y, NORMAL, brightness=HALF)
        return
    for ball in range(face.max_balls):
        dots.text("●" if ball < face.on_board else "○", 7 * ball, STATUS_Y, NORMAL)
