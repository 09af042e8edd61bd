// Vectors, numbers, colours and elements.

export type Vec3 = [number, number, number];
export type Pair = [number, number];
export interface Line {
  origin: Vec3;
  direction: Vec3;
}

export const add = (a: Vec3, b: Vec3): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scaled = (s: number, a: Vec3): Vec3 => [s * a[0], s * a[1], s * a[2]];
export const dot = (a: Vec3, b: Vec3) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vec3, b: Vec3): Vec3 =>
  [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const norm = (a: Vec3) => Math.hypot(a[0], a[1], a[2]);
export const unit = (a: Vec3) => scaled(1 / (norm(a) || 1), a);
export const along = (ray: Line, t: number) => add(ray.origin, scaled(t, ray.direction));

// Four significant digits; JSON represents non-finite numbers by null.
export function number(x: number | null | undefined) {
  if (x === null || x === undefined) return "\u221e";
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (size >= 1e5 || size < 1e-4) return x.toExponential(2).replace("e+", "e");
  return String(Number(x.toPrecision(4)));
}
export const triple = (c: Vec3) => c.map(number).join(", ");

// Linear radiance as a CSS colour.
export function css(color: Vec3) {
  const code = (c: number) =>
    Math.round(255 * Math.min(1, Math.max(0, c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055)));
  return `rgb(${color.map(c => code(c ?? 0)).join(" ")})`;
}

export type Child = Node | string | null | undefined;
type Value = string | number | boolean | undefined;
export type Attributes = Record<string, Value | ((event: Event) => void)>;

// element("p", {class: "soft"}, "text", child, ...)
export function element<Name extends keyof HTMLElementTagNameMap>(name: Name, attributes?: Attributes,
                                                                  ...children: Child[]): HTMLElementTagNameMap[Name];
export function element(name: `svg:${string}`, attributes?: Attributes, ...children: Child[]): SVGElement;
export function element(name: string, attributes: Attributes = {}, ...children: Child[]) {
  const made = name.startsWith("svg:") ? document.createElementNS("http://www.w3.org/2000/svg", name.slice(4))
                                       : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === false || value === undefined) continue;
    if (typeof value === "function") made.addEventListener(key, value);
    else made.setAttribute(key, value === true ? "" : String(value));
  }
  made.append(...children.filter(c => c !== null && c !== undefined));
  return made;
}
// A patch of a colour. Uses the style object, as the page's policy forbids style attributes.
export function swatch(color: Vec3) {
  const made = element("span", {class: "swatch", "aria-hidden": "true"});
  made.style.background = css(color);
  return made;
}
// A list item; `level` of nested lists counts from 1.
export function listItem(level: number, ...children: Child[]) {
  return element("li", {"aria-level": level}, ...children);
}
export function scrollBehavior(): ScrollBehavior {
  return matchMedia("(prefers-reduced-motion: reduce)").matches ? "auto" : "smooth";
}
// A table that scrolls horizontally by itself.
export function scrolling(name: string, table: HTMLTableElement) {
  return element("div", {class: "scroll", tabindex: "0", role: "region", "aria-label": name}, table);
}
export function headRow(heads: string[]) {
  return element("thead", {}, element("tr", {}, ...heads.map(h => h ? element("th", {scope: "col"}, h) : element("td"))));
}
export const KINDS = {eye: "eye ray", shadow: "shadow ray", reflection: "reflected ray", refraction: "refracted ray"};
