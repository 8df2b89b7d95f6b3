"""`silverball bench blind` and `silverball bench agents`: what is made on the ids of the benchmark."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from silverball.cli.bench import bench, output_path
from silverball.cli.console import error_console, print_json, print_lines, progress_bar
from silverball.cli.shared_options import AsJson
from silverball.errors import SilverballError

if TYPE_CHECKING:
    from silverball.benchmarks.agents.trials import Entrant
    from silverball.metrics.statistics import Estimate

Id = Annotated[str, typer.Argument(metavar="ID", help="An environment, as silverball/PinballClassic-v1.")]
CsvFile = Annotated[str | None, typer.Option("--out", metavar="FILE.csv", help="CSV file to write.")]


@bench.command()
def blind(
    id_: Id = "silverball/PinballClassic-v1",
    balls: Annotated[
        int, typer.Option(min=2, max=1000, help="Balls of each of the 200 rhythms, on training boards.")
    ] = 200,
    finals: Annotated[
        int, typer.Option(min=2, max=1000, help="Balls of the ten best, on test boards with other seeds.")
    ] = 1000,
    out: CsvFile = None,
    as_json: AsJson = False,
) -> None:
    """Measure what can be made without looking: the best of 200 rhythms beside random presses (2 minutes).

    Example: `silverball bench blind silverball/PinballClassic-v1 --out blind.csv`
    """
    path = None if out is None else output_path(out, (".csv",))
    check_id(id_)
    from silverball.benchmarks.agents import rhythms

    with progress_bar() as bar:
        task = bar.add_task("compiling …", total=None)
        found = rhythms.search_rhythms(id_, balls, finals, lambda doing: bar.update(task, description=doing))
    best, share = rhythms.best_rhythm(found), rhythms.blind_share(found)
    if path is not None:
        written(path, lambda temporary: rhythms.write_csv(temporary, id_, found))
    if as_json:
        print_json({"id": id_, "rhythm": str(best.rhythm), "points": best.points, "of_random": share})
        return
    for one in found:
        if one.is_final:
            name = "random presses" if one.rhythm is None else str(one.rhythm)
            print_lines(f"{name:28} {one.points.value:8,.0f} points a ball ({_range(one.points, 0)})")
    print_lines(
        f"the best rhythm makes {share.value:.2f} ({_range(share, 2)}) times what random presses make"
    )


@bench.command()
def agents(
    id_: Id = "silverball/PinballClassic-v1",
    player: Annotated[
        list[str],
        typer.Option(help="Who plays; may be repeated. [default: all but the planner, which takes an hour]"),
    ] = [],  # noqa: B006  (typer copies it)
    policy: Annotated[
        list[Path],
        typer.Option(
            metavar="FILE.npz",
            help="A policy by examples/train_benchmark.py or train_sb3_benchmark.py; may be repeated.",
        ),
    ] = [],  # noqa: B006
    balls: Annotated[int, typer.Option(min=2, max=1000, help="Test boards, with a ball on each.")] = 1000,
    out: CsvFile = None,
    as_json: AsJson = False,
) -> None:
    """Measure what players and trained policies make on the test boards of an environment.

    Policies that were trained alike are trainings of one contestant, and see what they saw in the training,
    as pictures of some size. The score is 0 for `blind` and 1 for `planner`.

    Example: `silverball bench agents --player blind --player reflex --policy ppo.npz --out results.csv`
    """
    path = None if out is None else output_path(out, (".csv",))
    check_id(id_)
    from silverball.benchmarks.agents import results_table

    entrants = chosen_entrants(player, policy)
    with progress_bar() as bar:
        task = bar.add_task("compiling …", total=None)
        trials = results_table.play_all(
            id_, entrants, balls, lambda doing: bar.update(task, description=doing)
        )
    if path is not None:
        written(path, lambda temporary: results_table.write_csv(temporary, id_, trials))
    results = results_table.summarise(trials)
    if as_json:
        print_json([one._asdict() for one in results])
    else:
        print_lines(*results_table.markdown(results).splitlines())


def chosen_entrants(players: list[str], policies: list[Path]) -> dict[str, list[Entrant]]:
    """The contestants of these names, and those that these policies are trainings of.

    Raises:
        SilverballError: There is no such contestant, a file is no policy, or it has the name of a player.
    """
    from silverball.benchmarks.agents.contestants import CONTESTANTS
    from silverball.benchmarks.agents.stored_policies import StoredPolicy

    names = players or [name for name in CONTESTANTS if name != "planner"]
    for name in names:
        if name not in CONTESTANTS:
            raise SilverballError(f"--player {name}: expected one of {', '.join(CONTESTANTS)}")
    entrants: dict[str, list[Any]] = {name: [CONTESTANTS[name]] for name in names}
    for path in policies:
        stored = StoredPolicy(path)
        if stored.contestant in CONTESTANTS:
            raise SilverballError(f"{path} calls itself {stored.contestant!r}, which is the name of a player")
        entrants.setdefault(stored.contestant, []).append(stored)
    return entrants


def check_id(id_: str) -> None:
    """Refuse an environment that is not registered.

    Raises:
        SilverballError: It is not.
    """
    from silverball.envs import IDS

    if id_ not in IDS:
        raise SilverballError(f"{id_}: expected one of {', '.join(IDS)}")


def written(path: Path, write: Callable[[Path], object]) -> None:
    """Write a whole file and say so."""
    from silverball.wholefile import write_whole

    write_whole(path, write)
    error_console.print(f"wrote {path}")


def _range(one: Estimate, digits: int) -> str:
    """The interval of an estimate."""
    return f"{one.low:,.{digits}f}–{one.high:,.{digits}f}"
