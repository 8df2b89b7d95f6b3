// Unpacks what the page carries: text, compressed arrays, pictures. The other half of web/pack.py.

/** The bytes of a data block of the page; the block is emptied, to free its memory. */
export function bytesOf(id) {
  const block = document.getElementById(id);
  const bytes = fromText(block.textContent);
  block.textContent = "";
  return bytes;
}

/** The bytes of a text: their number, and two letters for every 13 bits. */
export function fromText(text) {
  const start = text.indexOf(" ") + 1, bytes = new Uint8Array(Number(text.slice(0, start))), values = new Uint8Array(128);
  let count = 0, bits = 0, held = 0, at = 0;
  for (let code = 33; code < 127; code++) if (!"&<>".includes(String.fromCharCode(code))) values[code] = count++;
  for (let place = start; at < bytes.length; place += 2) {
    held |= (values[text.charCodeAt(place)] + count * values[text.charCodeAt(place + 1)]) << bits;
    for (bits += 13; bits >= 8 && at < bytes.length; bits -= 8, held >>>= 8) bytes[at++] = held & 255;
  }
  return bytes;
}

export async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** A lossless picture: width, height, and RGBA. */
export async function decode(bytes) {
  const options = { colorSpaceConversion: "none", premultiplyAlpha: "none" };
  const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/webp" }), options);
  const canvas = document.createElement("canvas");
  canvas.width = bitmap.width;
  canvas.height = bitmap.height;
  const context = canvas.getContext("2d", { alpha: false, willReadFrequently: true });
  context.drawImage(bitmap, 0, 0);
  const rgba = context.getImageData(0, 0, bitmap.width, bitmap.height).data;
  return { width: bitmap.width, height: bitmap.height, rgba };
}

/** The number that the bits of a 16-bit float stand for. */
export function half(bits) {
  const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, mantissa = bits & 1023;
  if (exponent === 0) return sign * mantissa * 2 ** -24;
  if (exponent === 31) return mantissa ? NaN : sign * Infinity;
  return sign * (1 + mantissa / 1024) * 2 ** (exponent - 15);
}
