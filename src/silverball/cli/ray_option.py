"""The option --ray: which Ray cluster does the work of a command."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from silverball.soak.campaign import RoundSource
    from silverball.studies.run import Runner

RayAddress = Annotated[
    str | None,
    typer.Option(
        "--ray",
        metavar="ADDRESS",
        help="Do the work on a Ray cluster: local, auto, HOST:PORT or ray://HOST:PORT; the same results.",
        show_default="without Ray",
    ),
]


def runner_at(address: str | None, players: Iterable[str]) -> Runner | None:
    """What plays the chunks of games; None: this process.

    Args:
        address: The value of --ray.
        players: The players of all chunks.

    Raises:
        MissingExtra: Ray is not installed.
        NoCluster: The address is none, or no cluster answers there.
    """
    if address is None:
        return None
    from silverball.studies.ray_cluster import require_cluster
    from silverball.studies.ray_runner import ray_runner

    require_cluster(address)
    return ray_runner(address, players)


def connected(address: str | None) -> AbstractContextManager[object]:
    """Hold a connection to the cluster, so that several works one after the other share it; None: nothing.

    Args:
        address: The value of --ray.
    """
    if address is None:
        return nullcontext()
    from silverball.studies.ray_cluster import cluster

    return cluster(address)


def rounds_at(address: str | None) -> RoundSource | None:
    """What plays the rounds of a soak; None: this process.

    Raises:
        MissingExtra: Ray is not installed.
        NoCluster: The address is none, or no cluster answers there.
    """
    if address is None:
        return None
    from silverball.studies.ray_cluster import require_cluster
    from silverball.studies.ray_runner import soak_rounds

    require_cluster(address)
    return soak_rounds(address)
