"""How are initials and numbers entered? The paddles turn a letter and Space takes it, or a keyboard types it.

Behind the last letter stands END; "◄" among the letters deletes one. Keys that are paddle buttons and bear a
letter, A and D, turn letters until any other letter has been typed, or backspace pressed; then they are
letters like all others, until a button that bears none (an arrow, Shift, a gamepad's) turns again.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Callable, Hashable

from silverball.app.bindings import keys_for
from silverball.app.menus import page_layout
from silverball.app.menus.commands import Button, Command
from silverball.app.menus.context import MenuContext, Page
from silverball.drawing.dotmatrix.canvas import FULL, WIDTH, Dots
from silverball.drawing.dotmatrix.fonts import BOLD, NORMAL

DELETE, END = "◄", "END"
LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.- "
BACKSPACE = "backspace"
SIGN_PATIENCE = 25.0  # [s] without a touch after which a score is signed as offered
HELP_TURN = 2.5  # [s] after which the help says the next thing
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
        self._is_typed = False  # whether keys that are paddle buttons too are letters
        self._offer()

    @property
    def choices(self) -> tuple[str, ...]:
        """What the paddles turn through at this place."""
        letters = tuple(self._letters) if len(self.text) < self._most else ()
        end = (END,) if len(self.text) >= self._least else ()
        return (*letters, *end, *((DELETE,) if self.text else ()))

    def press(self, button: Button, context: MenuContext) -> Command | None:
        """Turn the letter, take it, or take the last one back."""
        if self._is_typed and button is Button.START:
            text = self._completed()
            return self._done(text) if len(text) >= self._least else None
        if self._is_typed:
            self._is_typed = False
            self._offer()
        choice = self.choices[self._turn]
        if button is Button.LEFT:
            self._turn = (self._turn - 1) % len(self.choices)
        elif button is Button.RIGHT:
            self._turn = (self._turn + 1) % len(self.choices)
        elif button is Button.BACK or choice == DELETE:
            return self._delete(context)
        elif choice == END:
            return self._done(self.text)
        else:
            self.text += choice
            self._offer()
        return None

    def type(self, written: str, key: str, context: MenuContext, *, is_button: bool) -> bool:
        """A key was pressed; whether it was meant for the text.

        Args:
            written: What the key writes; empty if that is not known.
            key: The name of the key.
            context: Is told if this cannot be entered here.
            is_button: Whether it is a button of the menus as well.
        """
        if key == BACKSPACE:
            self.text = self.text[:-1]
        elif " " in (written, key) or key == "space" or (is_button and not self._is_typed):
            return False
        elif letter := _typed(written, key, self._letters):
            self.text = (self.text + letter)[: self._most]
        elif written.isprintable() and written:
            context.say("ONLY DIGITS" if self._letters.isdigit() else "ONLY LETTERS, DIGITS, . AND -")
            return True
        else:
            return False
        self._is_typed = True
        self._turn = 0
        return True

    def draw(self, context: MenuContext, seconds: float, below: Dots) -> Dots:
        """The text so far, the letter that turns, and what the buttons do."""
        dots = Dots()
        page_layout.title(dots, self._title, seconds=seconds)
        help_ = self._help(context, seconds)
        if self._most <= LARGE_MOST:
            self._draw_places(dots, 4, 8, 2, seconds)
            ends = not self._is_typed and self.choices[self._turn] == END
            for line, y in zip(help_, (11, 22), strict=True):
                room = WIDTH - HELP_X - (END_WIDTH if ends else 0)
                left = WIDTH - min(NORMAL.width(line), room)
                page_layout.marquee(dots, line, y, left, WIDTH, NORMAL, seconds, "left", 190)
        else:
            self._draw_places(dots, (WIDTH - 28 - self._most * 11) // 2, page_layout.MIDDLE_Y, 1, seconds)
            page_layout.foot(dots, ("   ".join(help_),), seconds)
        return dots

    def _help(self, context: MenuContext, seconds: float) -> tuple[str, str]:
        """What the buttons do, and in turn what the keys of a keyboard do."""
        start = context.key("create")
        is_first = seconds % (2 * HELP_TURN) < HELP_TURN
        if self._is_typed:
            return ("TYPE ON", f"{start}: DONE") if is_first else ("◄ ►: TURN", "BACKSP.: DEL")
        does = {END: "DONE", DELETE: "DELETE"}.get(self.choices[self._turn], "TAKE")
        return (_turning_keys(context), f"{start}: {does}") if is_first else ("ALL OTHER", "KEYS: TYPE")

    def _draw_places(self, dots: Dots, left: int, y: int, scale: int, seconds: float) -> None:
        """A place for every letter, each underlined, and END behind them."""
        choice = "" if self._is_typed else self.choices[self._turn]
        count, step = len(self.text), scale * 9 + 2
        for place in range(self._most):
            x = left + place * step
            here = choice if place == count and choice not in (END, DELETE) else ""
            letter = self.text[place] if place < count else here
            light = FULL if here or choice == END or self._is_typed else page_layout.HALF
            dots.text(letter, x + step // 2 - 1, y, BOLD, "center", light, scale)
            if place != count or not self._is_typed or page_layout.blinks(seconds):
                dots.box(x, y + 11 * scale + 1, step - 2, 1, FULL if place == count else page_layout.HALF)
        if choice == END and page_layout.blinks(seconds):
            dots.text(END, left + count * step + 2, y + 11 * scale - 11, BOLD)
        if choice == DELETE and page_layout.blinks(seconds):
            x = left + (count - 1) * step
            dots.invert(x - 1, y, step, 11 * scale)

    def signature(self) -> Hashable:
        """How many letters there are, and which one turns."""
        return len(self.text), self._turn, self._is_typed

    def _completed(self) -> str:
        """The text as it is to be taken if nothing more comes."""
        return self.text

    def _delete(self, context: MenuContext) -> Command | None:
        if not self.text:
            return self._give_up(context)
        last = self.text[-1]
        self.text = self.text[:-1]
        self._turn = self.choices.index(last) if last in self.choices else 0
        return None

    def _give_up(self, context: MenuContext) -> Command | None:
        context.back()
        return None

    def _offer(self) -> None:
        """Begin with the letter that was entered last time, or with END where nothing can follow."""
        place = len(self.text)
        offered = self._offered[place] if place < len(self._offered) else ""
        self._turn = self.choices.index(offered) if offered and offered in self.choices else 0


class InitialsPage(LettersPage):
    """Whose score is it? Where nobody says so, it is signed as offered.

    Args:
        score: The score.
        rank: Its place in the table, from 1.
        start: The initials that were entered last.
        done: What to do with the initials.
    """

    quiet = False  # the score is signed first, then the program may play

    def __init__(self, score: int, rank: int, start: str, done: Callable[[str], Command | None]) -> None:
        super().__init__("initials", f"NO. {rank} WITH {score:,}", LETTERS, 3, done, start=start)

    def _give_up(self, context: MenuContext) -> Command | None:
        # A score is never lost: who leaves at once gets the initials of last time.
        return self._done(self._offered)

    def tick(self, context: MenuContext) -> Command | None:
        """Whoever made the score may have gone; the next one must not sign it."""
        return self._done(self._completed()) if context.idle >= SIGN_PATIENCE else None

    def _completed(self) -> str:
        if self._is_typed and self.text:
            return self.text.ljust(self._most)
        return self.text + self._offered[len(self.text) :]


def _typed(written: str, key: str, letters: str) -> str:
    """The letter that a key means: what it writes, without accents, else what it is called; empty if none."""
    for text in (written, key.removeprefix("[").removesuffix("]")):  # in brackets those of the number pad
        if len(text) == 1:
            letter = unicodedata.normalize("NFKD", text).upper()[:1]
            if letter in letters:
                return letter
    return ""


def _turning_keys(context: MenuContext) -> str:
    """Which buttons turn, those that bear letters named."""
    sides = [line for line in context.actions if line.action in ("left", "right")]
    letters = [
        context.shown(key) for line in sides for key in keys_for(context.settings, line) if len(key) == 1
    ]
    return " ".join([*letters[:2], "◄ ►: TURN"])
