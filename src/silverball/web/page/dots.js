// The dots of the score display, 160 × 32 levels of brightness, and how to draw with them. The same as
// drawing/dotmatrix/canvas.py.

import { round } from "./poses.js";

export const WIDTH = 160;
export const HEIGHT = 32;
export const FULL = 255;
const SIZES = ["huge", "bold", "normal", "tiny"];
const SHARES = { left: () => 0, center: (width) => Math.floor(width / 2), right: (width) => width };

/** A picture of dots. */
export class Dots {
  /** @param fonts What web/look.py says about the fonts. */
  constructor(fonts) {
    this.fonts = fonts;
    this.levels = new Uint8Array(WIDTH * HEIGHT);
  }

  clear() {
    this.levels.fill(0);
  }

  glyph(font, letter) {
    return font.glyphs[letter] ?? font.glyphs[letter.toUpperCase()] ?? font.box;
  }

  /** The width of a text in a font, given by its name. */
  width(name, text) {
    const font = this.fonts[name];
    let width = 0;
    for (const letter of text) width += this.glyph(font, letter)[0] + font.gap;
    return Math.max(width - font.gap, 0);
  }

  /** The name of the first font in which a text is no wider than `width`, or of the last one. */
  fitting(text, width = WIDTH, names = ["bold", "normal", "tiny"]) {
    return names.find((name) => this.width(name, text) <= width) ?? names[names.length - 1];
  }

  /**
   * Write one line; the dots between its strokes are unchanged.
   * @param x Its left end, its middle, or the first dot to the right of it, by `align`.
   * @param window The columns to write in: the first, and the one after the last.
   * @returns The width of the text.
   */
  text(text, x, y, name = "normal", align = "left", brightness = FULL, scale = 1, window = [0, WIDTH]) {
    const font = this.fonts[name], width = scale * this.width(name, text);
    let at = x - SHARES[align](width);
    for (const letter of text) {
      const [columns, rows] = this.glyph(font, letter);
      rows.forEach((bits, row) => {
        for (let column = 0; column < columns; column++) {
          if ((bits >> (columns - 1 - column)) & 1) this.block(at + scale * column, y + scale * row, scale, brightness, window);
        }
      });
      at += scale * (columns + font.gap);
    }
    return width;
  }

  /** Set a square of dots, within some columns. */
  block(x, y, size, brightness, window) {
    for (let down = y; down < y + size; down++) for (let across = x; across < x + size; across++) {
      if (across >= window[0] && across < window[1]) this.dot(across, down, brightness);
    }
  }

  /** Write an integer with commas, in the first font in which it fits; a smaller one is centred in the height of the first. */
  number(value, x, y, width = WIDTH, names = SIZES, align = "center", brightness = FULL) {
    const text = value.toLocaleString("en-US"), name = this.fitting(text, width, names);
    const lower = Math.floor((this.fonts[names[0]].height - this.fonts[name].height) / 2);
    this.text(text, x, y + lower, name, align, brightness);
  }

  dot(x, y, brightness = FULL) {
    if (x >= 0 && x < WIDTH && y >= 0 && y < HEIGHT) this.levels[y * WIDTH + x] = brightness;
  }

  /** Make a dot at least so bright. */
  raise(x, y, brightness) {
    if (x < 0 || x >= WIDTH || y < 0 || y >= HEIGHT) return;
    const at = y * WIDTH + x;
    this.levels[at] = Math.max(this.levels[at], brightness);
  }

  /** Draw a line of one dot's width, both ends included. */
  line(x0, y0, x1, y1, brightness = FULL) {
    const steps = Math.max(Math.abs(x1 - x0), Math.abs(y1 - y0));
    for (let step = 0; step <= steps; step++) {
      const across = steps ? step * ((x1 - x0) / steps) : 0, down = steps ? step * ((y1 - y0) / steps) : 0;
      this.dot(round(x0 + across), round(y0 + down), brightness);
    }
  }

  box(x, y, width, height, brightness = FULL) {
    for (let down = y; down < y + height; down++) for (let across = x; across < x + width; across++) {
      this.dot(across, down, brightness);
    }
  }

  invert() {
    this.levels.forEach((level, at) => {
      this.levels[at] = FULL - level;
    });
  }
}
