// The JSON of an explanation (explanation_json.cpp, method_json.cpp) as types. Non-finite numbers are null.

import type {Pair, Vec3} from "./basics";

export type RayKind = "eye" | "shadow" | "reflection" | "refraction";

export interface Crossing {
  t: number;
  object: string;
}
/** The contribution of a light to a point, and the shadow ray to it. */
export interface LightTerm {
  light: string;
  cosine: number;
  intensity: Vec3;
  diffuse: Vec3;
  highlight: Vec3;
  through: Vec3;
  value: Vec3;
  cast: boolean;
  origin: Vec3;
  direction: Vec3;
  t: number | null;
  crossings: Crossing[];
}
/** A ray that is sent on, or why there is none. */
export interface OnwardTerm {
  reason: string;
  factor?: Vec3;
  value?: Vec3;
  ray?: TreeRay;
}
export interface SurfacePoint {
  t: number;
  point: Vec3;
  normal: Vec3;
  object: string;
  material: string;
  entering: boolean;
  unlit: boolean;
  share: Vec3;
  emission: Vec3;
  color: Vec3;
  ambient_factor: Vec3;
  ambient: {light: string; intensity: Vec3; value: Vec3}[];
  lights: LightTerm[];
  reflected?: OnwardTerm;
  refracted?: OnwardTerm;
  filter?: Vec3;
}
export interface TreeRay {
  id: number;
  kind: Exclude<RayKind, "shadow">;
  depth: number;
  origin: Vec3;
  direction: Vec3;
  inside: boolean;
  radiance: Vec3;
  weight: Vec3;
  in_pixel: Vec3;
  escaped: boolean;
  given_up?: boolean;  // `left` had passed the largest number of surfaces
  left?: Vec3;
  surfaces: SurfacePoint[];
}

export type Span = [number | null, number | null];
/** A leaf with a name, or an operator with operands. */
export interface Combination {
  name?: string;
  operator?: "union" | "intersection" | "difference";
  spans: Span[];
  operands?: Combination[];
}
export interface Solid {
  name: string;
  spans: Span[];
  combination?: Combination;
}
export interface PolynomialOnRay {
  shape: string;
  object: string;
  expression: string;
  degree: number;
  from: number;
  to: number;
  bernstein: number[];
  roots: number[];
}

export interface TraversalStep {
  kind: "cell" | "bound" | "beam" | "primitive";
  number: number;
  met: boolean;
  object: string;
  corners: Vec3[];
}
export interface AcceleratorWork {
  accelerator: string;
  unavailable?: string;
  node_visits: number;
  empty_cells: number;
  box_tests: number;
  primitive_tests: number;
  mailbox_saved: number;
  t: number | null;
}
export interface Traversal {
  accelerator: string;
  steps: TraversalStep[];
  left_out: number;
  work: AcceleratorWork[];
}

export interface ConePart {
  object: string;
  t: number;
  at: Pair;
  share: number;
  weight: number;
  color: Vec3;
  cones: Cone[];
}
interface AnyCone {
  depth: number;
  origin: Vec3;
  axis: Vec3;
  radius: number;
  spread: number;
  narrowed: number;
  length: number | null;
}
export interface ShadowCone extends AnyCone {
  kind: "shadow";
  through: Vec3;
  light: string;
  part: number;  // from 1, of `part_count`
  part_count: number;
  weight: number;  // of the part
}
export interface SeeingCone extends AnyCone {
  kind: Exclude<RayKind, "shadow">;
  radiance: Vec3;
  left: number;
  parts: ConePart[];
}
export type Cone = ShadowCone | SeeingCone;
export interface Unavailable {
  unavailable: string;
}
export interface Cones {
  cut: boolean;
  tree: SeeingCone;
}

export type Outline = Pair[][];
export interface BeamPiece {
  id: number;
  from: number;
  kind: RayKind;
  depth: number;
  object: string;
  background: boolean;
  share: number;
  here: boolean;
  own?: Vec3;
  outline: Outline;
  lights: {light: string; through: string[]; here: boolean; color?: Vec3; outline?: Outline}[];
}
export interface Beams {
  polygons: number;
  beams: number;
  from: Pair;
  to: Pair;
  color: Vec3;
  left_out: number;
  pieces: BeamPiece[];
}

/** A ray of a path and the event at its end; colours are in the pixel. Without an object it hits no surface. */
export interface PathVertex {
  kind: Exclude<RayKind, "shadow">;
  origin: Vec3;
  direction: Vec3;
  t: number | null;
  throughput: Vec3;
  found: Vec3;
  step: "scattered" | "mirrored" | "straight" | "escaped" | "deepest" | "absorbed" | "roulette" | "passed_most";
  in_volume?: boolean;
  object?: string;
  material?: string;
  normal?: Vec3;
  light?: {origin: Vec3; direction: Vec3; t: number | null; offered: Vec3; arrived: Vec3};
}
export interface PathData {
  radiance: Vec3;
  vertices: PathVertex[];
}

export interface PatchSubdivision {
  shape: string;
  object: string;
  piece: number;
  degree: Pair;
  cut: boolean;
  parts: {level: number; u: number; v: number; met: boolean}[];
  crossings: {t: number; u: number; v: number}[];
}

/** x, y, z and the red, green, blue of 0 to 255 that is seen there. */
export type ScenePoint = [number, number, number, number, number, number];

export interface Explanation {
  scene: string;
  renderer: string;          // of the picture
  draws_at_random: boolean;  // true if the renderer is stochastic
  width: number;
  height: number;
  x: number;
  y: number;
  sample: number;
  max_depth: number;
  cut: number | false;
  pixel: Vec3;
  rays: Record<RayKind, number>;
  samples: {place: Pair; radiance: Vec3}[];
  picture: [Vec3, Vec3, Vec3, Vec3];
  parallel: boolean;
  tree: TreeRay;
  solids: Solid[];
  polynomials: PolynomialOnRay[];
  patches: PatchSubdivision[];
  cones?: Cones | Unavailable;
  beams?: Beams | Unavailable;
  path?: PathData;
  traversal?: Traversal;
  points: ScenePoint[];
}
