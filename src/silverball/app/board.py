"""The board on screen: the table it was made from, its seed, and changes of the table's file."""

from __future__ import annotations

import secrets
from collections.abc import Callable
from typing import TYPE_CHECKING

from silverball.app.catalog import quoted_file_name, table_error_text, table_problem_text
from silverball.errors import SilverballError
from silverball.plain import plain

if TYPE_CHECKING:
    from silverball.app.catalog import Catalog
    from silverball.app.menus import MenuContext
    from silverball.app.settings import PlayerSettings
    from silverball.game.replay.format import Replay
    from silverball.table import Table

SEED_LIMIT = 1_000_000  # seeds of new boards are smaller, so that people can pass them on


class CurrentBoard:
    """The board on screen.

    Args:
        catalog: Reads tables and makes boards of them.
        settings: The player's settings, with the chosen table.
        context: Menu context; `last_seed` is set for every random board.
        show_message: Shows the player a sentence.
        seed: Seed of the first board; None draws one.

    Attributes:
        table: The board: a table whose random parts are placed.
        recipe: The table that it was made from.
        seed: The seed that it was made with.
        is_unplayed: Whether no game has been played on it yet.

    Raises:
        SilverballError: The chosen table cannot be used.
    """

    table: Table
    recipe: Table
    seed: int
    is_unplayed: bool

    def __init__(
        self,
        catalog: Catalog,
        settings: PlayerSettings,
        context: MenuContext,
        show_message: Callable[[str], None],
        seed: int | None,
    ) -> None:
        self._catalog, self._settings, self._context = catalog, settings, context
        self._show_message = show_message
        self.show(catalog.recipe(settings.current.table), seed)

    @property
    def random_seed(self) -> int | None:
        """The seed of a random board; None if the table has no random parts."""
        return None if self.recipe.random is None else self.seed

    def show(self, recipe: Table, seed: int | None) -> None:
        """Show the board that a seed makes of a table; None draws a seed.

        Raises:
            SilverballError: The seed makes no board.
        """
        seed = secrets.randbelow(SEED_LIMIT) if seed is None else seed
        self.table = self._catalog.make_board(recipe, seed)
        self.recipe, self.seed, self.is_unplayed = recipe, seed, True
        if recipe.random is not None:
            self._context.last_seed = seed

    def show_table(self, name: str, seed: int | None) -> bool:
        """Show the board of a table. If it cannot be used, show why, leave the board and return False."""
        try:
            self.show(self._catalog.recipe(name), seed)
        except SilverballError as error:
            self._show_message(table_error_text(name, error))
            return False
        return True

    def show_replay(self, replay: Replay) -> None:
        """Show the board of a replay."""
        self.recipe = self.table = replay.table
        self.seed = replay.seed

    def renew(self, seed: int | None, key: str) -> str | None:
        """Show another board of the chosen table, or the same board again; a changed file is read again.

        Args:
            seed: Seed of the board; None: a new one.
            key: The key that makes a new board, as the display writes it.

        Returns:
            A message for the player; None if no board could be made, which has been reported.
        """
        name, before = self._settings.current.table, self.recipe
        try:
            self.show(self._catalog.recipe(name), seed)
        except SilverballError as error:
            try:
                self.show(before, seed)
            except SilverballError as no_board:
                self._show_message(str(no_board))
                return None
            return f"{table_error_text(name, error)}. This is the previous version of the table"
        reread = f"{quoted_file_name(name)} was read again" if self.recipe != before else ""
        if self.recipe.random is None:
            fixed = f"{plain(self.table.name)} has no random parts; only the balls start elsewhere"
            return reread or fixed
        is_new = seed is None
        text = f"board {self.seed}. Shift+{key} plays it again" if is_new else f"board {self.seed} again"
        return f"{reread}: {text}" if reread else text

    def check_file(self, key: str, *, has_session: bool) -> None:
        """Show the table again if its file has changed; during a session, only show a message.

        Args:
            key: The key that makes a new board, as the display writes it.
            has_session: Whether a session runs on the board.
        """
        change = self._catalog.chosen_file_change()
        if change is None or change.table == self.recipe:
            return
        name = self._settings.current.table
        if not has_session:
            self.show_table(name, self.seed)
        elif change.table is not None:
            self._show_message(f"{quoted_file_name(name)} has changed: {key} plays the new one")
        else:
            self._show_message(
                f"{table_problem_text(name, change.problem)}. {key} plays the previous version"
            )
