"""`silverball demo`: the program plays by itself, into a file."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from silverball.cli.output import file_name

if TYPE_CHECKING:
    from silverball.drawing import Renderer
    from silverball.drawing.film import Picture

TICK_RATE = 240
SECOND_BALL_AFTER = 3.0  # [s]
HEIGHTS = {".gif": 720, ".mp4": 1080, ".png": 1152}  # [pixel] if no size is asked for
GIF_LIMIT = 600_000_000  # pixels of all pictures together: a GIF is packed in memory, a byte or two for each


def demo(
    out: Path | None = typer.Option(
        None,
        parser=file_name,
        metavar="FILE",
        help="Ends in .gif, .mp4 or .png; demo.gif in this folder if not given.",
    ),
    seconds: float = typer.Option(20.0, min=0.1, max=600.0, help="Of play. A PNG shows the last moment."),
    table: str = typer.Option("classic", help="A built-in table or a table file."),
    seed: int = typer.Option(7, min=0, max=2**63 - 1, help="Of the board and of everything random on it."),
    size: int | None = typer.Option(None, min=100, max=4320, help="Height of the picture in pixels."),
    player: str = typer.Option("reflex", help="Who presses: idle, random, reflex, hold or planner."),
    force: bool = typer.Option(False, "--force", help="Overwrite a file that exists."),
) -> None:
    """Let the program play by itself and make a film of it; no display is needed.

    Example: `silverball demo --out demo.gif --seconds 20`
    """
    make_demo(out or free_name("demo.gif"), seconds, table, seed, size, player, force=force)


def make_demo(
    out: Path,
    seconds: float = 20.0,
    table: str = "classic",
    seed: int = 7,
    size: int | None = None,
    player: str = "reflex",
    *,
    force: bool = False,
) -> None:
    """Make a film, or a picture, of the program playing; say where it is."""
    from rich.progress import Progress

    from silverball.cli.console import compiling, errors
    from silverball.drawing import Renderer, best_size
    from silverball.drawing.film import FILM_RATES, check_output, write_film, write_picture
    from silverball.errors import OutputError
    from silverball.players import make_player, player_kind
    from silverball.table import generate_table, load_table

    check_output(out, (".gif", ".mp4", ".png"), force=force)
    ending = out.suffix.lower()
    board = load_table(table)
    board_seed = None if board.random is None else seed
    if board.random is not None:
        board = generate_table(seed, board)
    height = size or HEIGHTS[ending]
    width, height = best_size(board.board, height)
    if ending == ".gif" and width * height * seconds * FILM_RATES[ending] > GIF_LIMIT:
        raise OutputError(
            f"{out}: a GIF of {seconds:g} s at {width} × {height} pixels is too large to make; "
            "ask for fewer --seconds, a smaller --size, or an .mp4"
        )
    player_kind(player)
    with compiling("plan_worlds" if player == "planner" else "run_worlds"):
        from silverball.app.startup import warm_up
        from silverball.world import World

        warm_up(board)
        make_player(player).press(World(board))
    renderer = Renderer(board, (width, height), board_seed=board_seed)
    with Progress(console=errors, transient=True) as bar:
        task = bar.add_task(f"playing into {out.name}", total=seconds)

        def advance(done: float) -> None:
            bar.update(task, completed=done)

        if ending == ".png":
            write_picture(out, list(film(renderer, seed, seconds, 1.0 / seconds, player, advance))[-1])
        else:
            write_film(out, film(renderer, seed, seconds, FILM_RATES[ending], player, advance))
    typer.echo(f"wrote {out}")


def film(
    renderer: Renderer, seed: int, seconds: float, rate: float, player: str, advance: Callable[[float], None]
) -> Iterator[Picture]:
    """The pictures of the program playing, `rate` for every second of play."""
    from silverball.drawing import Moment
    from silverball.players import make_player
    from silverball.world import World

    world = World(renderer.table, seed, TICK_RATE)
    hand = make_player(player)
    for number in range(1, max(round(seconds * rate), 1) + 1):
        while world.tick < round(number * TICK_RATE / rate):
            wanted = 2 if world.time > SECOND_BALL_AFTER else 1
            if len(world.balls) < min(wanted, world.table.board.max_balls):
                world.create_ball()
            world.step(*hand.press(world))
            renderer.note(world.events, TICK_RATE)
        yield renderer.array(Moment.of(world))
        advance(number / rate)


def free_name(name: str) -> Path:
    """A name in this folder that no file has: demo.gif, or else demo-2.gif, demo-3.gif and so on."""
    path = Path(name)
    number = 1
    while path.exists():
        number += 1
        path = Path(name).with_stem(f"{Path(name).stem}-{number}")
    return path
