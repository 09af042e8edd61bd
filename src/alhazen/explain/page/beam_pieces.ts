// The pieces of beam_tracing around a pixel: polygons of the picture, with their contributions to the pixel.

import {element, headRow, number, scrolling, swatch, triple} from "./basics";
import type {Pair} from "./basics";
import type {BeamPiece, Beams, Explanation, Outline, Unavailable} from "./explanation_data";

export function beamPieces(root: HTMLElement, data: Explanation, beams: Beams | Unavailable) {
  if ("unavailable" in beams) root.append(element("p", {}, `beam_tracing does not take this scene: ${beams.unavailable}`));
  else new BeamPieces(root, data, beams);
}

class BeamPieces {
  private readonly pixel: Pair;
  private readonly svg: SVGElement;
  private readonly rows = new Map<BeamPiece, HTMLElement>();
  private near = true;
  private chosen: BeamPiece | undefined;

  constructor(root: HTMLElement, data: Explanation, private readonly beams: Beams) {
    this.pixel = [data.x, data.y];
    const of_pixel = beams.pieces.filter(p => p.share > 0);
    this.chosen = of_pixel.find(p => p.here) ?? of_pixel.at(0) ?? beams.pieces.at(0);
    this.svg = element("svg:svg", {class: "beams", role: "img", "aria-label":
      `${beams.pieces.length} pieces of the picture; ${of_pixel.length} of them in the pixel`});
    const zoom = element("button", {type: "button", click: () => {
      this.near = !this.near;
      zoom.textContent = this.near ? "Show more" : "Show the pixel";
      this.draw();
    }}, "Show more");
    const facts = `${beams.polygons} polygons, ${beams.beams} beams for ` +
      (beams.to[0] - beams.from[0] < data.width ? "the pixels around" : "the whole picture") +
      (beams.left_out ? `; ${beams.left_out} pieces are not listed` : "");
    root.append(element("p", {class: "soft"}, `By beam_tracing: the pieces that the beams of this pixel see, each the visible part of a polygon. ${facts}.`),
      element("div", {class: "disc"}, element("div", {}, this.svg, zoom), this.table(of_pixel)));
    this.draw();
  }
  // The pieces on the way from the eye to a piece.
  private chain(piece: BeamPiece) {
    const list = [piece];
    for (let at = piece; at.from !== at.id;) {
      const before = this.beams.pieces.find(p => p.id === at.from);
      if (!before) break;
      list.unshift(at = before);
    }
    return list;
  }
  private table(pieces: BeamPiece[]) {
    const rows = pieces.map(p => {
      const what = p.background ? "background" : `\u2018${p.object}\u2019`;
      const behind = this.chain(p).slice(0, -1).map(q => `\u2018${q.object}\u2019`);
      const lights = p.lights.flatMap(l => !l.color ? [] : element("div", {class: "soft"},
        `${l.light}${l.through.length ? ` through ${l.through.join(", ")}` : ""}: (${triple(l.color)})`));
      const button = element("button", {type: "button", class: `link ${p.kind}`, click: () => this.choose(p)}, what);
      const row = element("tr", {}, element("th", {scope: "row"}, button,
        behind.length ? element("div", {class: "soft"}, `${p.kind === "reflection" ? "mirrored in" : "seen through"} ${behind.join(", ")}`) : null),
        element("td", {}, `${number(100 * p.share)} %`),
        element("td", {class: "how"}, p.own ? element("div", {}, `own light: (${triple(p.own)})`) : "does not hold the sample point", ...lights));
      this.rows.set(p, row);
      return row;
    });
    const heads = ["piece", "of the pixel", "adds to the sample point"];
    return scrolling("Pieces of the pixel", element("table", {}, headRow(heads), element("tbody", {}, ...rows),
      element("tfoot", {}, element("tr", {}, element("th", {scope: "row", colspan: 2}, "sum"),
        element("td", {}, `(${triple(this.beams.color)}) `, swatch(this.beams.color))))));
  }
  private choose(piece: BeamPiece) {
    this.chosen = piece;
    this.draw();
  }
  private draw() {
    const {beams, svg, pixel: [x, y]} = this;
    const ring = this.near ? 5 : Infinity;
    const lo = [Math.max(beams.from[0], x - ring), Math.max(beams.from[1], y - ring)];
    const hi = [Math.min(beams.to[0], x + 1 + ring), Math.min(beams.to[1], y + 1 + ring)];
    svg.setAttribute("viewBox", `${lo[0]} ${lo[1]} ${hi[0] - lo[0]} ${hi[1] - lo[1]}`);
    const path = (outline: Outline, type: string) => element("svg:path", {class: type, "fill-rule": "evenodd",
      d: outline.map(loop => `M${loop.map(p => p.join(" ")).join("L")}Z`).join("")});
    svg.replaceChildren();
    for (const p of beams.pieces) if (p.depth === 0) svg.append(path(p.outline, "piece"));
    const chain = this.chosen ? this.chain(this.chosen) : [];
    chain.forEach(p => svg.append(path(p.outline, `chosen ${p.kind}`)));
    for (const light of this.chosen?.lights ?? []) if (light.outline) svg.append(path(light.outline, "lit"));
    svg.append(element("svg:rect", {class: "here", x, y, width: 1, height: 1}));
    for (const [p, row] of this.rows) {
      row.classList.toggle("selected", p === this.chosen);
      if (p === this.chosen) row.setAttribute("aria-current", "true");
      else row.removeAttribute("aria-current");
    }
  }
}
