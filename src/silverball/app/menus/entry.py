"""Pages for initials and numbers: turn letters with the paddles and take them with Space, or type them.

END follows the last letter; "◄" among the letters deletes one. Keys that are paddle buttons and also letters,
A and D, turn letters until another letter or backspace is typed; then they type like all others, until a
button without a letter (an arrow, Shift, a gamepad button) turns again.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Callable, Hashable

from silverball.app.bindings import keys_for
from silverball.app.menus import page_layout
from silverball.app.menus.commands import Button, Command
from silverball.app.menus.context import MenuContext, Page
from silverball.app.menus.listing import Listing, Row
from silverball.drawing.dotmatrix.canvas import FULL, WIDTH, Dots
from silverball.drawing.dotmatrix.fonts import BOLD, NORMAL

DELETE, END = "◄", "END"
LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.- "
CELLS = {DELETE: "DEL", " ": "SPACE"}  # what cells of a grid say for these letters
COLUMNS = 10  # cells of that grid
BACKSPACE = "backspace"
SIGN_TIMEOUT = 25.0  # [s] without a button, after which a score gets the offered initials
HELP_TURN = 2.5  # [s] for each help text
MAX_LARGE = 3  # letters that are drawn in double size, with the help beside them
HELP_X, END_WIDTH = 68, 29  # [dot] where that help may begin, and how much of it END covers


class LettersPage(Page):
    """A page on which a text is entered letter by letter.

    Args:
        name: Identifier of the page.
        title: Text above the letters.
        letters: The letters to choose from.
        max_length: Greatest length of the text.
        done: Callback that receives the text.
        min_length: Least length of the text; None: `max_length`.
        offered: Text whose letters are preselected.
    """

    def __init__(
        self,
        name: str,
        title: str,
        letters: str,
        max_length: int,
        done: Callable[[str], Command | None],
        min_length: int | None = None,
        offered: str = "",
    ) -> None:
        self.name = name
        self._title = title
        self._letters = letters
        self._max_length = max_length
        self._min_length = max_length if min_length is None else min_length
        self._done = done
        self._offered = offered
        self.text = ""
        self._turn = 0
        self._is_typed = False  # whether keys that are paddle buttons type letters
        self._offer()

    @property
    def choices(self) -> tuple[str, ...]:
        """The letters and commands that the paddles cycle through at the current place."""
        letters = tuple(self._letters) if len(self.text) < self._max_length else ()
        end = (END,) if len(self.text) >= self._min_length else ()
        return (*letters, *end, *((DELETE,) if self.text else ()))

    def press(self, button: Button, context: MenuContext) -> Command | None:
        """Turn the letter, take it, or delete the last one."""
        if self._is_typed and button is Button.START:
            text = self._completed()
            return self._done(text) if len(text) >= self._min_length else None
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
        """Handle a key that was pressed; return whether the text used it.

        Args:
            written: The character that the key types; empty if unknown.
            key: The name of the key.
            context: Shows a message if the character is not allowed here.
            is_button: Whether the key is also a button of the menus.
        """
        if key == BACKSPACE:
            self.text = self.text[:-1]
        elif " " in (written, key) or key == "space" or (is_button and not self._is_typed):
            return False
        elif letter := _letter_of(written, key, self._letters):
            self.text = (self.text + letter)[: self._max_length]
        elif written.isprintable() and written:
            context.show_message(
                "ONLY DIGITS" if self._letters.isdigit() else "ONLY LETTERS, DIGITS, . AND -"
            )
            return True
        else:
            return False
        self._is_typed = True
        self._turn = 0
        return True

    def draw(self, context: MenuContext, seconds: float, below: Dots) -> Dots:
        """Draw the text so far, the current letter, and what the buttons do."""
        dots = Dots()
        page_layout.title(dots, self._title, seconds=seconds)
        help_ = self._help(context, seconds)
        if self._max_length <= MAX_LARGE:
            self._draw_places(dots, 4, 8, 2, seconds)
            ends = not self._is_typed and self.choices[self._turn] == END
            for line, y in zip(help_, (11, 22), strict=True):
                available = WIDTH - HELP_X - (END_WIDTH if ends else 0)
                left = WIDTH - min(NORMAL.width(line), available)
                page_layout.marquee(dots, line, y, left, WIDTH, NORMAL, seconds, "left", 190)
        else:
            self._draw_places(
                dots, (WIDTH - 28 - self._max_length * 11) // 2, page_layout.MIDDLE_Y, 1, seconds
            )
            page_layout.foot(dots, ("   ".join(help_),), seconds)
        return dots

    def _help(self, context: MenuContext, seconds: float) -> tuple[str, str]:
        """Return two lines of help: what the buttons do, alternating with what the keyboard does."""
        start = context.key_label("create")
        is_first = seconds % (2 * HELP_TURN) < HELP_TURN
        if self._is_typed:
            return ("TYPE ON", f"{start}: DONE") if is_first else ("◄ ►: TURN", "BACKSP.: DEL")
        verb = {END: "DONE", DELETE: "DELETE"}.get(self.choices[self._turn], "TAKE")
        return (_turning_keys(context), f"{start}: {verb}") if is_first else ("ALL OTHER", "KEYS: TYPE")

    def _draw_places(self, dots: Dots, left: int, y: int, scale: int, seconds: float) -> None:
        """Draw an underlined place for every letter, and END after them."""
        choice = "" if self._is_typed else self.choices[self._turn]
        count, step = len(self.text), scale * 9 + 2
        for place in range(self._max_length):
            x = left + place * step
            current = choice if place == count and choice not in (END, DELETE) else ""
            letter = self.text[place] if place < count else current
            light = FULL if current or choice == END or self._is_typed else page_layout.HALF
            dots.text(letter, x + step // 2 - 1, y, BOLD, "center", light, scale)
            if place != count or not self._is_typed or page_layout.is_blink_on(seconds):
                dots.box(x, y + 11 * scale + 1, step - 2, 1, FULL if place == count else page_layout.HALF)
        if choice == END and page_layout.is_blink_on(seconds):
            dots.text(END, left + count * step + 2, y + 11 * scale - 11, BOLD)
        if choice == DELETE and page_layout.is_blink_on(seconds):
            x = left + (count - 1) * step
            dots.invert(x - 1, y, step, 11 * scale)

    def listing(self, context: MenuContext) -> Listing:
        """Return the text so far, and what can follow as cells of a grid."""
        places = [*self.text, *("_" * (self._max_length - len(self.text)))]
        index = -1 if self._is_typed else self._turn
        rows = tuple(Row(CELLS.get(choice, choice)) for choice in self.choices)
        hint = f"TYPE, OR CLICK, OR TURN WITH THE PADDLES. {context.key_label('create')}: TAKE"
        if self._is_typed:
            hint = f"BACKSPACE: DELETE. {context.key_label('create')} OR ENTER: DONE"
        return Listing(self._title, rows, index, hint, " ".join(places), columns=COLUMNS)

    def point(self, index: int, context: MenuContext) -> bool:
        """Select the letter under the mouse pointer; return whether it is another one."""
        if not 0 <= index < len(self.choices) or (index == self._turn and not self._is_typed):
            return False
        self._turn, self._is_typed = index, False
        return True

    def click(self, index: int, context: MenuContext, step: int) -> Command | None:
        """Take a letter, delete the last one, or end."""
        if not 0 <= index < len(self.choices):
            return None
        self.point(index, context)
        return self.press(Button.START, context)

    def signature(self) -> Hashable:
        """Return the number of letters, the current choice, and whether keys type."""
        return len(self.text), self._turn, self._is_typed

    def _completed(self) -> str:
        """Return the text that is used if nothing more is entered."""
        return self.text

    def _delete(self, context: MenuContext) -> Command | None:
        if not self.text:
            return self._leave(context)
        last = self.text[-1]
        self.text = self.text[:-1]
        self._turn = self.choices.index(last) if last in self.choices else 0
        return None

    def _leave(self, context: MenuContext) -> Command | None:
        context.back()
        return None

    def _offer(self) -> None:
        """Select the offered letter of the current place, or END where nothing can follow."""
        place = len(self.text)
        offered = self._offered[place] if place < len(self._offered) else ""
        self._turn = self.choices.index(offered) if offered and offered in self.choices else 0


class InitialsPage(LettersPage):
    """The initials of a new high score; after a timeout the offered ones are used.

    Args:
        score: The score.
        rank: Its rank in the high scores, from 1.
        offered: The initials entered last, preselected.
        done: Callback that receives the initials.
        player: Whose score it is in a match, from 1; 0 with one player.
    """

    allows_attract = False  # the score must get its initials first

    def __init__(
        self,
        score: int,
        rank: int,
        offered: str,
        done: Callable[[str], Command | None],
        player: int = 0,
    ) -> None:
        whose = f"PLAYER {player}: " if player else ""
        super().__init__("initials", f"{whose}NO. {rank} WITH {score:,}", LETTERS, 3, done, offered=offered)

    def _leave(self, context: MenuContext) -> Command | None:
        # A score is never lost: without an entry it gets the offered initials.
        return self._done(self._offered)

    def tick(self, context: MenuContext) -> Command | None:
        """Use the offered initials after a timeout, so that the next player cannot sign the score."""
        return self._done(self._completed()) if context.idle >= SIGN_TIMEOUT else None

    def _completed(self) -> str:
        if self._is_typed and self.text:
            return self.text.ljust(self._max_length)
        return self.text + self._offered[len(self.text) :]


def _letter_of(written: str, key: str, letters: str) -> str:
    """Return the letter that a key types, without accents, or else its name; empty if neither is a letter."""
    for text in (written, key.removeprefix("[").removesuffix("]")):  # keypad keys have names in brackets
        if len(text) == 1:
            letter = unicodedata.normalize("NFKD", text).upper()[:1]
            if letter in letters:
                return letter
    return ""


def _turning_keys(context: MenuContext) -> str:
    """Return a help text with the letter keys that turn."""
    sides = [binding for binding in context.actions if binding.action in ("left", "right")]
    letters = [
        context.button_label(key)
        for binding in sides
        for key in keys_for(context.settings.current, binding)
        if len(key) == 1
    ]
    return " ".join([*letters[:2], "◄ ►: TURN"])
