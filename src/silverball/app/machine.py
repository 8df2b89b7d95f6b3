"""The machine: the board, the session that runs on it, its score display, and how fast time passes."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from silverball.app.announcements import TableWords
from silverball.app.controls import Action
from silverball.app.score_display import ScoreDisplay
from silverball.app.sessions import DemoSession, GameSession, Session

if TYPE_CHECKING:
    from silverball.app.board import CurrentBoard
    from silverball.app.menus import Menus
    from silverball.app.settings import PlayerSettings

SPEEDS = (0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0)
NORMAL_SPEED = SPEEDS.index(1.0)


class Machine:
    """What games, replays and demos run on.

    Args:
        board: The board on screen.
        settings: The player's settings.
        menus: The pages on the score display.
        show_message: Shows the player a sentence.

    Attributes:
        session: What runs on the board; None at first and in the menus.
        display: The score display of the session.
        is_replay_paused: Whether the replay is paused.
        demo_speed: How fast the player of a demo can play, at most.
        now: Time of the last update [s], of a monotonic clock.
    """

    def __init__(
        self, board: CurrentBoard, settings: PlayerSettings, menus: Menus, show_message: Callable[[str], None]
    ) -> None:
        self.board, self.settings, self.menus, self.show_message = board, settings, menus, show_message
        self.session: Session | None = None
        self.display = ScoreDisplay()
        self.is_replay_paused = False
        self.demo_speed = SPEEDS[-1]
        self.now = 0.0
        self._speed = NORMAL_SPEED

    @property
    def speed(self) -> float:
        """Seconds of play per second of real time."""
        return SPEEDS[self._speed]

    @property
    def has_game(self) -> bool:
        """Whether a game of the player is running or paused."""
        return isinstance(self.session, GameSession) and not self.session.has_ended

    @property
    def is_moving(self) -> bool:
        """Whether time passes on the board."""
        if self.session is None or self.session.has_ended:
            return False
        if isinstance(self.session, GameSession):
            return not self.menus.is_open
        return not self.is_replay_paused

    def start(self, session: Session) -> None:
        """Run a session on the board, at normal speed and with a new display."""
        self.session = session
        is_calm = self.settings.current.effects == "less"
        words = TableWords.of(session.game.table)
        self.display = ScoreDisplay(self.key_label(Action.CREATE), is_calm, words)
        self._speed, self.is_replay_paused = NORMAL_SPEED, False

    def change_speed(self, step: int) -> None:
        """Play slower (negative) or faster by some steps, as far as the session allows; 0 only limits it."""
        self._speed = min(max(self._speed + step, 0), self._max_speed)

    def key_label(self, action: Action) -> str:
        """Return the first key of an action, as the display writes it."""
        return self.menus.context.key_label(action)

    @property
    def _max_speed(self) -> int:
        """The greatest index in SPEEDS that the session allows."""
        if isinstance(self.session, GameSession):
            return NORMAL_SPEED
        limit = self.demo_speed if isinstance(self.session, DemoSession) else SPEEDS[-1]
        return max(index for index, speed in enumerate(SPEEDS) if speed <= limit)
