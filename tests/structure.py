"""Count what keeps the code readable: `python tests/structure.py [src/silverball]`.

Prints the numbers of files, of short files, of kernels with many parameters, of bare `Any` annotations, the
files of one name and the circles of imports; tests/test_structure.py holds the code to them.
"""

from __future__ import annotations

import ast
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

PACKAGE = Path(__file__).parents[1] / "src" / "silverball"
SHORT = 40  # lines; a shorter file had better be part of another one
MOST_PARAMETERS = 8
DECORATORS = {"kernel", "internal", "inlined", "ir_inlined"}


def sources(package: Path = PACKAGE) -> dict[str, Path]:
    """The file of every module, by its dotted name."""
    found = {}
    for path in sorted(package.rglob("*.py")):
        parts = path.relative_to(package.parent).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def short_files(package: Path = PACKAGE) -> list[str]:
    """The files that are shorter than SHORT lines, except the `__init__.py` and `__main__.py`."""
    return [
        path.relative_to(package).as_posix()
        for path in sources(package).values()
        if not path.name.startswith("__") and len(path.read_text(encoding="utf-8").splitlines()) < SHORT
    ]


def homonyms(package: Path = PACKAGE) -> dict[str, list[str]]:
    """The files of one name, by that name."""
    by_name = defaultdict(list)
    for path in sources(package).values():
        if not path.name.startswith("__"):
            by_name[path.name].append(path.relative_to(package).as_posix())
    return {name: paths for name, paths in by_name.items() if len(paths) > 1}


def kernels(package: Path = PACKAGE) -> Iterator[tuple[str, int]]:
    """Every compiled function, as module.name, with the number of its parameters."""
    for module, path in sources(package).items():
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef):
                names = {one.id for one in node.decorator_list if isinstance(one, ast.Name)}
                if names & DECORATORS:
                    arguments = node.args
                    yield (
                        f"{module}.{node.name}",
                        len([*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]),
                    )


def wide_kernels(package: Path = PACKAGE) -> dict[str, int]:
    """The kernels with more than MOST_PARAMETERS parameters."""
    return {name: count for name, count in kernels(package) if count > MOST_PARAMETERS}


def bare_any(package: Path = PACKAGE) -> int:
    """How often `Any` alone annotates something."""
    count = 0
    for path in sources(package).values():
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            annotation = getattr(node, "annotation", None)
            count += isinstance(annotation, ast.Name) and annotation.id == "Any"
    return count


def imports(package: Path = PACKAGE) -> dict[str, set[str]]:
    """What every module imports of the package, in functions too, but not for the type checker alone."""
    modules = sources(package)

    def found(node: ast.AST) -> Iterator[str]:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.If) and "TYPE_CHECKING" in ast.dump(child.test):
                continue
            if isinstance(child, ast.ImportFrom) and child.module:
                for one in child.names:
                    inner = f"{child.module}.{one.name}"
                    yield inner if inner in modules else child.module
            elif isinstance(child, ast.Import):
                yield from (one.name for one in child.names)
            yield from found(child)

    return {
        module: set(found(ast.parse(path.read_text(encoding="utf-8")))) & set(modules) - {module}
        for module, path in modules.items()
    }


def circles(package: Path = PACKAGE) -> list[list[str]]:
    """The groups of modules that import each other, directly or through others."""
    graph = imports(package)

    def reached(start: str) -> set[str]:
        seen: set[str] = set()
        waiting = [start]
        while waiting:
            for name in graph[waiting.pop()] - seen:
                seen.add(name)
                waiting.append(name)
        return seen

    reach = {module: reached(module) for module in graph}
    groups = {
        tuple(sorted(other for other in reach[module] if module in reach[other]))
        for module in graph
        if module in reach[module]
    }
    return [list(group) for group in sorted(groups)]


def main(package: Path) -> None:
    """Print all counts."""
    print(f"{len(sources(package))} files, {len(short_files(package))} of them under {SHORT} lines")
    wide = wide_kernels(package)
    print(f"{len(list(kernels(package)))} kernels, {len(wide)} with more than {MOST_PARAMETERS} parameters")
    for name, count in sorted(wide.items(), key=lambda one: -one[1]):
        print(f"    {count:2} {name}")
    print(f"{bare_any(package)} bare `Any`")
    same = homonyms(package)
    print(f"{len(same)} names of more than one file")
    for name, paths in same.items():
        print(f"    {name}: {', '.join(paths)}")
    print(f"{len(circles(package))} circles of imports")
    for group in circles(package):
        print(f"    {', '.join(group)}")


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else PACKAGE)
