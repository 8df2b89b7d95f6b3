// How bright the lamps are: by their states, or by the light show that runs. The same as drawing/lamp_levels.py
// and drawing/light_shows.py.

import { round } from "./poses.js";

const ON = 1, BLINKING = 2, BLINK_RATE = 2.5, BLINK_ON = 0.55, BLINK_EDGE = 0.09, FULL = 256;
const SHOW_FADE = 0.25, RISE = 0.07, WAVE_FADE = 0.15;

/** How bright a blinking lamp is at a time [s]. */
function blink(time) {
  const phase = (time * BLINK_RATE) % 1;
  return Math.min(Math.max(Math.min(phase, BLINK_ON - phase) / BLINK_EDGE, 0), 1);
}

/** How bright a wave makes a lamp at the place `at` of its order, 0 to 1. */
function waveLevel(wave, age, at) {
  const ends = wave.ends ?? Infinity, arrived = (age - wave.begins) * wave.rate - wave.spread * at;
  if (age < wave.begins || age >= ends || arrived < 0) return 0;
  const phase = arrived % 1, fall = Math.min(Math.max((wave.width - phase) / (wave.width - RISE), 0), 1);
  return wave.light * Math.min(phase / RISE, fall) * Math.min((ends - age) / WAVE_FADE, 1);
}

/** How bright a show makes each lamp at an age [s]. */
function showLevels(show, age, look) {
  if (show.repeats) age %= Math.max(...show.waves.map((wave) => wave.ends));
  return look.inserts.map((_, lamp) => show.waves.reduce(
    (level, wave) => Math.max(level, waveLevel(wave, age, look.places[wave.order][lamp])), 0));
}

function ownLevels(look, judge, time) {
  const states = judge ? judge.lamps : [];
  return look.inserts.map(({ lamp, begins }) => {
    const state = states.length ? states[lamp] : begins;
    return state === BLINKING ? blink(time) : state === ON ? 1 : 0;
  });
}

/**
 * The level of every light, 0 to 256.
 * @param look What web/look.py says of the lamps.
 * @param judge The rules of the game that is played; null: lamps are as when a game begins.
 * @param running The light show that runs, with its age [s]; null: there is none.
 */
export function lightLevels(look, judge, time, running = null) {
  let levels = ownLevels(look, judge, time);
  if (running) {
    const { show, age } = running, light = showLevels(show, age, look);
    const share = Math.min(Math.max(((show.seconds ?? Infinity) - age) / SHOW_FADE, 0), 1);
    levels = levels.map((own, lamp) => share * Math.max(light[lamp], show.under * own) + (1 - share) * own);
  }
  const colour = judge ? judge.modeColour(look.modeColors) : look.modeColors.plain;
  return look.lights.map(({ insert, color }) => (
    look.inserts[insert].isOfTheMode && color !== colour ? 0 : round(FULL * levels[insert])));
}
