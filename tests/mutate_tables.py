"""Fuzzing of table files: thousands of damaged files through load, check and five seconds of play.

    python tests/mutate_tables.py --count 50000
    python tests/mutate_tables.py --count 5000 --rules

Each is a valid file with changed bytes, lines, numbers, keys or types, or with a hostile recipe or mesh; with
`--rules` a table whose rules are changed, and name what is there in wrong places. File n of a seed is always
the same. A table or a `TableError` is right. Wrong, and listed, are any other exception, a control character
in a message, more than 5 s, more than 200 MB beyond the process itself, a world that stops with a fault, a
recipe that loads but makes no board, and a check that fails.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import random
import re
import resource
import signal
import sys
import time
import unicodedata
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np

from rule_tables import COMET_RULES, PARTS, comet
from silverball.errors import SilverballError, TableError
from silverball.game.game import Game
from silverball.soak.hostile_parts import hostile_part_table
from silverball.soak.part_boards import part_table
from silverball.table import Table, dump_table, generate_table, load_table, table_names
from silverball.table.model import key_of
from silverball.table.parts import Arcade, Board, RandomRecipe
from silverball.table.rulebook import Rule
from silverball.table.table import PART_KINDS, RULE_SECTIONS
from silverball.world import World

LONGEST = 5.0  # [s] of computing time for one file, and ten times that by the clock
LARGEST = 200e6  # [bytes] by which the process may grow
PLAY = 5.0  # [s] simulated
NUMBERS = (
    *(
        "0",
        "-0.0",
        "nan",
        "inf",
        "-inf",
        "1e308",
        "-1e308",
        "5e-324",
        "1e400",
        "0.1",
        "-1",
        "1",
        "2",
        "3",
        "5",
    ),
    *("10", "99.9", "100", "-100", "1e9", str(2**31), str(2**63), "-" + "9" * 30, "1" * 5000, "0x10", "1_0"),
)
VALUES = (
    *(
        '"text"',
        '""',
        "true",
        "false",
        "[]",
        "{}",
        "[[]]",
        "[1]",
        "[1, 2, 3]",
        "[nan, nan]",
        "[0, 0]",
        "{ a = 1 }",
    ),
    *(
        "1979-05-27",
        "1979-05-27T07:32:00Z",
        "07:32:00",
        '"\\u001b[31m"',
        '"\\u202e"',
        "[[[[[[[[]]]]]]]]",
        "'''x\ny'''",
    ),
)
CHARACTERS = "\x00\x07\x1b\x7f\x85\x9b\u200b\u202e\u2066\ufeff\u2028é𝄞\"'\\[]{}=#.,\n\r\t"
WORDS = tuple(
    dict.fromkeys(
        [
            *(
                key_of(model, name)
                for model in (Board, RandomRecipe, Arcade, *PART_KINDS.values(), *RULE_SECTIONS.values())
                for name in model.model_fields
            ),
            *("format", "from", "to", "flipper", "__class__", "\x1b[1m"),
        ]
    )
)
HEADS = ("[board]", "[random]", "[arcade]", *(f"[[{kind}]]" for kind in (*PART_KINDS, *RULE_SECTIONS)))
RULE_KEYS = tuple(Rule.model_fields)
SECTION = re.compile(r"^(?=\[)", re.MULTILINE)
NAME = re.compile(r'"([^"\n]*)"')
NUMBER = re.compile(r"(?<![\w.\"])-?\d[\d_.]*(?:e-?\d+)?(?![\w.])")


class Finding(NamedTuple):
    """What was wrong with a file."""

    number: int
    what: str


# --- how a file is damaged ------------------------------------------------------------------------------


def _bytes(text: str, dice: random.Random) -> str:
    """Change or remove some bytes."""
    letters = list(text)
    for _ in range(dice.randint(1, 6)):
        place = dice.randrange(len(letters))
        letters[place] = dice.choice(["", chr(dice.randrange(256)), dice.choice(CHARACTERS)])
    return "".join(letters)


def _lines(text: str, dice: random.Random) -> str:
    """Remove, double, swap or move lines."""
    lines = text.split("\n")
    for _ in range(dice.randint(1, 4)):
        one, other = dice.randrange(len(lines)), dice.randrange(len(lines))
        way = dice.randrange(4)
        if way == 0 and len(lines) > 1:
            del lines[one]
        elif way == 1:
            lines.insert(other, lines[one])
        elif way == 2:
            lines[one], lines[other] = lines[other], lines[one]
        else:
            lines[other:other] = lines[one : one + dice.randint(1, 40)] * dice.choice([1, 1, 2, 60])
    return "\n".join(lines)


def _numbers(text: str, dice: random.Random) -> str:
    """Replace some numbers by hostile ones, or change them a little."""
    found = list(NUMBER.finditer(text))
    for match in sorted(dice.sample(found, min(len(found), dice.randint(1, 5))), key=lambda m: -m.start()):
        nasty = dice.choice(NUMBERS)
        with contextlib.suppress(ValueError):
            if dice.random() < 0.5:
                nasty = repr(
                    float(match.group()) * dice.choice([0.5, 0.9, 1.1, 2.0, 10.0]) + dice.uniform(-1.0, 1.0)
                )
        text = text[: match.start()] + nasty + text[match.end() :]
    return text


def _gentle(text: str, dice: random.Random) -> str:
    """Change one or two numbers a little, so that many of these files can be played."""
    found = list(NUMBER.finditer(text))
    for match in sorted(dice.sample(found, min(len(found), dice.randint(1, 2))), key=lambda m: -m.start()):
        with contextlib.suppress(ValueError):
            value = float(match.group()) * dice.uniform(0.8, 1.25)
            text = text[: match.start()] + repr(value) + text[match.end() :]
    return text


def _types(text: str, dice: random.Random) -> str:
    """Change the types of some values, and some keys."""
    lines = text.split("\n")
    places = [place for place, line in enumerate(lines) if " = " in line]
    for place in dice.sample(places, min(len(places), dice.randint(1, 4))):
        key, _, value = lines[place].partition(" = ")
        if dice.random() < 0.6:
            value = dice.choice(VALUES + NUMBERS)
        else:
            word = dice.choice(WORDS)
            key = word if word.isidentifier() else '"\\u001b[1m"'
        lines[place] = f"{key} = {value}"
    return "\n".join(lines)


def _additions(text: str, dice: random.Random) -> str:
    """Insert sections and keys from elsewhere."""
    lines = text.split("\n")
    for _ in range(dice.randint(1, 4)):
        word = dice.choice([word for word in WORDS if word.isidentifier()])
        line = dice.choice(HEADS) if dice.random() < 0.3 else f"{word} = {dice.choice(VALUES + NUMBERS)}"
        lines.insert(dice.randrange(len(lines) + 1), line)
    return "\n".join(lines)


def _cut(text: str, dice: random.Random) -> str:
    """Truncate the file."""
    return text[: dice.randrange(len(text))]


def _nesting(text: str, dice: random.Random) -> str:
    """Nest brackets and sections."""
    depth = dice.choice([10, 100, 1000, 5000])
    return text + dice.choice(
        [
            f"\nx = {'[' * depth}{']' * depth}\n",
            f"\n[{'.'.join('a' * depth)}]\n",
            "\nx = " + "{a=" * depth + "1" + "}" * depth + "\n",
        ]
    )


def _recipe(text: str, dice: random.Random) -> str:
    """Change the recipe; its area may be too small, or outside the board."""
    x, z = (
        sorted(dice.uniform(-11.0, 11.0) for _ in range(2)),
        sorted(dice.uniform(-6.0, 6.0) for _ in range(2)),
    )
    size, radius = (sorted(round(dice.uniform(0.2, 1.6), 3) for _ in range(2)) for _ in range(2))
    turned = sorted(dice.choice([0.0, 10.0, 20.0, 30.0, 45.0, 80.0, 360.0]) for _ in range(2))
    lines = [
        f"triangular_prisms = {dice.choice([0, 1, 2, 4, 4, 8, 32])}",
        f"cylinders = {dice.choice([0, 1, 3, 3, 6, 32])}",
        f"area = [[{x[0]}, {z[0]}], [{x[1]}, {z[1]}]]",
        f"gap = {dice.choice([0.0, 0.62, 0.7, 0.9, 2.0, 10.0])}",
        f"wall_gap = {dice.choice([0.0, 0.62, 0.7, 0.9, 2.0, 10.0])}",
        f"prism_size = {size}",
        f"cylinder_radius = {radius}",
        f"rotation = {turned}",
    ]
    kept = dice.sample(lines, dice.randint(1, len(lines)))
    bare = text.partition("[random]")[0]
    return bare + "\n[random]\n" + "\n".join(kept) + "\n"


def _mesh(text: str, dice: random.Random) -> str:
    """Add a prism and a cylinder with a mesh, which may be damaged."""
    names = [f"{name}.{kind}" for name in ("good", "bad") for kind in ("stl", "obj", "glb")]
    names += ["gone.stl", "/dev/null", "..", "good.glb/x.stl", "\\u0000.stl", "\\u001b[31m.obj"]
    mesh = dice.choice(names)
    return f'{text}\n[[{dice.choice(["cylinder", "triangular_prism"])}]]\nmesh = "{mesh}"\n'


# --- how its rules are damaged --------------------------------------------------------------------------


def _split(text: str) -> tuple[list[str], list[int]]:
    """The sections of a file, and the numbers of those that belong to its rules."""
    sections = SECTION.split(text)
    heads = tuple(f"[[{section}]]" for section in RULE_SECTIONS)
    return sections, [number for number, one in enumerate(sections) if one.startswith(heads)]


def _names(text: str, dice: random.Random) -> str:
    """Exchange some names in the rules for others of the file, which may be of another sort."""
    sections, rules = _split(text)
    names = sorted(set(NAME.findall(text))) or ["x"]
    for number in dice.choices(rules or [0], k=dice.randint(1, 3)):
        found = list(NAME.finditer(sections[number]))
        if found:
            one = dice.choice(found)
            section, name = sections[number], dice.choice([*names, "any", "combo", "in_play", "nobody"])
            sections[number] = section[: one.start()] + f'"{name}"' + section[one.end() :]
    return "".join(sections)


def _keys(text: str, dice: random.Random) -> str:
    """Give rules other keys, or another value of the same key, or one more."""
    sections, rules = _split(text)
    lines = [line for number in rules for line in sections[number].splitlines() if " = " in line]
    for number in dice.choices(rules or [0], k=dice.randint(1, 3)):
        own = sections[number].rstrip("\n").split("\n")
        line = dice.choice(lines or ["x = 1"])
        key, _, value = line.partition(" = ")
        place, way = dice.randrange(1, len(own) + 1), dice.randrange(4)
        if way == 0:
            own.insert(place, line)
        elif way == 1:
            own.insert(place, f"{dice.choice(RULE_KEYS)} = {value}")
        elif way == 2:
            own.insert(place, f"{key} = {dice.choice(VALUES + NUMBERS)}")
        else:
            own[place - 1] = line
        sections[number] = "\n".join(own) + "\n\n"
    return "".join(sections)


def _sections(text: str, dice: random.Random) -> str:
    """Remove, double or move lamps, counters, modes and rules; or repeat one hundreds of times."""
    sections, rules = _split(text)
    for _ in range(dice.randint(1, 3)):
        if not rules:
            break
        one, other, way = dice.choice(rules), dice.choice(rules), dice.randrange(4)
        if way == 0:
            sections[one] = ""
        elif way == 1:
            sections[other] += sections[one]
        elif way == 2:
            sections[one], sections[other] = sections[other], sections[one]
        else:
            sections[other] += sections[one] * dice.choice([2, 30, 300])
    return "".join(sections)


def _rule_numbers(text: str, dice: random.Random) -> str:
    """Change some numbers of the rules: a little, to a limit, or to what is none."""
    sections, rules = _split(text)
    for number in dice.choices([one for one in rules if NUMBER.search(sections[one])] or [0], k=3):
        section = sections[number]
        found = list(NUMBER.finditer(section))
        if found:
            one = dice.choice(found)
            value = dice.choice(["0", "1", "2", "8", "1000000000", "0.5", "600.0", *NUMBERS])
            sections[number] = section[: one.start()] + value + section[one.end() :]
    return "".join(sections)


Ways = tuple[Callable[[str, random.Random], str], ...]

RULE_WAYS: Ways = (*(_names, _keys, _sections, _rule_numbers) * 2, _bytes, _cut)
WAYS: Ways = (
    *(
        _bytes,
        _lines,
        _numbers,
        _gentle,
        _gentle,
        _gentle,
        _types,
        _additions,
        _cut,
        _nesting,
        _recipe,
        _mesh,
    ),
)


def good_texts() -> list[str]:
    """The files to damage: the built-in tables, boards of all parts too, and a table with every key."""
    tables = [load_table(name) for name in table_names()]
    tables += [generate_table(seed, name) for name in ("random", "original") for seed in range(3)]
    tables += [part_table(seed) for seed in range(6)] + [hostile_part_table(seed) for seed in range(3)]
    full = "\n".join(["[arcade]", "balls = 5", "tilt_limit = 2.0", "combo_window = 1.5"])
    return [dump_table(table) for table in tables] + [dump_table(tables[0]) + full + "\n"]


def rule_texts() -> list[str]:
    """The files whose rules are damaged: a whole machine, as it is written and as it is dumped."""
    return [f"{PARTS}\n{COMET_RULES}", dump_table(comet())]


def mutated(texts: list[str], seed: int, number: int, ways: Ways = WAYS) -> bytes:
    """Make damaged file number n of a seed."""
    dice = random.Random(f"{seed}/{number}")
    text = dice.choice(texts)
    for _ in range(dice.choice([1, 1, 1, 2, 3])):
        if text:
            text = dice.choice(ways)(text, dice)
    content = text.encode("utf-8", "surrogatepass")
    if dice.random() < 0.05 and content:  # bytes that are no text
        place = dice.randrange(len(content))
        content = content[:place] + bytes([dice.randrange(256)]) + content[place + 1 :]
    return content


def write_meshes(folder: Path, dice: random.Random) -> None:
    """A wedge in each format, valid and damaged."""
    stl = bytes(80) + (2).to_bytes(4, "little")
    corners = np.array(
        [[2, 0, -1], [3.2, 0, -1.4], [2.4, 1, 0.2], [2, 1, -1], [3.2, 1, -1.4], [2.4, 0, 0.2]], "<f4"
    )
    for triangle in corners.reshape(2, 9):
        stl += bytes(12) + triangle.tobytes() + bytes(2)
    obj = "".join(f"v {x} {y} {z}\n" for x, y, z in corners.tolist()) + "f 1 2 3\nf 4 5 6\n"
    described = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 72}],
        "buffers": [{"byteLength": 72}],
    }
    scene = json.dumps(described).encode()
    scene += b" " * (-len(scene) % 4)
    data = corners.tobytes()
    head = b"glTF" + b"".join(
        n.to_bytes(4, "little") for n in (2, 28 + len(scene) + 72, len(scene), 0x4E4F534A)
    )
    glb = head + scene + (72).to_bytes(4, "little") + (0x004E4942).to_bytes(4, "little") + data
    for kind, content in (("stl", stl), ("obj", obj.encode()), ("glb", glb)):
        (folder / f"good.{kind}").write_bytes(content)
        damaged = bytearray(content)
        for _ in range(3):
            damaged[dice.randrange(len(damaged))] = dice.randrange(256)
        (folder / f"bad.{kind}").write_bytes(damaged)


# --- what becomes of it ---------------------------------------------------------------------------------


def take_through(path: Path, seed: int) -> tuple[str, str]:
    """Load, check and play a file; returns the outcome and the message."""
    try:
        table = load_table(path)
    except TableError as error:
        return "refused", str(error).replace("\n  ", " ")
    except SilverballError as error:
        return "refused", str(error)
    try:
        if table.random is not None:
            table = generate_table(seed, table)
    except TableError as error:
        return "WRONG: loads, but makes no board", str(error)
    if table.rule:
        play_game(table, seed)
        return "played", ""
    dice = random.Random(seed)
    world = World(table, seed=seed, tick_rate=dice.choice([60, 240]))
    held = [False, False]
    for _ in range(round(PLAY * 10)):
        with contextlib.suppress(SilverballError):  # no room, or as many balls as there may be
            if len(world.balls) < table.board.max_balls and dice.random() < 0.5:
                world.create_ball()
        held = [state != (dice.random() < 0.3) for state in held]
        for _ in range(world.tick_rate // 10):
            world.step(left=held[0], right=held[1], jitter=dice.random() < 0.01, launch=held[0])
    return "played", ""


def play_game(table: Table, seed: int) -> None:
    """Play a game with the rules of a table, save it, and verify its replay."""
    dice = random.Random(seed)
    game = Game(table, seed, tick_rate=dice.choice([60, 240]))
    held = [False, False, False]
    for _ in range(round(PLAY * 10)):
        with contextlib.suppress(SilverballError):  # no ball is left, or there is no room
            if dice.random() < 0.5:
                game.create_ball()
        with contextlib.suppress(SilverballError):  # no ball to shove
            if dice.random() < 0.05:
                game.jitter()
        held = [state != (dice.random() < 0.3) for state in held]
        game.step(held[0], held[1], game.tick_rate // 10, launch=held[2])
    assert game.fault is None, f"fault {game.fault}"
    assert game.score >= 0
    assert all(value >= 0 for value in game.counters.values())
    assert set(game.lamps.values()) <= {"off", "on", "blinking"}
    other = Game(table, seed, tick_rate=game.tick_rate)
    other.restore(game.save())
    assert other.digest() == game.digest(), "another game after save and restore"
    assert (verdict := game.replay.verify()).ok, verdict.message


def examine(path: Path, seed: int) -> tuple[str, str | None]:
    """Return the outcome of a file, and what was wrong with it."""
    start = time.process_time()
    try:
        with _alarm(10.0 * LONGEST):
            outcome, said = take_through(path, seed)
    except BaseException as error:
        if isinstance(error, KeyboardInterrupt):
            raise
        return "wrong", f"{type(error).__name__}: {str(error)[:200]!r}"
    if outcome.startswith("WRONG"):
        return "wrong", f"{outcome[7:]}: {said}"
    obeyed = {
        character for character in said if unicodedata.category(character) in ("Cc", "Cf", "Cs", "Zl", "Zp")
    }
    if obeyed:
        return "wrong", f"says characters that are obeyed, {sorted(map(ascii, obeyed))}: {said[:200]!r}"
    taken = time.process_time() - start
    if taken > LONGEST:
        return "wrong", f"took {taken:.1f} s ({outcome})"
    return outcome, None


@contextlib.contextmanager
def _alarm(seconds: float) -> Iterator[None]:
    """Limit the computing time, where the system can."""

    def ring(*_: object) -> None:
        raise TimeoutError(f"no end within {seconds:.0f} s")

    if not hasattr(signal, "setitimer"):
        yield
        return
    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def run(
    count: int,
    seed: int = 0,
    first: int = 0,
    tell: Callable[[int, Finding | None], None] = lambda number, found: None,
    *,
    rules: bool = False,
) -> tuple[Counter[str], list[Finding], float]:
    """Run the files of a seed; returns the number of each outcome, the findings, and the growth [bytes]."""
    texts, ways = (rule_texts(), RULE_WAYS) if rules else (good_texts(), WAYS)
    outcomes, findings = Counter[str](), []
    World("classic", seed=1).step()
    play_game(comet(), 1)  # compiles what is needed
    before = _peak()
    with TemporaryDirectory() as folder:
        path = Path(folder) / "table.toml"
        for number in range(first, first + count):
            if number % 100 == 0 or number == first:
                write_meshes(Path(folder), random.Random(f"{seed}/{number // 100}"))
            path.write_bytes(mutated(texts, seed, number, ways))
            outcome, wrong = examine(path, number)
            if _peak() - before > LARGEST and not any("memory" in found.what for found in findings):
                outcome, wrong = "wrong", f"has grown the memory by {(_peak() - before) / 1e6:.0f} MB"
            outcomes[outcome] += 1
            found = Finding(number, wrong) if wrong else None
            findings += [found] if found else []
            tell(number, found)
    return outcomes, findings, _peak() - before


def _peak() -> float:
    """[bytes] The peak memory of this process."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1.0 if sys.platform == "darwin" else 1024.0)


def main() -> int:
    """Run from the command line; returns 1 if anything was wrong."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("--count", type=int, default=1000, help="how many files")
    options.add_argument("--seed", type=int, default=0)
    options.add_argument("--first", type=int, default=0, help="number of the first file")
    options.add_argument("--rules", action="store_true", help="damage rules instead of parts")
    options.add_argument("--show", type=int, help="write this damaged file to the standard output instead")
    chosen = options.parse_args()
    if chosen.show is not None:
        texts, ways = (rule_texts(), RULE_WAYS) if chosen.rules else (good_texts(), WAYS)
        sys.stdout.buffer.write(mutated(texts, chosen.seed, chosen.show, ways))
        return 0
    start = time.process_time()

    def tell(number: int, found: Finding | None) -> None:
        if found:
            print(f"file {found.number}: {found.what}", flush=True)
        if (number + 1) % 1000 == 0:
            print(f"{number + 1:,} files, {time.process_time() - start:.0f} s", file=sys.stderr, flush=True)

    outcomes, findings, grown = run(chosen.count, chosen.seed, chosen.first, tell, rules=chosen.rules)
    told = ", ".join(f"{number:,} {outcome}" for outcome, number in sorted(outcomes.items()))
    cost = f"{grown / 1e6:.0f} MB, {time.process_time() - start:.0f} s"
    print(f"{chosen.count:,} files of seed {chosen.seed}: {told}; {cost}")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
