// Animations of the score display, each a function of the time since it began. The same as
// drawing/dotmatrix/animations.py.

import { FULL, HEIGHT, WIDTH } from "./dots.js";
import { round } from "./poses.js";

const GOLDEN = 0.6180339887, BALL_HALF = 4;
const BALL = [
  "...+++...", ".+#####+.", ".##@@###.", "+#@@@###+", "+##@####+", "+#######+", ".#####++.", ".+###+++.", "...+++...",
].map((row) => [...row].map((dot) => 85 * ".+#@".indexOf(dot)));

function drawBall(dots, x, y) {
  const left = round(x) - BALL_HALF, top = round(y) - BALL_HALF;
  BALL.forEach((row, down) => row.forEach((level, across) => level && dots.dot(left + across, top + down, level)));
}

export function burst(dots, at, x = WIDTH / 2, y = HEIGHT / 2, rays = 36) {
  const light = 1 - at / 0.7;
  for (let ray = 0; ray < rays; ray++) {
    const angle = (2 * Math.PI * ray) / rays, speed = 200 * (0.5 + 0.6 * ((ray * GOLDEN) % 1));
    for (let step = 0; step < 8; step++) {
      const away = speed * (at - 0.012 * step);
      if (away <= 3 || light <= 0) continue;
      const across = round(x + away * Math.cos(angle)), down = round(y + 0.7 * away * Math.sin(angle));
      dots.dot(across, down, round(FULL * light * (1 - 0.11 * step)));
    }
  }
}

export function ring(dots, at, x = WIDTH / 2, y = HEIGHT / 2, speed = 110) {
  const strength = FULL * Math.max(1 - 0.6 * at, 0);
  for (let row = 0; row < HEIGHT; row++) for (let column = 0; column < WIDTH; column++) {
    const away = Math.abs(Math.hypot(column - x, row - y) - speed * at);
    dots.raise(column, row, Math.trunc(Math.min(Math.max(1.6 - away, 0), 1) * strength));
  }
}

export function fireworks(dots, at, top = 0, bottom = HEIGHT) {
  for (let rocket = 0; rocket < 8; rocket++) {
    const since = at - 0.3 * rocket;
    if (since < 0 || since >= 1.3) continue;
    const x = 14 + 132 * ((0.31 + rocket * GOLDEN) % 1), goal = top + 4 + 7 * ((rocket * GOLDEN * 3) % 1);
    if (since < 0.3) {
      const y = round(bottom + (goal - bottom) * (since / 0.3));
      dots.line(round(x), y, round(x), y + 2, 150);
    } else {
      sparks(dots, since - 0.3, x, goal, top, bottom);
    }
  }
}

function sparks(dots, age, x, goal, top, bottom) {
  for (let spark = 0; spark < 18; spark++) {
    const angle = (2 * Math.PI * spark) / 18, speed = 14 + 14 * ((spark * GOLDEN) % 1);
    const across = round(x + 1.6 * speed * age * Math.cos(angle));
    const down = round(goal + speed * age * Math.sin(angle) + 14 * age * age);
    if (top <= down && down < bottom) dots.dot(across, down, round(FULL * (1 - age)));
  }
}

export function twoBalls(dots, at) {
  const meet = 0.35, away = at < meet ? 4.5 + 90 * (1 - at / meet) : 4.5 + 160 * (at - meet);
  if (at >= meet) {
    ring(dots, at - meet);
    if (away > 24) dots.text("×2", WIDTH / 2, 5, "bold", "center", FULL, 2);
  }
  drawBall(dots, WIDTH / 2 - away, HEIGHT / 2);
  drawBall(dots, WIDTH / 2 + away, HEIGHT / 2);
}

export function savedBall(dots, at) {
  const low = 0.32;
  for (const side of [-1, 1]) for (let row = 0; row < 3; row++) {
    dots.line(80 + side * 34, 22 + row, 80 + side * 13, 28 + (row >> 1), 170);
  }
  const y = at < low ? -5 + 43 * (at / low) ** 2 : 38 - 110 * (at - low);
  for (let row = Math.max(round(y) + 5, 0); at >= low && row < HEIGHT; row++) {
    const light = FULL - 12 * (row - round(y));
    if (light > 30) dots.line(78, row, 82, row, light);
  }
  drawBall(dots, WIDTH / 2, y);
  if (at <= low) return;
  dots.text("BALL", 4, 10, "bold");
  dots.text("SAVED", WIDTH - 3, 10, "bold", "right");
}

export function fallingBall(dots, at) {
  const y = 60 * at + 90 * at * at, low = round(y);
  for (let row = Math.max(low - 14, 0); row < Math.min(Math.max(low, 0), HEIGHT); row++) {
    dots.line(76, row, 84, row, Math.max(10 * (row - low + 14), 0));
  }
  drawBall(dots, WIDTH / 2, y);
}

export function tilt(dots, at) {
  const shake = round(2.5 * Math.sin(40 * at) * Math.max(1 - at, 0.25));
  let x = Math.floor((WIDTH - 2 * dots.width("bold", "TILT")) / 2);
  [..."TILT"].forEach((letter, number) => {
    const lean = round(1.5 * Math.sin(23 * at + 1.7 * number));
    x += dots.text(letter, x + shake, 5 + lean, "bold", "left", FULL, 2) + 4;
  });
  stripes(dots);
  if (at % 0.4 < 0.2) dots.invert();
}

/** Warning stripes on both sides; they brighten what is there. */
function stripes(dots) {
  const before = dots.levels.slice();
  for (let stripe = 0; stripe < 34; stripe += 6) {
    for (const [start, slope] of [[stripe, 8], [WIDTH - 2 - stripe, -8]]) {
      dots.line(start, 0, start - slope, HEIGHT - 1, 110);
      dots.line(start + 1, 0, start + 1 - slope, HEIGHT - 1, 110);
    }
  }
  before.forEach((level, at) => {
    dots.levels[at] = Math.max(dots.levels[at], level);
  });
}

export function shakingText(dots, at, text, y) {
  const shift = round(2 * Math.sin(55 * at) * Math.max(1 - at, 0));
  dots.text(text, WIDTH / 2 + shift, y, "bold", "center");
}

export function growingText(dots, at, text, y) {
  const half = round((Math.min(at / 0.15, 1) * WIDTH) / 2), light = at % 0.2 < 0.12 || at > 0.6 ? FULL : 120;
  const font = dots.width("bold", text) <= WIDTH ? "bold" : "normal";
  dots.text(text, WIDTH / 2, y, font, "center", light, 1, [WIDTH / 2 - half, WIDTH / 2 + half]);
}
