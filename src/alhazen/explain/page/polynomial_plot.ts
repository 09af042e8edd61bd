// The polynomial of an algebraic surface along the ray, with its Bernstein coefficients as a control polygon and its
// roots.

import {element, number} from "./basics";
import type {Explanation, PolynomialOnRay} from "./explanation_data";

export function polynomialPlots(root: HTMLElement, data: Explanation) {
  for (const p of data.polynomials) root.append(polynomialPlot(p));
}
function bernsteinValue(b: number[], u: number) {
  const row = [...b];
  for (let n = row.length - 1; n > 0; --n) for (let i = 0; i < n; ++i) row[i] = (1 - u) * row[i] + u * row[i + 1];
  return row[0];
}
function polynomialPlot(p: PolynomialOnRay) {
  const w = 360, h = 170, n = p.degree, count = 160;
  const values = Array.from({length: count + 1}, (_, i) => bernsteinValue(p.bernstein, i / count));
  const size = Math.max(...p.bernstein.map(Math.abs)) || 1;
  // Coefficients of high degrees are far larger than the values between the roots: asinh shows both.
  const bent = (v: number) => n > 2 ? Math.asinh(50 * v / size) / Math.asinh(50) : v / size;
  const y = (v: number) => h / 2 - (h / 2 - 8) * bent(v);
  const x = (u: number) => 8 + (w - 16) * u;
  const path = values.map((v, i) => `${i ? "L" : "M"}${x(i / count).toFixed(1)} ${y(v).toFixed(1)}`).join("");
  const polygon = p.bernstein.map((b, i) => `${x(i / n).toFixed(1)},${y(b).toFixed(1)}`).join(" ");
  const title = `${p.shape} \u2018${p.object}\u2019: degree ${n}, ` +
                (p.roots.length ? `roots at t = ${p.roots.map(number).join(", ")}` : "no real root in its bounds");
  const svg = element("svg:svg", {viewBox: `0 0 ${w} ${h}`, role: "img", "aria-label": title},
    element("svg:line", {class: "zero", x1: 8, x2: w - 8, y1: h / 2, y2: h / 2}),
    element("svg:polyline", {class: "polygon", points: polygon}),
    element("svg:path", {class: "curve", d: path}));
  p.bernstein.forEach((b, i) => svg.append(element("svg:circle", {class: "control", cx: x(i / n), cy: y(b), r: 3})));
  p.roots.forEach((t, i) => {  // labels alternate above and below
    const u = (t - p.from) / (p.to - p.from);
    svg.append(element("svg:circle", {class: "root", cx: x(u), cy: h / 2, r: 5}));
    svg.append(element("svg:text", {x: x(u), y: i % 2 ? h / 2 + 20 : h / 2 - 10}, number(t)));
  });
  return element("figure", {class: "plot"}, svg, element("figcaption", {},
    element("b", {}, title), element("br"), element("code", {}, p.expression.length > 120 ? `${p.expression.slice(0, 117)}...` : p.expression),
    element("details", {}, element("summary", {class: "soft"}, "Bernstein coefficients"), element("p", {class: "mono"},
      `t from ${number(p.from)} to ${number(p.to)}: ${p.bernstein.map(b => number(b)).join(", ")}`))));
}
