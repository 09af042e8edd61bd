// Vectors, numbers, colours and elements, for the files behind this one.
// All files of the page are joined, in the order of CMakeLists.txt, into one module: their names are shared.

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scaled = (s, a) => [s * a[0], s * a[1], s * a[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = a => Math.hypot(a[0], a[1], a[2]);
const unit = a => scaled(1 / (norm(a) || 1), a);
const along = (ray, t) => add(ray.origin, scaled(t, ray.direction));

// Four significant digits; JSON has null for what is not finite.
function number(x) {
  if (x === null || x === undefined) return "\u221e";
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (size >= 1e5 || size < 1e-4) return x.toExponential(2).replace("e+", "e");
  return String(Number(x.toPrecision(4)));
}
const triple = c => c.map(number).join(", ");

// Linear radiance as a CSS colour.
function css(color) {
  const code = c => Math.round(255 * Math.min(1, Math.max(0, c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055)));
  return `rgb(${color.map(c => code(c ?? 0)).join(" ")})`;
}

// element("p", {class: "soft"}, "text", child, ...)
function element(name, attributes = {}, ...children) {
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
// A patch of a colour. Set by the style object: the page's policy forbids style attributes.
function swatch(color) {
  const made = element("span", {class: "swatch", "aria-hidden": "true"});
  made.style.background = css(color);
  return made;
}
const KINDS = {eye: "eye ray", shadow: "shadow ray", reflection: "reflected ray", refraction: "refracted ray"};
