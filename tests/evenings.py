"""A program without a window, and a player for it."""

from __future__ import annotations

from silverball.app.button_handlers import press, release
from silverball.app.catalog import Catalog
from silverball.app.controls import Action, PaddleInput
from silverball.app.program import Program
from silverball.app.settings import Settings
from silverball.game.scores.store import Store
from silverball.game.view import Phase
from silverball.table import Board, Cylinder, Table

NOTHING = PaddleInput((False, False), (False, False))
LEAKY = Table(
    name="Leaky",
    board=Board(gravity=40.0),
    cylinder=tuple(Cylinder(center=(-2.0, z), radius=1.15) for z in (-3.2, 0.0, 3.2)),
)


class Evening:
    """A program, and an evening at it."""

    def __init__(self, folder, settings=None, table=LEAKY) -> None:
        self.said: list[str] = []
        self.store = Store(folder, nonblocking=True)  # as a window has it
        self.catalog = Catalog(self.store, folder, {table.name: table})
        chosen = settings or Settings(table=table.name)
        self.program = Program(self.store, chosen, self.catalog, seed=3, show_message=self.said.append)
        self.seconds = 0.0

    def go(self, seconds: float) -> None:
        for _ in range(round(seconds * 30)):
            self.seconds += 1 / 30
            self.program.update(self.seconds)
            self.advance(8)
            self.program.dots(self.seconds)

    def advance(self, ticks: int) -> None:
        """Advance the session, as the window does."""
        if self.program.session is not None and self.program.is_moving:
            with self.program.stopping_on_error():
                self.program.session.advance(NOTHING, ticks)

    def press(self, action: Action) -> None:
        press(self.program, action)

    def tap(self, *actions: Action) -> None:
        for action in actions:
            self.press(action)
            release(self.program, action)
            self.go(1 / 30)

    def play_to_the_end(self) -> None:
        for _ in range(30):
            if self.program.session.has_ended:
                return
            self.tap(Action.CREATE)
            for _ in range(60):
                if self.program.session.game.phase is not Phase.PLAY:
                    break
                self.go(0.5)
