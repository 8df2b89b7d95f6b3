"""The commands of `silverball`; an error prints one message and exits with code 2, without a traceback.

The modules of the commands import what they need when they run, so that `silverball --help` is quick.
"""

from __future__ import annotations

import functools
import sys
from typing import Any

import typer
import typer.main

from silverball.cli import bench_agents  # noqa: F401  (adds commands to bench)
from silverball.cli.ball_time import ball_time
from silverball.cli.bench import bench
from silverball.cli.cache import cache
from silverball.cli.check import check
from silverball.cli.dataset import dataset
from silverball.cli.demo import demo
from silverball.cli.design import design
from silverball.cli.feel import feel
from silverball.cli.generate import generate
from silverball.cli.info import info
from silverball.cli.marks import marks
from silverball.cli.page import page
from silverball.cli.play import play
from silverball.cli.replay import replay
from silverball.cli.scores import scores
from silverball.cli.show import show
from silverball.cli.signals import STOPPED, stopped
from silverball.cli.simulate import simulate
from silverball.cli.soak import soak
from silverball.cli.streams import discard_output, is_broken_pipe
from silverball.cli.study import study
from silverball.cli.tables import tables
from silverball.errors import SilverballError
from silverball.plain import plain

MAX_LINE_LENGTH = 1000  # of a message, which may quote a longer argument
RENAMED = {  # options of version 0.1 that are now commands
    "simulate": {"--soak": "soak", "--feel": "feel", "--ball-time": "ball-time"},
    "bench": {f"--{name}": f"bench {name}" for name in ("marks", "drawing", "envs", "peers")},
}

app = typer.Typer(
    rich_markup_mode="markdown",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
for command in (
    play, replay, page, scores, demo, tables, show, check, generate, simulate, study, ball_time, feel, marks,
    soak, design, dataset, info, cache,
):  # fmt: skip
    app.command()(command)
app.add_typer(bench, name="bench")


@app.callback(invoke_without_command=True)
def silverball(
    ctx: typer.Context,
    version: bool = typer.Option(False, "--version", help="Print the version and exit."),
) -> None:
    """A pinball table: play it, build it, and run it a million times.

    Without a command, `silverball` opens the window, or films a demo where there is no display.
    """
    if version:
        from silverball import __version__

        typer.echo(f"silverball {__version__}")
        raise typer.Exit
    if ctx.invoked_subcommand is None:
        from silverball.cli.play import play_or_demo

        play_or_demo()


@functools.cache
def main_command() -> Any:
    """The click command behind `app`, built once; Typer would build it again for every call."""
    return typer.main.get_command(app)


def run(arguments: list[str]) -> int:
    """Run the command line and return the exit code.

    0: success, or the reader of the output closed it. 1: a negative result, for example a finding of a soak.
    2: wrong arguments, a file or stream that cannot be read or written, or not enough memory, with a message.
    130: stopped by Ctrl-C.
    """
    try:
        code = main_command().main(arguments, prog_name="silverball", standalone_mode=False)
        sys.stdout.flush()
    except SilverballError as error:
        return print_error(str(error))
    except KeyboardInterrupt:
        code = STOPPED
    except typer.Abort as end:
        if isinstance(end.__cause__, EOFError):  # no command reads input, so this is not Ctrl-D
            raise end.__cause__ from None
        code = STOPPED
    except (BrokenPipeError, SystemExit) as error:
        if not is_broken_pipe(error):
            raise
        discard_output(sys.stdout)
        discard_output(sys.stderr)
        return 0
    except OSError as error:
        discard_output(sys.stdout)
        where = f"{error.filename}: " if error.filename else ""
        return print_error(f"silverball: {where}{error.strerror or error}")
    except MemoryError:
        return print_error("silverball: out of memory; use smaller values")
    except Exception as error:
        if not hasattr(error, "format_message"):
            raise
        return print_error(usage_message(error, arguments))
    if code == STOPPED:
        return stopped()
    return code if isinstance(code, int) else 0


def print_error(message: str) -> int:
    """Print an error message, with control characters escaped; returns its exit code."""
    try:
        print("\n".join(map(shortened, plain(message, keep="\n").split("\n"))), file=sys.stderr)
        sys.stderr.flush()
    except OSError:
        discard_output(sys.stderr)
    return 2


def shortened(line: str) -> str:
    """The line, without its middle if it is longer than `MAX_LINE_LENGTH`."""
    if len(line) <= MAX_LINE_LENGTH:
        return line
    return f"{line[: MAX_LINE_LENGTH // 2]} … {line[-MAX_LINE_LENGTH // 2 :]}"


def usage_message(error: Any, arguments: list[str]) -> str:
    """One sentence about wrong arguments: where, what was expected, what was got, and the help to read."""
    context = error.ctx
    name = context.command_path if context is not None else "silverball"
    new = new_spelling(arguments)
    if new is not None:
        return f"{name}: this is now a separate command, `silverball {new}`. See `silverball {new} --help`"
    message = error.format_message().rstrip(".")
    given = given_value(getattr(error, "param", None), arguments)
    commands = getattr(context and context.command, "commands", None)
    if given is not None:
        message += f", got {given!r}"
    elif commands and message.endswith(("command", "'")):
        message += f"; the commands are {', '.join(commands)}"
    return f"{name}: {message}{'' if message.endswith('?') else '.'} See `{name} --help`"


def new_spelling(arguments: list[str]) -> str | None:
    """The command that replaces these arguments of version 0.1; None if they are not from version 0.1."""
    command, *options = arguments or [""]
    for option in options:
        if option in RENAMED.get(command, ()):
            return RENAMED[command][option]
    if command == "bench" and options and options[0].startswith("-"):
        return "bench step"
    return None


def given_value(parameter: Any, arguments: list[str]) -> str | None:
    """The text that was given for an option; None if it was not given."""
    for option in getattr(parameter, "opts", ()):
        for index, word in enumerate(arguments):
            if word == option and index + 1 < len(arguments):
                return arguments[index + 1]
            if word.startswith(f"{option}="):
                return word.split("=", 1)[1]
    return None
