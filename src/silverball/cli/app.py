"""Which commands are there, and how does a mistake end?

The modules of the commands import what they need when they run, so that `silverball --help` is quick.
"""

from __future__ import annotations

import sys

import typer

from silverball.cli.bench import bench
from silverball.cli.check import check
from silverball.cli.demo import demo
from silverball.cli.generate import generate
from silverball.cli.play import play
from silverball.cli.show import show
from silverball.cli.simulate import simulate
from silverball.cli.tables import tables
from silverball.errors import SilverballError

app = typer.Typer(
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
for command in (play, demo, tables, show, check, generate, simulate, bench):
    app.command()(command)


@app.callback(invoke_without_command=True)
def silverball(
    ctx: typer.Context,
    version: bool = typer.Option(False, "--version", help="Print the version and end."),
) -> None:
    """A pinball table: play it, build it, and run it a million times.

    Without a command, [bold]silverball[/bold] opens the window, or makes a demo file where there is no
    display.
    """
    if version:
        from silverball import __version__

        typer.echo(f"silverball {__version__}")
        raise typer.Exit
    if ctx.invoked_subcommand is None:
        from silverball.cli.play import play_or_demo

        play_or_demo()


def run(arguments: list[str]) -> None:
    """Run the command line; a mistake of a person ends with its message and exit code 2."""
    try:
        app(args=arguments, prog_name="silverball")
    except SilverballError as error:
        print(error, file=sys.stderr)
        sys.exit(2)
    except BrokenPipeError:  # the reader of our output has gone, as `head` does
        sys.stderr.close()
        sys.exit(0)
