"""The command line, `silverball <command>`: a thin layer with one file for each command.

A command turns its arguments into calls of the library and prints the result. `app` registers the commands
and reports errors, `shared_options` and `console` have options and output that several commands use,
`signals` and `streams` handle Ctrl-C and closed standard streams.
"""

from __future__ import annotations

import sys

from silverball.cli.signals import run_until_stopped


def main() -> None:
    """Run `silverball` or `python -m silverball`."""
    run_until_stopped(_run)


def _run() -> int:
    from silverball.cli.streams import prepare

    prepare()
    from silverball.cli.app import run

    return run(sys.argv[1:])
