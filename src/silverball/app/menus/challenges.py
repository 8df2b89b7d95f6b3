"""The pages of challenges: today's board, rivals, players in turn, and the medals of every table."""

from __future__ import annotations

from silverball.app.menus.choice import ChoicePage, Item
from silverball.app.menus.commands import Play, Rivalry
from silverball.app.menus.context import Challenges, MenuContext
from silverball.game.match import MAX_PLAYERS
from silverball.game.view import Mode


def challenges_page(context: MenuContext, challenges: Challenges) -> ChoicePage:
    """Everything that is more than one game for points."""
    table = context.settings.current.arcade_table

    def begin(**how: object) -> Play:
        context.close()
        context.settings.change(mode=Mode.ARCADE)
        return Play(Mode.ARCADE, table, **how)  # type: ignore[arg-type]

    def today() -> Play:
        return begin(seed=challenges.seed, rival=Rivalry.TODAY)

    def match_item(players: int) -> Item:
        return Item(f"{players} PLAYERS", "IN TURN, BALL BY BALL", lambda: begin(players=players))

    def items() -> list[Item]:
        best, rows = challenges.best, challenges.today
        first = f"BEST {rows[0].score:,} BY {rows[0].initials}" if rows else "NOBODY HAS PLAYED IT YET"
        found = [Item("TODAY'S BOARD", f"{challenges.day}: {first}", today)]
        if rows:
            found.append(
                Item(
                    "TODAY'S SCORES",
                    f"{len(rows)} SO FAR",
                    lambda: context.open(today_page(context, challenges)),
                )
            )
        found.append(
            Item(
                "BEAT THE PLANNER", "IT PLAYS THE SAME BOARD BESIDE YOU", lambda: begin(rival=Rivalry.PLANNER)
            )
        )
        if best is not None:
            hint = f"{best.initials} PLAYS {best.score:,} BESIDE YOU"
            found.append(Item("RACE THE BEST", hint, lambda: begin(rival=Rivalry.BEST)))
        found += [match_item(players) for players in range(2, MAX_PLAYERS + 1)]
        if challenges.standings:
            found.append(
                Item(
                    "MEDALS",
                    "AND RANKS, KEPT FOR EVER",
                    lambda: context.open(medals_page(context, challenges)),
                )
            )
        return [*found, Item("BACK", "ALSO: HOLD BOTH PADDLES", context.back)]

    return ChoicePage("challenges", "CHALLENGES", items)


def today_page(context: MenuContext, challenges: Challenges) -> ChoicePage:
    """The list of today's board."""

    def items() -> list[Item]:
        rows = [
            Item(f"{place}  {row.initials}  {row.score:,}", f"TODAY, {challenges.day}")
            for place, row in enumerate(challenges.today, 1)
        ]
        return [*rows, Item("BACK", "ALSO: HOLD BOTH PADDLES", context.back)]

    return ChoicePage("today", f"TODAY {challenges.day}", items)


def medals_page(context: MenuContext, challenges: Challenges) -> ChoicePage:
    """The medals and ranks of all tables that have any."""

    def items() -> list[Item]:
        rows = []
        for one in challenges.standings:
            medal = f"{one.medal.upper()} MEDAL" if one.medal else "NO MEDAL YET"
            rank = f"RANK {one.rank}" if one.rank else ""
            rows.append(Item(one.title.upper(), "   ".join(filter(None, (medal, one.goal, rank)))))
        return [*rows, Item("BACK", "ALSO: HOLD BOTH PADDLES", context.back)]

    return ChoicePage("medals", "MEDALS", items)
