"""The text of a page: its template, its style, and all its modules as one script.

A page is a file without neighbours, so the modules of `page/` cannot import each other there. `script` writes
them one after the other, those first that others import: each becomes a function that returns its exports.
For that, an import is one line that names all it takes, and an export one name.

The script travels compressed, like everything else. The only one that a browser finds is `loader`, with the
module that unpacks; it puts the script into the page.

Nothing of a page is fetched, and its policy forbids it: scripts and styles are allowed by their hashes alone.
"""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Mapping
from functools import cache
from html import escape
from pathlib import Path

from silverball.web.pack import compress

FOLDER = Path(__file__).with_name("page")
MAIN, UNPACK = "main.js", "unpack.js"
IMPORT = re.compile(r'^import (\{[^}]*\}) from "\./([\w-]+\.js)";$', re.MULTILINE)
EXPORT = re.compile(r"^export ((?:async )?(?:function|class|const) (\w+))", re.MULTILINE)
PLACE = re.compile(r"%([A-Z]+)%")  # of something in a template


def page_text(title: str, label: str, room: str, blocks: Mapping[str, str]) -> str:
    """The text of a page.

    Args:
        title: Its title.
        label: What the picture shows, for those who cannot see it.
        room: The colour around the table, in CSS.
        blocks: Data as text, by name; the script reads them as `data-NAME`.
    """
    code, style = loader(), fill(read("style.css"), {"ROOM": room}).strip()
    policy = (
        f"default-src 'none'; script-src '{source_hash(code)}' '{source_hash(script())}' 'wasm-unsafe-eval'; "
        f"style-src '{source_hash(style)}'; base-uri 'none'; form-action 'none'"
    )
    data = "\n".join(
        f'<script type="application/octet-stream" id="data-{escape(name)}">{_plain_letters(text)}</script>'
        for name, text in {**blocks, "script": compress(script().encode())}.items()
    )
    places = {
        "POLICY": policy, "TITLE": escape(title), "LABEL": escape(label), "STYLE": style, "SCRIPT": code,
        "DATA": data,
    }  # fmt: skip
    return fill(read("page.html"), places)


def _plain_letters(text: str) -> str:
    """Data as it is: inside of a script nothing is unescaped, so it must contain nothing that ends one.

    Raises:
        ValueError: It does.
    """
    if "<" in text:
        raise ValueError("data of a page must not contain <")
    return text


def fill(template: str, places: Mapping[str, str]) -> str:
    """Put texts in the places of a template; what they contain is not looked at again."""
    return PLACE.sub(lambda place: places[place[1]], template)


@cache
def loader() -> str:
    """The script that unpacks the other one and puts it into the page."""
    return _checked(
        ['"use strict";\nconst modules = {};', _as_function(UNPACK), read("load_script.js").strip()]
    )


@cache
def script() -> str:
    """All modules as one script, but the one that unpacks."""
    order: list[str] = []
    _visit(MAIN, order, ())
    return _checked(['"use strict";', *(_as_function(name) for name in order if name != UNPACK)])


def _checked(parts: list[str]) -> str:
    code = "\n\n".join(parts)
    if "</script" in code.lower() or "<!--" in code:
        raise ValueError("a script must not contain what ends it in a page: </script or <!--")
    return code


def _as_function(name: str) -> str:
    """A module as a function that is called once."""
    text = IMPORT.sub(r'const \1 = modules["\2"];', read(name)).strip()
    names = ", ".join(found[1] for found in EXPORT.findall(text))
    body = EXPORT.sub(r"\1", text)
    return f'modules["{name}"] = (() => {{\n{body}\nreturn {{ {names} }};\n}})();'


def _visit(name: str, order: list[str], above: tuple[str, ...]) -> None:
    """Append a module after those that it imports."""
    if name in above:
        raise ValueError(f"modules import each other: {' → '.join((*above, name))}")
    if name in order:
        return
    for _, other in IMPORT.findall(read(name)):
        _visit(other, order, (*above, name))
    order.append(name)


@cache
def read(name: str) -> str:
    """The text of a file of the page."""
    return (FOLDER / name).read_text(encoding="utf-8")


def source_hash(text: str) -> str:
    """The hash of a script or a style, as a policy names it."""
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
