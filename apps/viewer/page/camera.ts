// The camera: its position, its frame, and the point it turns around.

import {add, cross, dot, norm, scaled, sub, unit} from "../../../src/alhazen/explain/page/basics";
import type {Vec3} from "../../../src/alhazen/explain/page/basics";
import type {CameraData} from "./state";

export class ViewCamera {
  eye: Vec3;
  look: Vec3;
  right: Vec3;
  up: Vec3;
  readonly parallel: boolean;
  readonly aspect: number;
  distance: number;
  private readonly world: Vec3;

  constructor(given: CameraData, up: "y" | "z") {
    ({eye: this.eye, look: this.look, right: this.right, up: this.up, parallel: this.parallel} = given);
    this.aspect = norm(given.right) / norm(given.up);
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
  // Turns around the point at `distance`; the pole is not crossed.
  orbit(dx: number, dy: number) {
    const center = add(this.eye, scaled(this.distance, unit(this.look)));
    this.turn(this.world, -dx);
    const rise = Math.asin(Math.max(-1, Math.min(1, dot(unit(this.look), this.world))));
    const to = Math.max(-1.5, Math.min(1.5, rise - dy));
    this.turn(this.right, to - rise);
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
  block() {
    const v = (a: Vec3) => `(${a.map(x => String(Number(x.toPrecision(9)))).join(", ")})`;
    const size = this.parallel ? `height = ${Number(norm(this.up).toPrecision(9))}`
      : `fov_deg = ${Number((2 * Math.atan2(norm(this.up) / 2, norm(this.look)) * 180 / Math.PI).toPrecision(9))}`;
    return `${this.parallel ? "orthographic" : "perspective"}_camera "view" {\n    eye = ${v(this.eye)}\n    look_at = ` +
           `${v(add(this.eye, scaled(this.distance || 1, unit(this.look))))}\n    up = ${v(unit(this.up))}\n    ${size}\n}\n`;
  }
}
