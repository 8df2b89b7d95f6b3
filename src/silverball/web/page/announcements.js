// What the score display announces of a game's events, and which announcement goes before another. The same as
// app/announcements.py.

import { burst, fallingBall, fireworks, growingText, ring, savedBall, shakingText, twoBalls } from "./dot_animations.js";
import { FULL, WIDTH } from "./dots.js";
import { round } from "./poses.js";

const MAX_DELAY = 3.5, LEAST_COMBO = 3, MILESTONE = 5, LEAST_AWARD = 1000, BONUS_COUNT_TIME = 1.2, BONUS_TIME = 2.2;
export const RANK = {
  BALL_LOST: 1, COMBO: 2, NOTICE: 3, MISSION: 4, MULTIBALL: 5, JACKPOT: 6, WARNING: 7, BALL_SAVED: 8, BONUS: 9,
  EXTRA_BALL: 10, HIGH_SCORE: 11,
};

function announcement(name, rank, text, length, full = null, fullTime = 0, drawText = growingText) {
  return { name, rank, text, length, full, fullTime, drawText, detail: "" };
}

function jackpot(dots, at) {
  burst(dots, at);
  ring(dots, at, undefined, undefined, 220);
  fireworks(dots, at + 0.3);
}

function highScore(dots, at) {
  fireworks(dots, at + 0.3);
  dots.box(14, 9, 132, 14, 0);
  growingText(dots, at, "HIGH SCORE!", 11);
}

export const HIGH_SCORE = announcement("high", RANK.HIGH_SCORE, "HIGH SCORE!", 3.2, highScore, 0.8);
const SAVED = announcement("saved", RANK.BALL_SAVED, "BALL SAVED", 2.2, savedBall, 0.85);
const DOUBLE = announcement("double", RANK.NOTICE, "DOUBLE POINTS", 2.2, twoBalls, 0.8);

/** The bonus at the end of a ball, which is counted out. */
export function bonus(points) {
  const count = (dots, at, text, y) => {
    const counted = round(Math.min(at / BONUS_COUNT_TIME, 1) * points);
    dots.text(`BONUS ${counted.toLocaleString("en-US")}`, WIDTH / 2, y, "bold", "center");
  };
  return announcement("bonus", RANK.BONUS, `BONUS ${points.toLocaleString("en-US")}`, BONUS_TIME, null, 0, count);
}

function combo(value) {
  const scene = (dots, at) => {
    ring(dots, at, undefined, undefined, 170);
    burst(dots, at);
    dots.text(`${value} HITS`, WIDTH / 2, 5, "bold", "center", FULL, 2);
  };
  const isMilestone = value % MILESTONE === 0;
  return announcement("combo", RANK.COMBO, `COMBO ${value}`, isMilestone ? 1.2 : 0.8, isMilestone ? scene : null, 0.55);
}

/**
 * How an event is announced; null if it is not.
 * @param event An event of a game, with the text or the mode that it is about.
 * @param words What web/display_words.py says of the table's rules.
 */
function announcementOf({ kind, value, text }, words) {
  const shown = words.shown[text] ?? "";
  switch (kind) {
    case "COMBO": return value >= LEAST_COMBO ? combo(value) : null;
    case "BALL_SAVED": return SAVED;
    case "DOUBLE_ON": return DOUBLE;
    case "WARNING": return announcement("warning", RANK.WARNING, "WARNING" + "!".repeat(Math.min(value, 3)), 1.2, null, 0, shakingText);
    case "BALL_LOST": return value ? announcement("lost", RANK.BALL_LOST, `BALL ${value} LOST`, 1.4, fallingBall, 0.45) : null;
    case "MESSAGE": {
      const rank = words.messages[text] ?? RANK.NOTICE, scene = rank === RANK.JACKPOT ? jackpot : null;
      return announcement(`message ${shown}`, rank, shown, rank <= RANK.NOTICE ? 1.6 : 2.4, scene, scene ? 0.6 : 0);
    }
    case "CUE": return text in words.cues ? announcement(`message ${shown}`, words.cues[text], shown, 2.4, jackpot, 0.6) : null;
    case "MODE_STARTED": return words.announced.includes(text) ? announcement(`message ${shown}`, RANK.MISSION, shown, 2.4) : null;
    case "BALL_LOCKED": return announcement("locked", RANK.MISSION, `BALL ${value} LOCKED`, 2);
    default: return null;
  }
}

/** The announcements of a game: the one on the display, and those that wait. */
export class Announcements {
  /** @param words What the table's rules say. */
  constructor(words) {
    this.words = words;
    this.award = { tick: -1, points: 0 };
    this.began = 0;
    this.clear();
  }

  addEvent(event) {
    const { kind, tick, value } = event, { award } = this;
    if (kind === "SCORED") {
      this.award = { tick, points: Math.max(value, award.tick === tick ? award.points : 0) };
      return;
    }
    const made = announcementOf(event, this.words);
    if (made === null) return;
    const isPaid = award.tick === tick && award.points >= LEAST_AWARD && made.rank >= RANK.NOTICE;
    this.add(isPaid ? { ...made, detail: award.points.toLocaleString("en-US") } : made);
  }

  add(made) {
    this.queue = this.queue.filter((entry) => entry.made.name !== made.name);
    this.queue.push({ made, since: null });
    this.queue.sort((a, b) => b.made.rank - a.made.rank);
  }

  clear() {
    this.current = null;
    this.queue = [];
  }

  /** End the current announcement if it is over, and begin the next or a more important one. */
  advance(seconds) {
    if (this.current && seconds - this.began >= this.current.length) this.current = null;
    for (const entry of this.queue) entry.since ??= seconds;
    this.queue = this.queue.filter(({ since }) => seconds - since <= MAX_DELAY);
    if (!this.queue.length) return;
    const [{ made }] = this.queue, now = this.current;
    if (now && made.rank <= now.rank && made.name !== now.name) return;
    this.current = made;
    this.began = seconds;
    this.queue.shift();
  }
}
