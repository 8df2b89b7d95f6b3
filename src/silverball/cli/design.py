"""`silverball design`: tables that play as wished, found by search."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from silverball.cli.completion import complete_player, complete_table
from silverball.cli.console import compiling, print_json, print_lines, progress_bar
from silverball.cli.feel import finite, interval
from silverball.cli.ray_option import RayAddress, connected, runner_at
from silverball.cli.shared_options import LAST_SEED, AsJson, Force
from silverball.cli.study import command
from silverball.errors import OutputError, SilverballError
from silverball.plain import plain
from silverball.studies.figure_words import ROWS

if TYPE_CHECKING:
    from silverball.studies.design import Judged, Tried, Wish
    from silverball.studies.goals import Target
    from silverball.studies.run import Runner

PICTURE_HEIGHT = 480  # [pixels]


def design(
    table: Annotated[
        str, typer.Argument(help="Built-in table, table file or recipe.", autocompletion=complete_table)
    ] = "classic",
    target: Annotated[
        list[str] | None,
        typer.Option(
            metavar="FIGURE=VALUE±DISTANCE",
            help="What has to be reached, for example ball_time=30±2; may be given several times.",
            show_default=False,
        ),
    ] = None,
    player: Annotated[
        str, typer.Option(help="A player, or beginner.", autocompletion=complete_player)
    ] = "beginner",
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="PATH=LEAST:GREATEST",
            help="A number of the table that may be changed; may be given several times.",
            show_default="gravity and paddles; of a recipe also how many obstacles there are",
        ),
    ] = None,
    games: Annotated[int, typer.Option(min=10, max=100_000, help="Games of each table of the search.")] = 200,
    tried: Annotated[
        int, typer.Option("--tables", min=10, max=100_000, help="Tables that are tried at most.")
    ] = 150,
    seed: Annotated[
        int, typer.Option(min=0, max=LAST_SEED // 2, help="Seed of the search and of the games.")
    ] = 0,
    out: Annotated[
        Path | None,
        typer.Option(metavar="FOLDER", help="Where the tables go. [default: design-… in this folder]"),
    ] = None,
    ray: RayAddress = None,
    pictures: Annotated[bool, typer.Option(help="Whether each table is drawn.")] = True,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Search for tables that play as wished; the ten best become table files with pictures.

    What is found is judged by games of other seeds than those of the search, in three sets. A table that
    `check` refuses is never among them.

    Exit codes: 0 reached, 1 not reached with these numbers.

    Example: `silverball design classic --target "ball_time=20±2" --vary paddle.length=1.8:2.3`
    """
    wish = make_wish(table, target or [], player, vary or [], games, tried, seed)
    folder = out or Path(f"design-{folder_name(table, target or [])}")
    check_folder(folder, force=force)
    runner = runner_at(ray, [player])
    with connected(ray):  # one connection for all tables
        found, count = look(wish, runner)
    report = write_tables(wish, found, folder, pictures) | {"tried": count, "folder": str(folder)}
    if as_json:
        print_json(report)
    else:
        print_found(wish, found, count, folder)
    raise typer.Exit(0 if report["reached"] else 1)


def make_wish(
    table: str, targets: list[str], player: str, ranges: list[str], games: int, tables: int, seed: int
) -> Wish:
    """What is looked for; everything is checked before the first game.

    Raises:
        SilverballError: Something cannot be used.
    """
    from silverball.players.registry import check_name
    from silverball.studies.design import Wish, check_range, require_cmaes
    from silverball.studies.goals import figure_names, parse_range, parse_target, usual_ranges
    from silverball.table import load_table

    if not targets:
        names = ", ".join(figure_names())
        raise SilverballError(
            f"silverball design: give a --target, for example ball_time=30±2; the figures are {names}"
        )
    wanted = tuple(map(parse_target, targets))
    check_name(player, others=("beginner",))
    require_cmaes()
    loaded = load_table(table)
    varied = [parse_range(text, loaded) for text in ranges] or usual_ranges(loaded)
    if len({one.path for one in varied}) < len(varied):
        raise SilverballError("silverball design: each number once in --vary")
    for one in varied:
        check_range(loaded, one)
    return Wish(loaded, player, wanted, tuple(varied), games, tables, seed)


def folder_name(table: str, targets: list[str]) -> str:
    """The default name of the folder."""
    import re

    words = "-".join([Path(table).stem, *targets])
    return re.sub(r"[^a-z0-9]+", "-", words.lower()).strip("-")[:60]


def check_folder(folder: Path, *, force: bool) -> None:
    """Make the folder, before a minute of work is lost.

    Raises:
        OutputError: It cannot be made, or holds something.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        is_used = any(folder.iterdir())
    except OSError as error:
        raise OutputError(
            f"{folder}: cannot be used ({error.strerror or error}); give another --out"
        ) from None
    if is_used and not force:
        raise OutputError(f"{folder}: this folder is not empty; give another --out, or --force")


def look(wish: Wish, runner: Runner | None) -> tuple[list[Judged], int]:
    """Search, with the best so far, then judge; returns the best tables and how many were tried.

    Ctrl-C ends the search; what it has found until then is judged.
    """
    with compiling("watch_games", "half a minute"):
        from silverball.studies.design import judge, search
        from silverball.studies.run import play_here
        from silverball.studies.study_plan import Arm, Plan

        list(play_here(Plan((Arm("", wish.table, wish.player),), 2, longest=1.0).chunks()))
    tried: list[Tried] = []
    with progress_bar() as bar:
        task = bar.add_task("searching", total=wish.tables)

        def progress(one: Tried) -> None:
            tried.append(one)
            bar.update(task, completed=len(tried), description=best_so_far(tried, wish.targets))

        try:
            search(wish, runner or play_here, progress)
        except KeyboardInterrupt:
            print_lines("stopped; what has been found so far is judged (Ctrl-C again: not)", err=True)
        task = bar.add_task("judging the best by games of other seeds", total=None)
        return judge(wish, tried, runner or play_here), len(tried)


def best_so_far(tried: Sequence[Tried], targets: Sequence[Target]) -> str:
    """The best table so far, in a few words."""
    best = min(tried, key=lambda one: one.miss)
    if best.table is None:
        return "searching"
    words = ", ".join(f"{one.name} {best.figures[one.figure].value:.3g}" for one in targets)
    return f"best so far: {words} (table {best.number})"


def write_tables(wish: Wish, found: Sequence[Judged], folder: Path, pictures: bool) -> dict[str, Any]:
    """Write the tables and what is known of them; returns that as JSON."""
    from silverball import __version__
    from silverball.physics import PHYSICS_VERSION
    from silverball.studies.result_folder import write_text
    from silverball.table import save_table, table_digest

    rows = []
    with progress_bar() as bar:
        for number, one in enumerate(bar.track(found, description="drawing"), 1):
            assert one.tried.table is not None
            board = one.tried.table.replace(name=f"{wish.table.name} {number}"[:60])
            path = folder / f"{number:02}.toml"
            save_table(board, path)
            if pictures:
                draw(board, path.with_suffix(".png"))
            rows.append({
                "file": path.name,
                "digest": table_digest(board),
                "changes": dict(one.tried.values),
                "reached": one.reaches(wish.targets),
                "figures": {name: list(map(finite, figure)) for name, figure in one.together.items()},
            })  # fmt: skip
    report = {
        "command": command(),
        "version": __version__,
        "physics": PHYSICS_VERSION,
        "table": table_digest(wish.table),
        "player": wish.player,
        "targets": [str(one) for one in wish.targets],
        "ranges": {one.path: [one.low, one.high] for one in wish.ranges},
        "games": wish.games,
        "seed": wish.seed,
        "reached": bool(rows and rows[0]["reached"]),
        "tables": rows,
    }
    write_text(folder / "design.json", json.dumps(report, indent=1) + "\n")
    return report


def draw(board: Any, path: Path) -> None:
    """Draw a table, of a recipe its first board."""
    from silverball.drawing import Moment, Renderer, best_size
    from silverball.export.film import write_picture
    from silverball.table import generate_table

    seed = None if board.random is None else 0
    shown = board if seed is None else generate_table(seed, board)
    renderer = Renderer(shown, best_size(shown.board, PICTURE_HEIGHT), board_seed=seed)
    picture = renderer.array(Moment.before(shown))
    renderer.close()
    write_picture(path, picture)


def print_found(wish: Wish, found: Sequence[Judged], count: int, folder: Path) -> None:
    """Print the tables, the best first, and whether the target is reached."""
    for number, one in enumerate(found, 1):
        numbers = ", ".join(f"{path}={value:g}" for path, value in one.tried.values)
        print_lines(f"{number:02}.toml  {figures_of(one, wish.targets)}  with {numbers}")
    shown, wanted = plain(str(folder)), ", ".join(map(str, wish.targets))
    if not found:
        print_lines(f"none of {count:,} tables in these ranges can be played; give other ranges with --vary")
    elif found[0].reaches(wish.targets):
        print_lines(f"{wanted} is reached, also in games of other seeds; the tables are in {shown}")
    else:
        print_lines(
            f"no table in these ranges reaches {wanted}: the nearest of {count:,} has "
            f"{figures_of(found[0], wish.targets)}; widen --vary, or wish for something else "
            f"(what was found is in {shown})"
        )


def figures_of(one: Judged, targets: Sequence[Target]) -> str:
    """The figures that targets name, with their intervals."""
    words = []
    for target in targets:
        figure = one.together[target.figure]
        form = ROWS[target.figure][1]
        words.append(f"{target.name} {interval(list(map(finite, figure)), form)}")
    return ", ".join(words)
