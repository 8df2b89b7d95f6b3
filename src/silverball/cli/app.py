"""Which commands are there, and how does a mistake end?

Commands are named here with their help and loaded when they are called, so that `silverball --help` is quick.
"""

from __future__ import annotations

import sys
from importlib import import_module
from typing import Any

import click
import typer
from typer.core import TyperGroup

from silverball.errors import SilverballError

COMMANDS = ("play", "demo", "tables", "show", "check", "generate", "simulate", "bench")


class LazyGroup(TyperGroup):
    """A group whose commands are imported from `silverball.cli.<name>` when they are needed."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The names of the commands, in the order of the help page."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> Any:
        """The command of that name, or None."""
        if cmd_name not in COMMANDS:
            return None
        module = import_module(f"silverball.cli.{cmd_name}")
        single = typer.Typer(add_completion=False, rich_markup_mode="rich")
        single.command(cmd_name)(getattr(module, cmd_name))
        return typer.main.get_command(single)


app = typer.Typer(cls=LazyGroup, add_completion=False, rich_markup_mode="rich", invoke_without_command=True)


@app.callback()
def silverball(
    ctx: typer.Context,
    version: bool = typer.Option(False, "--version", help="Print the version and end."),
) -> None:
    """A pinball table: play it, build it, and run it a million times.

    Without a command, [bold]silverball[/bold] opens the window, or makes a demo file where there is no display.
    """
    if version:
        from silverball import __version__

        typer.echo(f"silverball {__version__}")
        raise typer.Exit
    if ctx.invoked_subcommand is None:
        from silverball.cli.play import play_or_demo

        play_or_demo()


def run(arguments: list[str]) -> int:
    """Run the command line and return the exit code: 0, 2 for a mistake of a person, 130 after Ctrl-C."""
    try:
        result = app(args=arguments, prog_name="silverball", standalone_mode=False)
    except SilverballError as error:
        print(error, file=sys.stderr)
        return 2
    except click.ClickException as error:
        error.show()
        return 2
    except (KeyboardInterrupt, click.Abort):
        print("stopped", file=sys.stderr)
        return 130
    except BrokenPipeError:
        sys.stderr.close()
        return 0
    return result if isinstance(result, int) else 0
