"""`silverball dataset`: episodes of a player as a data set for learning, in Minari's format."""

from __future__ import annotations

import json
import shlex
import tomllib
from pathlib import Path
from typing import Annotated, Any

import typer

from silverball.cli.console import compiling, print_json, print_lines, progress_bar
from silverball.cli.shared_options import LAST_SEED, AsJson, Force, PlayerName
from silverball.errors import SilverballError

MOST_EPISODES = 10_000_000


def dataset(
    environment: Annotated[
        str, typer.Argument(metavar="ID", help="Environment, for example silverball/PinballClassic-v0.")
    ] = "silverball/PinballClassic-v0",
    player: PlayerName = "reflex",
    episodes: Annotated[int, typer.Option(min=1, max=MOST_EPISODES, help="Episodes to record.")] = 100,
    seed: Annotated[
        int,
        typer.Option(
            min=0,
            max=LAST_SEED - MOST_EPISODES,
            help="Seed of the first episode; the others get the seeds after it.",
        ),
    ] = 0,
    option: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KEY=VALUE", help="An option of the environment, as often as needed: frame_skip=4."
        ),
    ] = None,
    name: Annotated[
        str | None,
        typer.Option(help="Its name in Minari.", show_default="silverball/ENVIRONMENT/PLAYER-v0"),
    ] = None,
    folder: Annotated[
        Path | None, typer.Option(help="Folder of data sets.", show_default="the one that Minari uses")
    ] = None,
    infos: Annotated[bool, typer.Option("--infos", help="Write the counts of events too.")] = False,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Record episodes of a player through an environment, as a data set that Minari loads.

    Its metadata holds the command, the versions and the digests of the tables and of the data: the same
    command gives the same data. It is written as a whole or not at all.

    Example: `silverball dataset silverball/PinballClassic-v0 --player planner --episodes 1000`
    """
    name = name or default_name(environment, player)
    options = parsed_options(option or [])
    with compiling("plan_worlds" if player == "planner" else "press_all"):
        from silverball.export.episodes import Recording
        from silverball.export.minari_dataset import checked_place, write_dataset

        place = checked_place(name, folder, force=force)
        recording = Recording(environment, options, player, seed)
    command = shlex.join(
        ["silverball", "dataset", environment, "--player", player, "--episodes", str(episodes),
         "--seed", str(seed), *(word for one in option or [] for word in ("--option", one)),
         *["--infos"] * infos, "--name", name]
    )  # fmt: skip
    with progress_bar() as bar:
        task = bar.add_task(f"recording {episodes:,} episodes", total=episodes)
        digest = write_dataset(
            recording, episodes, name, place, command, with_infos=infos,
            progress=lambda done: bar.update(task, completed=done),
        )  # fmt: skip
    report = read_report(place, name, digest)
    if as_json:
        print_json(report)
        return
    print_lines(
        f"{name}: {report['episodes']:,} episodes, {report['steps']:,} steps, {report['megabytes']:,.1f} MB; "
        f"digest {digest[:16]}",
        f"it is in {place}",
        "load it with:",
        *([f"    export MINARI_DATASETS_PATH={shlex.quote(str(folder.absolute()))}"] if folder else []),
        f"    import minari; data = minari.load_dataset({name!r})",
    )


def default_name(environment: str, player: str) -> str:
    """The name of a data set in Minari, in a folder for its environment."""
    return f"silverball/{environment.removeprefix('silverball/')}/{player}-v0"


def parsed_options(words: list[str]) -> dict[str, Any]:
    """Options of an environment from the command line: values are written as in a table file.

    Raises:
        SilverballError: A word has no `=`, or an option is given twice.
    """
    options: dict[str, Any] = {}
    for word in words:
        key, sign, text = word.partition("=")
        if not sign or not key:
            raise SilverballError(f"--option must be KEY=VALUE, for example frame_skip=4, got {word!r}")
        if key in options:
            raise SilverballError(f"--option {key} is given twice; give it once")
        options[key] = parsed_value(text)
    return options


def parsed_value(text: str) -> Any:
    """A value of TOML or JSON (None is written null), else the text itself."""
    try:
        return json.loads(text)
    except ValueError:
        pass
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except (tomllib.TOMLDecodeError, KeyError):
        return text


def read_report(place: Path, name: str, digest: str) -> dict[str, Any]:
    """What Minari's reader says about the data set."""
    from minari import MinariDataset

    data: Any = MinariDataset(place / "data")
    size = sum(file.stat().st_size for file in (place / "data").iterdir())
    return {
        "name": name, "folder": str(place), "episodes": int(data.total_episodes),
        "steps": int(data.total_steps), "megabytes": size / 1e6, "digest": digest,
    }  # fmt: skip
