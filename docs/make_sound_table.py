"""Write the table of docs/sound.md: `python docs/make_sound_table.py`.

`--picture FILE.png` also draws what all sounds look like; that needs matplotlib:
`.venv/bin/pip install '.[bench]'`.
"""

from __future__ import annotations

import argparse
import math
import re
from pathlib import Path

import numpy as np

from silverball.app.sound.bank import FULL, RECIPES, Key, make_bank
from silverball.app.sound.levels import loudness
from silverball.app.sound.rolling import ROLL_SPEEDS
from silverball.app.sound.synth import RATE, Wave

PAGE = Path(__file__).with_name("sound.md")
BEGIN, END = "<!-- table: python docs/make_sound_table.py -->\n", "<!-- end of table -->\n"


def rows() -> list[tuple[str, Wave, str]]:
    """Name, wave and description of every sound; of layers the first and the last."""
    bank = make_bank()
    found = []
    for name, recipe in RECIPES.items():
        words = str(recipe.make.__doc__).partition(":")[0].partition(".")[0].strip()
        for layer in sorted({0, recipe.layers - 1}):
            key = Key(name, layer)
            found.append((f"{name} {layer}" if recipe.layers > 1 else name, bank.waves[key] / FULL, words))
    for number in (0, 3, len(ROLL_SPEEDS) - 1):
        found.append((f"rolling at {ROLL_SPEEDS[number]:.1f} u/s", bank.loops[number] / FULL, "A ball rolls"))
    return found


def line(name: str, wave: Wave, words: str) -> str:
    """One line of the table."""
    power = np.abs(np.fft.rfft(wave)) ** 2
    pitches = np.fft.rfftfreq(len(wave), 1.0 / RATE)
    peak = float(np.abs(wave).max())
    moment = wave[:4800] if len(wave) > 4800 else wave
    crest = 20.0 * math.log10(peak / math.sqrt(float(np.mean(moment**2))))
    middle = float(np.sum(pitches * power) / np.sum(power))
    high = 100.0 * float(power[pitches > 6000.0].sum() / power.sum())
    high_words = f"{high:.2f}" if high >= 0.01 else "< 0.01"
    cells = (
        name,
        words,
        f"{len(wave) / RATE:.2f}",
        f"{loudness(wave):.1f}",
        f"{crest:.0f}",
        f"{middle:.0f}",
        high_words,
    )
    return f"| {' | '.join(cells)} |"


def table() -> str:
    """The whole table."""
    head = (
        "| sound | what it is | length [s] | loudness [dB] | crest [dB] | middle [Hz] | over 6 kHz [%] |\n"
        "| --- | --- | --- | --- | --- | --- | --- |\n"
    )
    return head + "".join(f"{line(*row)}\n" for row in rows())


def draw(path: Path) -> None:
    """Spectrograms of all sounds."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot

    sounds = rows()
    figure, axes = pyplot.subplots(-(-len(sounds) // 6), 6, figsize=(18, 16), layout="constrained")
    for axis, (name, wave, _) in zip(axes.flat, sounds, strict=False):
        noise = 1e-6 * np.random.default_rng(0).standard_normal(len(wave) + 2048)
        padded = np.concatenate([wave, np.zeros(2048)])
        axis.specgram(padded + noise, NFFT=1024, Fs=RATE, noverlap=896, vmin=-140, vmax=-50, cmap="magma")
        shown = np.arange(len(wave)) / RATE
        over = axis.twinx()
        over.plot(shown, wave, color="white", linewidth=0.4)
        over.set(ylim=(-3.0, 0.6), yticks=[])
        axis.set(title=name, ylim=(0, 8000))
    for axis in axes.flat[len(sounds) :]:
        axis.set_axis_off()
    figure.savefig(path, dpi=70)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--picture", type=Path, help="also draw spectrograms into this PNG")
    chosen = parser.parse_args()
    page = PAGE.read_text(encoding="utf-8")
    between = re.compile(f"{re.escape(BEGIN)}.*{re.escape(END)}", re.DOTALL)
    PAGE.write_text(between.sub(lambda _: BEGIN + table() + END, page), encoding="utf-8")
    print(f"wrote {PAGE}")
    if chosen.picture:
        draw(chosen.picture)
        print(f"wrote {chosen.picture}")
