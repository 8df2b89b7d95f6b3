// The module's memory: addresses are given out one after the other, and never back.

const PAGE = 65536, ALIGNMENT = 16;

export class Memory {
  constructor(exports) {
    this.exports = exports;
    this.top = exports.heap.value;
    this.look();
  }

  /** Views of the memory; a memory that grows invalidates those of before. */
  look() {
    const buffer = this.exports.memory.buffer;
    this.bytes = new Uint8Array(buffer);
    this.view = new DataView(buffer);
    this.floats = new Float32Array(buffer);
    this.doubles = new Float64Array(buffer);
  }

  /** The address of so many new bytes, all zero. */
  room(size) {
    const at = (this.top + ALIGNMENT - 1) & -ALIGNMENT;
    this.top = at + size;
    const missing = this.top - this.bytes.length;
    if (missing > 0) {
      this.exports.memory.grow(Math.ceil(missing / PAGE));
      this.look();
    }
    return at;
  }

  put(bytes) {
    const at = this.room(bytes.length);
    this.bytes.set(bytes, at);
    return at;
  }

  int(at) {
    return this.view.getInt32(at, true); // the low half: no number of a game is greater
  }

  double(at) {
    return this.view.getFloat64(at, true);
  }

  writeInt(at, value) {
    this.view.setBigInt64(at, BigInt(value), true);
  }
}
