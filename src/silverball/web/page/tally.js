// What has made the points of a game. The same as game/tally.py.

/** The points by their causes, and the bonus of the last ball. */
export class Tally {
  /** @param words What web/display_words.py says: the labels of the parts, and modes that are not shown. */
  constructor(words) {
    this.words = words;
    this.clear();
  }

  clear() {
    this.points = [new Map()];
    this.up = 0;
    this.modes = [];
    this.lostAt = -1;
    this.bonus = 0;
  }

  add(events) {
    for (const event of events) {
      const { kind, text } = event, others = this.modes.filter((name) => name !== text);
      if (kind === "SCORED") this.addPoints(event);
      else if (kind === "MODE_STARTED" && !this.words.unshown.includes(text)) this.modes = [...others, text];
      else if (kind === "MODE_ENDED") this.modes = others;
      else if (kind === "BALL_LOST") this.lostAt = event.tick;
      else if (kind === "PLAYER_UP") [this.up, this.modes] = [event.value - 1, []];
    }
  }

  addPoints({ tick, value, part }) {
    const points = (this.points[this.up] ??= new Map()), isBonus = tick === this.lostAt;
    if (isBonus) this.bonus += value;
    const mode = this.modes[this.modes.length - 1];
    const name = isBonus ? "bonus" : mode !== undefined ? this.words.shown[mode] : (this.words.labels[part] ?? "rules");
    points.set(name, (points.get(name) ?? 0) + value);
  }

  takeBonus() {
    const { bonus } = this;
    this.bonus = 0;
    return bonus;
  }

  /** Names and points of a player (from 0), the most first. */
  causes(player = 0) {
    return [...(this.points[player] ?? [])].sort((a, b) => b[1] - a[1]);
  }
}
