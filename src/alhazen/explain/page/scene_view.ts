// The rays of a pixel in space: points of the scene, the frame of the picture, the tree of rays, and the steps of an
// accelerator. Drag, wheel and keys turn the view; a click selects a ray.

import {add, along, cross, dot, norm, scaled, sub, unit} from "./basics";
import type {Pair, Vec3} from "./basics";
import type {Cone, Explanation, ScenePoint} from "./explanation_data";
import type {AnyRay} from "./ray_outline";

type Spot = [x: number, y: number, depth: number];
type Segment = [Spot, Spot];
interface Stroke {
  color: string;
  width?: number;
  dash?: number[];
  arrow?: boolean;
  alpha?: number;
}

/** A line with a colour of the page's. */
export interface DrawnLine {
  from: Vec3;
  to: Vec3;
  color: string;
  width: number;
  dash: number[];
}

export class SceneView {
  selected: AnyRay | null = null;
  step = -1;
  showSteps = true;
  showShadows = true;
  cones: Cone[] = [];
  lines: DrawnLine[] = [];
  private readonly eye: Vec3;
  private readonly axes: {right: Vec3; up: Vec3};
  private readonly up: Vec3;
  private center: Vec3 = [0, 0, 0];
  private radius = 1;
  // The view: an azimuth and an elevation around the target.
  private front: Vec3 = [0, 0, 1];
  private side: Vec3 = [1, 0, 0];
  private turn = 0;
  private rise = 0;
  private distance = 1;
  private target: Vec3 = [0, 0, 0];
  // Of the current drawing.
  private width = 0;
  private height = 0;
  private near = 0;
  private f!: ReturnType<SceneView["frame"]>;
  private g: CanvasRenderingContext2D;
  private hot: [Segment, AnyRay][] = [];

  constructor(private readonly canvas: HTMLCanvasElement, private readonly data: Explanation,
              private readonly rays: AnyRay[], private readonly onSelect: (ray: AnyRay) => void) {
    this.g = canvas.getContext("2d")!;
    this.eye = data.tree.origin;
    const [a, b, , d] = data.picture;
    this.axes = {right: unit(sub(b, a)), up: unit(sub(a, d))};
    this.up = Math.abs(this.axes.up[2]) >= Math.abs(this.axes.up[1]) ? [0, 0, 1] : [0, 1, 0];
    if (dot(this.up, this.axes.up) < 0) this.up = scaled(-1, this.up);
    this.measure();
    this.home();
    this.listen();
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  // The sphere in view: around the first surface, as large as what the camera sees near it. Distant points, such as
  // those of an unbounded ground, do not count.
  private measure() {
    const first = this.data.tree.surfaces[0];
    const points = this.data.points.map((p): Vec3 => [p[0], p[1], p[2]]);
    const mean = points.length ? scaled(1 / points.length, points.reduce(add)) : along(this.data.tree, 1);
    this.center = first ? first.point : mean;
    const distances = points.map(p => norm(sub(p, this.center))).sort((x, y) => x - y);
    const common = distances.length ? 1.4 * distances[Math.floor(0.45 * distances.length)] : 0;
    this.radius = common || 0.3 * norm(sub(this.eye, this.center)) || 1;
  }
  home() {
    const back = sub(this.eye, this.center);
    const height = dot(back, this.up), flat = sub(back, scaled(height, this.up));
    this.front = norm(flat) > 1e-9 ? unit(flat) : unit(cross(this.axes.right, this.up));
    this.side = cross(this.up, this.front);
    this.turn = 0.7;
    this.rise = Math.min(1.2, Math.atan2(height, norm(flat)) + 0.25);
    this.distance = 2.6 * this.radius;
    this.target = this.center;
    this.draw();
  }

  private frame() {
    const c = Math.cos(this.rise), s = Math.sin(this.rise);
    const flat = add(scaled(Math.cos(this.turn), this.front), scaled(Math.sin(this.turn), this.side));
    const back = add(scaled(c, flat), scaled(s, this.up));
    const right = unit(cross(this.up, back));
    return {back, right, up: cross(back, right), eye: add(this.target, scaled(this.distance, back))};
  }
  // [x, y, depth] on the canvas.
  private project(p: Vec3, f = this.f): Spot {
    const v = sub(p, f.eye), depth = -dot(v, f.back);
    const scale = 0.9 * Math.min(this.width, this.height) / Math.max(depth, 1e-6 * this.distance);
    return [this.width / 2 + scale * dot(v, f.right), this.height / 2 - scale * dot(v, f.up), depth];
  }

  draw() {
    const ratio = devicePixelRatio || 1, box = this.canvas.getBoundingClientRect();
    if (!box.width) return;
    this.width = box.width;
    this.height = box.height;
    this.canvas.width = Math.round(box.width * ratio);
    this.canvas.height = Math.round(box.height * ratio);
    const g = this.g;
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    g.lineCap = "round";
    this.f = this.frame();
    this.near = 0.02 * this.distance;
    this.hot = [];
    this.drawPoints();
    this.drawPicture();
    if (this.showSteps) this.drawSteps();
    for (const cone of this.cones) this.drawCone(cone);
    for (const ray of this.rays) if (ray !== this.selected) this.drawRay(ray);
    if (this.selected) this.drawRay(this.selected);
    for (const l of this.lines) this.line(l.from, l.to, {color: this.color(l.color), width: l.width, dash: l.dash, arrow: true});
    this.drawLabels();
  }
  private color(name: string) {
    return getComputedStyle(this.canvas).getPropertyValue(`--${name}`).trim() || "#888";
  }
  private drawPoints() {
    const seen = this.data.points.map((p): [Vec3, ScenePoint] => [[p[0], p[1], p[2]], p])
      .filter(([at]) => norm(sub(at, this.center)) < 8 * this.radius)
      .map(([at, p]): [Spot, ScenePoint] => [this.project(at), p]).filter(([q]) => q[2] > this.near);
    seen.sort((a, b) => b[0][2] - a[0][2]);
    for (const [q, p] of seen) {
      const size = Math.min(14, Math.max(2, 0.011 * this.height * this.radius / q[2] * 2.6));
      this.g.globalAlpha = 0.75;
      this.g.fillStyle = `rgb(${p[3]} ${p[4]} ${p[5]})`;
      this.g.fillRect(q[0] - size / 2, q[1] - size / 2, size, size);
    }
    this.g.globalAlpha = 1;
  }
  // Clips a line at the near plane; returns its ends on the canvas, or null.
  private segment(a: Vec3, b: Vec3): Segment | null {
    let p = this.project(a), q = this.project(b);
    if (p[2] < this.near && q[2] < this.near) return null;
    const cut = (from: Vec3, to: Vec3, df: number, dt: number) => add(from, scaled((this.near - df) / (dt - df), sub(to, from)));
    if (p[2] < this.near) p = this.project(cut(a, b, p[2], q[2]));
    else if (q[2] < this.near) q = this.project(cut(a, b, p[2], q[2]));
    return [p, q];
  }
  private line(a: Vec3, b: Vec3, {color, width = 1.5, dash = [], arrow = false, alpha = 1}: Stroke) {
    const s = this.segment(a, b);
    if (!s) return null;
    const g = this.g, [p, q] = s;
    g.globalAlpha = alpha;
    g.strokeStyle = g.fillStyle = color;
    g.lineWidth = width;
    g.setLineDash(dash);
    g.beginPath();
    g.moveTo(p[0], p[1]);
    g.lineTo(q[0], q[1]);
    g.stroke();
    g.setLineDash([]);
    const dx = q[0] - p[0], dy = q[1] - p[1], long = Math.hypot(dx, dy);
    if (arrow && long > 18) {
      const x = p[0] + 0.6 * dx, y = p[1] + 0.6 * dy, u = dx / long, v = dy / long, size = 4 + 1.6 * width;
      g.beginPath();
      g.moveTo(x + size * u, y + size * v);
      g.lineTo(x - size * u - 0.7 * size * v, y - size * v + 0.7 * size * u);
      g.lineTo(x - size * u + 0.7 * size * v, y - size * v - 0.7 * size * u);
      g.fill();
    }
    g.globalAlpha = 1;
    return s;
  }
  private drawPicture() {
    const reach = 0.35 * norm(sub(this.center, this.eye));
    const at: Vec3[] = this.data.parallel ? this.data.picture
      : this.data.picture.map(p => add(this.eye, scaled(reach, unit(sub(p, this.eye)))));
    const color = this.color("soft");
    at.forEach((p, i) => {
      this.line(p, at[(i + 1) % 4], {color, width: 1, alpha: 0.8});
      if (!this.data.parallel) this.line(this.eye, p, {color, width: 1, alpha: 0.35});
    });
  }
  // The end of a ray: its last surface, or a point in free space.
  private end(ray: AnyRay) {
    if (ray.kind === "shadow") return along(ray, ray.t ?? 0.8 * this.radius);
    const met = ray.surfaces.at(-1);
    return ray.escaped || !met ? along(ray, 1.1 * this.radius + (met ? met.t : 0)) : met.point;
  }
  private drawRay(ray: AnyRay) {
    if (ray.kind === "shadow" && !this.showShadows && ray !== this.selected) return;
    const chosen = ray === this.selected;
    const blocked = ray.kind === "shadow" && ray.blocked;
    const s = this.line(ray.origin, this.end(ray), {
      color: this.color(ray.kind), width: chosen ? 4.5 : ray.kind === "shadow" ? 1.3 : 2.4,
      dash: ray.kind === "shadow" ? [5, 4] : ray.escaped ? [10, 5] : [], arrow: true,
      alpha: blocked && !chosen ? 0.55 : 1});
    if (!s) return;
    this.hot.push([s, ray]);
    const g = this.g, q = s[1];
    g.strokeStyle = g.fillStyle = this.color(ray.kind);
    g.lineWidth = 2;
    if (blocked) {
      g.beginPath();
      for (const k of [-1, 1]) {
        g.moveTo(q[0] - 4, q[1] - 4 * k);
        g.lineTo(q[0] + 4, q[1] + 4 * k);
      }
      g.stroke();
    } else if (ray.kind === "shadow" && ray.t !== null) {
      g.beginPath();
      g.arc(q[0], q[1], 5, 0, 7);
      g.fillStyle = "#ffd34d";
      g.fill();
      g.stroke();
    } else if (ray.kind !== "shadow" && ray.surfaces.length) {
      g.beginPath();
      g.arc(q[0], q[1], chosen ? 6 : 4, 0, 7);
      g.fill();
    }
    for (const surface of chosen && ray.kind !== "shadow" ? ray.surfaces : []) {
      this.line(surface.point, add(surface.point, scaled(0.14 * this.radius, surface.normal)),
                {color: this.color("ink"), width: 2, arrow: true});
    }
  }
  private drawLabels() {
    const g = this.g;
    g.font = "600 12px system-ui, sans-serif";
    g.textAlign = "center";
    g.textBaseline = "middle";
    const taken: Pair[] = [];
    for (const [[p, q], ray] of this.hot) {
      if (ray.kind === "shadow" && ray !== this.selected) continue;
      const x = p[0] + 0.38 * (q[0] - p[0]), y = p[1] + 0.38 * (q[1] - p[1]) - 12;
      if (taken.some(t => Math.hypot(t[0] - x, t[1] - y) < 16) && ray !== this.selected) continue;
      taken.push([x, y]);
      const text = ray.kind === "shadow" ? ray.light : String(ray.id), w = g.measureText(text).width / 2 + 5;
      g.fillStyle = this.color("card");
      g.globalAlpha = 0.9;
      g.beginPath();
      g.roundRect(x - w, y - 9, 2 * w, 18, 9);
      g.fill();
      g.globalAlpha = 1;
      g.fillStyle = this.color(ray.kind);
      g.fillText(text, x, y + 0.5);
    }
  }
  private drawSteps() {
    const steps = this.data.traversal?.steps ?? [];
    const last = this.step < 0 ? -1 : this.step;
    for (let i = 0; i <= last && i < steps.length; ++i) {
      const step = steps[i], current = i === last;
      if (!step.corners.length || (i < last - 60)) continue;
      const p = step.corners.map(c => this.project(c));
      if (p.some(q => q[2] < this.near)) continue;
      const g = this.g, color = this.color(step.kind === "bound" && !step.met ? "missed" : "cell");
      g.beginPath();
      hull(p).forEach((q, k) => (k ? g.lineTo(q[0], q[1]) : g.moveTo(q[0], q[1])));
      g.closePath();
      g.fillStyle = g.strokeStyle = color;
      g.globalAlpha = current ? 0.22 : 0.05;
      g.fill();
      g.globalAlpha = current ? 1 : 0.35;
      g.lineWidth = current ? 2.5 : 1;
      g.stroke();
      if (step.corners.length === 8 && step.kind !== "beam" && current) boxEdges(step.corners).forEach(([a, b]) =>
        this.line(a, b, {color, width: 1, alpha: 0.8}));
      g.globalAlpha = 1;
    }
  }

  // A cone up to its end: its silhouette and circles; then the cones that leave it.
  private drawCone(c: Cone) {
    const color = this.color(c.kind), parts = c.kind === "shadow" ? [] : c.parts;
    const e1 = unit(cross(c.axis, Math.abs(c.axis[0]) < 0.7 ? [1, 0, 0] : [0, 1, 0])), e2 = cross(c.axis, e1);
    const length = c.length ?? 1.1 * this.radius + (parts.at(-1)?.t ?? 0);
    const ring = (t: number) => Array.from({length: 24}, (_, i) => {
      const a = 2 * Math.PI * i / 24, r = c.radius + c.spread * t;
      return add(add(c.origin, scaled(t, c.axis)), add(scaled(r * Math.cos(a), e1), scaled(r * Math.sin(a), e2)));
    });
    const stops = [0, ...parts.map(p => p.t), length].map(ring);
    stops.forEach(points => points.forEach((p, i) => this.line(p, points[(i + 1) % 24], {color, width: 1, alpha: 0.7})));
    for (let i = 0; i < 24; i += 4) this.line(stops[0][i], stops[stops.length - 1][i], {color, width: 1, alpha: 0.45});
    for (const part of parts) for (const k of part.cones) this.drawCone(k);
  }

  private listen() {
    const c = this.canvas, touches = new Map<number, Pair>();
    let moved = 0, spread = 0;
    c.addEventListener("pointerdown", e => {
      c.setPointerCapture(e.pointerId);
      touches.set(e.pointerId, [e.clientX, e.clientY]);
      moved = 0;
      spread = 0;
    });
    c.addEventListener("pointermove", e => {
      const before = touches.get(e.pointerId);
      if (!before) return;
      const dx = e.clientX - before[0], dy = e.clientY - before[1];
      moved += Math.abs(dx) + Math.abs(dy);
      touches.set(e.pointerId, [e.clientX, e.clientY]);
      if (touches.size === 2) {
        const [a, b] = [...touches.values()], now = Math.hypot(a[0] - b[0], a[1] - b[1]);
        if (spread) this.distance *= spread / now;
        spread = now;
        this.pan(dx / 2, dy / 2);
      } else if (e.shiftKey || e.buttons & 2) this.pan(dx, dy);
      else this.orbit(-0.008 * dx, 0.008 * dy);
      this.draw();
    });
    const up = (e: PointerEvent) => {
      if (touches.delete(e.pointerId) && moved < 4 && e.type === "pointerup") this.pick(e);
    };
    c.addEventListener("pointerup", up);
    c.addEventListener("pointercancel", up);
    c.addEventListener("contextmenu", e => e.preventDefault());
    c.addEventListener("wheel", e => {
      e.preventDefault();
      this.distance *= Math.exp(0.0012 * e.deltaY);
      this.draw();
    }, {passive: false});
    const keys: Record<string, () => void> = {
      ArrowLeft: () => this.orbit(-0.1, 0), ArrowRight: () => this.orbit(0.1, 0), ArrowUp: () => this.orbit(0, 0.1),
      ArrowDown: () => this.orbit(0, -0.1), "+": () => { this.distance *= 0.87; }, "-": () => { this.distance /= 0.87; },
      "0": () => this.home()};
    const withShift: Record<string, () => void> = {
      ArrowLeft: () => this.pan(30, 0), ArrowRight: () => this.pan(-30, 0), ArrowUp: () => this.pan(0, 30),
      ArrowDown: () => this.pan(0, -30)};
    c.addEventListener("keydown", e => {
      const act = (e.shiftKey ? withShift[e.key] : undefined) ?? keys[e.key];
      if (!act || e.ctrlKey || e.metaKey) return;
      e.preventDefault();
      act();
      this.draw();
    });
  }
  private orbit(turn: number, rise: number) {
    this.turn += turn;
    this.rise = Math.min(1.55, Math.max(-1.55, this.rise + rise));
  }
  private pan(dx: number, dy: number) {
    const f = this.frame(), scale = this.distance / (0.9 * Math.min(this.width, this.height));
    this.target = add(this.target, add(scaled(-scale * dx, f.right), scaled(scale * dy, f.up)));
  }
  private pick(e: PointerEvent) {
    const box = this.canvas.getBoundingClientRect(), x = e.clientX - box.left, y = e.clientY - box.top;
    let best: AnyRay | null = null, least = 9;
    for (const [[p, q], ray] of this.hot) {
      const dx = q[0] - p[0], dy = q[1] - p[1];
      const u = Math.min(1, Math.max(0, ((x - p[0]) * dx + (y - p[1]) * dy) / (dx * dx + dy * dy || 1)));
      const d = Math.hypot(x - p[0] - u * dx, y - p[1] - u * dy);
      if (d < least) [best, least] = [ray, d];
    }
    if (best) this.onSelect(best);
  }
  select(ray: AnyRay) {
    this.selected = ray;
    this.draw();
  }
}

// The convex hull of points of the canvas (Andrew's monotone chain).
function hull(points: Spot[]) {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const turn = (o: Spot, a: Spot, b: Spot) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
  const chain = (list: Spot[]) => {
    const made: Spot[] = [];
    for (const p of list) {
      while (made.length > 1 && turn(made[made.length - 2], made[made.length - 1], p) <= 0) made.pop();
      made.push(p);
    }
    return made.slice(0, -1);
  };
  return [...chain(sorted), ...chain(sorted.reverse())];
}
// The edges of a box: pairs of corners that differ along one axis.
function boxEdges(corners: Vec3[]) {
  const edges: [Vec3, Vec3][] = [];
  corners.forEach((a, i) => corners.slice(i + 1).forEach(b => {
    if ([0, 1, 2].filter(k => a[k] !== b[k]).length === 1) edges.push([a, b]);
  }));
  return edges;
}
