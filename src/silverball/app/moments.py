"""The moments of a game as plain values: what a finished game came to, and what there is to challenge."""

from __future__ import annotations

from datetime import date
from typing import TYPE_CHECKING

from silverball.app.menus.commands import Play
from silverball.app.menus.context import Challenges, ScoreRow, Standing
from silverball.app.menus.game_over import GameOver, Signing
from silverball.app.rival import outcome
from silverball.errors import SilverballError
from silverball.game.scores.daily import daily_seed
from silverball.game.scores.medals import medal_of, next_medal
from silverball.game.view import Mode

if TYPE_CHECKING:
    from collections.abc import Sequence

    from silverball.app.catalog import Catalog
    from silverball.app.game_archive import GameResult
    from silverball.app.sessions import GameSession
    from silverball.table import Table


def game_over(
    session: GameSession, result: GameResult, rows: Sequence[ScoreRow], again: Play | None, rank: int
) -> GameOver:
    """What a finished game came to.

    Args:
        session: The game.
        result: Its scores as they were saved.
        rows: The list that its score is in now, best first.
        again: The game that "play again" begins; None: another one by the settings.
        rank: The missions finished in all games on the table, with this one.
    """
    game = session.game
    is_match = game.players > 1
    lines = _match_lines(game.scores) if is_match else _score_lines(session, result, rows)
    if sum(game.ranks):
        lines.append(f"RANK {rank}")
    causes = session.tally.causes(game.scores.index(game.score) + 1)
    signings = tuple(
        Signing(one.score, one.rank, one.player if is_match else 0)
        for one in result.scores
        if one.rank is not None
    )
    return GameOver(tuple(lines), tuple((one.name, one.points) for one in causes), signings, again)


def _match_lines(scores: tuple[int, ...]) -> list[str]:
    """Who has won, and the points of all."""
    best = max(scores)
    winners = [f"{player}" for player, score in enumerate(scores, 1) if score == best]
    won = f"PLAYER {winners[0]} WINS" if len(winners) == 1 else f"PLAYERS {' AND '.join(winners)} DRAW"
    return [won, *(f"PLAYER {player}: {score:,}" for player, score in enumerate(scores, 1))]


def _score_lines(session: GameSession, result: GameResult, rows: Sequence[ScoreRow]) -> list[str]:
    """Whom the player has beaten and who is to be beaten, rivals and medals."""
    game, lines = session.game, []
    if session.rival is not None:
        lines.append(outcome(game.score, session.rival))
    rank = next((one.rank for one in result.scores), None)
    if rank is not None:
        lines.append("THE BEST SO FAR" if rank == 1 else f"NO. {rank}")
    lines += [f"NO. {one.rank_today} TODAY" for one in result.scores if one.rank_today is not None]
    above = [row for row in rows if row.score > game.score]
    if above:
        lines.append(f"{above[-1].score - game.score + 1:,} TO BEAT {above[-1].initials}")
    medal, goal = medal_of(game.table, game.score), next_medal(game.table, game.score)
    if medal is not None:
        lines.append(f"{medal.upper()} MEDAL")
    if goal is not None:
        lines.append(f"{goal[1] - game.score:,} TO {goal[0].upper()}")
    return lines


def challenges(catalog: Catalog, table: str, names: Sequence[str], today: date) -> Challenges:
    """What there is to challenge on a table.

    Args:
        catalog: All tables and scores.
        table: The table that was chosen for arcade games.
        names: All tables that can be played.
        today: The date.
    """
    seed = daily_seed(today)
    rows = catalog.scores(table, Mode.ARCADE)
    return Challenges(
        f"{today:%d.%m.%y}",
        seed,
        catalog.best_of_seed(table, Mode.ARCADE, seed),
        next((row for row in rows if row.key), None),
        [one for name in names if (one := _standing(catalog, name)) is not None],
    )


def _standing(catalog: Catalog, name: str) -> Standing | None:
    """How the player stands on a table; None if there is nothing to say."""
    try:
        recipe: Table = catalog.recipe(name)
    except SilverballError:
        return None
    rows = catalog.scores(name, Mode.ARCADE)
    best, rank = rows[0].score if rows else 0, catalog.rank(name)
    medal, goal = medal_of(recipe, best), next_medal(recipe, best)
    if goal is None and medal is None and not rank:
        return None
    text = f"{goal[0].upper()} AT {goal[1]:,}" if goal is not None else ""
    return Standing(recipe.name, medal or "", text, rank)
