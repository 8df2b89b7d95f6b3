// Composes frames: the baked table, and on it everything that moves. The same as drawing/compose.py, with the
// same kernels, so that every pixel is the same.

import { lightLevels } from "./lamps.js";
import { poseOf, round } from "./poses.js";
import { half } from "./unpack.js";

const MAX_SPOTS = 64, TRAIL_LIGHT = 0.5, SPARK_LIGHT = 1, SUNK = 0.4, SHADOW_SHIFT = 1.2, MARGIN = 4;
const WHITE = [1, 1, 1];

export class Painter {
  /**
   * @param memory The module's memory.
   * @param look What web/look.py says.
   * @param pictures The decoded pictures, by name.
   * @param pack The bytes of all arrays.
   * @param arrays The places of the arrays in them.
   */
  constructor(memory, look, pictures, pack, arrays) {
    this.memory = memory;
    this.kernels = memory.exports;
    this.look = look;
    [this.width, this.height] = look.size;
    const [width, height] = look.size, put = (name) => {
      const [offset, size, shape] = arrays[name];
      return { at: memory.put(pack.subarray(offset, offset + size)), shape };
    };
    this.stage = put("stage");
    this.inks = put("inks");
    this.spots = memory.room(8 * 7 * MAX_SPOTS);
    this.out = memory.room(4 * 8);
    this.rgba = memory.room(4 * width * height);
    this.still = memory.room(3 * width * height);
    this.copyColors(pictures.table, 0, 0, width, height, this.still);
    const heights = memory.room(4 * width * height);
    this.copyHeights(pictures.heights, 0, 0, width, height, heights, 0);
    this.makeSprites(pictures);
    this.makeFlashes(pictures);
    this.makeLamps(pictures, put);
    this.makeLayers(heights, pictures);
    this.before = { size: 0, at: 0 };
    this.changed = [];
  }

  // --- what is loaded --------------------------------------------------------------------------------

  copyColors(picture, column, row, width, height, at) {
    const { bytes } = this.memory;
    for (let y = 0; y < height; y++) {
      let from = 4 * ((row + y) * picture.width + column), to = at + 3 * y * width;
      for (let x = 0; x < width; x++, from += 4, to += 3) {
        bytes[to] = picture.rgba[from];
        bytes[to + 1] = picture.rgba[from + 1];
        bytes[to + 2] = picture.rgba[from + 2];
      }
    }
  }

  /** Heights whose high byte is the channel `first`, and whose low byte is the next one. */
  copyHeights(picture, column, row, width, height, at, first) {
    const { floats } = this.memory;
    for (let y = 0; y < height; y++) {
      let from = 4 * ((row + y) * picture.width + column) + first, to = at / 4 + y * width;
      for (let x = 0; x < width; x++, from += 4, to++) {
        floats[to] = half((picture.rgba[from] << 8) | picture.rgba[from + 1]);
      }
    }
  }

  sprite(place, pictures) {
    const [left, top, columns, rows, column, row] = place, { memory } = this;
    const sprite = { left, top, rows, columns };
    sprite.added = memory.room(3 * rows * columns);
    sprite.remaining = memory.room(rows * columns);
    sprite.tall = memory.room(4 * rows * columns);
    this.copyColors(pictures.colors, column, row, columns, rows, sprite.added);
    this.copyHeights(pictures.covers, column, row, columns, rows, sprite.tall, 1);
    for (let y = 0; y < rows; y++) {
      let from = 4 * ((row + y) * pictures.covers.width + column);
      for (let x = 0; x < columns; x++, from += 4) {
        memory.bytes[sprite.remaining + y * columns + x] = pictures.covers.rgba[from];
      }
    }
    return sprite;
  }

  mirrored(sprite) {
    const { rows, columns, top } = sprite, { memory } = this;
    const image = { left: this.width - sprite.left - columns, top, rows, columns };
    image.added = memory.room(3 * rows * columns);
    image.remaining = memory.room(rows * columns);
    image.tall = memory.room(4 * rows * columns);
    const { bytes, floats } = memory;
    for (let y = 0; y < rows; y++) for (let x = 0; x < columns; x++) {
      const from = y * columns + x, to = y * columns + columns - 1 - x;
      for (let c = 0; c < 3; c++) bytes[image.added + 3 * to + c] = bytes[sprite.added + 3 * from + c];
      bytes[image.remaining + to] = bytes[sprite.remaining + from];
      floats[image.tall / 4 + to] = floats[sprite.tall / 4 + from];
    }
    return image;
  }

  makeSprites(pictures) {
    this.sprites = [];
    for (const part of this.look.moving) {
      this.sprites.push(
        part.mirrors === undefined
          ? part.sprites.map((place) => this.sprite(place, pictures))
          : this.sprites[part.mirrors].map((sprite) => this.mirrored(sprite)));
    }
  }

  makeFlashes(pictures) {
    this.flashes = new Map();
    for (const [part, left, top, columns, rows, column, row] of this.look.flashes) {
      const at = this.memory.room(3 * rows * columns);
      this.copyColors(pictures.colors, column, row, columns, rows, at);
      if (!this.flashes.has(part)) this.flashes.set(part, []);
      this.flashes.get(part).push({ left, top, columns, rows, at });
    }
  }

  /** The lights of the lamps, one after the other, and the table with those that shine. */
  makeLamps(pictures, put) {
    const { lights, tile } = this.look.lamps, { memory, width, height } = this, size = 3 * width * height;
    this.lit = this.still;
    if (!lights.length) return;
    const pixels = lights.reduce((sum, { place }) => sum + place[2] * place[3], 0), light = memory.room(3 * pixels);
    let at = light;
    for (const { place: [, , columns, rows, column, row] } of lights) {
      this.copyColors(pictures.colors, column, row, columns, rows, at);
      at += 3 * columns * rows;
    }
    const [tiles, boxes, changed] = ["lamp tiles", "lamp boxes", "lamp changed"].map(put);
    this.lit = memory.room(size);
    memory.bytes.copyWithin(this.lit, this.still, this.still + size);
    const levels = memory.room(16 * lights.length);
    this.relighting = {
      tile, changed, levels, count: lights.length,
      arguments: [
        this.still, height, 3 * width, this.lit, height, 3 * width, tiles.at, ...tiles.shape, boxes.at, ...boxes.shape,
        light, 3 * pixels, levels, 2, lights.length, changed.at, ...changed.shape,
      ],
    };
  }

  makeLayers(heights, pictures) {
    const { memory, width, height } = this, count = width * height;
    this.layers = [];
    for (const { level, base, over } of this.look.layers) {
      const below = this.layers[this.layers.length - 1];
      const layer = { level, base, raised: [], frame: memory.room(3 * count), tall: memory.room(4 * count) };
      layer.stillTall = memory.room(4 * count);
      const from = below ? below.stillTall : heights, frame = below ? below.frame : this.still;
      memory.bytes.copyWithin(layer.stillTall, from, from + 4 * count);
      memory.bytes.copyWithin(layer.frame, frame, frame + 3 * count);
      if (over) {
        layer.over = this.sprite(over, pictures);
        this.raise(layer);
        this.layOver(below, layer, this.boxOf(layer.over));
      }
      memory.bytes.copyWithin(layer.tall, layer.stillTall, layer.stillTall + 4 * count);
      layer.parts = [];
      this.layers.push(layer);
    }
    this.look.moving.forEach((part, index) => this.layerOf(part.level).parts.push(index));
  }

  /** Put the heights of an upper level over those below it. */
  raise(layer) {
    const { left, top, rows, columns, tall } = layer.over, { floats } = this.memory;
    for (let y = 0; y < rows; y++) for (let x = 0; x < columns; x++) {
      const value = floats[tall / 4 + y * columns + x];
      if (value >= 0) floats[layer.stillTall / 4 + (top + y) * this.width + left + x] = value;
    }
  }

  /** A buffer for the pixels below a ball, of so many rows and columns. */
  roomForBall(size) {
    if (size > this.before.size) this.before = { size: size + MARGIN, at: this.memory.room(3 * (size + MARGIN) ** 2) };
    return this.before;
  }

  layerOf(level) {
    let found = this.layers[0];
    for (const layer of this.layers) if (layer.level <= level) found = layer;
    return found;
  }

  // --- the camera: drawing/camera.py --------------------------------------------------------------------

  toPixel(x, z, y) {
    const [eyeX, eyeY, sine, cosine, focal, across, down] = this.look.frustum;
    const dx = x - eyeX, dy = y - eyeY, depth = dx * sine - dy * cosine;
    return [across + focal * (z / depth), down - focal * ((dx * cosine + dy * sine) / depth)];
  }

  box(lowX, highX, lowZ, highZ, lowY, highY) {
    let left = Infinity, right = -Infinity, top = Infinity, bottom = -Infinity;
    for (const x of [lowX, highX]) for (const z of [lowZ, highZ]) for (const y of [lowY, highY]) {
      const [across, down] = this.toPixel(x, z, y);
      left = Math.min(left, across);
      right = Math.max(right, across);
      top = Math.min(top, down);
      bottom = Math.max(bottom, down);
    }
    left = Math.min(Math.max(Math.floor(left) - 1, 0), this.width);
    top = Math.min(Math.max(Math.floor(top) - 1, 0), this.height);
    right = Math.min(Math.max(Math.ceil(right) + 1, left), this.width);
    bottom = Math.min(Math.max(Math.ceil(bottom) + 1, top), this.height);
    return [left, top, right, bottom];
  }

  boxOf({ left, top, rows, columns }) {
    return [left, top, left + columns, top + rows];
  }

  // --- a frame ---------------------------------------------------------------------------------------

  /** Copy a rectangle of pixels of some bytes each. */
  restore([left, top, right, bottom], to, from, size) {
    const { bytes } = this.memory, { width, height } = this;
    left = Math.max(left, 0);
    right = Math.min(right, width);
    if (right <= left) return;
    for (let row = Math.max(top, 0); row < Math.min(bottom, height); row++) {
      const start = (row * width + left) * size;
      bytes.copyWithin(to + start, from + start, from + (row * width + right) * size);
    }
  }

  /** Light the table anew where lamps have changed; the boxes of those tiles. */
  relight(levels) {
    if (!this.relighting) return [];
    const { tile, changed, levels: at, count } = this.relighting, { memory } = this;
    memory.bytes.copyWithin(at, at + 8 * count, at + 16 * count);
    let isNew = false;
    levels.forEach((level, lamp) => {
      isNew ||= memory.int(at + 8 * lamp) !== level;
      memory.writeInt(at + 8 * (count + lamp), level);
    });
    if (!isNew) return [];
    this.kernels.relight(...this.relighting.arguments);
    const boxes = [], [rows, columns] = changed.shape;
    for (let row = 0; row < rows; row++) for (let column = 0; column < columns; column++) {
      const first = column;
      while (column < columns && memory.bytes[changed.at + row * columns + column]) column++;
      if (column > first) boxes.push([first * tile, row * tile, column * tile, (row + 1) * tile]);
    }
    return boxes;
  }

  /**
   * Draw a world with its effects; the frame is that of the last layer.
   * @param judge The rules of the game, for its lamps; null: they are as when a game begins.
   * @param running The light show; by default the one that events have begun.
   */
  compose(world, effects, judge = null, running = null) {
    const { time } = world, [lowest] = this.layers;
    const levels = lightLevels(this.look.lamps, judge, time, running ?? effects.show(time));
    const stale = [...this.changed, ...this.relight(levels)];
    this.changed = [];
    for (const box of stale) this.restore(box, lowest.frame, this.lit, 3);
    for (const [part, strength] of effects.flashes(time)) this.lightUp(part, strength);
    const onBoard = world.balls(), balls = [...onBoard, ...effects.sinkingBalls(time)];
    const trails = effects.trails(time, onBoard);
    this.layers.forEach((layer, number) => {
      for (const box of layer.raised) this.restore(box, layer.tall, layer.stillTall, 4);
      layer.raised = [];
      if (number) this.layLevel(this.layers[number - 1], layer, [...stale, ...this.changed]);
      for (const index of layer.parts) this.layPart(layer, index, world, onBoard, effects, time);
      const here = balls.filter((ball) => this.layerOf(ball.level) === layer);
      for (const ball of here) this.shade(layer, ball);
      for (const ball of here) this.addSpots(layer, trails.get(ball.id) ?? [], this.look.trail, TRAIL_LIGHT);
      for (const ball of here.sort((a, b) => b.x - a.x)) this.drawBall(layer, ball);
    });
    const top = this.layers[this.layers.length - 1];
    for (const spots of effects.sparks(time)) this.addSpots(top, spots, this.look.spark, SPARK_LIGHT);
  }

  /** The frame as the picture of a canvas. */
  image() {
    const { frame } = this.layers[this.layers.length - 1], { width, height } = this, count = width * height;
    this.kernels.rgba(frame, this.rgba, count);
    const pixels = new Uint8ClampedArray(this.memory.exports.memory.buffer, this.rgba, 4 * count);
    return new ImageData(pixels, width, height);
  }

  frameOf(layer) {
    return [layer.frame, this.height, this.width, 3];
  }

  tallOf(layer) {
    return [layer.tall, this.height, this.width];
  }

  lightUp(part, strength) {
    for (const flash of this.flashes.get(part) ?? []) {
      this.addLight(this.layers[0].frame, flash, round(256 * strength));
      this.changed.push(this.boxOf(flash));
    }
  }

  addLight(frame, { left, top, rows, columns, at }, level) {
    this.kernels.add_light(frame, this.height, 3 * this.width, left, top, at, rows, 3 * columns, level);
  }

  layLevel(below, layer, boxes) {
    for (const box of boxes) {
      this.restore(box, layer.frame, below.frame, 3);
      this.layOver(below, layer, box);
    }
  }

  layOver(below, layer, box) {
    const { left, top, rows, columns, remaining, added } = layer.over;
    this.kernels.lay_over(...this.frameOf(below), ...this.frameOf(layer), left, top, remaining, rows, columns,
      added, rows, columns, 3, ...box);
  }

  layPart(layer, index, world, balls, effects, time) {
    const pose = poseOf(this.look.moving[index], world, balls, effects, time);
    if (pose === null) return;
    const sprite = this.sprites[index][pose], { left, top, rows, columns } = sprite;
    this.kernels.lay_sprite(...this.frameOf(layer), ...this.tallOf(layer), left, top, sprite.remaining, rows, columns,
      sprite.added, rows, columns, 3, sprite.tall, rows, columns);
    this.changed.push(this.boxOf(sprite));
    layer.raised.push(this.boxOf(sprite));
  }

  /** A ball as the kernels take it: place, radius, floor and tint. */
  sphere(layer, ball) {
    const { radius, tints } = this.look;
    const y = layer.base + (this.isSunk(ball) ? -SUNK * radius : radius);
    const tint = tints.length && ball.id ? tints[(ball.id - 1) % tints.length] : WHITE;
    return [ball.x, y, ball.z, radius, layer.base, ...tint];
  }

  isSunk(ball) {
    return this.look.holes.includes(ball.holder);
  }

  shade(layer, ball) {
    if (this.isSunk(ball)) return;
    const { radius: r } = this.look, shift = layer.base * SHADOW_SHIFT;
    const box = this.box(ball.x - shift - 2.8 * r, ball.x + 2.2 * r, ball.z - 2.2 * r, ball.z + 2.2 * r, 0,
      layer.base + 2 * r);
    this.kernels.cast_shadow(...this.frameOf(layer), ...this.tallOf(layer), this.stage.at, 1,
      ...this.sphere(layer, ball), ...box);
    this.changed.push(box);
  }

  drawBall(layer, ball) {
    const { radius: r } = this.look, sphere = this.sphere(layer, ball), y = sphere[1];
    const box = this.box(ball.x - r, ball.x + r, ball.z - r, ball.z + r, Math.max(y - r, layer.base), y + r);
    const { size, at } = this.roomForBall(Math.max(box[2] - box[0], box[3] - box[1]));
    this.kernels.draw_ball(...this.frameOf(layer), ...this.tallOf(layer), at, size, size, 3, this.stage.at, 1,
      this.inks.at, ...this.inks.shape, ...sphere, ...box);
    this.changed.push(box);
  }

  addSpots(layer, spots, color, light) {
    if (!spots.length) return;
    const count = Math.min(spots.length, MAX_SPOTS), { memory } = this;
    for (let index = 0; index < count; index++) {
      const spot = spots[index], shine = light * spot.strength;
      const row = [spot.x, spot.y + layer.base, spot.z, spot.radius, ...color.map((value) => shine * value)];
      memory.doubles.set(row, this.spots / 8 + 7 * index);
    }
    this.kernels.add_spots(this.out, ...this.frameOf(layer), ...this.tallOf(layer), this.stage.at, 1, this.spots,
      MAX_SPOTS, 7, count);
    this.changed.push([0, 1, 2, 3].map((index) => memory.int(this.out + 8 * index)));
  }
}
