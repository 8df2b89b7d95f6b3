// The panel of the score display: dots behind dark glass. The same as drawing/dotmatrix/panel.py.

import { HEIGHT, WIDTH } from "./dots.js";

const RADIUS = 0.43, UNLIT = 0.075, BLOOM = 0.26, HOT = 0.42, GAMMA = 0.8, BITS = 5, LEAST_SPACING = 4;

/** Draws dots onto a canvas. */
export class DotPanel {
  /** @param panel What web/look.py says about the score panel. */
  constructor(panel) {
    const [, , width, height] = panel.area, edge = Math.max(Math.round(0.045 * height), 1);
    this.panel = panel;
    this.edge = edge;
    const inner = [Math.max(width - 4 * edge, 1), Math.max(height - 4 * edge, 1)];
    let spacing = Math.min(inner[0] / WIDTH, inner[1] / HEIGHT);
    if (Math.floor(spacing) >= Math.max(LEAST_SPACING, 0.95 * spacing)) spacing = Math.floor(spacing);
    this.shown = [Math.max(Math.round(WIDTH * spacing), 1), Math.max(Math.round(HEIGHT * spacing), 1)];
    const larger = Math.ceil(LEAST_SPACING / spacing);
    this.canvas = document.createElement("canvas");
    [this.canvas.width, this.canvas.height] = this.shown.map((size) => size * larger);
    this.context = this.canvas.getContext("2d", { alpha: false });
    this.image = this.context.createImageData(this.canvas.width, this.canvas.height);
    this.pixels = new Uint32Array(this.image.data.buffer);
    this.makeMask();
    this.makeColors(spacing < LEAST_SPACING);
    this.last = new Uint8Array(WIDTH * HEIGHT).fill(1);
  }

  /** How much light of its dot each pixel shows, 0 to 31. */
  makeMask() {
    const { width, height } = this.canvas, spacing = width / WIDTH;
    this.mask = new Uint8Array(width * height);
    for (let row = 0; row < height; row++) for (let column = 0; column < width; column++) {
      const x = (((column + 0.5) * WIDTH) / width) % 1, y = (((row + 0.5) * HEIGHT) / height) % 1;
      const away = Math.hypot(x - 0.5, y - 0.5);
      const edge = Math.min(Math.max((RADIUS - away) * spacing + 0.5, 0), 1);
      const dome = 1 - 0.35 * Math.min(away / RADIUS, 1) ** 2;
      this.mask[row * width + column] = Math.round(edge * dome * 31);
    }
  }

  /** The colours by brightness, glow and mask. */
  makeColors(isSmall) {
    const { dots, glass } = this.panel, count = 1 << BITS, last = count - 1;
    this.colors = new Uint32Array(count ** 3);
    for (let l = 0; l < count; l++) for (let g = 0; g < count; g++) for (let m = 0; m < count; m++) {
      const level = (l / last) ** GAMMA, glow = g / last, mask = isSmall ? (m / last) ** 0.5 : m / last;
      let color = 0xff000000;
      for (let channel = 0; channel < 3; channel++) {
        const tint = dots[channel] / 255;
        let lit = (UNLIT + (1 - UNLIT) * level) * tint;
        lit += (1 - lit) * HOT * (level * mask) ** 3 * (0.35 + 0.65 * tint);
        const ground = Math.max(glass[channel] / 255 + BLOOM * glow * tint, 0);
        const light = Math.min(ground * (1 - 0.5 * mask) + lit * mask, 1);
        color |= Math.round(255 * light) << (8 * channel);
      }
      this.colors[(l << (2 * BITS)) | (g << BITS) | m] = color >>> 0;
    }
  }

  /** Draw dots onto a canvas at the place of the panel. */
  draw(target, dots) {
    if (dots.levels.some((level, index) => level !== this.last[index])) {
      this.last.set(dots.levels);
      this.light(dots.levels);
    }
    const [left, top, width, height] = this.panel.area, [across, down] = this.shown, { edge } = this;
    this.frame(target, left, top, width, height, edge);
    target.drawImage(this.canvas, left + (width - across) / 2, top + (height - down) / 2, across, down);
  }

  frame(target, left, top, width, height, edge) {
    const rounding = height / 9, [outer, inner] = this.panel.edges;
    const css = ([red, green, blue]) => `rgb(${red} ${green} ${blue})`;
    target.fillStyle = css(this.panel.glass);
    target.beginPath();
    target.roundRect(left, top, width, height, rounding);
    target.fill();
    const rim = (color, inset, thickness) => {
      target.strokeStyle = css(color);
      target.lineWidth = thickness;
      target.beginPath();
      const at = inset + thickness / 2;
      target.roundRect(left + at, top + at, width - 2 * at, height - 2 * at, Math.max(rounding - inset, 1));
      target.stroke();
    };
    rim(outer, 0, Math.max(Math.floor(edge / 2), 1));
    rim(inner, edge, Math.max((2 / 3) * Math.floor(edge / 2), 1));
  }

  light(levels) {
    const { width, height } = this.canvas, glow = glowOf(levels), { mask, colors, pixels } = this;
    for (let row = 0; row < height; row++) {
      const line = Math.floor(((row + 0.5) * HEIGHT) / height) * WIDTH;
      for (let column = 0; column < width; column++) {
        const dot = line + Math.floor(((column + 0.5) * WIDTH) / width), at = row * width + column;
        pixels[at] = colors[((levels[dot] >> 3) << (2 * BITS)) | ((glow[dot] >> 3) << BITS) | mask[at]];
      }
    }
    this.context.putImageData(this.image, 0, 0);
  }
}

/** The light that reaches each dot from those around it: 1, 4, 6, 4, 1 sixteenths across, then down. */
function glowOf(levels) {
  const across = new Uint16Array(levels.length), both = new Uint16Array(levels.length), shares = [1, 4, 6, 4, 1];
  for (let row = 0; row < HEIGHT; row++) for (let column = 0; column < WIDTH; column++) {
    let sum = 0;
    for (let k = -2; k <= 2; k++) {
      if (column + k >= 0 && column + k < WIDTH) sum += shares[k + 2] * levels[row * WIDTH + column + k];
    }
    across[row * WIDTH + column] = sum >> 4;
  }
  for (let row = 0; row < HEIGHT; row++) for (let column = 0; column < WIDTH; column++) {
    let sum = 0;
    for (let k = -2; k <= 2; k++) {
      if (row + k >= 0 && row + k < HEIGHT) sum += shares[k + 2] * across[(row + k) * WIDTH + column];
    }
    both[row * WIDTH + column] = sum >> 4;
  }
  return both;
}
