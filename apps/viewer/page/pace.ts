// Chooses the cost of pictures while the view moves, for 20 pictures a second at half the width: reduces first the
// depth of rays, then the number of pixels, based on the times of earlier pictures.

import type {FrameFacts} from "./state";

const AIM = 48;      // milliseconds between pictures
const GROWTH = 1.6;  // approximate exponent of the time in the width
const GUESS = 1.3;   // assumed cost ratio of one more generation
const LATE = 0.4;    // weight of late pictures in the mean
const FADE = 0.002;  // loss of weight of measurements of other depths per picture: views change

export interface PaceLimits {
  full: number;      // width of the whole picture
  depth: number;     // chosen depth
  deepens: boolean;  // the renderer has a depth
}

export class Pace {
  private width: number | undefined;
  private depth: number | undefined;
  private cost: number | undefined;  // mean, at this depth and half the width
  private late: number[] = [];       // the last three costs at most, at this depth and half the width
  private ratios: number[] = [];     // [depth] ratio of its cost to that of one less
  private left: {depth: number; cost: number} | undefined;  // the previous depth, until a picture has this depth

  /** Forgets all times, for another scene or renderer. */
  forget() {
    this.width = this.depth = this.cost = this.left = undefined;
    this.ratios = [];
    this.late = [];
  }
  /** Width and depth of the next picture. Without known times an eighth as wide, and two generations. */
  next(limits: PaceLimits) {
    this.width = clamped(this.width ?? limits.full / 8, 48, limits.full / 2);
    this.depth = Math.max(0, Math.min(this.depth ?? 2, limits.depth));
    return {width: Math.round(this.width), depth: limits.deepens ? this.depth : limits.depth};
  }
  /** `cost`: milliseconds since the previous picture, or since the request; `depth`: that of the picture. */
  learn(cost: number, facts: FrameFacts, depth: number, limits: PaceLimits) {
    if (this.width === undefined || this.depth === undefined || Math.abs(facts.width - this.width) > 0.5 * this.width) return;
    if (limits.deepens && depth !== this.depth) return;
    const most = limits.full / 2, whole = cost * (most / facts.width) ** GROWTH;
    if (this.left) this.compare(whole, facts.width > 0.7 * most);
    // The median of three, so that a single delayed picture does not count.
    this.late = [...this.late.slice(-2), whole];
    const median = [...this.late].sort((a, b) => a - b)[this.late.length >> 1], known = this.cost ?? whole;
    this.cost = known + LATE * (median - known);
    if (limits.deepens) this.choose(limits);
    this.width = Math.min(most, widthFor(this.cost, most), 1.5 * facts.width);
  }

  /** The first picture of another depth; `wide`: wide enough to measure the cost of the depth. */
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

/** The width at which a picture takes the target time. */
function widthFor(cost: number, most: number) {
  return most * (AIM / Math.max(cost, 0.1)) ** (1 / GROWTH);
}
/** The width below which depth is reduced before width. */
function leastWidth(depth: number, limits: PaceLimits) {
  return depth > 0 ? limits.full / 2 : 0;
}

function clamped(x: number, lo: number, hi: number) {
  return Math.min(hi, Math.max(lo, x));
}
