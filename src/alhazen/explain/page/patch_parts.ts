// The subdivision of patches for the eye ray: the parts of the unit square, level by level.

import {element, number} from "./basics";
import type {Explanation, PatchSubdivision} from "./explanation_data";

export function patchParts(root: HTMLElement, data: Explanation) {
  for (const p of data.patches) root.append(patchFigure(p));
}
function patchFigure(p: PatchSubdivision) {
  const deepest = Math.max(...p.parts.map(q => q.level)), svg = element("svg:svg", {class: "pixel patch", viewBox: "-0.02 -0.02 1.04 1.04"});
  const text = element("p", {class: "soft", "aria-live": "polite"});
  const level = element("input", {type: "range", min: 0, max: deepest, value: Math.min(5, deepest), "aria-label": "Level", input: () => draw()});
  const draw = () => {
    const most = Number(level.value), shown = p.parts.filter(q => q.level <= most), last = p.parts.filter(q => q.level === most);
    svg.replaceChildren(...shown.map(q => {
      const size = 2 ** -q.level;
      return element("svg:rect", {class: q.met ? (q.level === most ? "met" : "divided") : "dropped", x: q.u * size, y: 1 - (q.v + 1) * size,
                                  width: size, height: size});
    }), ...p.crossings.map(c => element("svg:circle", {class: "root", cx: c.u, cy: 1 - c.v, r: 0.012})));
    text.textContent = `Level ${most} of ${deepest}: ${last.length} parts tested, ${last.filter(q => q.met).length} met`;
    svg.setAttribute("aria-label", text.textContent);
  };
  svg.setAttribute("role", "img");
  draw();
  const roots = p.crossings.length ? `crossed at ${p.crossings.map(c => `t = ${number(c.t)} (u ${number(c.u)}, v ${number(c.v)})`).join(", ")}`
    : "not crossed";
  return element("figure", {class: "plot"}, svg, level, text, element("figcaption", {},
    element("b", {}, `${p.shape} \u2018${p.object}\u2019, patch ${p.piece}, degrees ${p.degree[0]} and ${p.degree[1]}: ${roots}`),
    p.cut ? element("p", {class: "cut"}, "The subdivision is cut: there are more than 4000 parts.") : null));
}
