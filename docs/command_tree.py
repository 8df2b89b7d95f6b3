"""The commands as a Click command, which is what the page of the commands is made from."""

import typer

from silverball.cli.app import app

command = typer.main.get_command(app)
