// First zeros and extremes of a polynomial on [0, 1], as in tippetop.integrators.polynomials.
import { crossing } from "./mechanics.js";

const LOOKS = 32;

/** How far a polynomial goes at most from where it starts. */
export function reach(terms, from, degree) {
  let total = 0;
  for (let k = from + degree; k > from; k -= 1) total += Math.abs(terms[k]);
  return total;
}

/** A polynomial: coefficients in increasing order, from a place in an array on. */
export class Polynomial {
  constructor(terms, from, degree) {
    this.terms = terms;
    this.from = from;
    this.degree = degree;
    this.reach = reach(terms, from, degree);
  }

  get start() {
    return this.terms[this.from];
  }

  at(x) {
    let total = 0;
    for (let k = this.from + this.degree; k >= this.from; k -= 1) total = total * x + this.terms[k];
    return total;
  }

  slope(x) {
    let total = 0;
    for (let k = this.degree; k > 0; k -= 1) total = total * x + k * this.terms[this.from + k];
    return total;
  }

  bend(x) {
    let total = 0;
    for (let k = this.degree; k > 1; k -= 1) total = total * x + k * (k - 1) * this.terms[this.from + k];
    return total;
  }

  /** The least value of sign times it, with its place; by Newton's method from the least of some looks. */
  least(sign = 1, low = 0, high = 1, looks = LOOKS) {
    let place = low, value = sign * this.at(low);
    for (let look = 1; look <= looks; look += 1) {
      const there = low + ((high - low) * look) / looks, found = sign * this.at(there);
      if (found < value) [place, value] = [there, found];
    }
    let x = place;
    const from = Math.max(low, place - (high - low) / looks), to = Math.min(high, place + (high - low) / looks);
    for (let turn = 0; turn < 8; turn += 1) {
      const bend = sign * this.bend(x);
      if (!(bend > 0)) break;
      const next = Math.min(Math.max(x - (sign * this.slope(x)) / bend, from), to);
      const done = Math.abs(next - x) < 1e-12;
      x = next;
      if (done) break;
    }
    const found = sign * this.at(x);
    return found < value ? [x, found] : [place, value];
  }

  /** Where sign times it, plus a number, first falls to zero from above; nan where it does not. */
  firstFall(sign = 1, shift = 0, fromAbove = false) {
    const value = (x) => sign * this.at(x) + shift;
    const first = value(0), second = value(1 / LOOKS);
    if ((fromAbove ? first === 0 : first <= 0) && second <= 0) return 0;
    let before = first;
    for (let look = 1; look <= LOOKS; look += 1) {
      const low = (look - 1) / LOOKS, high = look / LOOKS, after = value(high);
      if (before > 0 && after <= 0) return crossing(value, low, high);
      if (before > 0 && sign * this.slope(low) < 0 && sign * this.slope(high) > 0) {
        const [place, least] = this.least(sign, low, high, 2);
        if (least + shift <= 0) return crossing(value, low, place);
      }
      before = after;
    }
    return NaN;
  }
}
