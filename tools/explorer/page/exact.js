// SPDX-License-Identifier: GPL-3.0-or-later
// Exact numbers: m * 2^e with a BigInt m. Every finite double is one, and sums and products of them are; so no rounding
// happens anywhere in a proof, and no division is needed.

const bitsOf = new DataView(new ArrayBuffer(8));

class Exact {
  constructor(mantissa, exponent) {
    this.m = mantissa;
    this.e = exponent;
  }

  // Throws RangeError for what is not finite.
  static of(x) {
    if (!Number.isFinite(x)) throw new RangeError(`not a finite number: ${x}`);
    bitsOf.setFloat64(0, x);
    const high = bitsOf.getUint32(0), low = bitsOf.getUint32(4);
    const exponent = (high >>> 20) & 0x7ff;
    const fraction = (BigInt(high & 0xfffff) << 32n) | BigInt(low);
    const m = exponent === 0 ? fraction : fraction | (1n << 52n);
    return new Exact(high >>> 31 ? -m : m, (exponent === 0 ? 1 : exponent) - 1075);
  }

  plus(b) {
    if (this.m === 0n) return b;
    if (b.m === 0n) return this;
    const e = Math.min(this.e, b.e);
    return new Exact((this.m << BigInt(this.e - e)) + (b.m << BigInt(b.e - e)), e);
  }
  minus(b) {
    return this.plus(b.negated());
  }
  times(b) {
    return new Exact(this.m * b.m, this.e + b.e);
  }
  squared() {
    return this.times(this);
  }
  negated() {
    return new Exact(-this.m, this.e);
  }
  // -1, 0 or 1.
  sign() {
    return this.m > 0n ? 1 : this.m < 0n ? -1 : 0;
  }
  absolute() {
    return this.m < 0n ? this.negated() : this;
  }
  isMoreThan(b) {
    return this.minus(b).sign() > 0;
  }
  // Rounded, for readers.
  approximately() {
    let m = this.m < 0n ? -this.m : this.m, e = this.e;
    const digits = m.toString(2).length;
    if (digits > 64) {
      m >>= BigInt(digits - 64);
      e += digits - 64;
    }
    const value = Number(m) * 2 ** Math.max(-1000, Math.min(1000, e));
    return this.m < 0n ? -value : value;
  }
}

const ZERO = new Exact(0n, 0);
const ONE = new Exact(1n, 0);
const TWO = new Exact(2n, 0);

function larger(a, b) {
  return a.isMoreThan(b) ? a : b;
}

// Exact vectors are pairs.
function exactVector(x, y) {
  return {x: Exact.of(x), y: Exact.of(y)};
}
function exactDot(a, b) {
  return a.x.times(b.x).plus(a.y.times(b.y));
}

export {Exact, ZERO, ONE, TWO, larger, exactVector, exactDot};
