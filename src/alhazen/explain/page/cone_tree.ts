// The cones of a pixel, with what each covers: as discs, as tables and in space.

import {css, element, headRow, listItem, number, scrolling, swatch, triple} from "./basics";
import type {Cone, Cones, SeeingCone, Unavailable} from "./explanation_data";
import type {SceneView} from "./scene_view";

const CONE_NAMES = {eye: "cone of the pixel", reflection: "reflected cone", refraction: "refracted cone"};

/** `from`: the object that it leaves, if any. A large piece samples each light in parts. */
function nameOf(c: Cone, from: string | undefined) {
  const whence = from === undefined ? "" : ` from \u2018${from}\u2019`;
  if (c.kind !== "shadow") return CONE_NAMES[c.kind] + whence;
  const part = c.part_count > 1 ? `, part ${c.part} of ${c.part_count} (${number(100 * c.weight)} %)` : "";
  return `cone to \u2018${c.light}\u2019${whence}${part}`;
}

export class ConeTree {
  constructor(root: HTMLElement, cones: Cones | Unavailable, private readonly view: SceneView) {
    if ("unavailable" in cones) {
      root.append(element("p", {}, `cone_tracing does not take this scene: ${cones.unavailable}`));
      return;
    }
    root.append(element("p", {class: "soft"}, "By cone_tracing: each piece covers a share of its cone; the weight is its visible fraction. " +
      "A cone\u2019s radiance is the sum of weight \u00d7 colour, plus what is left of the cone times the background."));
    if (cones.cut) root.append(element("p", {class: "cut"}, "The tree is cut: it has more than 2000 cones."));
    root.append(element("div", {class: "outline"}, element("ul", {"aria-label": "Cones"}, listItem(1, this.cone(cones.tree)))));
    view.cones = [cones.tree];
    view.draw();
  }
  private cone(c: Cone, from?: string): HTMLElement {
    const shadow = c.kind === "shadow", color = shadow ? c.through : c.radiance;
    const value = shadow ? `(${triple(color)}) of the light comes through` : `radiance (${triple(color)})`;
    const summary = element("summary", {class: c.kind}, ` ${nameOf(c, from)}: ${value} `, swatch(color));
    const show = () => { this.view.cones = [c]; this.view.draw(); };
    summary.addEventListener("click", show);
    summary.addEventListener("focus", show);
    const angle = number(2 * Math.atan(Math.abs(c.spread)) * 180 / Math.PI);
    const body = element("details", {class: "ray cone", open: c.depth < 2 && !shadow}, summary,
      element("p", {class: "soft"}, `radius ${number(c.radius)} where it starts, ` +
        (c.spread === 0 ? "parallel" : `${c.spread < 0 ? "narrows" : "widens"} by ${number(Math.abs(c.spread))} a unit (${angle}\u00b0)`) +
        (c.narrowed < 1 ? `; of it a part ${number(c.narrowed)} as wide was searched, for it met too many pieces` : "")));
    if (shadow) return body;
    const onward = c.parts.flatMap(p => p.cones.map(k => listItem(c.depth + 2, this.cone(k, p.object))));
    body.append(this.pieces(c), onward.length ? element("ul", {"aria-label": `Cones from this ${CONE_NAMES[c.kind]}`}, ...onward) : "");
    return body;
  }
  private pieces(c: SeeingCone) {
    const rows = c.parts.map(p => element("tr", {}, element("th", {scope: "row"}, `\u2018${p.object}\u2019`),
      ...[p.t, p.share, p.weight].map(x => element("td", {}, number(x))), element("td", {}, `(${triple(p.color)})`),
      element("td", {}, swatch(p.color))));
    const heads = ["piece", "t", "share", "weight", "colour", ""];
    return element("div", {class: "disc"}, coneDisc(c), scrolling("Pieces of a cone",
      element("table", {}, headRow(heads),
        element("tbody", {}, ...rows), element("tfoot", {}, element("tr", {}, element("th", {scope: "row", colspan: 3}, "left of the cone"),
          element("td", {}, number(c.left)), element("td"), element("td"))))));
  }
}
// The disc of a cone; each piece is a disc of its size around its middle.
function coneDisc(c: SeeingCone) {
  const svg = element("svg:svg", {class: "pixel", viewBox: "-1.15 -1.15 2.3 2.3", role: "img",
    "aria-label": `A cone with ${c.parts.length} pieces`}, element("svg:circle", {class: "frame", cx: 0, cy: 0, r: 1}));
  for (const p of c.parts) {
    const mark = element("svg:circle", {cx: p.at[0], cy: -p.at[1], r: Math.max(0.04, Math.sqrt(Math.min(1, p.share)) * 0.98),
                                        class: "piece"});
    mark.style.fill = css(p.color);
    svg.append(mark);
  }
  return svg;
}
