"""The text of a page: its modules as one script, its policy, and what is escaped."""

from __future__ import annotations

import base64
import hashlib
import re

import pytest

from silverball.web import bundle
from silverball.web.bundle import FOLDER, fill, loader, page_text, script, source_hash

PAGE = page_text("A <b> & c", 'say "x"', "rgb(1 2 3)", {"meta": "AAAA"})


def test_the_policy_allows_this_script_and_this_style_and_nothing_else():
    policy = re.search(r'http-equiv="Content-Security-Policy" content="([^"]*)"', PAGE)[1]
    for tag in ("script", "style"):
        text = re.search(rf"<{tag}>(.*?)</{tag}>", PAGE, re.DOTALL)[1]
        digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        assert f"{tag}-src 'sha256-{digest}'" in policy
    assert f"'{source_hash(script())}'" in policy, "that of the script which the loader puts into the page"
    assert policy.startswith("default-src 'none'; ")
    assert "unsafe-inline" not in policy
    assert "http" not in policy


def test_texts_are_escaped():
    assert "<title>A &lt;b&gt; &amp; c</title>" in PAGE
    assert 'aria-label="say &quot;x&quot;"' in PAGE


def test_nothing_of_a_page_has_an_address():
    assert re.findall(r"(?:src|href|url)\s*[=(]\s*[\"']?\w+:", PAGE) == []
    for text in (PAGE, script()):
        assert not re.search(r"\b(fetch|XMLHttpRequest|importScripts|WebSocket|eval)\s*\(", text)


def test_what_is_put_in_a_place_is_not_looked_at_again():
    assert fill("%A% %B%", {"A": "%B%", "B": "2"}) == "%B% 2"


def test_every_module_is_in_the_script_after_those_that_it_imports():
    order = re.findall(r'^modules\["([\w-]+\.js)"\]', script(), re.MULTILINE)
    assert re.findall(r'^modules\["([\w-]+\.js)"\]', loader(), re.MULTILINE) == [bundle.UNPACK]
    order = [bundle.UNPACK, *order]
    assert sorted([*order, "load_script.js"]) == sorted(path.name for path in FOLDER.glob("*.js"))
    for position, name in enumerate(order):
        for _, other in bundle.IMPORT.findall(bundle.read(name)):
            assert other in order[:position]
    assert "import " not in re.sub(r"//.*", "", script())
    assert "export " not in re.sub(r"//.*", "", script())


def test_what_a_module_imports_is_exported_there():
    for path in FOLDER.glob("*.js"):
        for names, other in bundle.IMPORT.findall(path.read_text(encoding="utf-8")):
            exported = {found[1] for found in bundle.EXPORT.findall(bundle.read(other))}
            assert set(re.findall(r"\w+", names)) <= exported, f"{path.name} imports from {other}"


def test_modules_that_import_each_other_are_refused(monkeypatch):
    texts = {"main.js": 'import { A } from "./a.js";\n', "a.js": 'import { B } from "./main.js";\n'}
    monkeypatch.setattr(bundle, "read", texts.__getitem__)
    with pytest.raises(ValueError, match=r"main\.js → a\.js → main\.js"):
        bundle.script.__wrapped__()


def test_a_script_that_would_end_itself_is_refused(monkeypatch):
    monkeypatch.setattr(bundle, "read", {"main.js": 'const x = "</SCRIPT>";'}.__getitem__)
    with pytest.raises(ValueError, match="</script"):
        bundle.script.__wrapped__()
