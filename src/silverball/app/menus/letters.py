"""How are initials and numbers entered with three buttons? The paddles turn a letter, Space takes it.

Behind the last letter stands END; "◄" among the letters deletes one.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable

from silverball.app.menus import layout
from silverball.app.menus.commands import Button, Command
from silverball.app.menus.desk import Desk, Page
from silverball.drawing.dotfonts import BOLD, NORMAL
from silverball.drawing.dots import FULL, WIDTH, Dots

DELETE, END = "◄", "END"
LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.- "
LARGE_MOST = 3  # letters that are written twice as large, the help beside them
HELP_X, END_WIDTH = 68, 29  # [dot] where it may begin then, and how much of it END takes


class LettersPage(Page):
    """A page on which a text is entered letter by letter.

    Args:
        name: What tells it from other pages.
        title: What stands above.
        letters: Those to choose from.
        most: How many there can be.
        done: What to do with the text.
        least: How many there must be.
        start: Offered to begin with, letter by letter.
    """

    quiet = False

    def __init__(
        self,
        name: str,
        title: str,
        letters: str,
        most: int,
        done: Callable[[str], Command | None],
        least: int | None = None,
        start: str = "",
    ) -> None:
        self.name = name
        self._title = title
        self._letters = letters
        self._most = most
        self._least = most if least is None else least
        self._done = done
        self._offered = start
        self.text = ""
        self._turn = 0
        self._offer()

    @property
    def choices(self) -> tuple[str, ...]:
        """What the paddles turn through at this place."""
        letters = tuple(self._letters) if len(self.text) < self._most else ()
        end = (END,) if len(self.text) >= self._least else ()
        return (*letters, *end, *((DELETE,) if self.text else ()))

    def press(self, button: Button, desk: Desk) -> Command | None:
        """Turn the letter, take it, or take the last one back."""
        choice = self.choices[self._turn]
        if button is Button.LEFT:
            self._turn = (self._turn - 1) % len(self.choices)
        elif button is Button.RIGHT:
            self._turn = (self._turn + 1) % len(self.choices)
        elif button is Button.BACK or choice == DELETE:
            return self._delete(desk)
        elif choice == END:
            return self._done(self.text)
        else:
            self.text += choice
            self._offer()
        return None

    def draw(self, desk: Desk, seconds: float, below: Dots) -> Dots:
        """The text so far, the letter that turns, and what the buttons do."""
        dots = Dots()
        layout.title(dots, self._title, seconds=seconds)
        choice = self.choices[self._turn]
        does = {END: "DONE", DELETE: "DELETE"}.get(choice, "TAKE")
        help_ = ("◄ ►: TURN", f"{desk.key('create')}: {does}")
        if self._most <= LARGE_MOST:
            self._draw_places(dots, 4, 8, 2, seconds)
            for line, y in zip(help_, (11, 22), strict=True):
                room = WIDTH - HELP_X - (END_WIDTH if choice == END else 0)
                left = WIDTH - min(NORMAL.width(line), room)
                layout.marquee(dots, line, y, left, WIDTH, NORMAL, seconds, "left", 190)
        else:
            self._draw_places(dots, (WIDTH - 28 - self._most * 11) // 2, layout.MIDDLE_Y, 1, seconds)
            layout.foot(dots, ("   ".join(help_),), seconds)
        return dots

    def _draw_places(self, dots: Dots, left: int, y: int, scale: int, seconds: float) -> None:
        """A place for every letter, each underlined, and END behind them."""
        choice = self.choices[self._turn]
        count, step = len(self.text), scale * 9 + 2
        for place in range(self._most):
            x = left + place * step
            here = choice if place == count and choice not in (END, DELETE) else ""
            letter = self.text[place] if place < count else here
            light = FULL if here or choice == END else layout.HALF
            dots.text(letter, x + step // 2 - 1, y, BOLD, "center", light, scale)
            dots.box(x, y + 11 * scale + 1, step - 2, 1, FULL if place == count else layout.HALF)
        if choice == END and layout.blinks(seconds):
            dots.text(END, left + count * step + 2, y + 11 * scale - 11, BOLD)
        if choice == DELETE and layout.blinks(seconds):
            x = left + (count - 1) * step
            dots.invert(x - 1, y, step, 11 * scale)

    def signature(self) -> Hashable:
        """How many letters there are, and which one turns."""
        return len(self.text), self._turn

    def _delete(self, desk: Desk) -> Command | None:
        if not self.text:
            return self._give_up(desk)
        last = self.text[-1]
        self.text = self.text[:-1]
        self._turn = self.choices.index(last) if last in self.choices else 0
        return None

    def _give_up(self, desk: Desk) -> Command | None:
        desk.back()
        return None

    def _offer(self) -> None:
        """Begin with the letter that was entered last time, or with END where nothing can follow."""
        place = len(self.text)
        offered = self._offered[place] if place < len(self._offered) else ""
        self._turn = self.choices.index(offered) if offered and offered in self.choices else 0


class InitialsPage(LettersPage):
    """Whose score is it?

    Args:
        score: The score.
        rank: Its place in the table, from 1.
        start: The initials that were entered last.
        done: What to do with the initials.
    """

    def __init__(self, score: int, rank: int, start: str, done: Callable[[str], Command | None]) -> None:
        super().__init__("initials", f"NO. {rank} WITH {score:,}", LETTERS, 3, done, start=start)

    def _give_up(self, desk: Desk) -> Command | None:
        # A score is never lost: who leaves at once gets the initials of last time.
        return self._done(self._offered)
