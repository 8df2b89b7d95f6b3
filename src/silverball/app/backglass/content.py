"""What the backglass shows of the program: its display, score card, and rules card, list or help."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pygame

from silverball.app.backglass.backglass import Cell, Content
from silverball.app.backglass.card import Card, CardReader
from silverball.app.menus.attract import title_picture
from silverball.app.menus.high_scores import MODE_LABELS
from silverball.app.menus.listing import Listing, Row
from silverball.app.rule_words import Standing
from silverball.app.score_display import SCORE_ROWS, stacked
from silverball.app.scoring import how_to_score
from silverball.app.startup import draw_line
from silverball.drawing.dotmatrix.canvas import Dots, Levels
from silverball.drawing.themes import THEMES
from silverball.game.view import GameView, Mode
from silverball.plain import plain

if TYPE_CHECKING:
    from collections.abc import Hashable

    from silverball.app.program import Program
    from silverball.app.scoring import Rule
    from silverball.app.sessions import Session
    from silverball.table import Table

CARD_INTERVAL = 0.1  # [s] between two looks at what is lit
TITLE_PERIOD = 8.0  # [s] after which the title is uncovered again
TURN = 8.0  # [s] for the best scores beside the attract mode, and then for what is lit in its game
BEST_SHOWN = 10  # scores beside the attract mode
RANK = "rank"  # the counter of a table that is shown as the player's rank


class ContentReader:
    """Reads what the backglass shows.

    Args:
        program: The program.
    """

    def __init__(self, program: Program) -> None:
        self._program = program
        self._reader: tuple[Table, CardReader] | None = None
        self._rules: tuple[tuple[Table, Mode, str], list[Rule]] | None = None
        self._card, self._card_at = Card(), -1.0

    def read(
        self, seconds: float, help_picture: tuple[pygame.Surface, Hashable] | None = None, shove_key: str = ""
    ) -> Content:
        """Return what to show.

        Args:
            seconds: Time of a monotonic clock [s].
            help_picture: The open page of the help, and what identifies it; None if it is closed.
            shove_key: Label of the key that shoves the table.
        """
        program = self._program
        table, theme = program.board.table, THEMES[program.settings.current.theme]
        body: Card | Listing | pygame.Surface
        body, key = help_picture or (self._body(seconds, shove_key), None)
        return Content(plain(table.name), theme, self._dots(seconds), self._cells(), body, key)

    def rules(self, shove_key: str) -> list[Rule]:
        """Return how to score on the board on screen."""
        program = self._program
        key = program.board.table, program.mode, shove_key
        if self._rules is None or self._rules[0] != key:
            self._rules = key, how_to_score(*key)
        return self._rules[1]

    def _dots(self, seconds: float) -> Levels:
        """Return the dots of the display: a score in the upper half, in the lower one a game or a page."""
        program, session = self._program, self._program.session
        menus = program.menus
        if session is not None:
            game = session.game
            program.note_standing()
            dots = program.display.wide_frame(game.view, seconds, program.best_score, game.modes)
        elif not menus.is_open:
            return stacked(None, program.waiting_page(seconds))
        else:
            dots = stacked(self._best()[0] or None, title_picture(menus.context, seconds % TITLE_PERIOD))
        listing = menus.listing
        if menus.is_open and (listing is None or listing.text):
            dots[SCORE_ROWS:] = menus.draw(seconds, Dots(dots[SCORE_ROWS:].copy())).pixels
        if program.progress is not None:
            draw_line(Dots(dots[SCORE_ROWS:]), program.progress)
        return dots

    def _best(self) -> tuple[int, str]:
        """Return the best score on the chosen table, and who made it; 0 if there is none."""
        context = self._program.menus.context
        rows = context.scores(context.settings.current.table, context.mode)
        return (rows[0].score, rows[0].initials) if rows else (0, "")

    def _cells(self) -> tuple[Cell, ...]:
        session = self._program.session
        best, initials = self._best()
        last = Cell("BEST", f"{best:,}  {initials}" if best else "–")
        if session is None:
            context = self._program.menus.context
            return Cell("MODE", MODE_LABELS[context.mode]), Cell("TABLE", plain(context.table.title)), last
        view = session.game.view
        if view.scores:
            players = [
                Cell(f"PLAYER {number}", f"{score:,}", number == view.player)
                for number, score in enumerate(view.scores, 1)
            ]
            return _ball_cell(view), *players
        cells = [_ball_cell(view), Cell("POINTS", f"×{view.multiplier}")]
        counters = session.game.counters
        if RANK in counters:
            kept = self._program.games.kept_rank if session.is_played else 0
            cells.append(Cell("RANK", rank_text(kept, counters[RANK])))
        return (*cells, last)

    def _body(self, seconds: float, shove_key: str) -> Card | Listing:
        """Return the list of the open page, or the rules card of what is played."""
        program, session = self._program, self._program.session
        listing = program.menus.listing
        if listing is not None:
            return listing._replace(hint=program.menus.context.message(seconds)[0] or listing.hint)
        if session is None and not program.menus.is_open:
            return Card(rules=tuple(self.rules(shove_key)))  # something to read while a game waits
        is_attract = program.menus.page == "attract"
        if session is None or (is_attract and (program.has_attract_lights or seconds % (2.0 * TURN) < TURN)):
            return self._attraction()
        if seconds - self._card_at >= CARD_INTERVAL or seconds < self._card_at:
            self._card_at = seconds
            self._card = self._read_card(session, shove_key)
        return self._card

    def _read_card(self, session: Session, shove_key: str) -> Card:
        game = session.game
        if self._reader is None or self._reader[0] is not game.table:
            self._reader = game.table, CardReader(game.table)
        counters = game.counters | {"in_play": len(game.state.balls)}  # jackpots pay by the balls in play
        standing = Standing(game.lamps, counters, game.modes)
        return self._reader[1].card(standing, self.rules(shove_key))

    def _attraction(self) -> Listing:
        """Return the best scores of the chosen table, beside the attract mode."""
        context = self._program.menus.context
        scores = context.scores(context.settings.current.table, context.mode)[:BEST_SHOWN]
        rows = [
            Row(f"{place}  {row.initials}  {row.score:,}", row.date, can_choose=False)
            for place, row in enumerate(scores, 1)
        ]
        rows = rows or [Row("NO SCORES YET: BE THE FIRST", can_choose=False)]
        title = f"{plain(context.table.title).upper()} · {MODE_LABELS[context.mode]}"
        return Listing(title, tuple(rows), hint=f"PRESS {context.key_label('create')}, OR CLICK")


def rank_text(kept: int, now: int) -> str:
    """Return a rank: the missions of earlier games, and those of this one."""
    return f"{kept:,} + {now:,}" if kept and now else f"{kept + now:,}"


def _ball_cell(view: GameView) -> Cell:
    if view.balls:
        return Cell("BALL", f"{view.ball} / {view.balls}")
    return Cell("BALLS", f"{view.on_board} / {view.max_balls}")
