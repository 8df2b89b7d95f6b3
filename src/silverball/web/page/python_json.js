// JSON as Python writes it, for the state of a game, whose text is part of its digests.

/** A number that Python knows as a float. */
export class Float {
  constructor(value) {
    this.value = value;
  }

  /** The number as Python writes it. */
  toString() {
    const { value } = this;
    if (Object.is(value, -0)) return "-0.0";
    if (Number.isInteger(value) && Math.abs(value) < 1e16) return `${value}.0`;
    const [mantissa, power] = value.toExponential().split("e"), exponent = Number(power);
    if (exponent >= -4 && exponent < 16) return String(value);
    return `${mantissa}e${exponent < 0 ? "-" : "+"}${String(Math.abs(exponent)).padStart(2, "0")}`;
  }
}

/** The text of a value, without spaces; integers of 64 bits are BigInts. */
export function toJson(value) {
  if (value instanceof Float || typeof value === "bigint") return value.toString();
  if (Array.isArray(value)) return `[${value.map(toJson).join(",")}]`;
  if (value === null || typeof value !== "object") return JSON.stringify(value);
  return `{${Object.entries(value).map(([key, item]) => `${JSON.stringify(key)}:${toJson(item)}`).join(",")}}`;
}
