// The messages of the server (view_menus.cpp, scene_store.cpp) as types.

import type {Vec3} from "../../../src/alhazen/explain/page/basics";

export interface LensData {
  radius: number;
  focus_distance: number;
  blades: number;
  turn: number;  // radians
}
export interface CameraData {
  name: string;
  eye: Vec3;
  look: Vec3;
  right: Vec3;
  up: Vec3;
  aspect: number;    // width / height that the sides are given for
  width: number;     // of its picture, pixels
  height: number;
  parallel: boolean;
  distance: number;
  lens?: LensData;   // undefined: a pinhole
  block?: string;    // its block in the native format if it moves
  headlight?: LightEntry;  // the added light for this camera if it differs from that of the first
}
export interface Choice {
  name: string;
  value?: string;
  what?: string;
}
export interface RendererChoice extends Choice {
  selects: boolean;
  follows_light: boolean;
  depth?: number;  // default; undefined: that of the scene
}
/** A light; absent fields are left out. */
export interface LightEntry extends Choice {
  position?: Vec3;
  direction?: Vec3;  // into the scene
  color: Vec3;       // or radiance, ambient term, emission
  sizes?: {name: string, value: number}[];  // of a light with extent
}
/** Changes of a light relative to the file. */
export interface LightChange {
  name: string;
  position?: Vec3;
  direction?: Vec3;
  color: Vec3;
  sizes?: number[];
}
/** State that changes only with the file. */
export interface Menus {
  scene: string;
  width: number;
  height: number;
  up: "y" | "z";
  depth: number;
  cameras: CameraData[];
  renderers: RendererChoice[];
  accelerators: Choice[];
  lights: LightEntry[];
  added_light?: {name: string, follows_light: boolean};  // false: renderers that follow light do without
  environments: Choice[];
  layers: Choice[];
  scales: Record<"heat" | "grey", string[]>;
  curves: string[];
  steps: string;
}
/** Running work; `client` if it belongs to one page, `part` (0 to 1) if it is known. */
export interface Work {
  what: string;
  seconds: number;
  client?: string;
  part?: number;
}
/** State that changes continually. */
export interface Moment {
  version: number;
  accelerator: string;
  error: string;
  memory: number;
  stopped: boolean;  // reading was stopped; it restarts on request
  work: Work[];
}
export type State = Moment & Partial<Menus>;
export type Scene = Moment & Menus;

export interface LayerFacts {
  name: string;
  meaning: string;
  low?: number;
  high?: number;
  colors?: "heat" | "grey";
}
export interface FrameFacts {
  seconds: number;
  rays: number;
  threads: number;
  version: number;
  width: number;
  height: number;
  layer?: LayerFacts;
}
/** The head of a picture. */
export interface FrameHead {
  id: number;
  status: number;
  type: string;
  facts: FrameFacts | null;
}
export interface Wish {
  /** `of`: number of the camera that the view began at. */
  camera: Pick<CameraData, "eye" | "look" | "right" | "up" | "parallel" | "aspect" | "lens"> & {of: number};
  width: number;
  height: number;
  renderer: string;
  accelerator: string;
  layer: string;
  depth?: number;  // undefined: that of scene and renderer
  exposure: number;
  curve: string;
  environment: string;  // empty: that of the scene
  lights_off: string[];
  lights: LightChange[];
  samples: number;
  selected?: boolean;
}
