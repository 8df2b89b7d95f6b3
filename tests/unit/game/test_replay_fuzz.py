"""Damaged replays give a clear sentence or a named difference, never a traceback or a hang.

A few hundred mutated files are tried in every run, ten thousand with `pytest -m slow`. Most of them get the
checksum that belongs to the damaged text, so that what lies behind it is reached too.
"""

from __future__ import annotations

import random
import re
import signal
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest
from games import bare, bumper, frantic_game, reflex_game

from silverball.errors import SilverballError
from silverball.game.game import Game
from silverball.game.replay.format import Replay
from silverball.game.replay.reader import checksum
from silverball.game.replay.verify import compare, verify
from silverball.game.view import Mode
from silverball.table import generate_table, table_digest

SECONDS_PER_FILE = 5.0  # a file of a few kilobytes must be done with long before
HUGE = ("0", "-1", "1e400", "nan", "9" * 18, "9" * 400, str(2**63), "1_0", "٣", "0x10", "", "  7")


def short_game() -> Game:
    game = Game(bare(bumper(), balls=1, ball_save=1.0), 5)
    game.create_ball()
    game.step(True, False, 100)
    game.jitter()
    game.step(False, True, 5000)
    return game


SOURCES = [
    reflex_game("classic", 2, seconds=6).replay.to_text(),
    reflex_game(generate_table(4), 4, Mode.FREE, seconds=5).replay.to_text(),
    frantic_game(3, seconds=4).replay.to_text(),
    short_game().replay.to_text(),
]
GOOD = [Replay.from_text(text) for text in SOURCES]


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Stop what takes more of the processor's time [s] than this."""

    def stop(*_: object) -> None:
        raise TimeoutError(f"not done after {seconds} s")

    before = signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        signal.signal(signal.SIGVTALRM, before)


def flip(text: str, draw: random.Random) -> str:
    data = bytearray(text.encode("utf-8", "surrogateescape"))
    for _ in range(draw.choice((1, 1, 2, 8))):
        data[draw.randrange(len(data))] ^= 1 << draw.randrange(8)
    return data.decode("utf-8", "surrogateescape")


def other_bytes(text: str, draw: random.Random) -> str:
    at = draw.randrange(len(text))
    return text[:at] + bytes(draw.randrange(256) for _ in range(4)).decode("latin-1") + text[at:]


def drop_line(text: str, draw: random.Random) -> str:
    lines = text.split("\n")
    del lines[draw.randrange(len(lines))]
    return "\n".join(lines)


def double_line(text: str, draw: random.Random) -> str:
    lines = text.split("\n")
    at = draw.randrange(len(lines))
    return "\n".join([*lines[:at], lines[at], *lines[at:]])


def swap_lines(text: str, draw: random.Random) -> str:
    lines = text.split("\n")
    one, other = draw.randrange(len(lines)), draw.randrange(len(lines))
    lines[one], lines[other] = lines[other], lines[one]
    return "\n".join(lines)


def swap_digits(text: str, draw: random.Random) -> str:
    numbers = list(re.finditer(r"\d+(\.\d+)?", text))
    number = draw.choice(numbers)
    return text[: number.start()] + str(draw.randrange(10 ** len(number[0]))) + text[number.end() :]


def huge_number(text: str, draw: random.Random) -> str:
    number = draw.choice(list(re.finditer(r"(?<= )-?\d+(\.\d+)?", text)))
    return text[: number.start()] + draw.choice(HUGE) + text[number.end() :]


def cut(text: str, draw: random.Random) -> str:
    return text[: draw.randrange(len(text))]


def second_of(text: str, draw: random.Random) -> tuple[list[str], int]:
    """The lines of a file, and the place of one that is a second of play."""
    lines = text.split("\n")
    return lines, draw.randrange(lines.index("--- play") + 1, lines.index("--- end"))


def change_input(text: str, draw: random.Random) -> str:
    lines, at = second_of(text, draw)
    tokens = ("a", "k", "z", "K", "Z", "2c", "3B", "+b", "!d", "+a", "!2e", "1Z")
    more = "".join(draw.choice(tokens) for _ in range(draw.randrange(1, 5)))
    digests, _, inputs = lines[at].partition(" ")
    lines[at] = f"{digests} {draw.choice((more, inputs + more, more + inputs))}"
    return "\n".join(lines)


def change_digest(text: str, draw: random.Random) -> str:
    lines, at = second_of(text, draw)
    place = draw.randrange(12)
    lines[at] = lines[at][:place] + draw.choice("AZaz09-_") + lines[at][place + 1 :]
    return "\n".join(lines)


def other_length(text: str, draw: random.Random) -> str:
    """A second more or less, with the number of ticks that belongs to it."""
    lines, at = second_of(text, draw)
    more = draw.choice((0, 1, 2))
    lines[at : at + 1] = [lines[at]] * more
    count = next(number for number, line in enumerate(lines) if line.startswith("ticks = "))
    lines[count] = f"ticks = {int(lines[count].removeprefix('ticks = ')) + 240 * (more - 1)}"
    return "\n".join(lines)


def change_end(text: str, draw: random.Random) -> str:
    key = draw.choice(("score", "ended", "ticks", "seed", "mode", "tick_rate"))
    to = draw.choice(
        ("over", "running", "stopped", "outside", "arcade", "free", "0", "1", "60", "241", "480")
    )
    return re.sub(rf"(?m)^{key} = .*$", f"{key} = {to}", text)


def change_table(text: str, draw: random.Random) -> str:
    """Another table with the digest that belongs to it, where it is a table at all."""
    head, mark, rest = text.partition("--- table\n")
    table, play, end = rest.partition("\n--- play")
    table = draw.choice((swap_digits, drop_line, huge_number, swap_lines))(table, draw)
    try:
        import tomllib

        from silverball.table import Table

        digest = table_digest(Table.model_validate(tomllib.loads(table)))
    except ValueError:
        return head + mark + table + play + end
    head = re.sub(r"(?m)^table = .*$", f"table = {digest}", head)
    return head + mark + table + play + end


def repeat_part(text: str, draw: random.Random) -> str:
    start = draw.randrange(len(text))
    part = text[start : start + draw.randrange(1, 2000)]
    return text[:start] + part * draw.choice((2, 10, 100)) + text[start:]


def empty_part(text: str, draw: random.Random) -> str:
    start = draw.randrange(len(text))
    return text[:start] + text[start + draw.randrange(1, 400) :]


def mix(text: str, draw: random.Random) -> str:
    other = draw.choice(SOURCES)
    return text[: draw.randrange(len(text))] + other[draw.randrange(len(other)) :]


MUTATIONS: tuple[Callable[[str, random.Random], str], ...] = (
    flip, other_bytes, drop_line, double_line, swap_lines, swap_digits, huge_number, cut, change_input,
    change_table, change_digest, other_length, change_end, repeat_part, empty_part, mix,
)  # fmt: skip


def mutated(number: int) -> tuple[str, bytes]:
    """The name of a kind of damage, and a damaged file."""
    draw = random.Random(number)
    mutate = MUTATIONS[number % len(MUTATIONS)]
    text = mutate(draw.choice(SOURCES), draw)
    for _ in range(draw.choice((0, 0, 0, 1, 3))):
        try:
            text = draw.choice(MUTATIONS)(text, draw)
        except (IndexError, ValueError, StopIteration):
            break  # nothing is left that this kind of damage could be done to
    if draw.random() < 0.85 and "checksum = " in text:
        body = text[: text.rindex("checksum = ")]
        text = f"{body}checksum = {checksum(body)}\n"
    return mutate.__name__, text.encode("utf-8", "surrogateescape")


def around_table(text: str) -> list[str]:
    """The lines that say how the game was played; a table and a program may be written in many ways."""
    before, _, rest = text.replace("\r\n", "\n").removeprefix("\ufeff").partition("--- table\n")
    lines = (before + rest[rest.index("--- play\n") :]).split("\n")
    return [line for line in lines if not line.startswith(("program = ", "checksum = "))]


def outcome_of(data: bytes, path) -> str:
    """What came of a file: "equal", "named" (a difference), or "refused"."""
    path.write_bytes(data)
    with time_limit(SECONDS_PER_FILE):
        try:
            replay = Replay.load(path)
        except SilverballError as error:
            said = str(error)
            assert said.startswith(str(path)), said
            assert "\n" not in said, said
            assert len(said) < 600 + len(str(path)), said
            return "refused"
        assert around_table(data.decode()) == around_table(replay.to_text())
        verdict = verify(replay)
        assert verdict.ok == (verdict.field == ""), verdict
        if verdict.ok:
            return "equal"
        assert verdict.field in verdict.message
        assert str(verdict.seen) in verdict.message
        assert 0 <= verdict.tick <= verdict.seen <= replay.ticks
        assert "\n" not in verdict.message
        for good in GOOD:
            compared = compare(good, replay)
            assert compared.ok == (compared.field == ""), compared
        return "named"


def run(numbers: range, tmp_path) -> Counter[tuple[str, str]]:
    outcomes: Counter[tuple[str, str]] = Counter()
    for number in numbers:
        name, data = mutated(number)
        try:
            outcomes[name, outcome_of(data, tmp_path / "fuzzed.replay")] += 1
        except (Exception, AssertionError) as error:
            raise AssertionError(f"mutation {number} ({name}): {type(error).__name__}: {error}") from error
    return outcomes


def test_hundreds_of_damaged_replays_are_refused_or_named(tmp_path):
    outcomes = run(range(400), tmp_path)
    seen = {outcome for _, outcome in outcomes}
    assert seen == {"refused", "named", "equal"}
    assert outcomes["change_input", "named"] > 5


@pytest.mark.slow
def test_ten_thousand_damaged_replays_are_refused_or_named(tmp_path):
    outcomes = run(range(10_000), tmp_path)
    total = Counter()
    for (_, outcome), count in outcomes.items():
        total[outcome] += count
    print(dict(total), {f"{name} {outcome}": count for (name, outcome), count in sorted(outcomes.items())})
    assert total.total() == 10_000
