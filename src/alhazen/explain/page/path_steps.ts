// A path of path_tracing: its throughput from surface to surface, emission it meets, and light samples.

import {add, along, element, headRow, norm, number, scaled, scrolling, swatch, triple, unit} from "./basics";
import type {Vec3} from "./basics";
import type {Explanation, PathData, PathVertex} from "./explanation_data";
import type {DrawnLine, SceneView} from "./scene_view";

const STEPS: Record<PathVertex["step"], string> = {
  scattered: "scattered, in a direction drawn at random", mirrored: "goes on in the one direction of a mirror or of smooth glass",
  straight: "goes straight on", escaped: "leaves the scene", deepest: "ends: no more scatterings are asked for",
  absorbed: "ends: no light goes on", roulette: "ends by chance: it carries little",
  passed_most: "ends: it has passed straight through as many surfaces as a path may"};
const isBlack = (c: Vec3) => c.every(x => x === 0);

export function pathSteps(root: HTMLElement, data: Explanation, path: PathData, view: SceneView) {
  const lines = linesOf(path), shown = element("input", {type: "checkbox", checked: true, change: () => draw()});
  const draw = () => {
    view.lines = shown.checked ? lines : [];
    view.draw();
  };
  root.append(
    element("p", {class: "soft"}, `Sample ${data.sample} as path_tracing followed it; each sample of each pixel has another path. ` +
      "Throughput is the fraction of the radiance at the origin of the ray that reaches the pixel. " +
      "The light of all rows adds up to the sample."),
    scrolling("The path", element("table", {}, headRow(["ray", "", "throughput", "hits", "direct light", "event", ""]),
      element("tbody", {}, ...path.vertices.map((v, i) => row(v, i))),
      element("tfoot", {}, element("tr", {}, element("th", {scope: "row", colspan: 5}, "sum"),
        element("td", {}, `(${triple(path.radiance)})`), element("td", {}, swatch(path.radiance)))))),
    element("label", {}, shown, " draw it in space above"));
  draw();
}
function row(v: PathVertex, i: number) {
  const met = v.t === null ? "meets nothing" : v.in_volume && !v.object ? "is scattered in a volume without end"
    : v.in_volume ? `is scattered inside \u2018${v.object}\u2019, or what is before it`
    : `meets \u2018${v.object}\u2019 at t = ${number(v.t)}`;
  const light = !v.light ? "none is asked" : isBlack(v.light.arrived) ? `blocked: (${triple(v.light.offered)})`
    : `(${triple(v.light.arrived)})`;
  const here = add(v.found, v.light?.arrived ?? [0, 0, 0]);
  return element("tr", {class: "vertex"}, element("th", {scope: "row", class: v.kind}, String(i + 1)),
    element("td", {class: "how"}, met), element("td", {}, `(${triple(v.throughput)})`),
    element("td", {}, isBlack(v.found) ? "no light" : `(${triple(v.found)})`), element("td", {}, light),
    element("td", {class: "how"}, STEPS[v.step]), element("td", {}, swatch(here)));
}
function linesOf(path: PathData) {
  const list: DrawnLine[] = [];
  const reach = Math.max(1e-9, ...path.vertices.map(v => v.t === null ? 0 : v.t * norm(v.direction)));
  for (const v of path.vertices) {
    const end = v.t === null ? add(v.origin, scaled(0.5 * reach, unit(v.direction))) : along(v, v.t);
    list.push({from: v.origin, to: end, color: "cell", width: 4, dash: v.t === null ? [10, 5] : []});
    if (!v.light) continue;
    const far = v.light.t === null ? 0.5 * reach / norm(v.light.direction) : v.light.t;
    list.push({from: v.light.origin, to: along(v.light, far), color: isBlack(v.light.arrived) ? "shadow" : "cell", width: 1.3,
               dash: [3, 4]});
  }
  return list;
}
