// What a picture may cost while the view moves, so that 20 a second come: fewer pixels first, then fewer generations of
// rays, by the times of the pictures before.

import type {FrameFacts} from "./state";

const AIM = 46;  // milliseconds from picture to picture

export interface PaceLimits {
  full: number;      // width of the whole picture
  depth: number;     // that is chosen
  deepens: boolean;  // whether the renderer has a depth
}

export class Pace {
  private width: number | undefined;
  private depth: number | undefined;

  /** Another scene or renderer: nothing is known. */
  forget() {
    this.width = this.depth = undefined;
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
    // Half of the way at once: times of single pictures differ.
    const wanted = this.width * clamped(AIM / cost, 0.25, 2.25) ** 0.35;
    const least = limits.full / 4, most = limits.full / 2;
    if (limits.deepens && wanted < least && this.depth > 0) {
      --this.depth;
      this.width = least;
    } else if (limits.deepens && cost < 0.6 * AIM && wanted >= most && this.depth < limits.depth) ++this.depth;
    else this.width = wanted;
  }
}

function clamped(x: number, lo: number, hi: number) {
  return Math.min(hi, Math.max(lo, x));
}
