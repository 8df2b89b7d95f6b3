"""Which options did a person type? The others have their defaults."""

from __future__ import annotations

import typer


def given_by(ctx: typer.Context) -> set[str]:
    """The names of the parameters that were given on the command line."""
    sources = {name: ctx.get_parameter_source(name) for name in ctx.params}
    # By its name: the text of a source is another one in every version of click.
    return {name for name, source in sources.items() if source is not None and source.name == "COMMANDLINE"}
