"""Remapping keys and gamepad buttons, without silently losing one."""

import pytest
from hypothesis import given, strategies as st

from reading import reads
from silverball.app.bindings import (
    ACTIONS,
    action_by_key,
    action_by_name,
    action_by_pad,
    display_name,
    keys_for,
    pad_buttons_for,
    with_assignment,
)
from silverball.app.menus import Button, JoystickEntry, Menus, TableEntry
from silverball.app.settings import PlayerSettings, Settings
from silverball.drawing.dotmatrix.fonts import BOLD

LEFT, RIGHT, START, BACK = Button
BINDINGS = {binding.action: binding for binding in ACTIONS}


def press(menus: Menus, *buttons: Button):
    last = None
    for button in buttons:
        last = menus.press(button) or last
        menus.release(button)
    return last


def choose(menus: Menus, label: str) -> None:
    for _ in range(30):
        if reads(menus.draw(LATER), label, (BOLD,)):
            press(menus, START)
            return
        press(menus, RIGHT)
    raise AssertionError(f"{label} is not on the page {menus.page}")


LATER = 0.4  # [s] when nothing slides any more


def asking(label: str, what: str = "NEW KEY", kind: str = "KEYS", settings: Settings | None = None) -> Menus:
    """Menus that wait for a key of an action."""
    menus = Menus(
        PlayerSettings(settings or Settings()), (TableEntry("classic", "Classic"),), lambda table, mode: ()
    )
    for item in ("SETTINGS", kind, label, what):
        choose(menus, item)
    assert menus.page == "capture"
    return menus


def test_a_free_key_is_taken_at_once():
    menus = asking("NUDGE LEFT")
    assert menus.wants_key
    assert not menus.wants_pad
    menus.capture("q")
    assert menus.context.settings.current == Settings(keys={"jitter": ("q",)})
    assert not menus.wants_key


def test_one_more_key_joins_those_that_are_there():
    menus = asking("LEFT PADDLE", "ONE MORE")
    menus.capture("q")
    assert keys_for(menus.context.settings.current, BINDINGS["left"]) == ("a", "left", "left shift", "q")


def test_a_gamepad_button_is_asked_for_like_a_key():
    menus = asking("NUDGE LEFT", "NEW BUTTON", "GAMEPAD")
    assert menus.wants_pad
    menus.capture("rightstick")
    assert menus.context.settings.current.pad == {"jitter": ("rightstick",)}
    assert menus.context.settings.current.keys == {}


def test_a_key_that_is_used_is_named_with_its_action_and_taken_only_if_meant():
    menus = asking("NUDGE LEFT")
    assert menus.capture("p") is None
    assert menus.page == "conflict"
    dots = menus.draw(LATER)
    assert reads(dots, "P FOR NUDGE LEFT?")
    assert reads(dots, "P IS PAUSE NOW")
    assert menus.context.settings.current == Settings()
    choose(menus, "TAKE IT")
    assert action_by_key(menus.context.settings.current)["p"] == "jitter"
    assert keys_for(menus.context.settings.current, BINDINGS["pause"]) == ()


def test_a_conflict_can_be_left_or_answered_with_another_key():
    menus = asking("NUDGE LEFT")
    menus.capture("p")
    choose(menus, "LEAVE IT")
    assert menus.context.settings.current == Settings()
    assert menus.page == "keys of an action"
    menus = asking("NUDGE LEFT")
    menus.capture("p")
    choose(menus, "OTHER KEY")
    assert menus.wants_key
    menus.capture("q")
    assert keys_for(menus.context.settings.current, BINDINGS["jitter"]) == ("q",)


def test_the_last_key_of_a_needed_action_is_refused_in_words():
    menus = asking("NUDGE LEFT")
    assert menus.capture("space") is None
    assert menus.wants_key
    frames = [menus.draw(LATER + tick / 5) for tick in range(40)]
    assert any(reads(dots, "SPACE IS THE ONLY") for dots in frames)
    assert any(reads(dots, "OF NEW BALL") for dots in frames)
    assert menus.context.settings.current == Settings()


def test_one_of_several_keys_of_a_needed_action_can_be_taken():
    menus = asking("NUDGE LEFT")
    menus.capture("a")
    choose(menus, "TAKE IT")
    assert keys_for(menus.context.settings.current, BINDINGS["left"]) == ("left", "left shift")
    assert action_by_key(menus.context.settings.current)["a"] == "jitter"


def test_esc_and_buttons_end_the_waiting_without_a_change():
    for end in (lambda menus: menus.capture("escape"), *(lambda menus, b=b: menus.press(b) for b in Button)):
        menus = asking("NUDGE LEFT")
        assert end(menus) is None
        assert menus.page == "keys of an action"
        assert menus.context.settings.current == Settings()


def test_waiting_ends_by_itself():
    menus = asking("NUDGE LEFT")
    menus.tick(1.0)
    menus.tick(5.0)
    assert menus.wants_key
    menus.tick(10.0)
    assert menus.page == "keys of an action"


def test_a_key_without_a_name_is_answered_in_words():
    menus = asking("NUDGE LEFT")
    assert menus.capture("") is None
    assert reads(menus.draw(LATER), "THAT KEY HAS NO NAME")


def test_reset_brings_the_defaults_back_for_one_action_and_for_all():
    changed = Settings(keys={"jitter": ("q",), "mute": ("w",)}, pad={"jitter": ("x",)})
    menus = Menus(PlayerSettings(changed), (), lambda table, mode: ())
    for item in ("SETTINGS", "KEYS", "NUDGE LEFT", "RESET"):
        choose(menus, item)
    assert menus.context.settings.current.keys == {"mute": ("w",)}
    press(menus, BACK)
    menus.tick(9.0)
    for _ in range(30):
        if reads(menus.draw(9.4), "RESET ALL", (BOLD,)):
            break
        press(menus, RIGHT)
    press(menus, START)
    assert menus.context.settings.current.keys == {}
    assert menus.context.settings.current.pad == {"jitter": ("x",)}


def test_resetting_an_action_takes_its_keys_back_from_others_but_never_the_last_one():
    taken = with_assignment(Settings(), ACTIONS, "keys", "create", ("z",))
    menus = Menus(PlayerSettings(taken), (), lambda table, mode: ())
    for item in ("SETTINGS", "KEYS", "NUDGE LEFT", "RESET"):
        choose(menus, item)
    assert menus.context.settings.current == taken
    assert reads(menus.draw(0.0), "NEW BALL NEEDS Z") or reads(menus.draw(0.7), "NEW BALL NEEDS Z")


def test_the_name_of_the_start_key_is_on_the_pages():
    menus = Menus(PlayerSettings(Settings(keys={"create": ("return",)})), (), lambda table, mode: ())
    assert any(reads(menus.draw(tick / 2), "RETURN: CHOOSE") for tick in range(20))


@pytest.mark.parametrize("kind", ["keys", "pad"])
def test_no_default_belongs_to_two_actions(kind):
    names = [name for line in ACTIONS for name in line.defaults(kind)]
    assert len(names) == len(set(names))


NAMES = st.sampled_from(["a", "d", "z", "p", "space", "q", "left", "f1", "x"])


@given(
    steps=st.lists(
        st.tuples(
            st.sampled_from([line.action for line in ACTIONS]), st.lists(NAMES, max_size=3, unique=True)
        )
    )
)
def test_whatever_is_assigned_each_key_has_one_action_and_settings_hold_only_differences(steps):
    settings = Settings()
    for action, names in steps:
        settings = with_assignment(settings, ACTIONS, "keys", action, names)
        table = action_by_key(settings)
        assert all(table[name] == action for name in names)
        assert keys_for(settings, BINDINGS[action]) == tuple(names)
        every = [name for line in ACTIONS for name in keys_for(settings, line)]
        assert len(every) == len(set(every))
        assert all(
            settings.keys[line.action] != line.keys for line in ACTIONS if line.action in settings.keys
        )


def test_settings_from_elsewhere_that_give_a_key_twice_are_read_in_one_way():
    settings = Settings(keys={"jitter": ("p",)}, pad={"jitter": ("a",)})
    assert action_by_key(settings)["p"] == "jitter"
    assert action_by_pad(settings)["a"] == "jitter"
    assert pad_buttons_for(settings, BINDINGS["create"]) == ("a",)


def test_a_button_of_a_joystick_is_kept_for_its_make_and_leaves_gamepads_as_they_were():
    menus = asking("NUDGE LEFT", "NEW BUTTON", "GAMEPAD")
    menus.capture("button 7", "a guid")
    menus.context.joysticks = (JoystickEntry("a guid", "Cabinet", 12),)
    assert menus.page == "conflict"
    assert menus.context.settings.current == Settings()
    choose(menus, "TAKE IT")
    assert action_by_name(menus.context.settings.current, "a guid")["button 7"] == "jitter"
    assert action_by_name(menus.context.settings.current, "another guid")["button 7"] == "left"
    assert pad_buttons_for(menus.context.settings.current, BINDINGS["jitter"]) == BINDINGS["jitter"].pad
    choose(menus, "RESET")
    assert "button 7" not in action_by_name(menus.context.settings.current, "a guid")
    press(menus, BACK)
    choose(menus, "RESET ALL")
    assert menus.context.settings.current == Settings()


def test_pages_write_what_stands_on_the_keys_of_the_layout():
    menus = Menus(PlayerSettings(Settings()), (), lambda table, mode: ())
    menus.context.key_labels = {"z": "я", ".": ":"}
    for item in ("SETTINGS", "KEYS", "NUDGE LEFT"):
        choose(menus, item)
    assert menus.context.key_label("jitter") == "Я"
    assert menus.context.key_label("faster") == "COLON"
    choose(menus, "NEW KEY")
    menus.capture("p")
    choose(menus, "TAKE IT")
    assert menus.context.settings.current.keys == {"jitter": ("p",), "pause": ()}


def test_names_of_keys_are_written_short():
    assert display_name("left shift") == "L SHIFT"
    assert display_name(",") == "COMMA"
    assert display_name("q") == "Q"
