"""`silverball scores`: who played best, and is it proven?"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import typer

from silverball.game.view import Mode
from silverball.plain import plain

if TYPE_CHECKING:
    from silverball.game.scores.store import Score, ScoreList, Store
    from silverball.game.scores.verify_score import ScoreVerdict

NAME_LENGTH = 60  # characters of a name that are printed


def scores(
    ctx: typer.Context,
    table: str = typer.Option("", help="Of this table only: the name that stands above its scores."),
    mode: Mode | None = typer.Option(None, help="Of this kind of game only."),
    limit: int = typer.Option(10, min=1, max=1_000_000, help="The best so many of every table."),
    verify: bool = typer.Option(False, "--verify", help="Play all replays back; mark what is not proven."),
    replay: int | None = typer.Option(None, metavar="ID", help="With --export: the number of the score."),
    export: str = typer.Option("", metavar="FILE", help="Write the replay of a score to a file."),
    force: bool = typer.Option(False, "--force", help="With --export: overwrite a file that exists."),
    remove: int | None = typer.Option(None, metavar="ID", help="Remove a score and its replay for ever."),
    as_json: bool = typer.Option(False, "--json", help="Print a JSON array."),
) -> None:
    """Show the best scores of every table, or see whether their replays prove them.

    Scores on random boards stand in one list, with the seed of each board. A score is proven if its replay is
    whole, is of the very table that stands above it, reaches it, and was not counted before; with --verify
    all others stand below, with the reason, and the exit code is 1 if there are any. Without --verify the
    list only says what came of it last.

    Example: `silverball scores --table random`, `silverball scores --verify`, or the replay of score 12 with
    `silverball scores --replay 12 --export best.replay`
    """
    from silverball.cli.console import errors
    from silverball.errors import SilverballError
    from silverball.game.scores.store import Store

    refuse_what_does_not_fit(ctx)
    with Store() as store:
        if store.warning and not store.is_unreadable:
            errors.print(plain(store.warning, keep="\n"), soft_wrap=True, markup=False, highlight=False)
        if remove is not None and not store.is_persistent:
            raise SilverballError(f"{store.path}: nothing was changed, for it cannot be written")
        if verify and not store.has_read:
            raise SilverballError(f"{store.path}: nothing was verified, for it cannot be read")
        if remove is not None:
            gone = store.score(remove)
            store.remove(remove)
            who, where = name(gone.initials), name(gone.table_name)
            typer.echo(f"removed score {remove}: {gone.score:,} by {who} on {where}")
        elif replay is not None:
            write_replay(store, replay, export, force)
        else:
            lists = chosen(store, table, mode)
            proofs = verify_all(store, lists, as_json) if verify else None
            show(store, lists, limit, as_json, proofs)
            raise typer.Exit(1 if any(not one.verified for one in (proofs or {}).values()) else 0)


def refuse_what_does_not_fit(ctx: typer.Context) -> None:
    """Refuse options that would change nothing or contradict each other."""
    from silverball.errors import SilverballError

    given = {
        parameter
        for parameter in ctx.params
        if (source := ctx.get_parameter_source(parameter)) is not None and source.name == "COMMANDLINE"
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
            other = others[0].removeprefix("as_")
            raise SilverballError(f"silverball scores: --{other} does not go with --{first}; leave one out")


def chosen(store: Store, table: str, mode: Mode | None) -> list[ScoreList]:
    """The lists of a table and mode; all if none is named."""
    from silverball.errors import SilverballError

    lists = [one for one in store.lists() if mode is None or one.mode == mode]
    if not table:
        return lists
    wanted = table.casefold()
    found = [one for one in lists if wanted in (one.table_name.casefold(), name(one.table_name).casefold())]
    if not found:
        names = ", ".join(sorted({name(one.table_name) for one in lists})) or "no table yet"
        raise SilverballError(
            f"--table: there are no such scores on '{name(table)}'; there are some on {names}"
        )
    return found


def write_replay(store: Store, id: int, out: str, force: bool) -> None:
    """Write the replay of a score to a file."""
    from silverball.cli.output import file_name
    from silverball.errors import OutputError
    from silverball.wholefile import write_whole

    path, shown = file_name(out), plain(out)
    text = store.replay(id)
    if path.is_dir():
        raise OutputError(f"{shown}: this is a folder; give the name of a file in it")
    if path.exists() and not path.is_file():
        raise OutputError(f"{shown}: this is no ordinary file; choose another name")
    if path.exists() and not force:
        raise OutputError(f"{shown}: this file exists; choose another name, or overwrite it with --force")
    if not path.absolute().parent.is_dir():
        raise OutputError(f"{shown}: there is no folder {plain(str(path.parent))}: make it first")
    try:
        write_whole(path, lambda place: place.write_text(text, encoding="utf-8", newline="\n"))
    except (OSError, ValueError) as error:  # ValueError: a zero character in the path
        reason = getattr(error, "strerror", None) or str(error)
        raise OutputError(f"{shown}: {reason.lower()}") from None
    typer.echo(f"wrote {shown}")


def verify_all(store: Store, lists: list[ScoreList], quiet: bool) -> dict[int, ScoreVerdict]:
    """Try to prove all scores of some lists, the best first, and mark them; what came of it, by number.

    A score of another list may be of the same game: those of the same seed are tried too.
    """
    from rich.progress import Progress

    from silverball.cli.console import compiling, errors

    with compiling():
        from silverball.game.scores.verify_score import CountedGames, verify_score
    every = [(score, one.id) for one in store.lists() for score in store.scores(list_id=one.id, limit=-1)]
    numbers = {one.id for one in lists}
    seeds = {(score.seed, score.mode) for score, number in every if number in numbers}
    tried = sorted((one for one in every if (one[0].seed, one[0].mode) in seeds), key=better_first)
    tables = {number: store.table_text(number) for number in {number for _, number in tried}}
    counted = CountedGames()
    proofs: dict[int, ScoreVerdict] = {}
    try:
        with Progress(console=errors, transient=True, disable=not errors.is_terminal) as bar:
            for score, number in bar.track(tried, description="playing back"):
                text = store.replay(score.id) if score.has_replay else None
                proof = verify_score(score, text, tables[number], counted)
                if number in numbers:
                    proofs[score.id] = proof
                    if not proof.verified and not quiet:
                        who = f"score {score.id}, {score.score:,} by {name(score.initials)}"
                        typer.echo(f"{who}: not proven: {proof.why}")
    finally:
        store.mark({id: (proof.verified, proof.why) for id, proof in proofs.items()})
    if not quiet:
        proven = sum(proof.verified for proof in proofs.values())
        typer.echo(f"of {len(proofs)} scores {proven} are proven and {len(proofs) - proven} are not")
    return proofs


def better_first(one: tuple[Score, int]) -> tuple[int, int]:
    """The higher score first, of equal ones the earlier: of one game in two scores the better one counts."""
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
    """The best scores of a list with their places; what was proven just now counts, and not what is noted."""
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
    del values["damage"]  # it stands in `why`
    return {"place": place} | values


def print_list(
    one: ScoreList, rows: list[tuple[int, Score]], is_one_of_several: bool, is_verified: bool
) -> None:
    """A list as people like to read it; of several of one name the digests tell which is which."""
    from rich import box
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    from silverball.game.scores.verify_score import is_built_in

    words = [name(one.table_name), name(one.mode)]
    words += ["built-in"] * is_built_in(one.table_digest)
    words += [f"version {name(one.table_digest[:8])}"] * is_one_of_several
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
            str(place), f"{score.score:,}", name(score.initials), str(score.seed),
            score.played("%Y-%m-%d %H:%M"), proof_words(score, is_verified), str(score.id),
        )  # fmt: skip
        grid.add_row(*map(Text, cells), style="red" if score.is_rejected else None)
    Console().print(grid)
    if len(rows) < one.length:
        typer.echo(f"  and {one.length - len(rows)} more; --limit shows them")


def proof_words(score: Score, is_verified: bool) -> str:
    """What is said of the proof of a score: a note of an earlier trial is in the past tense."""
    if score.verified is None:
        return "not tried" if score.has_replay else "no replay"
    words = "proven" if score.verified else "not proven"
    return words if is_verified or score.damage else f"was {words}"


def name(text: str) -> str:
    """Text out of the file or from the command line, fit to be printed on a line."""
    return plain(text if len(text) <= NAME_LENGTH else f"{text[:NAME_LENGTH]}…")
