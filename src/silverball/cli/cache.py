"""`silverball cache`: shows how large the caches are, and clears them.

Only files that Silverball made are counted and removed, recognised by their place and name:

    CACHE/compiled/HASH/PACKAGE/*.nbi, *.nbc     compiled code, a HASH for each version of the sources
    CACHE/pictures/KEY.picture                   baked pictures

and their temporary files. Links are not followed. Running programs are not affected: code that they have
loaded stays in memory, and what they miss they compile or bake again.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from silverball.cli.console import print_json, print_lines, print_table
from silverball.cli.shared_options import AsJson
from silverball.errors import OutputError

if TYPE_CHECKING:
    from rich.table import Table as RichTable

OTHER = "other versions"
PICTURES = "pictures"
KINDS = {
    "play": "compiled code: physics and players",
    "study": "compiled code: feel, marks, ball-time, soak",
    "environments": "compiled code: environments for agents",
    "drawing": "compiled code: drawing",
    OTHER: "compiled code of other versions",
    PICTURES: "baked pictures of tables",
}
VERSION_FOLDER = re.compile("[0-9a-f]{16}")
PACKAGE_FOLDER = re.compile("[a-z_.]+")
CODE_FILE = re.compile(r".+\.nb[ic]|\.[0-9a-f]{16}\.tmp")
PICTURE_FILE = re.compile(r"[0-9a-f]{32}\.picture|\.silverball-[0-9a-f]{16}\.picture")
INDEX_SUFFIX = ".nbi"
SHOWN_PROBLEMS = 10


class CachedFile(NamedTuple):
    """A file in a cache.

    Attributes:
        kind: One of `KINDS`.
        size: In bytes.
    """

    kind: str
    path: str
    size: int


class Listing(NamedTuple):
    """The contents of the caches.

    Attributes:
        files: All files; indexes of compiled code come first.
        folders: The folders of compiled code, inner ones first.
        problems: A sentence for each folder that cannot be read.
    """

    files: list[CachedFile]
    folders: list[str]
    problems: list[str]


def cache(
    clear: Annotated[
        bool, typer.Option("--clear", help="Delete compiled code and baked pictures; the next start is slow.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Show the folder and the size of the caches, or clear them.

    The caches hold compiled code and baked pictures, which are made again when they are needed. Other files
    in the folder, scores and settings are not touched.

    Exit codes: 0 done, 2 a file cannot be removed.

    Example: `silverball cache --clear`
    """
    folder = cache_base()
    listing = find_files(folder)
    if not clear:
        show(folder, listing, as_json)
        return
    removed, problems = remove_files(listing)
    total = sum(one.size for one in removed)
    if as_json:
        print_json(
            {
                "folder": str(folder),
                "removed_files": len(removed),
                "removed_bytes": total,
                "problems": problems,
            }
        )
    else:
        print_lines(f"removed {file_count_text(len(removed))}, {megabytes(total)}, from {folder}")
    if problems:
        raise OutputError(*shortened(problems))


def cache_base() -> Path:
    """The folder of all caches, which SILVERBALL_CACHE names; it may not exist."""
    from silverball.physics.kernel import code_folder

    return code_folder().parent.parent


def find_files(base: Path) -> Listing:
    """Find the files of all caches. A folder that cannot be read becomes a problem of the listing."""
    found = Listing([], [], [])
    kinds = kinds_by_folder()
    for version in entries(base / "compiled", found):
        if not is_folder(version, VERSION_FOLDER):
            continue
        kind = kinds.get(version.name, OTHER)
        for package in entries(version.path, found):
            if is_folder(package, PACKAGE_FOLDER):
                add_files(package.path, kind, CODE_FILE, found)
                found.folders.append(package.path)
        found.folders.append(version.path)
    add_files(base / "pictures", PICTURES, PICTURE_FILE, found)
    # Indexes are deleted first, so that no process ever finds an index whose code is missing.
    found.files.sort(key=lambda one: not one.path.endswith(INDEX_SUFFIX))
    return found


def kinds_by_folder() -> dict[str, str]:
    """The kind of compiled code in each folder of the running version, by the folder's name."""
    from silverball.physics import kernel

    packages = {
        "play": kernel.PLAY,
        "study": kernel.STUDY,
        "environments": kernel.AGENTS,
        "drawing": kernel.DRAWING,
    }
    return {kernel.code_folder(names).name: kind for kind, names in packages.items()}


def entries(folder: str | Path, found: Listing) -> Iterator[os.DirEntry[str]]:
    """The entries of a folder; none if it does not exist, is a link, or cannot be read."""
    if os.path.islink(folder):
        found.problems.append(f"{folder}: this is a link, which is not followed; clear its target yourself")
        return
    try:
        with os.scandir(folder) as scan:
            yield from sorted(scan, key=lambda entry: entry.name)
    except FileNotFoundError:
        pass
    except OSError as error:
        found.problems.append(f"{folder}: cannot be read ({error.strerror or error})")


def add_files(folder: str | Path, kind: str, pattern: re.Pattern[str], found: Listing) -> None:
    """Add the regular files of a folder whose names match."""
    for entry in entries(folder, found):
        if pattern.fullmatch(entry.name):
            with suppress(OSError):  # another process has removed it
                if entry.is_file(follow_symlinks=False):
                    size = entry.stat(follow_symlinks=False).st_size
                    found.files.append(CachedFile(kind, entry.path, size))


def is_folder(entry: os.DirEntry[str], pattern: re.Pattern[str]) -> bool:
    """Whether an entry is a folder with a matching name, and not a link to one."""
    is_junction = getattr(entry, "is_junction", bool)  # Windows directory junctions, from Python 3.12
    return bool(pattern.fullmatch(entry.name)) and entry.is_dir(follow_symlinks=False) and not is_junction()


def remove_files(listing: Listing) -> tuple[list[CachedFile], list[str]]:
    """Remove all files of a listing, and the folders this leaves empty.

    Returns:
        The files that were removed, and a sentence for each problem.
    """
    removed, problems = [], list(listing.problems)
    for file in listing.files:
        try:
            os.unlink(file.path)
        except FileNotFoundError:
            continue  # another process has removed it
        except OSError as error:
            problems.append(f"{file.path}: cannot be removed ({error.strerror or error})")
        else:
            removed.append(file)
    for folder in listing.folders:
        with suppress(OSError):  # it holds something else
            os.rmdir(folder)
    return removed, problems


def sizes(listing: Listing) -> dict[str, tuple[int, int]]:
    """The number of files and their bytes, by kind."""
    found = {}
    for kind in KINDS:
        files = [one.size for one in listing.files if one.kind == kind]
        found[kind] = len(files), sum(files)
    return found


def sizes_json(listing: Listing) -> dict[str, dict[str, int]]:
    """The sizes, in the form printed as JSON."""
    return {
        kind.replace(" ", "_"): {"files": files, "bytes": size}
        for kind, (files, size) in sizes(listing).items()
    }


def show(folder: Path, listing: Listing, as_json: bool) -> None:
    """Print the folder, the sizes and the problems."""
    if as_json:
        caches = sizes_json(listing)
        print_json({"folder": str(folder), "caches": caches, "problems": listing.problems})
        return
    print_lines(str(folder))
    print_table(sizes_table(listing))
    print_lines(*shortened(listing.problems))


def sizes_table(listing: Listing) -> RichTable:
    """A row for each kind of cache, and their total."""
    from rich import box
    from rich.table import Table as RichTable

    table = RichTable(box=box.SIMPLE_HEAD)
    table.add_column("cache")
    table.add_column("files", justify="right")
    table.add_column("size", justify="right")
    for kind, (files, size) in sizes(listing).items():
        table.add_row(KINDS[kind], f"{files:,}", megabytes(size))
    table.add_section()
    table.add_row("total", f"{len(listing.files):,}", megabytes(sum(one.size for one in listing.files)))
    return table


def megabytes(size: int) -> str:
    """A size in bytes as text."""
    return f"{size / 1e6:,.1f} MB"


def file_count_text(files: int) -> str:
    """A number of files as text."""
    return f"{files:,} file{'' if files == 1 else 's'}"


def shortened(problems: list[str]) -> list[str]:
    """The first problems, and the number of the others."""
    rest = len(problems) - SHOWN_PROBLEMS
    return [*problems[:SHOWN_PROBLEMS], *([f"and {rest:,} more problems"] if rest > 0 else [])]
