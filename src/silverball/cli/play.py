"""`silverball play`: the window. And what bare `silverball` does."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from silverball.errors import NoDisplay
from silverball.game.view import Mode

if TYPE_CHECKING:
    from silverball.game.replay.format import Replay

DEMO_SECONDS = 20.0


def play(
    table: str | None = typer.Option(
        None, help="A built-in table or a table file; that of the game if not given: the one chosen last."
    ),
    seed: int | None = typer.Option(
        None, min=0, max=2**63 - 1, help="Of the first board; drawn if not given."
    ),
    mode: Mode | None = typer.Option(
        None, help="Begin this game at once: arcade, or free for the original. Without, the menu comes first."
    ),
) -> None:
    """Play in a window: A and D move the paddles, Space chooses and brings a ball, F1 shows all keys.

    Example: `silverball play --table random --seed 7 --mode free`
    """
    open_window(table, seed, mode)


def open_window(
    table: str | None = None,
    seed: int | None = None,
    mode: Mode | None = None,
    replay: Replay | None = None,
) -> None:
    """Open the window and play, telling the terminal while the physics is being compiled."""
    from silverball.app.startup import compiling_message
    from silverball.app.window import Window
    from silverball.cli.console import errors

    status = errors.status("compiling the physics…")

    def tell() -> None:
        status.update(compiling_message())
        status.start()

    window = Window(table, seed, mode=mode, replay=replay, on_compile=tell, on_ready=status.stop)
    try:
        window.run()
    finally:
        status.stop()


def play_or_demo() -> None:
    """Play where there is a display; where there is none, say so and make a demo file instead."""
    try:
        open_window()
    except NoDisplay:
        from silverball.cli.demo import free_name, make_demo

        typer.echo(
            f"There is no display to open a window on; making a film of {DEMO_SECONDS:.0f} seconds of play "
            "instead (`silverball demo --help` tells more).",
            err=True,
        )
        # The planner would play better, but compiling it makes a first start half as long again.
        make_demo(free_name("demo.gif"), DEMO_SECONDS, player="reflex")
