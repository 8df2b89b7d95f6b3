"""`silverball play`: opens the window; `silverball` alone does too, or films a demo without a display."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from silverball.app.cabinet_mode import CabinetMode
from silverball.cli.completion import complete_table
from silverball.cli.shared_options import LAST_SEED
from silverball.errors import NoDisplay
from silverball.game.view import Mode

if TYPE_CHECKING:
    from silverball.game.replay.format import Replay

DEMO_SECONDS = 20.0


def play(
    table: Annotated[
        str | None,
        typer.Option(
            help="Built-in table or table file. [default: the one chosen last]",
            autocompletion=complete_table,
        ),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(min=0, max=LAST_SEED, help="Seed of the first board. [default: random]"),
    ] = None,
    mode: Annotated[
        Mode | None,
        typer.Option(help="Start a game of this mode, arcade or free (the original). [default: the menu]"),
    ] = None,
    cabinet: Annotated[
        CabinetMode | None,
        typer.Option(
            help="The screen of a cabinet: upright, or the top of the table to its left or right; the "
            "backglass goes to a second screen. [default: as in the settings]"
        ),
    ] = None,
) -> None:
    """Play in a window: A and D move the paddles, Space selects and launches a ball, F1 shows all keys.

    Example: `silverball play --table random --seed 7 --mode free`
    """
    open_window(table, seed, mode, cabinet=cabinet)


def open_window(
    table: str | None = None,
    seed: int | None = None,
    mode: Mode | None = None,
    replay: Replay | None = None,
    cabinet: CabinetMode | None = None,
) -> None:
    """Open the window and play; a message in the terminal says when the physics is being compiled."""
    from silverball.app.startup import compiling_message
    from silverball.app.window import Window
    from silverball.cli.console import error_console

    status = error_console.status("compiling the physics…")

    def show_status() -> None:
        status.update(compiling_message())
        status.start()

    window = Window(
        table,
        seed,
        mode=mode,
        replay=replay,
        cabinet=cabinet,
        on_compile=show_status,
        on_ready=status.stop,
    )
    try:
        window.run()
    finally:
        status.stop()


def play_or_demo() -> None:
    """Open the window; without a display, print a message and film a demo instead."""
    try:
        open_window()
    except NoDisplay:
        from silverball.cli.demo import free_name, make_demo

        typer.echo(
            f"There is no display to open a window on; filming {DEMO_SECONDS:.0f} seconds of play instead "
            "(see `silverball demo --help`).",
            err=True,
        )
        # The planner plays better, but its compilation makes a first start 1.5 times as long.
        make_demo(free_name("demo.gif"), DEMO_SECONDS, player="reflex")
