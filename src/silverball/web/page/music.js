// The music of a table: bars of notes, one after the other, in the mood of the game. The same notes as
// app/sound/music.py; each is made here, a few milliseconds in a frame.

import { MoodReader } from "./moods.js";

const RATE = 24000, SPREAD = 0.75, AHEAD = 0.25, FADE = 0.04, FLOOR = 1e-4;

/** The samples of a note: a sum of tones that die away, up within its attack, down within its release. */
export function noteWave(timbre, brightest, pitch, seconds, rate = RATE) {
  const length = seconds + timbre.release, count = Math.round(length * rate), wave = new Float32Array(count);
  for (const ratio of timbre.ratios) {
    const tone = pitch * ratio, decay = timbre.decay * ratio ** -timbre.damping;
    if (tone > brightest || tone >= 0.45 * rate) continue;
    const spreads = timbre.spread ? [-0.5 * timbre.spread, 0.5 * timbre.spread] : [0];
    for (const share of spreads) addTone(wave, tone * (1 + share), ratio ** -timbre.slope, decay, rate);
  }
  const attack = Math.min(count, Math.ceil(timbre.attack * rate)), end = (count - 1) / rate;
  for (let index = 0; index < attack; index++) wave[index] *= rise(index / rate / timbre.attack);
  for (let index = Math.max(count - Math.ceil(timbre.release * rate) - 1, 0); index < count; index++) {
    wave[index] *= rise((end - index / rate) / timbre.release);
  }
  return wave;
}

function rise(share) {
  return 0.5 - 0.5 * Math.cos(Math.PI * Math.min(Math.max(share, 0), 1));
}

/** Add a decaying sine: each sample is the one before it, turned and shortened. */
function addTone(wave, pitch, strength, decay, rate) {
  const shrink = Math.exp(-Math.log(1000) / (decay * rate)), angle = (2 * Math.PI * pitch) / rate;
  const across = shrink * Math.cos(angle), along = shrink * Math.sin(angle);
  let cosine = strength, sine = 0;
  for (let index = 0; index < wave.length && Math.abs(cosine) + Math.abs(sine) > FLOOR * strength; index++) {
    wave[index] += sine;
    [cosine, sine] = [cosine * across - sine * along, sine * across + cosine * along];
  }
}

export class Music {
  /**
   * @param context The sound of the page.
   * @param sheet What web/music_sheet.py says.
   * @param drums The buffers of the drums, by name.
   * @param target Where the music goes.
   */
  constructor(context, sheet, drums, target) {
    this.context = context;
    this.sheet = sheet;
    this.drums = drums;
    this.moods = new MoodReader(sheet.moods);
    this.gain = new GainNode(context);
    this.gain.connect(target);
    this.notes = new Map();
    this.missing = this.listNotes();
    this.playing = [];
    this.bar = -1; // the last one that was scheduled; −1: there is no music
    this.ends = 0;
  }

  get isPlaying() {
    return this.bar >= 0;
  }

  get barSeconds() {
    return this.sheet.beats * this.sheet.beat;
  }

  /** All notes, each once, those that are needed first at the end. */
  listNotes() {
    const found = new Map();
    for (const layer of this.sheet.layers) for (const bar of layer) for (const tone of bar) {
      if (!this.drums[tone[1]]) found.set(this.nameOf(tone), tone);
    }
    return [...found.values()].reverse();
  }

  nameOf([, instrument, pitch, seconds]) {
    return `${instrument} ${pitch} ${seconds}`;
  }

  /** Make the next note that is missing. */
  prepare() {
    const tone = this.missing.pop(), [, instrument, pitch, seconds] = tone;
    const wave = noteWave(this.sheet.timbres[instrument], this.sheet.brightest, pitch, seconds);
    const buffer = this.context.createBuffer(1, wave.length, RATE);
    buffer.copyToChannel(wave, 0);
    this.notes.set(this.nameOf(tone), buffer);
  }

  /** Keep the music going in the mood of a game, some seconds after the last call; `strength` 0 to 1. */
  follow(game, seconds, strength) {
    const mood = this.moods.read(game, seconds), now = this.context.currentTime;
    if (mood === null || strength === 0) {
      this.stop();
      return;
    }
    if (this.missing.length) {
      this.prepare();
      return;
    }
    this.gain.gain.setTargetAtTime(strength, now, FADE);
    if (!this.isPlaying || this.ends < now) this.ends = now + FADE;
    if (this.ends - now < AHEAD) this.schedule(mood);
  }

  /** Schedule the next bar in a mood. */
  schedule(mood) {
    const { layers, lift } = this.sheet, start = this.ends;
    this.bar = (this.bar + 1) % layers[0].length;
    for (const layer of layers.slice(0, mood.level)) for (const tone of layer[this.bar]) {
      this.playTone(tone, start, mood.isLifted ? lift : 0);
    }
    this.ends = start + this.barSeconds;
  }

  playTone(tone, start, lift) {
    const [at, instrument, , , strength, side] = tone, drum = this.drums[instrument];
    const semitones = drum ? 0 : instrument === "bass" && lift > 5 ? lift - 12 : lift;
    const buffer = drum ?? this.notes.get(this.nameOf(tone));
    const source = new AudioBufferSourceNode(this.context, { buffer, playbackRate: 2 ** (semitones / 12) });
    source.connect(new GainNode(this.context, { gain: strength }))
      .connect(new StereoPannerNode(this.context, { pan: SPREAD * side })).connect(this.gain);
    source.start(start + at);
    this.playing.push(source);
    source.onended = () => {
      this.playing = this.playing.filter((other) => other !== source);
    };
  }

  /** Fade out; the next music begins with the first bar. */
  stop() {
    if (!this.isPlaying) return;
    const now = this.context.currentTime;
    this.gain.gain.setTargetAtTime(0, now, FADE);
    for (const source of this.playing) source.stop(now + 4 * FADE);
    this.bar = -1;
  }
}
