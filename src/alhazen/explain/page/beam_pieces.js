// The pieces of beam_tracing around a pixel: polygons of the picture, and what each adds to the pixel.

class BeamPieces {
  constructor(root, data) {
    const {beams} = data;
    if (beams.unavailable) {
      root.append(element("p", {}, `beam_tracing does not take this scene: ${beams.unavailable}`));
      return;
    }
    Object.assign(this, {data, beams, pixel: [data.x, data.y], near: true});
    const of_pixel = beams.pieces.filter(p => p.share > 0);
    this.chosen = of_pixel.find(p => p.here) ?? of_pixel[0] ?? beams.pieces[0];
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
  // The pieces from the eye to a piece.
  chain(piece) {
    const list = [piece];
    for (let at = piece; at.from !== at.id;) {
      at = this.beams.pieces.find(p => p.id === at.from);
      if (!at) break;
      list.unshift(at);
    }
    return list;
  }
  table(pieces) {
    this.rows = new Map();
    const rows = pieces.map(p => {
      const what = p.background ? "background" : `\u2018${p.object}\u2019`;
      const behind = this.chain(p).slice(0, -1).map(q => `\u2018${q.object}\u2019`);
      const lights = p.lights.filter(l => l.here).map(l => element("div", {class: "soft"},
        `${l.light}${l.through.length ? ` through ${l.through.join(", ")}` : ""}: (${triple(l.color)})`));
      const button = element("button", {type: "button", class: `link ${p.kind}`, click: () => this.choose(p)}, what);
      const row = element("tr", {}, element("th", {scope: "row"}, button,
        behind.length ? element("div", {class: "soft"}, `${p.kind === "reflection" ? "mirrored in" : "seen through"} ${behind.join(", ")}`) : null),
        element("td", {}, `${number(100 * p.share)} %`),
        element("td", {class: "how"}, p.here ? element("div", {}, `own light: (${triple(p.own)})`) : "does not hold the sample point", ...lights));
      this.rows.set(p, row);
      return row;
    });
    const heads = ["piece", "of the pixel", "adds to the sample point"];
    return element("div", {class: "scroll", tabindex: "0", role: "region", "aria-label": "Pieces of the pixel"}, element("table", {},
      element("thead", {}, element("tr", {}, ...heads.map(h => element("th", {scope: "col"}, h)))), element("tbody", {}, ...rows),
      element("tfoot", {}, element("tr", {}, element("th", {scope: "row", colspan: 2}, "sum"),
        element("td", {}, `(${triple(this.beams.color)}) `, swatch(this.beams.color))))));
  }
  choose(piece) {
    this.chosen = piece;
    this.draw();
  }
  draw() {
    const {beams, svg, pixel: [x, y]} = this;
    const ring = this.near ? 5 : Infinity;
    const lo = [Math.max(beams.from[0], x - ring), Math.max(beams.from[1], y - ring)];
    const hi = [Math.min(beams.to[0], x + 1 + ring), Math.min(beams.to[1], y + 1 + ring)];
    svg.setAttribute("viewBox", `${lo[0]} ${lo[1]} ${hi[0] - lo[0]} ${hi[1] - lo[1]}`);
    const path = (outline, type) => element("svg:path", {class: type, "fill-rule": "evenodd",
      d: outline.map(loop => `M${loop.map(p => p.join(" ")).join("L")}Z`).join("")});
    svg.replaceChildren();
    for (const p of beams.pieces) if (p.depth === 0) svg.append(path(p.outline, "piece"));
    const chain = this.chosen ? this.chain(this.chosen) : [];
    chain.forEach(p => svg.append(path(p.outline, `chosen ${p.kind}`)));
    for (const light of this.chosen?.lights ?? []) if (light.outline) svg.append(path(light.outline, "lit"));
    svg.append(element("svg:rect", {class: "here", x, y, width: 1, height: 1}));
    for (const [p, row] of this.rows) row.classList.toggle("selected", p === this.chosen);
  }
}
