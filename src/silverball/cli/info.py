"""`silverball info`: prints versions, folders and caches, as a bug report needs them.

Nothing is compiled, created or changed. A part that cannot be found out says why; the others are printed.
"""

from __future__ import annotations

import os
import platform
from collections.abc import Callable, Iterator
from importlib import metadata
from pathlib import Path
from typing import Any

from silverball.cli.cache import cache_base, file_count_text, find_files, megabytes, shortened, sizes_json
from silverball.cli.console import print_json, print_table
from silverball.cli.shared_options import AsJson
from silverball.plain import plain

REQUIRED = (
    "numpy", "numba", "llvmlite", "pygame-ce", "pillow", "pydantic", "rich", "typer", "platformdirs",
    "tomli-w",
)  # fmt: skip
OPTIONAL = (
    "av", "gymnasium", "stable-baselines3", "pufferlib", "pymunk", "pyb2d3", "box2d", "mpmath", "matplotlib",
)  # fmt: skip
FOLDER_VARIABLES = ("SILVERBALL_DATA", "SILVERBALL_CACHE")
VARIABLES = ("SILVERBALL_", "NUMBA_", "SDL_", "DISPLAY", "WAYLAND_DISPLAY")  # beginnings of names
LAST_KERNEL_OF_ENVIRONMENTS = "run_task"  # it contains all the others


def info(as_json: AsJson = False) -> None:
    """Show versions, folders, caches and the display, for a bug report.

    Example: `silverball info --json`
    """
    report = {name: collect(part) for name, part in PARTS.items()}
    if as_json:
        print_json(report)
    else:
        print_report(report)


def collect(part: Callable[[], dict[str, Any]]) -> dict[str, Any]:
    """A part of the report; if a package or a folder is broken, in whatever way, the problem in its place."""
    try:
        return part()
    except Exception as error:
        return {"problem": f"{type(error).__name__}: {error}"}


def variables() -> dict[str, str | None]:
    """The environment variables that matter; None for one of Silverball's that is not set."""
    given = {name: value for name, value in sorted(os.environ.items()) if name.startswith(VARIABLES)}
    return {name: os.environ.get(name) for name in FOLDER_VARIABLES} | given


def versions() -> dict[str, str | int | None]:
    """The versions of Silverball, Python and the packages that are needed; None: not found."""
    from silverball import __version__
    from silverball.game.rules import RULES_VERSION
    from silverball.physics import PHYSICS_VERSION

    return {
        "silverball": __version__,
        "physics": PHYSICS_VERSION,
        "rules": RULES_VERSION,
        "python": platform.python_version(),
        "system": platform.platform(),
        **{name: version_of(name) for name in REQUIRED},
    }


def optional_packages() -> dict[str, str | None]:
    """The versions of the packages that are not always needed; None: not installed."""
    return {name: version_of(name) for name in OPTIONAL}


def version_of(package: str) -> str | None:
    """The version of an installed package; None if it is not installed."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


def machine() -> dict[str, Any]:
    """The processor as the compiler knows it, and its cores."""
    import llvmlite.binding

    available = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return {
        "architecture": platform.machine(),
        "processor": llvmlite.binding.get_host_cpu_name(),
        "cores": os.cpu_count(),
        "available_cores": available,
    }


def folders() -> dict[str, dict[str, str]]:
    """The folders of the user, and what can be done in them."""
    from silverball.game.user_folder import TABLES, data_folder

    paths = {"data": data_folder(), "tables": data_folder() / TABLES, "cache": cache_base()}
    return {name: {"path": str(path), "state": folder_state(path)} for name, path in paths.items()}


def folder_state(path: Path) -> str:
    """Whether a folder can be read and written, in words."""
    if os.path.isdir(path):
        can_read, can_write = os.access(path, os.R_OK | os.X_OK), os.access(path, os.W_OK | os.X_OK)
        if can_read and can_write:
            return "writable"
        return "read-only" if can_read else "cannot be read"
    if os.path.lexists(path):
        return "not a folder"
    return "does not exist yet" if can_create(path) else "does not exist and cannot be created"


def can_create(path: Path) -> bool:
    """Whether a folder that does not exist can be made in the nearest folder that does."""
    for parent in path.absolute().parents:
        try:
            os.lstat(parent)
        except FileNotFoundError:
            continue
        except OSError:
            return False
        return os.path.isdir(parent) and os.access(parent, os.W_OK | os.X_OK)
    return False


def caches() -> dict[str, Any]:
    """The sizes of the caches, and what cannot be read."""
    listing = find_files(cache_base())
    return {"sizes": sizes_json(listing), "problems": listing.problems}


def compiled() -> dict[str, bool]:
    """What is compiled for this version on this machine, and intact."""
    from silverball.drawing.background import LAST_KERNEL
    from silverball.physics.code_cache import find_code
    from silverball.physics.kernel import AGENTS, DRAWING, PLAY, code_folder

    kernels = {
        "play": ("step_single_world", PLAY),
        "planner": ("plan_worlds", PLAY),
        "drawing": (LAST_KERNEL, DRAWING),
        "environments": (LAST_KERNEL_OF_ENVIRONMENTS, AGENTS),
    }
    return {
        name: bool(find_code(code_folder(packages), kernel)) for name, (kernel, packages) in kernels.items()
    }


def display() -> dict[str, str | None]:
    """The version of SDL, and its driver for windows; None: there is no display, with the problem."""
    import silverball.drawing  # hides pygame's greeting  # noqa: F401, I001
    import pygame

    from silverball.errors import NoDisplay
    from silverball.video_driver import open_video

    driver, problem = None, None
    was_open = pygame.display.get_init()
    try:
        if not was_open:
            open_video("`silverball` films a demo instead")
        driver = pygame.display.get_driver()
    except NoDisplay as error:
        problem = str(error)
    finally:
        if not was_open:
            pygame.display.quit()
    return {"sdl": ".".join(map(str, pygame.get_sdl_version())), "driver": driver, "problem": problem}


PARTS: dict[str, Callable[[], dict[str, Any]]] = {
    "variables": variables,  # the first: others set variables of SDL
    "versions": versions,
    "optional_packages": optional_packages,
    "machine": machine,
    "folders": folders,
    "compiled": compiled,
    "caches": caches,
    "display": display,
}


def print_report(report: dict[str, Any]) -> None:
    """Print the report, one line for each fact."""
    from rich.table import Table
    from rich.text import Text

    table = Table.grid(padding=(0, 2))
    table.add_column(no_wrap=True)
    table.add_column(overflow="fold")
    for name, value in rows(report):
        table.add_row(Text(name), Text(plain(value)))
    print_table(table)


def rows(report: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """The lines of the report: names and values."""
    for name, part in report.items():
        problem = part.get("problem")
        if problem is not None and name != "display":
            yield name.replace("_", " "), problem
        else:
            yield from ROWS[name](part)


def variable_rows(part: dict[str, str | None]) -> Iterator[tuple[str, str]]:
    """The environment variables, one per line."""
    for name, value in part.items():
        yield name, "not set" if value is None else repr(value)


def version_rows(part: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """The versions of Silverball and Python, then all packages."""
    own = f"{part['silverball']}, physics {part['physics']}, rules {part['rules']}"
    yield "silverball", own
    yield "python", f"{part['python']}, {part['system']}"
    yield "packages", ", ".join(f"{name} {part[name] or 'not found'}" for name in REQUIRED)


def optional_rows(part: dict[str, str | None]) -> Iterator[tuple[str, str]]:
    """The optional packages, those that are installed first."""
    installed = [f"{name} {version}" for name, version in part.items() if version is not None]
    missing = [name for name, version in part.items() if version is None]
    yield "optional packages", ", ".join(installed) or "none"
    if missing:
        yield "not installed", ", ".join(missing)


def machine_rows(part: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """The processor and its cores."""
    cores = f"{part['available_cores']} of {part['cores']} cores"
    yield "processor", f"{part['architecture']}, {part['processor']}, {cores}"


def folder_rows(part: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """The folders and what can be done in them."""
    for name, folder in part.items():
        yield f"{name} folder", f"{folder['path']} ({folder['state']})"


def compiled_rows(part: dict[str, bool]) -> Iterator[tuple[str, str]]:
    """What is compiled."""
    yield "compiled", ", ".join(f"{name}: {'yes' if is_there else 'no'}" for name, is_there in part.items())


def cache_rows(part: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """The sizes of the caches, and what cannot be read."""
    for name, size in part["sizes"].items():
        yield (
            f"cache: {name.replace('_', ' ')}",
            f"{file_count_text(size['files'])}, {megabytes(size['bytes'])}",
        )
    for problem in shortened(part["problems"]):
        yield "cache", problem


def display_rows(part: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """The driver of windows, or why there is none."""
    if "sdl" not in part:
        yield "display", part["problem"]
    else:
        yield "display", f"{part['driver'] or 'none'} (SDL {part['sdl']})"
        if part["problem"]:
            yield "", part["problem"]


ROWS: dict[str, Callable[[dict[str, Any]], Iterator[tuple[str, str]]]] = {
    "variables": variable_rows,
    "versions": version_rows,
    "optional_packages": optional_rows,
    "machine": machine_rows,
    "folders": folder_rows,
    "compiled": compiled_rows,
    "caches": cache_rows,
    "display": display_rows,
}
