// A camera as a block of the native format, which gives the same picture.

import {cross, dot, norm, unit} from "../../../src/alhazen/explain/page/basics";
import type {Vec3} from "../../../src/alhazen/explain/page/basics";
import type {CameraData, LensData} from "./state";

type Frame = Pick<CameraData, "eye" | "look" | "right" | "up" | "parallel" | "aspect" | "lens">;

const ROUNDING = 1e-12;
const FAR = 1e5;  // distance of the eye from the origin, in that of what it sees, from which rounding is seen

const vector = (v: Vec3) => `(${v.join(", ")})`;

/** True if direction, upper side, angle and aspect describe the sides up to rounding. */
function isPlain({eye, look, right, up, aspect}: Frame, distance: number) {
  const l = unit(look), r = unit(right), u = unit(up);
  return [dot(l, r), dot(l, u), dot(r, u), norm(right) / norm(up) / aspect - 1].every(x => Math.abs(x) < ROUNDING) &&
    dot(cross(l, u), r) > 0 && norm(eye) < FAR * distance;
}
function lensLines(lens: LensData | undefined) {
  if (!lens) return [];
  return [`lens_radius = ${lens.radius}`, `focus_distance = ${lens.focus_distance}`,
          ...(lens.blades ? [`blades = ${lens.blades}`, `blade_turn_rad = ${lens.turn}`] : [])];
}
export function blockOf(frame: Frame & {distance: number}) {
  const {eye, look, right, up, parallel, aspect, lens} = frame, plain = isPlain(frame, frame.distance);
  const kind = parallel ? plain ? "orthographic" : "sheared_orthographic" : plain ? "perspective" : "sheared";
  const size = parallel ? `height = ${norm(up)}` : `fov_deg = ${2 * Math.atan2(norm(up) / 2, norm(look)) * 180 / Math.PI}`;
  const way = plain || parallel ? "direction" : "look";
  const lines = [`eye = ${vector(eye)}`, `${way} = ${vector(look)}`, ...(plain ? [`up = ${vector(unit(up))}`, size]
    : [`right = ${vector(right)}`, `up = ${vector(up)}`]), `aspect = ${aspect}`, ...lensLines(lens)];
  return `${kind}_camera "view" {\n${lines.map(line => `    ${line}\n`).join("")}}\n`;
}
