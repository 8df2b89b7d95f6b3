"""`silverball scores`: lists the best scores, verifies them by their replays, exports and removes them."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Annotated, Any

import typer

from silverball.cli.console import compiling, error_console, progress_bar
from silverball.game.view import Mode
from silverball.plain import plain

if TYPE_CHECKING:
    from silverball.game.scores.store import Score, ScoreList, Store
    from silverball.game.scores.verify_score import ScoreVerdict

NAME_LENGTH = 60  # printed characters of a name


def scores(
    ctx: typer.Context,
    table: Annotated[
        str, typer.Option(help="Only scores of this table, by the name in its heading. [default: all]")
    ] = "",
    mode: Annotated[Mode | None, typer.Option(help="Only scores of this mode. [default: both]")] = None,
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

    Scores on random boards share one list, which shows the seed of each board. A score is proven if its
    replay is complete, was played on the table of its list, reaches the score, and does not count twice. With
    --verify, all other scores are listed last, with the reason; without it, the list shows the result of the
    last verification.

    Exit codes: 0 success, 1 a score is not proven, 2 the scores cannot be read or changed.

    Example: `silverball scores --table random`

    Example: `silverball scores --replay 12 --export best.replay`
    """
    from silverball.errors import SilverballError
    from silverball.game.scores.store import Store

    refuse_conflicts(ctx)
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
            show(store, lists, limit, as_json, proofs)
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
    store: Store, lists: list[ScoreList], limit: int, as_json: bool, proofs: dict[int, ScoreVerdict] | None
) -> None:
    """Print the best scores of some lists."""
    if as_json:
        rows = [
            as_object(place, score) for one in lists for place, score in ranked(store, one, limit, proofs)
        ]
        typer.echo(json.dumps(rows, indent=2))
        return
    if not lists:
        typer.echo("there are no scores yet: play a game with `silverball`")
    for one in lists:
        versions = sum((other.mode, other.table_name) == (one.mode, one.table_name) for other in lists)
        print_list(one, ranked(store, one, limit, proofs), versions > 1, proofs is not None)


def ranked(
    store: Store, one: ScoreList, limit: int, proofs: dict[int, ScoreVerdict] | None
) -> list[tuple[int, Score]]:
    """The best scores of a list with their places; new proofs take precedence over stored ones."""
    if proofs is None:
        return list(enumerate(store.scores(list_id=one.id, limit=limit), 1))
    scores = [
        score._replace(verified=proofs[score.id].verified, why=proofs[score.id].why)
        for score in store.scores(list_id=one.id, limit=-1)
        if score.id in proofs
    ]
    return list(enumerate(sorted(scores, key=lambda score: score.order)[:limit], 1))


def as_object(place: int, score: Score) -> dict[str, Any]:
    """A score for JSON."""
    values = score._asdict() | {"when": score.when.isoformat()}
    del values["damage"]  # `why` contains it
    return {"place": place} | values


def print_list(
    one: ScoreList, rows: list[tuple[int, Score]], is_one_of_several: bool, is_verified: bool
) -> None:
    """Print a list as a table; the digest of the table distinguishes lists of one name."""
    from rich import box
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    from silverball.game.scores.verify_score import is_built_in

    words = [short_name(one.table_name), short_name(one.mode)]
    words += ["built-in"] * is_built_in(one.table_digest)
    words += [f"version {short_name(one.table_digest[:8])}"] * is_one_of_several
    grid = Table(title=Text(" · ".join(words)), title_justify="left", box=box.SIMPLE_HEAD)
    for head in ("place", "score"):
        grid.add_column(head, justify="right")
    grid.add_column("by")
    grid.add_column("seed", justify="right")
    grid.add_column("when")
    grid.add_column("proof")
    grid.add_column("ID", justify="right")
    for place, score in rows:
        cells = (
            str(place), f"{score.score:,}", short_name(score.initials), str(score.seed),
            score.played("%Y-%m-%d %H:%M"), proof_words(score, is_verified), str(score.id),
        )  # fmt: skip
        grid.add_row(*map(Text, cells), style="red" if score.is_rejected else None)
    Console().print(grid)
    if len(rows) < one.length:
        typer.echo(f"  and {one.length - len(rows)} more (see --limit)")


def proof_words(score: Score, is_verified: bool) -> str:
    """The state of the proof in words; that of an earlier verification is in the past tense."""
    if score.verified is None:
        return "not verified" if score.has_replay else "no replay"
    words = "proven" if score.verified else "not proven"
    return words if is_verified or score.damage else f"was {words}"


def short_name(text: str) -> str:
    """Text from a file or the command line, escaped and shortened to be printed on one line."""
    return plain(text if len(text) <= NAME_LENGTH else f"{text[:NAME_LENGTH]}…")
