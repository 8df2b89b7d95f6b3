// Hashes, and the digests of replays made of them. Web browsers have SHA-256, but not on every page, and no
// BLAKE2. Sources: FIPS 180-4 and RFC 7693.

const LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

/** The first 32 bits of the fractional parts of a root of each of the first primes. */
function rootsOfPrimes(count, power) {
  const found = [];
  for (let number = 2; found.length < count; number++) {
    let isPrime = true;
    for (let factor = 2; factor * factor <= number; factor++) if (number % factor === 0) isPrime = false;
    if (isPrime) found.push(((number ** power % 1) * 2 ** 32) | 0);
  }
  return found;
}

const ROUNDS = new Int32Array(rootsOfPrimes(64, 1 / 3)), START = rootsOfPrimes(8, 1 / 2);

/** The SHA-256 of some bytes, in hex digits. */
export function sha256(bytes) {
  const size = ((bytes.length + 8) >> 6 << 6) + 64, data = new Uint8Array(size), view = new DataView(data.buffer);
  data.set(bytes);
  data[bytes.length] = 0x80;
  view.setUint32(size - 8, Math.floor(bytes.length / 2 ** 29));
  view.setUint32(size - 4, bytes.length << 3);
  const state = new Int32Array(START), w = new Int32Array(64), turn = (x, n) => (x >>> n) | (x << (32 - n));
  for (let block = 0; block < size; block += 64) {
    for (let t = 0; t < 16; t++) w[t] = view.getInt32(block + 4 * t);
    for (let t = 16; t < 64; t++) {
      const a = w[t - 15], b = w[t - 2];
      const low = turn(a, 7) ^ turn(a, 18) ^ (a >>> 3), high = turn(b, 17) ^ turn(b, 19) ^ (b >>> 10);
      w[t] = w[t - 16] + low + w[t - 7] + high;
    }
    let [a, b, c, d, e, f, g, h] = state;
    for (let t = 0; t < 64; t++) {
      const chosen = (e & f) ^ (~e & g), most = (a & b) ^ (a & c) ^ (b & c);
      const one = (h + (turn(e, 6) ^ turn(e, 11) ^ turn(e, 25)) + chosen + ROUNDS[t] + w[t]) | 0;
      const two = ((turn(a, 2) ^ turn(a, 13) ^ turn(a, 22)) + most) | 0;
      [h, g, f, e, d, c, b, a] = [g, f, e, (d + one) | 0, c, b, a, (one + two) | 0];
    }
    [a, b, c, d, e, f, g, h].forEach((value, index) => (state[index] += value));
  }
  return [...state].map((word) => (word >>> 0).toString(16).padStart(8, "0")).join("");
}

// Numbers of 64 bits are pairs of a low and a high half.
const BLAKE_START = [
  0xf3bcc908, 0x6a09e667, 0x84caa73b, 0xbb67ae85, 0xfe94f82b, 0x3c6ef372, 0x5f1d36f1, 0xa54ff53a,
  0xade682d1, 0x510e527f, 0x2b3e6c1f, 0x9b05688c, 0xfb41bd6b, 0x1f83d9ab, 0x137e2179, 0x5be0cd19,
];
const SIGMA = [
  [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15], [14, 10, 4, 8, 9, 15, 13, 6, 1, 12, 0, 2, 11, 7, 5, 3],
  [11, 8, 12, 0, 5, 2, 15, 13, 10, 14, 3, 6, 7, 1, 9, 4], [7, 9, 3, 1, 13, 12, 11, 14, 2, 6, 5, 10, 4, 0, 15, 8],
  [9, 0, 5, 7, 2, 4, 10, 15, 14, 1, 11, 12, 6, 8, 3, 13], [2, 12, 6, 10, 0, 11, 8, 3, 4, 13, 7, 5, 15, 14, 1, 9],
  [12, 5, 1, 15, 14, 13, 4, 10, 0, 7, 6, 3, 9, 2, 8, 11], [13, 11, 7, 14, 12, 1, 3, 9, 5, 0, 15, 4, 8, 6, 2, 10],
  [6, 15, 14, 9, 11, 3, 0, 8, 12, 2, 13, 7, 1, 4, 10, 5], [10, 2, 8, 4, 7, 6, 1, 5, 15, 11, 9, 14, 3, 12, 13, 0],
];
const MIXED = [
  [0, 4, 8, 12], [1, 5, 9, 13], [2, 6, 10, 14], [3, 7, 11, 15],
  [0, 5, 10, 15], [1, 6, 11, 12], [2, 7, 8, 13], [3, 4, 9, 14],
];

function add(v, a, low, high) {
  const sum = (v[2 * a] >>> 0) + (low >>> 0);
  v[2 * a + 1] = v[2 * a + 1] + high + (sum >= 2 ** 32 ? 1 : 0);
  v[2 * a] = sum;
}

/** v[a] = (v[a] ^ v[b]), turned right by so many bits. */
function turnedXor(v, a, b, bits) {
  let low = v[2 * a] ^ v[2 * b], high = v[2 * a + 1] ^ v[2 * b + 1];
  if (bits >= 32) [low, high] = [high, low];
  const n = bits % 32;
  v[2 * a] = n ? (low >>> n) | (high << (32 - n)) : low;
  v[2 * a + 1] = n ? (high >>> n) | (low << (32 - n)) : high;
}

function compress(h, block, count, isLast) {
  const v = new Int32Array(32);
  v.set(h);
  v.set(BLAKE_START, 16);
  v[24] ^= count;
  if (isLast) {
    v[28] = ~v[28];
    v[29] = ~v[29];
  }
  const m = new DataView(block.buffer, block.byteOffset);
  for (let round = 0; round < 12; round++) {
    const order = SIGMA[round % 10];
    MIXED.forEach(([a, b, c, d], index) => {
      const mix = (word, first, second) => {
        add(v, a, v[2 * b], v[2 * b + 1]);
        add(v, a, m.getInt32(8 * word, true), m.getInt32(8 * word + 4, true));
        turnedXor(v, d, a, first);
        add(v, c, v[2 * d], v[2 * d + 1]);
        turnedXor(v, b, c, second);
      };
      mix(order[2 * index], 32, 24);
      mix(order[2 * index + 1], 16, 63);
    });
  }
  for (let index = 0; index < 16; index++) h[index] ^= v[index] ^ v[index + 16];
}

/** The first bytes of the BLAKE2b of some bytes, with a digest of so many. */
export function blake2b(bytes, size) {
  const h = new Int32Array(BLAKE_START);
  h[0] ^= 0x01010000 ^ size;
  const blocks = Math.max(Math.ceil(bytes.length / 128), 1), data = new Uint8Array(128 * blocks);
  data.set(bytes);
  for (let number = 0; number < blocks; number++) {
    const isLast = number === blocks - 1, count = isLast ? bytes.length : 128 * (number + 1);
    compress(h, data.subarray(128 * number, 128 * number + 128), count, isLast);
  }
  return new Uint8Array(h.buffer.slice(0, size));
}

/** Two characters for some bytes, as in the lines of a replay. */
function short(bytes) {
  const [first, second] = blake2b(bytes, 3);
  return LETTERS[first >> 2] + LETTERS[((first & 3) << 4) | (second >> 4)];
}

/** The short digests of the groups of a world's record, whose fields are spans of bytes. */
export function shortDigests(record, groups) {
  return groups.map((spans) => short(joined(spans.map(([start, end]) => record.subarray(start, end))))).join("");
}

/** The digest of the group of the rules: their state as text. */
export function rulesDigest(text) {
  return short(new TextEncoder().encode(text));
}

export function joined(parts) {
  const whole = new Uint8Array(parts.reduce((size, part) => size + part.length, 0));
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.length;
  }
  return whole;
}
