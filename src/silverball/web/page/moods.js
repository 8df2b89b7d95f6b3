// The mood of the music, read from a game. The same as app/sound/moods.py.

/** Reads the mood of a game, frame by frame. */
export class MoodReader {
  /** @param meta What web/music_sheet.py says of moods and missions. */
  constructor(meta) {
    this.meta = meta;
    this.clear();
  }

  clear() {
    this.wasInPlay = false;
    this.pause = 0;
  }

  /** The mood after some more seconds: layers and semitones; null: there is no music. */
  read(game, seconds) {
    const { meta } = this, { view } = game, isInPlay = view.phase === "play";
    if (this.wasInPlay && !isInPlay) this.pause = meta.pause;
    this.wasInPlay = isInPlay;
    this.pause = isInPlay ? 0 : Math.max(this.pause - seconds, 0);
    if (view.phase === "over" || view.tilted || this.pause > 0) return null;
    if (!isInPlay) return { level: meta.waiting, isLifted: false };
    if (view.onBoard > 1) return { level: meta.most, isLifted: true };
    const progress = this.progress(game);
    const level = progress === null
      ? Math.min(meta.playing + Math.floor(view.combo / meta.longCombo), meta.most - 1)
      : Math.min(meta.mission + Math.floor(3 * progress), meta.most);
    return { level, isLifted: false };
  }

  /** How far the furthest mission is, 0 to 1; null: none runs. */
  progress({ judge, world }) {
    let found = null;
    for (const [name, left] of judge.runningModes(world.tick, world.rate)) {
      const mission = this.meta.missions[name];
      if (!mission) continue;
      const counters = judge.list("counter", judge.setup("counters")), { lamps } = judge;
      const shares = mission.goals.map(({ counter, value, lamps: needed }) => (
        counter >= 0 ? Number(counters[counter]) : needed.filter((lamp) => lamps[lamp]).length) / value);
      found = Math.max(found ?? 0, 1 - left / mission.seconds, ...shares);
    }
    return found === null ? null : Math.min(found, 1);
  }
}
