"""Watching: how replays and demos begin and end, and what goes on while they run."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from silverball.app.demo_players import BEST_PLAYER, DemoPlayerSelector
from silverball.app.menus import ReplayStatus
from silverball.app.sessions import DemoSession, ReplaySession
from silverball.errors import SilverballError

if TYPE_CHECKING:
    from silverball.app.machine import Machine
    from silverball.game.replay.format import Replay

DEMO_OVER_SECONDS = 4.0  # [s] for which the end of a demo's game is shown before the next one
REPLAY_LOOKAHEAD = 480  # [tick] prepared per frame, so that jumps are fast


class Watching:
    """Shows replays and demos; the physics must be ready.

    Args:
        machine: What they run on.

    Attributes:
        demo_players: The player of the demo.
    """

    def __init__(self, machine: Machine) -> None:
        self._machine = machine
        self.demo_players = DemoPlayerSelector()
        self._demo_ended_at: float | None = None  # [s] when the game of the demo was over

    def start_replay(self, replay: Replay) -> None:
        """Show a replay from its beginning."""
        from silverball.game.replay.player import ReplayPlayer

        self._machine.board.show_replay(replay)
        session = ReplaySession(ReplayPlayer(replay))
        self._machine.start(session)
        self._machine.menus.open_transport(self._replay_status(session))

    def start_demo(self, player: str = BEST_PLAYER.name, *, is_attract: bool = False) -> None:
        """Start a demo; a fallback player plays until this one is compiled."""
        machine = self._machine
        board, table = machine.board, machine.settings.current.table
        needs_board = board.recipe.random is not None or machine.session is not None
        if needs_board and not board.show_table(table, None) and not is_attract:
            machine.menus.reopen()
            return
        chosen = self.demo_players.select(player)
        machine.start(DemoSession(board.table, board.seed, chosen, is_attract=is_attract))
        self._announce_demo_player()

    def update(self) -> None:
        """Do what is due in a frame: prepare a replay, or switch to the player of a demo once it is ready."""
        session = self._machine.session
        if isinstance(session, DemoSession):
            self._update_demo(session)
        elif isinstance(session, ReplaySession):
            with self.stopping_on_error():
                session.player.prepare(REPLAY_LOOKAHEAD)
                self._machine.menus.update_replay(self._replay_status(session))

    def _update_demo(self, session: DemoSession) -> None:
        """Switch to the requested player once it is ready, and begin anew after the end of a game."""
        now = self._machine.now
        if self.demo_players.switch_when_ready(session):
            self._announce_demo_player()
        if not session.has_ended:
            self._demo_ended_at = None
        elif self._demo_ended_at is None:
            self._demo_ended_at = now
        elif now - self._demo_ended_at >= DEMO_OVER_SECONDS:
            self.start_demo(self.demo_players.requested.name, is_attract=session.is_attract)

    def jump(self, seconds: float) -> None:
        """Jump back or ahead in the replay."""
        session = self._machine.session
        if isinstance(session, ReplaySession):
            target = session.player.tick + round(seconds * session.player.replay.tick_rate)
            with self.stopping_on_error():
                session.player.seek(target)

    def stop(self) -> None:
        """End the demo or the replay, and show the menu page from which it was started."""
        if isinstance(self._machine.session, ReplaySession):
            self.end()
        self._machine.session = None
        self._machine.menus.reopen()

    def end(self) -> None:
        """Remove the session and show the chosen table."""
        machine = self._machine
        machine.session = None
        machine.board.show_table(machine.settings.current.table, machine.menus.context.seed)

    @contextmanager
    def stopping_on_error(self) -> Iterator[None]:
        """Stop watching if the session fails: a replay may not match the game that it claims to be."""
        try:
            yield
        except SilverballError as error:
            self._machine.show_message(str(error))
            self.stop()

    def _announce_demo_player(self) -> None:
        """Show on the score display who plays the demo."""
        machine, playing = self._machine, self.demo_players.playing
        machine.demo_speed = playing.max_speed
        machine.change_speed(0)
        machine.display.player_label = playing.label
        machine.menus.context.demo_player = playing

    def _replay_status(self, session: ReplaySession) -> ReplayStatus:
        player, rate = session.player, session.player.replay.tick_rate
        machine = self._machine
        return ReplayStatus(
            player.tick / rate, player.ticks / rate, machine.speed, machine.is_replay_paused, "REPLAY"
        )
