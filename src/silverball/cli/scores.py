"""`silverball scores`: lists the best scores, verifies them by their replays, exports and removes them."""

from __future__ import annotations

import json
from datetime import date
from typing import TYPE_CHECKING, Annotated

import typer

from silverball.cli.console import compiling, error_console, progress_bar
from silverball.cli.score_tables import ShownList, print_rest, short_name
from silverball.game.scores.daily import daily_seed
from silverball.game.view import Mode
from silverball.plain import plain

if TYPE_CHECKING:
    from silverball.game.scores.store import Score, ScoreList, Store
    from silverball.game.scores.verify_score import ScoreVerdict

TODAY = "today"


def scores(
    ctx: typer.Context,
    table: Annotated[
        str, typer.Option(help="Only scores of this table, by the name in its heading. [default: all]")
    ] = "",
    mode: Annotated[Mode | None, typer.Option(help="Only scores of this mode. [default: both]")] = None,
    day: Annotated[
        str,
        typer.Option(
            metavar="DATE",
            help="Only the daily board of a day, as 2026-11-29 or 'today'. [default: all]",
        ),
    ] = "",
    limit: Annotated[
        int, typer.Option(min=1, max=1_000_000, help="Scores shown per table, best first.")
    ] = 10,
    verify: Annotated[
        bool, typer.Option("--verify", help="Play all replays and list the scores that they do not prove.")
    ] = False,
    replay: Annotated[
        int | None, typer.Option(metavar="ID", help="With --export: the ID of the score.")
    ] = None,
    export: Annotated[str, typer.Option(metavar="FILE", help="Write the replay of a score to a file.")] = "",
    force: Annotated[
        bool, typer.Option("--force", help="With --export: overwrite an existing file.")
    ] = False,
    remove: Annotated[
        int | None, typer.Option(metavar="ID", help="Remove a score and its replay permanently.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON array.")] = False,
) -> None:
    """List the best scores of every table, or verify them by their replays.

    Scores on random boards share one list, which shows the seed of each board. Above a list are the rank (the
    missions finished in all its games) and the medals of its table; a score on a daily board has its date.

    A score is proven if its replay is complete, was played on the table of its list, reaches the score, and
    does not count twice. With --verify, all other scores are listed last, with the reason; without it, the
    list shows the result of the last verification.

    Exit codes: 0 success, 1 a score is not proven, 2 the scores cannot be read or changed.

    Example: `silverball scores --table random`

    Example: `silverball scores --day today`

    Example: `silverball scores --replay 12 --export best.replay`
    """
    from silverball.errors import SilverballError
    from silverball.game.scores.store import Store

    refuse_conflicts(ctx)
    seed = seed_of_day(day)
    with Store() as store:
        if store.warning and not store.is_unreadable:
            error_console.print(
                plain(store.warning, keep="\n"), soft_wrap=True, markup=False, highlight=False
            )
        if remove is not None and not store.is_persistent:
            raise SilverballError(f"{store.path}: nothing was changed: the file cannot be written")
        if verify and not store.has_read:
            raise SilverballError(f"{store.path}: nothing was verified: the file cannot be read")
        if remove is not None:
            score = store.score(remove)
            store.remove(remove)
            initials, table_name = short_name(score.initials), short_name(score.table_name)
            typer.echo(f"removed score {remove}: {score.score:,} by {initials} on {table_name}")
        elif replay is not None:
            write_replay(store, replay, export, force)
        else:
            lists = select_lists(store, table, mode)
            proofs = verify_all(store, lists, as_json) if verify else None
            show(store, lists, limit, as_json, proofs, seed)
            raise typer.Exit(1 if any(not one.verified for one in (proofs or {}).values()) else 0)


def refuse_conflicts(ctx: typer.Context) -> None:
    """Refuse options that contradict each other or have no effect.

    Raises:
        SilverballError: Options do not go together; the message names them.
    """
    from silverball.errors import SilverballError

    given = {
        parameter
        for parameter in ctx.params
        if (source := ctx.get_parameter_source(parameter)) is not None and source.name == "COMMANDLINE"
    }
    if ("replay" in given) != ("export" in given):
        raise SilverballError(
            "silverball scores: --replay and --export must be used together: --replay ID --export FILE"
        )
    if "force" in given and "export" not in given:
        raise SilverballError("silverball scores: --force is for --export only; leave it out")
    for first, alone in (("remove", {"remove"}), ("export", {"export", "replay", "force"})):
        others = sorted(given - alone)
        if first in given and others:
            other = others[0].removeprefix("as_")
            raise SilverballError(f"silverball scores: --{other} does not go with --{first}; leave one out")


def seed_of_day(day: str) -> int | None:
    """The seed of a day's board; None if no day was given.

    Raises:
        SilverballError: It is not a date.
    """
    from silverball.errors import SilverballError

    if not day:
        return None
    try:
        return daily_seed(date.today() if day == TODAY else date.fromisoformat(day))
    except ValueError:
        raise SilverballError(
            f"--day: expected a date such as 2026-11-29, or '{TODAY}', got '{short_name(day)}'"
        ) from None


def select_lists(store: Store, table: str, mode: Mode | None) -> list[ScoreList]:
    """The lists of a table and mode, or all of them.

    Raises:
        SilverballError: There are no scores on that table.
    """
    from silverball.errors import SilverballError

    lists = [one for one in store.lists() if mode is None or one.mode == mode]
    if not table:
        return lists
    wanted = table.casefold()
    found = [
        one for one in lists if wanted in (one.table_name.casefold(), short_name(one.table_name).casefold())
    ]
    if not found:
        names = ", ".join(sorted({short_name(one.table_name) for one in lists})) or "no table yet"
        raise SilverballError(
            f"--table: there are no scores on '{short_name(table)}'; there are scores on {names}"
        )
    return found


def write_replay(store: Store, id: int, out: str, force: bool) -> None:
    """Write the replay of a score to a file.

    Raises:
        OutputError: The file exists, or cannot be written.
    """
    from silverball.cli.shared_options import check_output, file_name
    from silverball.errors import OutputError
    from silverball.wholefile import write_whole

    path, shown = file_name(out), plain(out)
    text = store.replay(id)
    check_output(path, force=force)
    try:
        write_whole(path, lambda place: place.write_text(text, encoding="utf-8", newline="\n"))
    except (OSError, ValueError) as error:  # ValueError: a null character in the path
        reason = getattr(error, "strerror", None) or str(error)
        raise OutputError(f"{shown}: {reason.lower()}") from None
    typer.echo(f"wrote {shown}")


def verify_all(store: Store, lists: list[ScoreList], quiet: bool) -> dict[int, ScoreVerdict]:
    """Verify all scores of some lists, best first, and store the results; returns them by score ID.

    Scores of other lists with the same seed are verified too: a game counts in one of its scores only.
    """
    with compiling():
        from silverball.game.scores.verify_score import CountedGames, verify_score
    all_scores = [
        (score, one.id) for one in store.lists() for score in store.scores(list_id=one.id, limit=-1)
    ]
    numbers = {one.id for one in lists}
    seeds = {(score.seed, score.mode) for score, number in all_scores if number in numbers}
    tried = sorted((one for one in all_scores if (one[0].seed, one[0].mode) in seeds), key=by_score)
    tables = {number: store.table_text(number) for number in {number for _, number in tried}}
    counted = CountedGames()
    proofs: dict[int, ScoreVerdict] = {}
    try:
        with progress_bar() as bar:
            for score, number in bar.track(tried, description="verifying"):
                text = store.replay(score.id) if score.has_replay else None
                proof = verify_score(score, text, tables[number], counted)
                if number in numbers:
                    proofs[score.id] = proof
                    if not proof.verified and not quiet:
                        label = f"score {score.id}, {score.score:,} by {short_name(score.initials)}"
                        typer.echo(f"{label}: not proven: {proof.why}")
    finally:
        store.save_verdicts({id: (proof.verified, proof.why) for id, proof in proofs.items()})
    if not quiet:
        proven = sum(proof.verified for proof in proofs.values())
        typer.echo(f"of {len(proofs)} scores {proven} are proven and {len(proofs) - proven} are not")
    return proofs


def by_score(one: tuple[Score, int]) -> tuple[int, int]:
    """Sort key: higher scores first, then earlier ones; of two scores of one game the first counts."""
    return -one[0].score, one[0].id


def show(
    store: Store,
    lists: list[ScoreList],
    limit: int,
    as_json: bool,
    proofs: dict[int, ScoreVerdict] | None,
    seed: int | None = None,
) -> None:
    """Print the best scores of some lists; with a seed, those of its board only."""
    ranked_lists = [(one, ranked(store, one, proofs, seed)) for one in lists]
    shown = [(ShownList(store, one), rows) for one, rows in ranked_lists if rows]
    if as_json:
        objects = [one.as_object(place, score) for one, rows in shown for place, score in rows[:limit]]
        typer.echo(json.dumps(objects, indent=2))
        return
    if not shown:
        which = "there are no scores on that board" if lists and seed is not None else "there are no scores"
        typer.echo(f"{which} yet: play a game with `silverball`")
    for one, rows in shown:
        heading = one.heading
        versions = sum(
            (other.mode, other.table_name) == (heading.mode, heading.table_name) for other in lists
        )
        one.print(rows[:limit], is_one_of_several=versions > 1, is_verified=proofs is not None)
        if len(rows) > limit:
            print_rest(len(rows) - limit)


def ranked(
    store: Store, one: ScoreList, proofs: dict[int, ScoreVerdict] | None, seed: int | None
) -> list[tuple[int, Score]]:
    """The scores of a list with their places; new proofs take precedence over stored ones."""
    scores = store.scores(list_id=one.id, limit=-1, seed=seed)
    if proofs is not None:
        scores = sorted(
            (
                score._replace(verified=proofs[score.id].verified, why=proofs[score.id].why)
                for score in scores
                if score.id in proofs
            ),
            key=lambda score: score.order,
        )
    return list(enumerate(scores, 1))
