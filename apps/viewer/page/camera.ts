// The camera: its position, its frame, and the point it turns around.

import {add, cross, dot, norm, scaled, sub, unit} from "../../../src/alhazen/explain/page/basics";
import type {Vec3} from "../../../src/alhazen/explain/page/basics";
import {blockOf} from "./camera_block";
import type {CameraData, LensData} from "./state";

const STEEPEST = 1.5;  // radians between the view and the horizontal
const LEAST = 1e-6;    // sine of an angle to the vertical: below it, the sides of the picture decide

export class ViewCamera {
  eye: Vec3;
  look: Vec3;
  right: Vec3;
  up: Vec3;
  readonly parallel: boolean;
  readonly aspect: number;
  readonly lens: LensData | undefined;
  distance: number;
  private readonly world: Vec3;
  private readonly given: CameraData;

  constructor(given: CameraData, up: "y" | "z") {
    ({eye: this.eye, look: this.look, right: this.right, up: this.up, parallel: this.parallel, aspect: this.aspect,
      lens: this.lens} = given);
    this.given = given;
    this.world = up === "z" ? [0, 0, 1] : [0, 1, 0];
    // Without a surface in the middle: a point that the eye can orbit.
    this.distance = given.distance || 0.5 * norm(this.eye) + 1;
  }
  copy(): ViewCamera {
    return Object.assign(Object.create(ViewCamera.prototype), this);
  }
  /** True if it is where the camera of the scene is. */
  isAt(given: CameraData) {
    const keys = ["eye", "look", "right", "up"] as const;
    return keys.every(key => norm(sub(this[key], given[key])) === 0);
  }
  private turn(axis: Vec3, angle: number) {
    const c = Math.cos(angle), s = Math.sin(angle), k = unit(axis);
    const by = (v: Vec3) => add(add(scaled(c, v), scaled(s, cross(k, v))), scaled((1 - c) * dot(k, v), k));
    for (const key of ["look", "right", "up"] as const) this[key] = by(this[key]);
  }
  // Turns around the point at `distance`; the pole is not crossed. Pictures may be mirrored: `dx` turns towards their
  // right side, `dy` raises the eye.
  orbit(dx: number, dy: number) {
    const center = add(this.eye, scaled(this.distance, unit(this.look)));
    const side = dot(cross(unit(this.look), this.world), unit(this.right));
    const mirrored = (Math.abs(side) > LEAST ? side : dot(cross(this.look, this.up), this.right)) < 0;
    this.turn(this.world, mirrored ? dx : -dx);
    const look = unit(this.look), rise = Math.asin(Math.max(-1, Math.min(1, dot(look, this.world))));
    const to = Math.max(-STEEPEST, Math.min(STEEPEST, rise - dy)), level = cross(look, this.world);
    this.turn(norm(level) > LEAST ? level : cross(look, this.up), to - rise);
    this.eye = sub(center, scaled(this.distance, unit(this.look)));
  }
  walk(right: number, up: number, forward: number) {
    const by = add(add(scaled(right, unit(this.right)), scaled(up, unit(this.up))), scaled(forward, unit(this.look)));
    this.eye = add(this.eye, scaled(this.distance, by));
  }
  zoom(factor: number) {
    if (this.parallel) {
      this.right = scaled(factor, this.right);
      this.up = scaled(factor, this.up);
    } else this.eye = add(this.eye, scaled(this.distance * (1 - factor), unit(this.look)));
    this.distance *= factor;
  }
  /** The view for a scene file. */
  block() {
    return (this.isAt(this.given) && this.given.block) || blockOf(this);
  }
}
