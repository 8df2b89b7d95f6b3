"""`silverball scores`: who played best, and is it true?"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import typer

from silverball.game.news import Mode
from silverball.game.when import local

if TYPE_CHECKING:
    from silverball.game.store import Score, ScoreList, Store


def scores(
    ctx: typer.Context,
    table: str = typer.Option("", help="Of this table only: the name that stands above its scores."),
    mode: Mode | None = typer.Option(None, help="Of this kind of game only."),
    limit: int = typer.Option(10, min=1, max=1_000_000, help="The best so many of every table."),
    verify: bool = typer.Option(False, "--verify", help="Play every replay back and mark what is not true."),
    replay: int | None = typer.Option(None, metavar="ID", help="With --export: the number of the score."),
    export: str = typer.Option("", metavar="FILE", help="Write the replay of a score to a file."),
    force: bool = typer.Option(False, "--force", help="With --export: overwrite a file that exists."),
    remove: int | None = typer.Option(None, metavar="ID", help="Remove a score and its replay for ever."),
    as_json: bool = typer.Option(False, "--json", help="Print a JSON array."),
) -> None:
    """Show the best scores of every table, or see whether their replays reach them.

    Scores on random boards stand in one list, with the seed of each board. With --verify the exit code is 1
    if a replay does not reach its score.

    Example: `silverball scores --table random`, `silverball scores --verify`, or the replay of score 12 with
    `silverball scores --replay 12 --export best.replay`
    """
    from silverball.cli.console import errors
    from silverball.errors import SilverballError
    from silverball.game.store import Store

    refuse_what_does_not_fit(ctx)
    with Store() as store:
        if store.trouble:
            errors.print(store.trouble, soft_wrap=True, markup=False, highlight=False)
        if (remove is not None or verify) and not store.keeps:
            raise SilverballError(f"{store.path}: nothing was changed, for it cannot be written")
        if remove is not None:
            gone = store.score(remove)
            store.remove(remove)
            typer.echo(f"removed score {remove}: {gone.score:,} by {gone.initials} on {gone.table_name}")
        elif replay is not None:
            write_replay(store, replay, export, force)
        else:
            lists = chosen(store, table, mode)
            wrong = verify_all(store, lists, as_json) if verify else 0
            show(store, lists, limit, as_json)
            raise typer.Exit(1 if wrong else 0)


def refuse_what_does_not_fit(ctx: typer.Context) -> None:
    """Refuse options that would change nothing or contradict each other."""
    from silverball.errors import SilverballError

    given = {
        name
        for name in ctx.params
        if (source := ctx.get_parameter_source(name)) is not None and source.name == "COMMANDLINE"
    }
    if ("replay" in given) != ("export" in given):
        raise SilverballError(
            "silverball scores: --replay and --export belong together: --replay ID --export FILE"
        )
    if "force" in given and "export" not in given:
        raise SilverballError("silverball scores: --force is for --export only; leave it out")
    for first, alone in (("remove", {"remove"}), ("export", {"export", "replay", "force"})):
        others = sorted(given - alone)
        if first in given and others:
            name = others[0].removeprefix("as_")
            raise SilverballError(f"silverball scores: --{name} does not go with --{first}; leave one out")


def chosen(store: Store, table: str, mode: Mode | None) -> list[ScoreList]:
    """The lists of a table and mode; all if none is named."""
    from silverball.errors import SilverballError

    lists = [one for one in store.lists() if mode is None or one.mode == mode]
    if not table:
        return lists
    found = [one for one in lists if one.table_name.casefold() == table.casefold()]
    if not found:
        names = ", ".join(sorted({one.table_name for one in lists})) or "no table yet"
        raise SilverballError(f"--table: there are no such scores on {table!r}; there are some on {names}")
    return found


def write_replay(store: Store, id: int, out: str, force: bool) -> None:
    """Write the replay of a score to a file."""
    from silverball.cli.output import file_name
    from silverball.errors import OutputError
    from silverball.wholefile import write_whole

    path = file_name(out)
    text = store.replay(id)
    if path.is_dir():
        raise OutputError(f"{out}: this is a folder; give the name of a file in it")
    if path.exists() and not force:
        raise OutputError(f"{out}: this file exists; choose another name, or overwrite it with --force")
    if not path.absolute().parent.is_dir():
        raise OutputError(f"{out}: there is no folder {path.parent}: make it first")
    try:
        write_whole(path, lambda place: place.write_text(text, encoding="utf-8", newline="\n"))
    except OSError as error:
        raise OutputError(f"{out}: {(error.strerror or str(error)).lower()}") from None
    typer.echo(f"wrote {out}")


def verify_all(store: Store, lists: list[ScoreList], quiet: bool) -> int:
    """Play all replays back and mark their scores; how many do not reach them."""
    from rich.progress import Progress

    from silverball.cli.console import compiling, errors

    with compiling():
        from silverball.game.proof import prove
    every = [score for one in lists for score in of(store, one, -1)]
    with_replay = [score for score in every if score.has_replay]
    found = {True: 0, False: 0, None: 0}
    with Progress(console=errors, transient=True, disable=not errors.is_terminal) as bar:
        for score in bar.track(with_replay, description="playing back"):
            proof = prove(score, store.replay(score.id))
            store.mark(score.id, *proof)
            found[proof.verified] += 1
            if proof.why and not quiet:
                typer.echo(f"score {score.id}, {score.score:,} by {score.initials}: {proof.why}")
    if not quiet:
        typer.echo(
            f"of {len(every)} scores {found[True]} are true, {found[False]} are not, {found[None]} are of "
            f"another version, and {len(every) - len(with_replay)} have no replay any more"
        )
    return found[False]


def of(store: Store, one: ScoreList, limit: int) -> list[Score]:
    """The best scores of a list."""
    return store.scores(one.mode, one.table_digest, limit=limit)


def show(store: Store, lists: list[ScoreList], limit: int, as_json: bool) -> None:
    """Print the best scores of some lists."""
    if as_json:
        rows = [as_object(place, score) for one in lists for place, score in ranked(store, one, limit)]
        typer.echo(json.dumps(rows, indent=2))
        return
    if not lists:
        typer.echo("there are no scores yet: play a game with `silverball`")
    for one in lists:
        versions = sum((other.mode, other.table_name) == (one.mode, one.table_name) for other in lists)
        print_list(one, ranked(store, one, limit), versions > 1)


def ranked(store: Store, one: ScoreList, limit: int) -> list[tuple[int, Score]]:
    """The best scores of a list with their places."""
    return list(enumerate(of(store, one, limit), 1))


def as_object(place: int, score: Score) -> dict[str, Any]:
    """A score for JSON."""
    return {"place": place} | score._asdict() | {"when": score.when.isoformat()}


def print_list(one: ScoreList, rows: list[tuple[int, Score]], is_one_of_several: bool) -> None:
    """A list as people like to read it; of several of one name the digests tell which is which."""
    from rich import box
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    version = f" · version {one.table_digest[:8]}" if is_one_of_several else ""
    grid = Table(
        title=Text(f"{one.table_name} · {one.mode}{version}"), title_justify="left", box=box.SIMPLE_HEAD
    )
    for name in ("place", "score"):
        grid.add_column(name, justify="right")
    grid.add_column("by")
    grid.add_column("seed", justify="right")
    grid.add_column("when")
    grid.add_column("replay")
    grid.add_column("ID", justify="right")
    for place, score in rows:
        kept = "kept" if score.has_replay else "not kept"
        if score.verified is not None:
            kept = "true" if score.verified else "does not reach it"
        when = local(score.when, "%Y-%m-%d %H:%M")
        cells = (str(place), f"{score.score:,}", score.initials, str(score.seed), when, kept, str(score.id))
        grid.add_row(*map(Text, cells), style="red" if score.verified is False else None)
    Console().print(grid)
    if len(rows) < one.length:
        typer.echo(f"  and {one.length - len(rows)} more; --limit shows them")
