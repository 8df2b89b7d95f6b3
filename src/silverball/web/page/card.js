// The card beside the table: which modes run and what pays now, or how to score. The same as app/rule_words.py
// and app/backglass/card.py.

import { element } from "./elements.js";

const OFF = 0, BLINKING = 2, EVERY_MS = 200, MOST = 9, MOST_COUNTERS = 4, NONE = [];

function holds(offer, { lamps, counters, isRunning }) {
  const { unlit = NONE, lit = NONE, blinking = NONE, running = NONE, stopped = NONE, atLeast = NONE, below = NONE } = offer;
  return unlit.every((lamp) => lamps[lamp] === OFF) && lit.every((lamp) => lamps[lamp] !== OFF)
    && blinking.every((lamp) => lamps[lamp] === BLINKING)
    && running.every((mode) => isRunning[mode]) && stopped.every((mode) => !isRunning[mode])
    && atLeast.every(([counter, value]) => counters[counter] >= value)
    && below.every(([counter, value]) => counters[counter] < value);
}

function shotOf(offer, { lamps, counters }) {
  const { where, phrases = NONE, otherwise = "", isMission = false, award = 0, times = NONE } = offer;
  const points = times.reduce((product, [counter, add]) => product * (counters[counter] + add), award);
  const isBlinking = [...(offer.blinking ?? NONE), ...(offer.lit ?? NONE)].some((lamp) => lamps[lamp] === BLINKING);
  const words = points ? [...phrases, points.toLocaleString("en-US")] : phrases;
  return { where, what: words.join(" · ") || otherwise, isBlinking, isMission, points };
}

/**
 * What pays now beyond ordinary hits, what belongs to a mode first, then what blinks.
 * @param offers What web/card_words.py says.
 * @param standing The states of lamps, the values of counters, and whether each mode runs.
 */
export function shotsOf(offers, standing) {
  const found = new Map();
  for (const offer of offers) {
    if (!holds(offer, standing)) continue;
    const shot = shotOf(offer, standing), name = JSON.stringify([shot.where, shot.what]);
    if (!found.has(name)) found.set(name, shot);
  }
  return [...found.values()].sort((a, b) => b.isMission - a.isMission || b.isBlinking - a.isBlinking || b.points - a.points);
}

export class Card {
  /**
   * @param place The element that shows it.
   * @param words What web/card_words.py says.
   */
  constructor(place, words) {
    this.place = place;
    this.words = words;
    this.shown = "";
    this.readAt = -Infinity;
  }

  /** Show how a game stands; the page looks a few times a second. */
  show(game, now) {
    if (now - this.readAt < EVERY_MS) return;
    this.readAt = now;
    const lines = this.lines(game), text = JSON.stringify(lines);
    if (text === this.shown) return;
    this.shown = text;
    this.place.replaceChildren();
    for (const [title, words, kind] of lines) {
      const line = element(this.place, "p", { className: kind });
      element(line, "b", {}, title);
      element(line, "span", {}, words);
    }
  }

  /** The lines of the card: a title, words, and what kind of line it is. */
  lines(game) {
    const { judge, world } = game, { offers, modes, counters, rules } = this.words, standing = judge.standing();
    const running = judge.runningModes(world.tick, world.rate).filter(([name]) => modes.includes(name));
    const shots = shotsOf(offers, standing);
    if (!shots.length) return rules[judge.meta.mode].map(([title, text]) => [title, text, "rule"]);
    const changed = counters.flatMap(([name, begins], index) => (
      standing.counters[index] === undefined || standing.counters[index] === begins ? [] : [[name, standing.counters[index]]]));
    return [
      ...running.map(([name, left]) => [name, left === Infinity ? "" : `${Math.floor(left) + 1} s`, "mode"]),
      ...shots.slice(0, MOST).map(({ where, what, isBlinking, isMission }) => [where, what, isMission || isBlinking ? "now" : "lit"]),
      ...changed.slice(0, MOST_COUNTERS).map(([name, value]) => [name, value.toLocaleString("en-US"), "counter"]),
    ];
  }
}
