// What a picture may cost while the view moves, so that 20 a second come at half the width: fewer generations of rays
// first, then fewer pixels, by the times of the pictures before.

import type {FrameFacts} from "./state";

const AIM = 48;      // milliseconds from picture to picture
const GROWTH = 1.6;  // power of the width by which the time grows, about
const GUESS = 1.3;   // what one more generation costs, times, where it is not known
const LATE = 0.4;    // share of the late pictures in the mean
const FADE = 0.002;  // of what was measured of another depth, with each picture: views change

export interface PaceLimits {
  full: number;      // width of the whole picture
  depth: number;     // that is chosen
  deepens: boolean;  // whether the renderer has a depth
}

export class Pace {
  private width: number | undefined;
  private depth: number | undefined;
  private cost: number | undefined;  // mean, at this depth and half the width
  private late: number[] = [];       // the last costs, three at most, at this depth and half the width
  private ratios: number[] = [];     // [depth] its cost over that of one less
  private left: {depth: number; cost: number} | undefined;  // the depth before this one, until a picture has this

  /** Another scene or renderer: nothing is known. */
  forget() {
    this.width = this.depth = this.cost = this.left = undefined;
    this.ratios = [];
    this.late = [];
  }
  /** Width and depth of the next picture. Where nothing is known an eighth as wide, and two generations. */
  next(limits: PaceLimits) {
    this.width = clamped(this.width ?? limits.full / 8, 48, limits.full / 2);
    this.depth = Math.min(this.depth ?? 2, limits.depth);
    return {width: Math.round(this.width), depth: limits.deepens ? this.depth : limits.depth};
  }
  /** `cost`: milliseconds since the picture before, or since it was asked for; `depth`: that of the picture. */
  learn(cost: number, facts: FrameFacts, depth: number, limits: PaceLimits) {
    if (this.width === undefined || this.depth === undefined || Math.abs(facts.width - this.width) > 0.5 * this.width) return;
    if (limits.deepens && depth !== this.depth) return;
    const most = limits.full / 2, whole = cost * (most / facts.width) ** GROWTH;
    if (this.left) this.compare(whole, facts.width > 0.7 * most);
    // The median of three: one picture that something else delayed does not count.
    this.late = [...this.late.slice(-2), whole];
    const median = [...this.late].sort((a, b) => a - b)[this.late.length >> 1], known = this.cost ?? whole;
    this.cost = known + LATE * (median - known);
    if (limits.deepens) this.choose(limits);
    this.width = Math.min(most, widthFor(this.cost, most), 1.5 * facts.width);
  }

  /** The first picture of another depth; `wide`: enough to tell what the depth costs. */
  private compare(whole: number, wide: boolean) {
    const {depth, cost} = this.left!, deeper = Math.max(depth, this.depth!);
    if (wide && Math.abs(depth - this.depth!) === 1) {
      this.ratios[deeper] = clamped(depth < this.depth! ? whole / cost : cost / whole, 1, 8);
    }
    this.left = undefined;
    this.cost = whole;
  }
  private choose(limits: PaceLimits) {
    const most = limits.full / 2, depth = this.depth!;
    this.ratios.forEach((ratio, k) => this.ratios[k] = ratio + FADE * (GUESS - ratio));
    let best = depth, cost = this.cost!;
    while (best > 0 && widthFor(cost, most) < 0.96 * leastWidth(best, limits)) cost /= this.ratios[best--] ?? GUESS;
    if (best === depth && depth < limits.depth) {
      const deeper = cost * (this.ratios[depth + 1] ?? GUESS);
      if (widthFor(deeper, most) >= leastWidth(depth + 1, limits)) {
        best = depth + 1;
        cost = deeper;
      }
    }
    if (best === depth) return;
    this.left = {depth, cost: this.cost!};
    this.late = [];
    this.depth = best;
    this.cost = cost;
  }
}

/** At which a picture takes the time that is aimed at. */
function widthFor(cost: number, most: number) {
  return most * (AIM / Math.max(cost, 0.1)) ** (1 / GROWTH);
}
/** Below it generations are given up before pixels are. */
function leastWidth(depth: number, limits: PaceLimits) {
  return depth > 0 ? limits.full / 2 : 0;
}

function clamped(x: number, lo: number, hi: number) {
  return Math.min(hi, Math.max(lo, x));
}
