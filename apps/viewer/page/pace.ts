// What a picture may cost while the view moves, so that 20 a second come: fewer generations of rays first, down to one,
// then fewer pixels, down to a quarter of the width, then no generations, by the times of the pictures before.

import type {FrameFacts} from "./state";

const AIM = 46;        // milliseconds from picture to picture
const TOO_SLOW = 1.07; // of AIM; times of single pictures differ
const FAST = 0.7;      // of AIM: another generation may fit
const USUAL = 1;       // generations that are kept while the picture is wider than a quarter

export interface PaceLimits {
  full: number;      // width of the whole picture
  depth: number;     // that is chosen
  deepens: boolean;  // whether the renderer has a depth
}

export class Pace {
  private width: number | undefined;
  private depth: number | undefined;
  private tooDeep = Infinity;  // was too slow at half the width
  private mean = AIM;          // of the costs, late ones more

  /** Another scene or renderer: nothing is known. */
  forget() {
    this.width = this.depth = undefined;
    this.tooDeep = Infinity;
    this.mean = AIM;
  }
  /** Width and depth of the next picture. Where nothing is known an eighth as wide, and two generations. */
  next(limits: PaceLimits) {
    this.width = clamped(this.width ?? limits.full / 8, 48, limits.full / 2);
    this.depth = Math.min(this.depth ?? 2, limits.depth);
    return {width: Math.round(this.width), depth: limits.deepens ? this.depth : limits.depth};
  }
  /** `cost`: milliseconds since the picture before, or since it was asked for. */
  learn(cost: number, facts: FrameFacts, limits: PaceLimits) {
    if (this.width === undefined || this.depth === undefined || Math.abs(facts.width - this.width) > 0.3 * this.width) return;
    this.mean += 0.3 * (cost - this.mean);
    const most = limits.full / 2, floor = limits.deepens ? leastWidth(this.depth, limits) : 0;
    // Half of the way at once.
    const wanted = this.width * clamped(AIM / cost, 0.25, 2.25) ** 0.35;
    this.width = Math.min(most, Math.max(wanted, Math.min(this.width, floor)));
    if (!limits.deepens) return;
    if (this.mean > TOO_SLOW * AIM && this.depth > 0 && this.width <= floor) {
      if (this.width === most) this.tooDeep = this.depth;
      this.change(this.depth - 1);
    } else if (this.width === most && this.depth < limits.depth) {
      const fast = this.depth + 1 < this.tooDeep ? FAST : FAST * FAST;
      if (this.mean < fast * AIM) this.change(this.depth + 1);
    }
  }

  private change(depth: number) {
    this.depth = depth;
    this.mean = AIM;  // of another depth
  }
}

/** Below it generations are given up before pixels are. */
function leastWidth(depth: number, limits: PaceLimits) {
  return depth > USUAL ? limits.full / 2 : depth > 0 ? limits.full / 4 : 0;
}

function clamped(x: number, lo: number, hi: number) {
  return Math.min(hi, Math.max(lo, x));
}
