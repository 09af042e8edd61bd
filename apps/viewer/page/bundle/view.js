// Made from apps/viewer/page/view.ts by scripts/page: do not edit.

// src/alhazen/explain/page/basics.ts
var add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
var sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
var scaled = (s, a) => [s * a[0], s * a[1], s * a[2]];
var dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
var cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
var norm = (a) => Math.hypot(a[0], a[1], a[2]);
var unit = (a) => scaled(1 / (norm(a) || 1), a);
var along = (ray, t) => add(ray.origin, scaled(t, ray.direction));
function number(x) {
  if (x === null || x === void 0) return "\u221E";
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (size >= 1e5 || size < 1e-4) return x.toExponential(2).replace("e+", "e");
  return String(Number(x.toPrecision(4)));
}
var triple = (c) => c.map(number).join(", ");
function css(color) {
  const code = (c) => Math.round(255 * Math.min(1, Math.max(0, c <= 31308e-7 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055)));
  return `rgb(${color.map((c) => code(c ?? 0)).join(" ")})`;
}
function element(name, attributes = {}, ...children) {
  const made = name.startsWith("svg:") ? document.createElementNS("http://www.w3.org/2000/svg", name.slice(4)) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === false || value === void 0) continue;
    if (typeof value === "function") made.addEventListener(key, value);
    else made.setAttribute(key, value === true ? "" : String(value));
  }
  made.append(...children.filter((c) => c !== null && c !== void 0));
  return made;
}
function swatch(color) {
  const made = element("span", { class: "swatch", "aria-hidden": "true" });
  made.style.background = css(color);
  return made;
}
function listItem(level, ...children) {
  return element("li", { "aria-level": level }, ...children);
}
function scrollBehavior() {
  return matchMedia("(prefers-reduced-motion: reduce)").matches ? "auto" : "smooth";
}
function scrolling(name, table) {
  return element("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": name }, table);
}
function headRow(heads) {
  return element("thead", {}, element("tr", {}, ...heads.map((h) => h ? element("th", { scope: "col" }, h) : element("td"))));
}
var KINDS = { eye: "eye ray", shadow: "shadow ray", reflection: "reflected ray", refraction: "refracted ray" };

// src/alhazen/explain/page/beam_pieces.ts
function beamPieces(root, data, beams) {
  if ("unavailable" in beams) root.append(element("p", {}, `beam_tracing does not take this scene: ${beams.unavailable}`));
  else new BeamPieces(root, data, beams);
}
var BeamPieces = class {
  constructor(root, data, beams) {
    this.beams = beams;
    this.pixel = [data.x, data.y];
    const of_pixel = beams.pieces.filter((p) => p.share > 0);
    this.chosen = of_pixel.find((p) => p.here) ?? of_pixel.at(0) ?? beams.pieces.at(0);
    this.svg = element("svg:svg", { class: "beams", role: "img", "aria-label": `${beams.pieces.length} pieces of the picture; ${of_pixel.length} of them in the pixel` });
    const zoom = element("button", { type: "button", click: () => {
      this.near = !this.near;
      zoom.textContent = this.near ? "Show more" : "Show the pixel";
      this.draw();
    } }, "Show more");
    const facts = `${beams.polygons} polygons, ${beams.beams} beams for ` + (beams.to[0] - beams.from[0] < data.width ? "the pixels around" : "the whole picture") + (beams.left_out ? `; ${beams.left_out} pieces are not listed` : "");
    root.append(
      element("p", { class: "soft" }, `By beam_tracing: the pieces that the beams of this pixel see, each the visible part of a polygon. ${facts}.`),
      element("div", { class: "disc" }, element("div", {}, this.svg, zoom), this.table(of_pixel))
    );
    this.draw();
  }
  pixel;
  svg;
  rows = /* @__PURE__ */ new Map();
  near = true;
  chosen;
  // The pieces on the way from the eye to a piece.
  chain(piece) {
    const list = [piece];
    for (let at = piece; at.from !== at.id; ) {
      const before = this.beams.pieces.find((p) => p.id === at.from);
      if (!before) break;
      list.unshift(at = before);
    }
    return list;
  }
  table(pieces) {
    const rows = pieces.map((p) => {
      const what = p.background ? "background" : `\u2018${p.object}\u2019`;
      const behind = this.chain(p).slice(0, -1).map((q) => `\u2018${q.object}\u2019`);
      const lights = p.lights.flatMap((l) => !l.color ? [] : element(
        "div",
        { class: "soft" },
        `${l.light}${l.through.length ? ` through ${l.through.join(", ")}` : ""}: (${triple(l.color)})`
      ));
      const button = element("button", { type: "button", class: `link ${p.kind}`, click: () => this.choose(p) }, what);
      const row2 = element(
        "tr",
        {},
        element(
          "th",
          { scope: "row" },
          button,
          behind.length ? element("div", { class: "soft" }, `${p.kind === "reflection" ? "mirrored in" : "seen through"} ${behind.join(", ")}`) : null
        ),
        element("td", {}, `${number(100 * p.share)} %`),
        element("td", { class: "how" }, p.own ? element("div", {}, `own light: (${triple(p.own)})`) : "does not hold the sample point", ...lights)
      );
      this.rows.set(p, row2);
      return row2;
    });
    const heads = ["piece", "of the pixel", "adds to the sample point"];
    return scrolling("Pieces of the pixel", element(
      "table",
      {},
      headRow(heads),
      element("tbody", {}, ...rows),
      element("tfoot", {}, element(
        "tr",
        {},
        element("th", { scope: "row", colspan: 2 }, "sum"),
        element("td", {}, `(${triple(this.beams.color)}) `, swatch(this.beams.color))
      ))
    ));
  }
  choose(piece) {
    this.chosen = piece;
    this.draw();
  }
  draw() {
    const { beams, svg, pixel: [x, y] } = this;
    const ring = this.near ? 5 : Infinity;
    const lo = [Math.max(beams.from[0], x - ring), Math.max(beams.from[1], y - ring)];
    const hi = [Math.min(beams.to[0], x + 1 + ring), Math.min(beams.to[1], y + 1 + ring)];
    svg.setAttribute("viewBox", `${lo[0]} ${lo[1]} ${hi[0] - lo[0]} ${hi[1] - lo[1]}`);
    const path = (outline, type) => element("svg:path", {
      class: type,
      "fill-rule": "evenodd",
      d: outline.map((loop) => `M${loop.map((p) => p.join(" ")).join("L")}Z`).join("")
    });
    svg.replaceChildren();
    for (const p of beams.pieces) if (p.depth === 0) svg.append(path(p.outline, "piece"));
    const chain = this.chosen ? this.chain(this.chosen) : [];
    chain.forEach((p) => svg.append(path(p.outline, `chosen ${p.kind}`)));
    for (const light of this.chosen?.lights ?? []) if (light.outline) svg.append(path(light.outline, "lit"));
    svg.append(element("svg:rect", { class: "here", x, y, width: 1, height: 1 }));
    for (const [p, row2] of this.rows) {
      row2.classList.toggle("selected", p === this.chosen);
      if (p === this.chosen) row2.setAttribute("aria-current", "true");
      else row2.removeAttribute("aria-current");
    }
  }
};

// src/alhazen/explain/page/cone_tree.ts
var CONE_NAMES = { eye: "cone of the pixel", reflection: "reflected cone", refraction: "refracted cone" };
function nameOf(c, from) {
  const whence = from === void 0 ? "" : ` from \u2018${from}\u2019`;
  if (c.kind !== "shadow") return CONE_NAMES[c.kind] + whence;
  const part = c.part_count > 1 ? `, part ${c.part} of ${c.part_count} (${number(100 * c.weight)} %)` : "";
  return `cone to \u2018${c.light}\u2019${whence}${part}`;
}
var ConeTree = class {
  constructor(root, cones, view) {
    this.view = view;
    if ("unavailable" in cones) {
      root.append(element("p", {}, `cone_tracing does not take this scene: ${cones.unavailable}`));
      return;
    }
    root.append(element("p", { class: "soft" }, "By cone_tracing: each piece covers a share of its cone; the weight is its visible fraction. A cone\u2019s radiance is the sum of weight \xD7 colour, plus what is left of the cone times the background."));
    if (cones.cut) root.append(element("p", { class: "cut" }, "The tree is cut: it has more than 2000 cones."));
    root.append(element("div", { class: "outline" }, element("ul", { "aria-label": "Cones" }, listItem(1, this.cone(cones.tree)))));
    view.cones = [cones.tree];
    view.draw();
  }
  cone(c, from) {
    const shadow = c.kind === "shadow", color = shadow ? c.through : c.radiance;
    const value = shadow ? `(${triple(color)}) of the light comes through` : `radiance (${triple(color)})`;
    const summary = element("summary", { class: c.kind }, ` ${nameOf(c, from)}: ${value} `, swatch(color));
    const show = () => {
      this.view.cones = [c];
      this.view.draw();
    };
    summary.addEventListener("click", show);
    summary.addEventListener("focus", show);
    const angle = number(2 * Math.atan(Math.abs(c.spread)) * 180 / Math.PI);
    const body = element(
      "details",
      { class: "ray cone", open: c.depth < 2 && !shadow },
      summary,
      element("p", { class: "soft" }, `radius ${number(c.radius)} where it starts, ` + (c.spread === 0 ? "parallel" : `${c.spread < 0 ? "narrows" : "widens"} by ${number(Math.abs(c.spread))} a unit (${angle}\xB0)`) + (c.narrowed < 1 ? `; of it a part ${number(c.narrowed)} as wide was searched, for it met too many pieces` : ""))
    );
    if (shadow) return body;
    const onward = c.parts.flatMap((p) => p.cones.map((k) => listItem(c.depth + 2, this.cone(k, p.object))));
    body.append(this.pieces(c), onward.length ? element("ul", { "aria-label": `Cones from this ${CONE_NAMES[c.kind]}` }, ...onward) : "");
    return body;
  }
  pieces(c) {
    const rows = c.parts.map((p) => element(
      "tr",
      {},
      element("th", { scope: "row" }, `\u2018${p.object}\u2019`),
      ...[p.t, p.share, p.weight].map((x) => element("td", {}, number(x))),
      element("td", {}, `(${triple(p.color)})`),
      element("td", {}, swatch(p.color))
    ));
    const heads = ["piece", "t", "share", "weight", "colour", ""];
    return element("div", { class: "disc" }, coneDisc(c), scrolling(
      "Pieces of a cone",
      element(
        "table",
        {},
        headRow(heads),
        element("tbody", {}, ...rows),
        element("tfoot", {}, element(
          "tr",
          {},
          element("th", { scope: "row", colspan: 3 }, "left of the cone"),
          element("td", {}, number(c.left)),
          element("td"),
          element("td")
        ))
      )
    ));
  }
};
function coneDisc(c) {
  const svg = element("svg:svg", {
    class: "pixel",
    viewBox: "-1.15 -1.15 2.3 2.3",
    role: "img",
    "aria-label": `A cone with ${c.parts.length} pieces`
  }, element("svg:circle", { class: "frame", cx: 0, cy: 0, r: 1 }));
  for (const p of c.parts) {
    const mark = element("svg:circle", {
      cx: p.at[0],
      cy: -p.at[1],
      r: Math.max(0.04, Math.sqrt(Math.min(1, p.share)) * 0.98),
      class: "piece"
    });
    mark.style.fill = css(p.color);
    svg.append(mark);
  }
  return svg;
}

// src/alhazen/explain/page/patch_parts.ts
function patchParts(root, data) {
  for (const p of data.patches) root.append(patchFigure(p));
}
function patchFigure(p) {
  const deepest = Math.max(...p.parts.map((q) => q.level)), svg = element("svg:svg", { class: "pixel patch", viewBox: "-0.02 -0.02 1.04 1.04" });
  const text = element("p", { class: "soft", "aria-live": "polite" });
  const level = element("input", { type: "range", min: 0, max: deepest, value: Math.min(5, deepest), "aria-label": "Level", input: () => draw() });
  const draw = () => {
    const most = Number(level.value), shown = p.parts.filter((q) => q.level <= most), last = p.parts.filter((q) => q.level === most);
    svg.replaceChildren(...shown.map((q) => {
      const size = 2 ** -q.level;
      return element("svg:rect", {
        class: q.met ? q.level === most ? "met" : "divided" : "dropped",
        x: q.u * size,
        y: 1 - (q.v + 1) * size,
        width: size,
        height: size
      });
    }), ...p.crossings.map((c) => element("svg:circle", { class: "root", cx: c.u, cy: 1 - c.v, r: 0.012 })));
    text.textContent = `Level ${most} of ${deepest}: ${last.length} parts tested, ${last.filter((q) => q.met).length} met`;
    svg.setAttribute("aria-label", text.textContent);
  };
  svg.setAttribute("role", "img");
  draw();
  const roots = p.crossings.length ? `crossed at ${p.crossings.map((c) => `t = ${number(c.t)} (u ${number(c.u)}, v ${number(c.v)})`).join(", ")}` : "not crossed";
  return element("figure", { class: "plot" }, svg, level, text, element(
    "figcaption",
    {},
    element("b", {}, `${p.shape} \u2018${p.object}\u2019, patch ${p.piece}, degrees ${p.degree[0]} and ${p.degree[1]}: ${roots}`),
    p.cut ? element("p", { class: "cut" }, "The subdivision is cut: there are more than 4000 parts.") : null
  ));
}

// src/alhazen/explain/page/path_steps.ts
var STEPS = {
  scattered: "scattered, in a direction drawn at random",
  mirrored: "goes on in the one direction of a mirror or of smooth glass",
  straight: "goes straight on",
  escaped: "leaves the scene",
  deepest: "ends: no more scatterings are asked for",
  absorbed: "ends: no light goes on",
  roulette: "ends by chance: it carries little",
  passed_most: "ends: it has passed straight through as many surfaces as a path may"
};
var isBlack = (c) => c.every((x) => x === 0);
function pathSteps(root, data, path, view) {
  const lines = linesOf(path), shown = element("input", { type: "checkbox", checked: true, change: () => draw() });
  const draw = () => {
    view.lines = shown.checked ? lines : [];
    view.draw();
  };
  root.append(
    element("p", { class: "soft" }, `Sample ${data.sample} as path_tracing followed it; each sample of each pixel has another path. Throughput is the fraction of the radiance at the origin of the ray that reaches the pixel. The light of all rows adds up to the sample.`),
    scrolling("The path", element(
      "table",
      {},
      headRow(["ray", "", "throughput", "hits", "direct light", "event", ""]),
      element("tbody", {}, ...path.vertices.map((v, i) => row(v, i))),
      element("tfoot", {}, element(
        "tr",
        {},
        element("th", { scope: "row", colspan: 5 }, "sum"),
        element("td", {}, `(${triple(path.radiance)})`),
        element("td", {}, swatch(path.radiance))
      ))
    )),
    element("label", {}, shown, " draw it in space above")
  );
  draw();
}
function row(v, i) {
  const met = v.t === null ? "meets nothing" : v.in_volume && !v.object ? "is scattered in a volume without end" : v.in_volume ? `is scattered inside \u2018${v.object}\u2019, or what is before it` : `meets \u2018${v.object}\u2019 at t = ${number(v.t)}`;
  const light = !v.light ? "none is asked" : isBlack(v.light.arrived) ? `blocked: (${triple(v.light.offered)})` : `(${triple(v.light.arrived)})`;
  const here = add(v.found, v.light?.arrived ?? [0, 0, 0]);
  return element(
    "tr",
    { class: "vertex" },
    element("th", { scope: "row", class: v.kind }, String(i + 1)),
    element("td", { class: "how" }, met),
    element("td", {}, `(${triple(v.throughput)})`),
    element("td", {}, isBlack(v.found) ? "no light" : `(${triple(v.found)})`),
    element("td", {}, light),
    element("td", { class: "how" }, STEPS[v.step]),
    element("td", {}, swatch(here))
  );
}
function linesOf(path) {
  const list = [];
  const reach = Math.max(1e-9, ...path.vertices.map((v) => v.t === null ? 0 : v.t * norm(v.direction)));
  for (const v of path.vertices) {
    const end = v.t === null ? add(v.origin, scaled(0.5 * reach, unit(v.direction))) : along(v, v.t);
    list.push({ from: v.origin, to: end, color: "cell", width: 4, dash: v.t === null ? [10, 5] : [] });
    if (!v.light) continue;
    const far = v.light.t === null ? 0.5 * reach / norm(v.light.direction) : v.light.t;
    list.push({
      from: v.light.origin,
      to: along(v.light, far),
      color: isBlack(v.light.arrived) ? "shadow" : "cell",
      width: 1.3,
      dash: [3, 4]
    });
  }
  return list;
}

// src/alhazen/explain/page/polynomial_plot.ts
function polynomialPlots(root, data) {
  for (const p of data.polynomials) root.append(polynomialPlot(p));
}
function bernsteinValue(b, u) {
  const row2 = [...b];
  for (let n = row2.length - 1; n > 0; --n) for (let i = 0; i < n; ++i) row2[i] = (1 - u) * row2[i] + u * row2[i + 1];
  return row2[0];
}
function polynomialPlot(p) {
  const w = 360, h = 170, n = p.degree, count = 160;
  const values = Array.from({ length: count + 1 }, (_, i) => bernsteinValue(p.bernstein, i / count));
  const size = Math.max(...p.bernstein.map(Math.abs)) || 1;
  const bent = (v) => n > 2 ? Math.asinh(50 * v / size) / Math.asinh(50) : v / size;
  const y = (v) => h / 2 - (h / 2 - 8) * bent(v);
  const x = (u) => 8 + (w - 16) * u;
  const path = values.map((v, i) => `${i ? "L" : "M"}${x(i / count).toFixed(1)} ${y(v).toFixed(1)}`).join("");
  const polygon = p.bernstein.map((b, i) => `${x(i / n).toFixed(1)},${y(b).toFixed(1)}`).join(" ");
  const title = `${p.shape} \u2018${p.object}\u2019: degree ${n}, ` + (p.roots.length ? `roots at t = ${p.roots.map(number).join(", ")}` : "no real root in its bounds");
  const svg = element(
    "svg:svg",
    { viewBox: `0 0 ${w} ${h}`, role: "img", "aria-label": title },
    element("svg:line", { class: "zero", x1: 8, x2: w - 8, y1: h / 2, y2: h / 2 }),
    element("svg:polyline", { class: "polygon", points: polygon }),
    element("svg:path", { class: "curve", d: path })
  );
  p.bernstein.forEach((b, i) => svg.append(element("svg:circle", { class: "control", cx: x(i / n), cy: y(b), r: 3 })));
  p.roots.forEach((t, i) => {
    const u = (t - p.from) / (p.to - p.from);
    svg.append(element("svg:circle", { class: "root", cx: x(u), cy: h / 2, r: 5 }));
    svg.append(element("svg:text", { x: x(u), y: i % 2 ? h / 2 + 20 : h / 2 - 10 }, number(t)));
  });
  return element("figure", { class: "plot" }, svg, element(
    "figcaption",
    {},
    element("b", {}, title),
    element("br"),
    element("code", {}, p.expression.length > 120 ? `${p.expression.slice(0, 117)}...` : p.expression),
    element("details", {}, element("summary", { class: "soft" }, "Bernstein coefficients"), element(
      "p",
      { class: "mono" },
      `t from ${number(p.from)} to ${number(p.to)}: ${p.bernstein.map((b) => number(b)).join(", ")}`
    ))
  ));
}

// src/alhazen/explain/page/ray_outline.ts
var REASONS = {
  no_coefficient: "the material has none",
  deepest: "the tree ends at this depth",
  too_weak: "its share of the pixel would be below the least contribution",
  total_reflection: "total internal reflection: Snell\u2019s law has no solution",
  not_traced: "this scene\u2019s conventions trace none"
};
function raysOf(tree) {
  const list = [];
  const visit = (ray) => {
    list.push(ray);
    for (const surface of ray.surfaces) {
      for (const light of surface.lights ?? []) {
        if (!light.cast) continue;
        const blocked = light.through.every((c) => c === 0);
        const shadow = Object.assign(light, { kind: "shadow", blocked, distance: light.t });
        if (blocked) shadow.t = light.crossings.at(-1)?.t ?? light.t;
        list.push(shadow);
      }
      for (const term of [surface.reflected, surface.refracted]) if (term?.ray) visit(term.ray);
    }
  };
  visit(tree);
  return list;
}
function isShadow(light) {
  return light !== void 0 && light.kind === "shadow";
}
var RayOutline = class {
  // denominator of the weights
  constructor(root, data, onSelect) {
    this.onSelect = onSelect;
    this.whole = data.samples.length > 1 ? "sample" : "pixel";
    root.append(element("ul", { "aria-label": "Rays" }, listItem(1, this.ray(data.tree))));
  }
  places = /* @__PURE__ */ new Map();
  whole;
  select(ray, reveal) {
    for (const [other, place2] of this.places) {
      place2.classList.toggle("selected", other === ray);
      if (other === ray) place2.setAttribute("aria-current", "true");
      else place2.removeAttribute("aria-current");
    }
    const place = this.places.get(ray);
    if (!place || !reveal) return;
    for (let at = place.parentElement; at; at = at.parentElement) if (at instanceof HTMLDetailsElement) at.open = true;
    place.scrollIntoView({ block: "nearest", behavior: scrollBehavior() });
  }
  ray(ray) {
    const met = ray.surfaces.map((s) => `\u2018${s.object}\u2019`).join(", then ");
    const first = ray.surfaces.at(0);
    const summary = element(
      "summary",
      { class: ray.kind },
      element("b", { class: "badge" }, `${ray.id}`),
      ` ${KINDS[ray.kind]} `,
      first ? `meets ${met} at t = ${number(first.t)}` : "meets nothing",
      " ",
      swatch(ray.radiance)
    );
    const body = element(
      "details",
      { open: ray.depth < 3, class: "ray" },
      summary,
      element("p", { class: "soft" }, `radiance (${triple(ray.radiance)}) \xD7 weight (${triple(ray.weight)}) = (${triple(ray.in_pixel)}) of the ${this.whole}`),
      element("details", {}, element("summary", { class: "soft" }, "where it runs"), element(
        "p",
        { class: "mono" },
        `origin (${triple(ray.origin)}), direction (${triple(ray.direction)})`,
        ray.inside ? "; it starts inside something transparent" : ""
      ))
    );
    summary.addEventListener("click", () => this.onSelect(ray));
    summary.addEventListener("focus", () => this.onSelect(ray, false));
    this.places.set(ray, summary);
    ray.surfaces.forEach((s) => body.append(this.surface(s, ray.depth + 2)));
    if (ray.left) body.append(element("p", {}, ray.given_up ? `It ends here: it has passed as many surfaces as a ray may, and (${triple(ray.left)}) of its light is not known.` : `It leaves the scene and takes (${triple(ray.left)}) of the background.`));
    return body;
  }
  // `level`: level in the outline of the rays that leave it.
  surface(s, level) {
    const box = element("div", { class: "surface" });
    box.append(element(
      "p",
      {},
      element("b", {}, `\u2018${s.object}\u2019`),
      s.material ? `, material \u2018${s.material}\u2019` : "",
      `, t = ${number(s.t)}, `,
      s.entering ? "from outside" : "from inside",
      s.share.some((c) => c !== 1) ? `, share of the ray (${triple(s.share)})` : ""
    ));
    box.append(this.equation(s));
    const onward = [s.reflected, s.refracted].flatMap((term) => term?.ray ? [listItem(level, this.ray(term.ray))] : []);
    if (onward.length) box.append(element("ul", { "aria-label": `Rays from ${s.object}` }, ...onward));
    return box;
  }
  equation(s) {
    const rows = [];
    const row2 = (name, how, value, light) => {
      const head = element("th", { scope: "row" }, name);
      const line = element(
        "tr",
        {},
        head,
        element("td", { class: "how" }, how),
        ...(value ?? [null, null, null]).map((c) => element("td", { title: String(c) }, value ? number(c) : "\u2013")),
        element("td", {}, value ? swatch(value) : "")
      );
      if (isShadow(light)) {
        head.replaceChildren(element("button", { type: "button", class: "link shadow", click: () => this.onSelect(light) }, name));
        this.places.set(light, line);
      }
      rows.push(line);
    };
    row2("emission", "ke", s.emission);
    if (!s.unlit) {
      for (const a of s.ambient) {
        row2(`ambient, ${a.light}`, `ka (${triple(s.ambient_factor)}) \xD7 Ia (${triple(a.intensity)})`, a.value);
      }
      for (const light of s.lights) row2(light.light, this.lightText(light), light.value, light);
      this.onward("reflected", "kr", s.reflected, row2);
      this.onward("refracted", "kt", s.refracted, row2);
      if (s.filter) row2("medium", `all of it \xD7 (${triple(s.filter)}): what the medium lets through`, null);
    }
    return scrolling(`Shading of ${s.object}`, element(
      "table",
      { class: "equation" },
      headRow(["term", "factors", "red", "green", "blue", ""]),
      element("tbody", {}, ...rows),
      element("tfoot", {}, element(
        "tr",
        {},
        element("th", { scope: "row", colspan: 2 }, "sum"),
        ...s.color.map((c) => element("td", { title: String(c) }, number(c))),
        element("td", {}, swatch(s.color))
      ))
    ));
  }
  lightText(light) {
    const names = light.crossings.map((c) => `\u2018${c.object}\u2019`);
    if (light.intensity.every((c) => c === 0)) return `emits nothing towards this point: I (0, 0, 0), N\xB7L = ${number(light.cosine)}`;
    const through = !light.cast ? "no shadow rays are cast" : isShadow(light) && light.blocked ? `blocked${names.length ? ` by ${names.at(-1)}` : ""}` : names.length ? `(${triple(light.through)}) comes through ${names.join(", ")}` : "unhindered";
    return `${through}; I (${triple(light.intensity)}) \xD7 [kd (N\xB7L) (${triple(light.diffuse)}) + ks highlight (${triple(light.highlight)})], N\xB7L = ${number(light.cosine)}`;
  }
  onward(name, factor, term, row2) {
    if (!term) return;
    if (term.ray && term.factor) row2(
      name,
      `${factor} (${triple(term.factor)}) \xD7 ray ${term.ray.id} (${triple(term.ray.radiance)})`,
      term.value
    );
    else if (term.reason !== "no_coefficient") row2(name, `not sent: ${REASONS[term.reason]}`, null);
  }
};

// src/alhazen/explain/page/scene_view.ts
var SceneView = class {
  constructor(canvas, data, rays, onSelect) {
    this.canvas = canvas;
    this.data = data;
    this.rays = rays;
    this.onSelect = onSelect;
    this.g = canvas.getContext("2d");
    this.eye = data.tree.origin;
    const [a, b, , d] = data.picture;
    this.axes = { right: unit(sub(b, a)), up: unit(sub(a, d)) };
    this.up = Math.abs(this.axes.up[2]) >= Math.abs(this.axes.up[1]) ? [0, 0, 1] : [0, 1, 0];
    if (dot(this.up, this.axes.up) < 0) this.up = scaled(-1, this.up);
    this.measure();
    this.home();
    this.listen();
    new ResizeObserver(() => this.draw()).observe(canvas);
  }
  selected = null;
  step = -1;
  showSteps = true;
  showShadows = true;
  cones = [];
  lines = [];
  eye;
  axes;
  up;
  center = [0, 0, 0];
  radius = 1;
  // The view: an azimuth and an elevation around the target.
  front = [0, 0, 1];
  side = [1, 0, 0];
  turn = 0;
  rise = 0;
  distance = 1;
  target = [0, 0, 0];
  // Of the current drawing.
  width = 0;
  height = 0;
  near = 0;
  f;
  g;
  hot = [];
  // The sphere in view: around the first surface, as large as what the camera sees near it. Distant points, such as
  // those of an unbounded ground, do not count.
  measure() {
    const first = this.data.tree.surfaces[0];
    const points = this.data.points.map((p) => [p[0], p[1], p[2]]);
    const mean = points.length ? scaled(1 / points.length, points.reduce(add)) : along(this.data.tree, 1);
    this.center = first ? first.point : mean;
    const distances = points.map((p) => norm(sub(p, this.center))).sort((x, y) => x - y);
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
  frame() {
    const c = Math.cos(this.rise), s = Math.sin(this.rise);
    const flat = add(scaled(Math.cos(this.turn), this.front), scaled(Math.sin(this.turn), this.side));
    const back = add(scaled(c, flat), scaled(s, this.up));
    const right = unit(cross(this.up, back));
    return { back, right, up: cross(back, right), eye: add(this.target, scaled(this.distance, back)) };
  }
  // [x, y, depth] on the canvas.
  project(p, f = this.f) {
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
    for (const l of this.lines) this.line(l.from, l.to, { color: this.color(l.color), width: l.width, dash: l.dash, arrow: true });
    this.drawLabels();
  }
  color(name) {
    return getComputedStyle(this.canvas).getPropertyValue(`--${name}`).trim() || "#888";
  }
  drawPoints() {
    const seen = this.data.points.map((p) => [[p[0], p[1], p[2]], p]).filter(([at]) => norm(sub(at, this.center)) < 8 * this.radius).map(([at, p]) => [this.project(at), p]).filter(([q]) => q[2] > this.near);
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
  segment(a, b) {
    let p = this.project(a), q = this.project(b);
    if (p[2] < this.near && q[2] < this.near) return null;
    const cut = (from, to, df, dt) => add(from, scaled((this.near - df) / (dt - df), sub(to, from)));
    if (p[2] < this.near) p = this.project(cut(a, b, p[2], q[2]));
    else if (q[2] < this.near) q = this.project(cut(a, b, p[2], q[2]));
    return [p, q];
  }
  line(a, b, { color, width = 1.5, dash = [], arrow = false, alpha = 1 }) {
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
  drawPicture() {
    const reach = 0.35 * norm(sub(this.center, this.eye));
    const at = this.data.parallel ? this.data.picture : this.data.picture.map((p) => add(this.eye, scaled(reach, unit(sub(p, this.eye)))));
    const color = this.color("soft");
    at.forEach((p, i) => {
      this.line(p, at[(i + 1) % 4], { color, width: 1, alpha: 0.8 });
      if (!this.data.parallel) this.line(this.eye, p, { color, width: 1, alpha: 0.35 });
    });
  }
  // The end of a ray: its last surface, or a point in free space.
  end(ray) {
    if (ray.kind === "shadow") return along(ray, ray.t ?? 0.8 * this.radius);
    const met = ray.surfaces.at(-1);
    return ray.escaped || !met ? along(ray, 1.1 * this.radius + (met ? met.t : 0)) : met.point;
  }
  drawRay(ray) {
    if (ray.kind === "shadow" && !this.showShadows && ray !== this.selected) return;
    const chosen = ray === this.selected;
    const blocked = ray.kind === "shadow" && ray.blocked;
    const s = this.line(ray.origin, this.end(ray), {
      color: this.color(ray.kind),
      width: chosen ? 4.5 : ray.kind === "shadow" ? 1.3 : 2.4,
      dash: ray.kind === "shadow" ? [5, 4] : ray.escaped ? [10, 5] : [],
      arrow: true,
      alpha: blocked && !chosen ? 0.55 : 1
    });
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
      this.line(
        surface.point,
        add(surface.point, scaled(0.14 * this.radius, surface.normal)),
        { color: this.color("ink"), width: 2, arrow: true }
      );
    }
  }
  drawLabels() {
    const g = this.g;
    g.font = "600 12px system-ui, sans-serif";
    g.textAlign = "center";
    g.textBaseline = "middle";
    const taken = [];
    for (const [[p, q], ray] of this.hot) {
      if (ray.kind === "shadow" && ray !== this.selected) continue;
      const x = p[0] + 0.38 * (q[0] - p[0]), y = p[1] + 0.38 * (q[1] - p[1]) - 12;
      if (taken.some((t) => Math.hypot(t[0] - x, t[1] - y) < 16) && ray !== this.selected) continue;
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
  drawSteps() {
    const steps = this.data.traversal?.steps ?? [];
    const last = this.step < 0 ? -1 : this.step;
    for (let i = 0; i <= last && i < steps.length; ++i) {
      const step = steps[i], current = i === last;
      if (!step.corners.length || i < last - 60) continue;
      const p = step.corners.map((c) => this.project(c));
      if (p.some((q) => q[2] < this.near)) continue;
      const g = this.g, color = this.color(step.kind === "bound" && !step.met ? "missed" : "cell");
      g.beginPath();
      hull(p).forEach((q, k) => k ? g.lineTo(q[0], q[1]) : g.moveTo(q[0], q[1]));
      g.closePath();
      g.fillStyle = g.strokeStyle = color;
      g.globalAlpha = current ? 0.22 : 0.05;
      g.fill();
      g.globalAlpha = current ? 1 : 0.35;
      g.lineWidth = current ? 2.5 : 1;
      g.stroke();
      if (step.corners.length === 8 && step.kind !== "beam" && current) boxEdges(step.corners).forEach(([a, b]) => this.line(a, b, { color, width: 1, alpha: 0.8 }));
      g.globalAlpha = 1;
    }
  }
  // A cone up to its end: its silhouette and circles; then the cones that leave it.
  drawCone(c) {
    const color = this.color(c.kind), parts = c.kind === "shadow" ? [] : c.parts;
    const e1 = unit(cross(c.axis, Math.abs(c.axis[0]) < 0.7 ? [1, 0, 0] : [0, 1, 0])), e2 = cross(c.axis, e1);
    const length = c.length ?? 1.1 * this.radius + (parts.at(-1)?.t ?? 0);
    const ring = (t) => Array.from({ length: 24 }, (_, i) => {
      const a = 2 * Math.PI * i / 24, r = c.radius + c.spread * t;
      return add(add(c.origin, scaled(t, c.axis)), add(scaled(r * Math.cos(a), e1), scaled(r * Math.sin(a), e2)));
    });
    const stops = [0, ...parts.map((p) => p.t), length].map(ring);
    stops.forEach((points) => points.forEach((p, i) => this.line(p, points[(i + 1) % 24], { color, width: 1, alpha: 0.7 })));
    for (let i = 0; i < 24; i += 4) this.line(stops[0][i], stops[stops.length - 1][i], { color, width: 1, alpha: 0.45 });
    for (const part of parts) for (const k of part.cones) this.drawCone(k);
  }
  listen() {
    const c = this.canvas, touches = /* @__PURE__ */ new Map();
    let moved = 0, spread = 0;
    c.addEventListener("pointerdown", (e) => {
      c.setPointerCapture(e.pointerId);
      touches.set(e.pointerId, [e.clientX, e.clientY]);
      moved = 0;
      spread = 0;
    });
    c.addEventListener("pointermove", (e) => {
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
      else this.orbit(-8e-3 * dx, 8e-3 * dy);
      this.draw();
    });
    const up = (e) => {
      if (touches.delete(e.pointerId) && moved < 4 && e.type === "pointerup") this.pick(e);
    };
    c.addEventListener("pointerup", up);
    c.addEventListener("pointercancel", up);
    c.addEventListener("contextmenu", (e) => e.preventDefault());
    c.addEventListener("wheel", (e) => {
      e.preventDefault();
      this.distance *= Math.exp(12e-4 * e.deltaY);
      this.draw();
    }, { passive: false });
    const keys = {
      ArrowLeft: () => this.orbit(-0.1, 0),
      ArrowRight: () => this.orbit(0.1, 0),
      ArrowUp: () => this.orbit(0, 0.1),
      ArrowDown: () => this.orbit(0, -0.1),
      "+": () => {
        this.distance *= 0.87;
      },
      "-": () => {
        this.distance /= 0.87;
      },
      "0": () => this.home()
    };
    const withShift = {
      ArrowLeft: () => this.pan(30, 0),
      ArrowRight: () => this.pan(-30, 0),
      ArrowUp: () => this.pan(0, 30),
      ArrowDown: () => this.pan(0, -30)
    };
    c.addEventListener("keydown", (e) => {
      const act = (e.shiftKey ? withShift[e.key] : void 0) ?? keys[e.key];
      if (!act || e.ctrlKey || e.metaKey) return;
      e.preventDefault();
      act();
      this.draw();
    });
  }
  orbit(turn, rise) {
    this.turn += turn;
    this.rise = Math.min(1.55, Math.max(-1.55, this.rise + rise));
  }
  pan(dx, dy) {
    const f = this.frame(), scale = this.distance / (0.9 * Math.min(this.width, this.height));
    this.target = add(this.target, add(scaled(-scale * dx, f.right), scaled(scale * dy, f.up)));
  }
  pick(e) {
    const box = this.canvas.getBoundingClientRect(), x = e.clientX - box.left, y = e.clientY - box.top;
    let best = null, least = 9;
    for (const [[p, q], ray] of this.hot) {
      const dx = q[0] - p[0], dy = q[1] - p[1];
      const u = Math.min(1, Math.max(0, ((x - p[0]) * dx + (y - p[1]) * dy) / (dx * dx + dy * dy || 1)));
      const d = Math.hypot(x - p[0] - u * dx, y - p[1] - u * dy);
      if (d < least) [best, least] = [ray, d];
    }
    if (best) this.onSelect(best);
  }
  select(ray) {
    this.selected = ray;
    this.draw();
  }
};
function hull(points) {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const turn = (o, a, b) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
  const chain = (list) => {
    const made = [];
    for (const p of list) {
      while (made.length > 1 && turn(made[made.length - 2], made[made.length - 1], p) <= 0) made.pop();
      made.push(p);
    }
    return made.slice(0, -1);
  };
  return [...chain(sorted), ...chain(sorted.reverse())];
}
function boxEdges(corners) {
  const edges = [];
  corners.forEach((a, i) => corners.slice(i + 1).forEach((b) => {
    if ([0, 1, 2].filter((k) => a[k] !== b[k]).length === 1) edges.push([a, b]);
  }));
  return edges;
}

// src/alhazen/explain/page/span_bars.ts
var SIGNS = { union: "\u222A", intersection: "\u2229", difference: "\u2212" };
function spanBars(root, data) {
  const solids = data.solids;
  if (!solids.length) {
    root.append(element("p", {}, "The eye ray enters no solid."));
    return;
  }
  const ends = solids.flatMap((s) => allEnds(s.combination ?? s)).filter(isFinite);
  const lo = Math.min(...ends), hi = Math.max(...ends), room = 0.06 * (hi - lo || 1);
  const range = [Math.max(0, lo - room), hi + room];
  const rows = element("div", { class: "spans" });
  for (const solid of solids) {
    const block = element("div", { class: "solid" });
    block.append(bar(solid.name, solid.spans, range, 0, true));
    if (solid.combination) {
      const more = element("details", { open: solids.length < 4 }, element("summary", {}, "how its leaves combine"));
      nodeBars(more, solid.combination, range, 0);
      block.append(more);
    }
    rows.append(block);
  }
  rows.append(axis(range));
  root.append(rows);
}
function isFinite(t) {
  return t !== null;
}
function allEnds(node) {
  return [...node.spans.flat(), ...(node.operands ?? []).flatMap(allEnds)];
}
var labelOf = (node) => node.operator ? `${SIGNS[node.operator]} ${node.operator}` : node.name ?? "";
function nodeBars(root, node, range, depth) {
  root.append(bar(labelOf(node), node.spans, range, depth, !!node.operator));
  for (const operand of node.operands ?? []) nodeBars(root, operand, range, depth + 1);
  if (node.operator && node.operands && node.operands.length > 1) root.append(rothTable(node, node.operator, node.operands));
}
function bar(label, spans, range, depth, strong) {
  const at = (t) => 100 * ((t ?? range[1]) - range[0]) / (range[1] - range[0]);
  const text = spans.length ? spans.map(([a, b]) => `${number(a)} to ${number(b)}`).join(", ") : "nowhere";
  const track = element("svg:svg", {
    class: "track",
    viewBox: "0 0 100 10",
    preserveAspectRatio: "none",
    role: "img",
    "aria-label": `${label}: inside from ${text}`
  });
  track.append(element("svg:rect", { class: "line", x: 0, y: 4.7, width: 100, height: 0.6 }));
  for (const [a, b] of spans) {
    track.append(element("svg:rect", {
      class: strong ? "in strong" : "in",
      x: at(a),
      y: 1,
      height: 8,
      width: Math.max(0.3, Math.min(100, at(b)) - at(a))
    }));
  }
  const name = element("span", { class: "name" }, label);
  name.style.paddingLeft = `${depth}rem`;
  return element("div", { class: spans.length ? "bar" : "bar none" }, name, track, element("span", { class: "soft number" }, text));
}
function axis(range) {
  const marks = [0, 0.25, 0.5, 0.75, 1].map((u) => {
    const mark = element("span", {}, `${u === 0 ? "t = " : ""}${number(range[0] + u * (range[1] - range[0]))}`);
    return mark;
  });
  return element("div", { class: "bar axis" }, element("span"), element("div", { class: "marks soft" }, ...marks), element("span"));
}
function rothTable(node, operator, operands) {
  const changes = [...new Set(operands.flatMap((o) => o.spans.flat()).filter(isFinite))].sort((a, b) => a - b);
  const inside = (spans, a, b) => spans.some(([from, to]) => (from ?? -Infinity) <= a && b <= (to ?? Infinity));
  const cell = (yes) => element("td", { class: yes ? "yes" : "no" }, yes ? "in" : "out");
  const rows = changes.slice(0, -1).map((a, i) => [a, changes[i + 1]]).map(([a, b]) => element(
    "tr",
    {},
    element("th", { scope: "row" }, `${number(a)} \u2013 ${number(b)}`),
    ...operands.map((o) => cell(inside(o.spans, a, b))),
    cell(inside(node.spans, a, b))
  ));
  if (!rows.length) return "";
  const heads = ["stretch of t", ...operands.map((o, i) => (i ? `${SIGNS[operator]} ` : "") + labelOf(o)), "result"];
  return element(
    "details",
    { class: "roth" },
    element("summary", {}, `table of the ${operator}`),
    scrolling(`Table of the ${operator}`, element("table", {}, headRow(heads), element("tbody", {}, ...rows)))
  );
}

// src/alhazen/explain/page/traversal_steps.ts
var TraversalSteps = class {
  constructor(root, traversal, view) {
    this.view = view;
    const { steps, accelerator, work } = traversal;
    this.steps = steps;
    this.range = element("input", { type: "range", min: 0, max: steps.length, value: 0, "aria-label": "Step", input: () => this.show() });
    this.text = element("output", { class: "step", "aria-live": "polite" });
    const move = (by) => () => {
      this.range.value = String(Number(this.range.value) + by);
      this.show();
    };
    const play = element("button", { type: "button", click: () => this.play() }, "Play");
    this.playButton = play;
    root.append(
      element("p", {}, `Steps of `, element("b", {}, accelerator), ` for the eye ray, in their order; drawn in space above.`),
      element(
        "div",
        { class: "stepper" },
        element("button", { type: "button", "aria-label": "One step back", click: move(-1) }, "\u25C0"),
        element("button", { type: "button", "aria-label": "One step on", click: move(1) }, "\u25B6"),
        play,
        this.range
      ),
      this.text
    );
    const tested = element("ol", { class: "candidates" });
    this.items = steps.map((s, i) => element("li", { class: s.kind }, element("button", {
      type: "button",
      class: "link",
      click: () => {
        this.range.value = String(i + 1);
        this.show();
      }
    }, this.describe(s))));
    tested.append(...this.items);
    root.append(
      element("details", {}, element("summary", {}, `all ${steps.length} steps`), tested),
      traversal.left_out ? element("p", { class: "cut" }, `The steps are cut: ${traversal.left_out} more are not shown.`) : "",
      this.table(work)
    );
    this.show();
  }
  steps;
  range;
  text;
  playButton;
  items;
  timer;
  describe(s) {
    if (s.kind === "cell") return `cell ${s.number} entered`;
    if (s.kind === "bound") return `bound of node ${s.number}: ${s.met ? "met" : "missed"}`;
    if (s.kind === "beam") return "region swept by the class of the ray";
    return `\u2018${s.object}\u2019 tested: ${s.met ? "hit" : "no hit"}`;
  }
  show() {
    const at = Number(this.range.value);
    const step = this.steps.at(at - 1);
    this.text.textContent = `Step ${at} of ${this.steps.length}${at > 0 && step ? `: ${this.describe(step)}` : ""}`;
    this.items.forEach((item, i) => {
      item.classList.toggle("current", i === at - 1);
      if (i === at - 1) item.setAttribute("aria-current", "step");
      else item.removeAttribute("aria-current");
    });
    this.view.step = at - 1;
    this.view.draw();
  }
  play() {
    if (this.timer !== void 0) return this.stop();
    if (Number(this.range.value) >= this.steps.length) this.range.value = "0";
    this.playButton.textContent = "Stop";
    this.text.ariaLive = "off";
    this.timer = setInterval(() => {
      this.range.value = String(Number(this.range.value) + 1);
      this.show();
      if (Number(this.range.value) >= this.steps.length) this.stop();
    }, Math.max(40, Math.min(600, 8e3 / (this.steps.length || 1))));
  }
  stop() {
    clearInterval(this.timer);
    this.timer = void 0;
    this.text.ariaLive = "polite";
    this.show();
    this.playButton.textContent = "Play";
  }
  table(work) {
    const columns = ["node_visits", "empty_cells", "box_tests", "primitive_tests", "mailbox_saved"];
    const heads = ["accelerator", "nodes or cells", "empty cells", "bounds tested", "primitives tested", "saved by mailbox", "t of the hit"];
    return scrolling("Work of accelerators", element(
      "table",
      {},
      element("caption", {}, "Work for this ray"),
      headRow(heads),
      element("tbody", {}, ...work.map((w) => element(
        "tr",
        {},
        element("th", { scope: "row" }, w.accelerator),
        ...w.unavailable ? [element("td", { colspan: 6 }, w.unavailable)] : [...columns.map((c) => element("td", {}, String(w[c]))), element("td", {}, number(w.t))]
      )))
    ));
  }
};

// src/alhazen/explain/page/explanation_view.ts
function showExplanation(root, data, picture, choose) {
  const rays = raysOf(data.tree);
  let view, outline;
  const select = (ray, reveal = true) => {
    view.select(ray);
    outline.select(ray, reveal);
  };
  const canvas = element("canvas", { class: "space", tabindex: "0", role: "application", "aria-label": `${rays.length} rays in space`, "aria-describedby": "space-keys" });
  const section = (id, title, ...children) => element(
    "section",
    { id, "aria-labelledby": `${id}-title` },
    element("h2", { id: `${id}-title` }, title),
    ...children
  );
  const tree = element("div", { class: "outline" });
  const cones = element("div"), beams = element("div"), path = element("div"), patches = element("div", { class: "plots" });
  const spans = element("div"), plots = element("div", { class: "plots" }), steps = element("div");
  root.replaceChildren(
    header(data, picture),
    element(
      "div",
      { class: "top" },
      section("space", "The rays in space", canvas, element(
        "p",
        { id: "space-keys", class: "unseen" },
        "Arrow keys turn the view, with shift they move it, plus and minus come nearer and go back, 0 is the view of the beginning. The outline below tells the same rays."
      ), legend(data, () => view)),
      section(
        "tree",
        "The tree of rays",
        element(
          "p",
          { class: "soft" },
          "I = ke + \u03A3 ka Ia + \u03A3 S I [kd (N\xB7L) + ks highlight] + kr I(reflected) + kt I(refracted). The numbers are those of the renderer; each table adds up to the colour of its ray."
        ),
        data.cut === false ? null : element("p", { class: "cut" }, `The tree is cut at depth ${data.cut}: deeper ones have too many rays to be shown. All colours here are those of a picture of that depth.`),
        tree
      )
    ),
    data.cones ? section("cones", "Cones and what covers them", cones) : "",
    data.beams ? section("beams", "Pieces of the beams", beams) : "",
    data.path ? section("path", `One path of a picture with ${data.samples.length} sample${data.samples.length > 1 ? "s" : ""}`, path) : "",
    section("spans", "Inside which solids the eye ray is", spans),
    data.polynomials.length ? section("roots", "Polynomials on the ray and their roots", plots) : "",
    data.patches.length ? section("patches", "Patches subdivided for the ray", patches) : "",
    data.traversal ? section("steps", "How the first surface is found", steps) : "",
    data.samples.length > 1 ? section("samples", "The samples of the pixel", sampleTable(data, choose)) : ""
  );
  view = new SceneView(canvas, data, rays, select);
  outline = new RayOutline(tree, data, select);
  spanBars(spans, data);
  polynomialPlots(plots, data);
  patchParts(patches, data);
  if (data.cones) new ConeTree(cones, data.cones, view);
  if (data.beams) beamPieces(beams, data, data.beams);
  if (data.path) pathSteps(path, data, data.path, view);
  if (data.traversal) new TraversalSteps(steps, data.traversal, view);
  select(rays[0], false);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => view.draw());
  return { view, outline, select };
}
function header(data, picture) {
  const facts = [
    `(${triple(data.pixel)})`,
    `${data.width} \xD7 ${data.height}`,
    `depth ${data.max_depth}`,
    `${data.samples.length} sample${data.samples.length > 1 ? `s, number ${data.sample} shown` : ""}`,
    ...Object.entries(data.rays).filter(([, n]) => n).map(([kind, n]) => `${n} ${kind}`)
  ];
  const head = element("header", {}, element(
    "div",
    {},
    element("h1", {}, swatch(data.pixel), ` Pixel ${data.x},${data.y} of ${data.scene}`),
    element("p", { class: "soft" }, facts.join(" \xB7 ")),
    otherRenderer(data)
  ));
  if (picture) {
    const image = element("img", { src: picture, alt: `The scene; the pixel is marked` });
    const mark = element("span", { class: "mark", "aria-hidden": "true" });
    mark.style.left = `${100 * (data.x + 0.5) / data.width}%`;
    mark.style.top = `${100 * (data.y + 0.5) / data.height}%`;
    head.append(element("div", { class: "preview" }, image, mark));
  }
  return head;
}
function otherRenderer({ renderer, draws_at_random, path }) {
  if (renderer === "whitted") return null;
  return element("p", { class: "cut", id: "other" }, draws_at_random ? `The picture is by ${renderer}, which draws rays at random for each sample. The tree shows the rays that whitted traces for this pixel: towards points of lights, in mirror directions and through glass. Its colour may differ.` + (path ? " One path of the picture follows below the tree." : "") : `The picture is by ${renderer}; the tree of rays is that of whitted, whose colour may differ.`);
}
function legend(data, view) {
  const shadows = element("input", { type: "checkbox", checked: true, change: () => {
    view().showShadows = shadows.checked;
    view().draw();
  } });
  const kinds = Object.entries(KINDS).filter(([kind]) => data.rays[kind]);
  return element(
    "div",
    { class: "legend" },
    ...kinds.map(([kind, text]) => element("span", { class: kind }, element("i", { class: "key", "aria-hidden": "true" }), text)),
    element("label", {}, shadows, " show shadow rays"),
    element("button", { type: "button", click: () => view().home() }, "Home view")
  );
}
function sampleTable(data, choose) {
  const plot = element(
    "svg:svg",
    { class: "pixel", viewBox: "0 0 100 100", role: "img", "aria-label": "Where the samples lie in the pixel" },
    element("svg:rect", { class: "frame", x: 0, y: 0, width: 100, height: 100 })
  );
  data.samples.forEach((s, i) => {
    const dot2 = element("svg:circle", {
      cx: 100 * s.place[0],
      cy: 100 * s.place[1],
      r: i === data.sample ? 5 : 3.5,
      class: i === data.sample ? "chosen" : ""
    });
    dot2.style.fill = css(s.radiance);
    plot.append(dot2);
  });
  const name = (i) => choose && i !== data.sample ? element("button", { type: "button", class: "link", "aria-label": `Explain sample ${i}`, click: () => choose(i) }, String(i)) : String(i);
  const rows = data.samples.map((s, i) => element(
    "tr",
    i === data.sample ? { class: "selected", "aria-current": "true" } : {},
    element("th", { scope: "row" }, name(i)),
    ...s.radiance.map((c) => element("td", {}, number(c))),
    element("td", {}, swatch(s.radiance))
  ));
  return element("div", { class: "samples" }, plot, scrolling("Samples", element(
    "table",
    {},
    headRow(["sample", "red", "green", "blue", ""]),
    element("tbody", {}, ...rows)
  )));
}

// apps/viewer/page/camera_block.ts
var ROUNDING = 1e-12;
var FAR = 1e5;
var vector = (v) => `(${v.join(", ")})`;
function isPlain({ eye, look, right, up, aspect }, distance) {
  const l = unit(look), r = unit(right), u = unit(up);
  return [dot(l, r), dot(l, u), dot(r, u), norm(right) / norm(up) / aspect - 1].every((x) => Math.abs(x) < ROUNDING) && dot(cross(l, u), r) > 0 && norm(eye) < FAR * distance;
}
function lensLines(lens) {
  if (!lens) return [];
  return [
    `lens_radius = ${lens.radius}`,
    `focus_distance = ${lens.focus_distance}`,
    ...lens.blades ? [`blades = ${lens.blades}`, `blade_turn_rad = ${lens.turn}`] : []
  ];
}
function blockOf(frame) {
  const { eye, look, right, up, parallel, aspect, lens } = frame, plain = isPlain(frame, frame.distance);
  const kind = parallel ? plain ? "orthographic" : "sheared_orthographic" : plain ? "perspective" : "sheared";
  const size = parallel ? `height = ${norm(up)}` : `fov_deg = ${2 * Math.atan2(norm(up) / 2, norm(look)) * 180 / Math.PI}`;
  const way = plain || parallel ? "direction" : "look";
  const lines = [`eye = ${vector(eye)}`, `${way} = ${vector(look)}`, ...plain ? [`up = ${vector(unit(up))}`, size] : [`right = ${vector(right)}`, `up = ${vector(up)}`], `aspect = ${aspect}`, ...lensLines(lens)];
  return `${kind}_camera "view" {
${lines.map((line) => `    ${line}
`).join("")}}
`;
}

// apps/viewer/page/camera.ts
var STEEPEST = 1.5;
var LEAST = 1e-6;
var ViewCamera = class _ViewCamera {
  eye;
  look;
  right;
  up;
  parallel;
  aspect;
  lens;
  distance;
  world;
  given;
  constructor(given, up) {
    ({
      eye: this.eye,
      look: this.look,
      right: this.right,
      up: this.up,
      parallel: this.parallel,
      aspect: this.aspect,
      lens: this.lens
    } = given);
    this.given = given;
    this.world = up === "z" ? [0, 0, 1] : [0, 1, 0];
    this.distance = given.distance || 0.5 * norm(this.eye) + 1;
  }
  copy() {
    return Object.assign(Object.create(_ViewCamera.prototype), this);
  }
  /** True if it is where the camera of the scene is. */
  isAt(given) {
    const keys = ["eye", "look", "right", "up"];
    return keys.every((key) => norm(sub(this[key], given[key])) === 0);
  }
  turn(axis2, angle) {
    const c = Math.cos(angle), s = Math.sin(angle), k = unit(axis2);
    const by = (v) => add(add(scaled(c, v), scaled(s, cross(k, v))), scaled((1 - c) * dot(k, v), k));
    for (const key of ["look", "right", "up"]) this[key] = by(this[key]);
  }
  // Turns around the point at `distance`; the pole is not crossed. Pictures may be mirrored: `dx` turns towards their
  // right side, `dy` raises the eye.
  orbit(dx, dy) {
    const center = add(this.eye, scaled(this.distance, unit(this.look)));
    const side = dot(cross(unit(this.look), this.world), unit(this.right));
    const mirrored = (Math.abs(side) > LEAST ? side : dot(cross(this.look, this.up), this.right)) < 0;
    this.turn(this.world, mirrored ? dx : -dx);
    const look = unit(this.look), rise = Math.asin(Math.max(-1, Math.min(1, dot(look, this.world))));
    const to = Math.max(-STEEPEST, Math.min(STEEPEST, rise - dy)), level = cross(look, this.world);
    this.turn(norm(level) > LEAST ? level : cross(look, this.up), to - rise);
    this.eye = sub(center, scaled(this.distance, unit(this.look)));
  }
  walk(right, up, forward) {
    const by = add(add(scaled(right, unit(this.right)), scaled(up, unit(this.up))), scaled(forward, unit(this.look)));
    this.eye = add(this.eye, scaled(this.distance, by));
  }
  zoom(factor) {
    if (this.parallel) {
      this.right = scaled(factor, this.right);
      this.up = scaled(factor, this.up);
    } else this.eye = add(this.eye, scaled(this.distance * (1 - factor), unit(this.look)));
    this.distance *= factor;
  }
  /** The view for a scene file. */
  block() {
    return this.isAt(this.given) && this.given.block || blockOf(this);
  }
};

// apps/viewer/page/light_fields.ts
var AXES = {
  position: ["x", "y", "z"],
  direction: ["x", "y", "z"],
  color: ["red", "green", "blue"]
};
var LABELS = { position: "position", direction: "direction", color: "colour" };
var MOST = 1e15;
function chosenSizes(light, values) {
  const own = light.sizes ?? [], chosen = values?.sizes;
  return chosen?.length === own.length && chosen.every((s, i) => s.name === own[i].name) ? chosen : void 0;
}
function capital(text) {
  return text[0].toUpperCase() + text.slice(1);
}
var LightFields = class {
  // since a field got the focus
  /** `changed` has no values if they are those of the file. */
  constructor(light, id, changed) {
    this.light = light;
    this.changed = changed;
    this.values = this.ofFile();
    const keys = ["position", "direction", "color"].filter((key) => light[key]);
    this.vectors = keys.map((key) => ({ key, fields: AXES[key].map((axis2, i) => this.field(`${axis2} of the ${LABELS[key]} of ${light.name}`, `${key} ${i}`)) }));
    this.sizes = (light.sizes ?? []).map((size) => this.field(`${capital(size.name)} of ${light.name}`, size.name));
    this.times = this.field(`Strength of ${light.name}, times its colour`, "times");
    this.reset = element("button", { type: "button", class: "link", "data-key": `reset ${light.name}`, click: () => {
      this.values = this.ofFile();
      this.show(void 0);
      this.changed(void 0, true);
    } }, "As in the file");
    const line = (label, ...fields) => element("div", { class: "numbers" }, element("span", { "aria-hidden": "true" }, label), ...fields);
    this.element = element(
      "fieldset",
      { id },
      element("legend", {}, `${light.name}: ${light.what ?? "light"}`),
      ...this.vectors.map((v) => line(LABELS[v.key], ...v.fields)),
      ...this.sizes.map((field, i) => line(light.sizes[i].name, field)),
      line("strength", this.times, this.reset)
    );
    this.show(void 0);
  }
  element;
  values;
  vectors;
  times;
  sizes;
  reset;
  marked = false;
  /** Undefined: those of the file. */
  show(values) {
    const file = this.ofFile();
    this.values = {
      position: values?.position ?? file.position,
      direction: values?.direction ?? file.direction,
      color: values?.color ?? file.color,
      times: values?.times ?? 1,
      sizes: chosenSizes(this.light, values) ?? file.sizes
    };
    for (const { key, fields } of this.vectors) {
      fields.forEach((field, i) => this.set(field, this.values[key][i]));
    }
    this.set(this.times, this.values.times);
    this.sizes.forEach((field, i) => this.set(field, this.values.sizes[i].value));
    this.reset.disabled = values === void 0;
  }
  ofFile() {
    const { position, direction, color, sizes } = this.light;
    return { position, direction, color, times: 1, sizes: sizes ?? [] };
  }
  set(field, x) {
    field.removeAttribute("aria-invalid");
    if (field === document.activeElement && Number(field.value) === x && field.value) return;
    field.value = String(Number(x.toPrecision(7)));
  }
  field(label, key) {
    const field = element("input", {
      type: "number",
      step: "any",
      "aria-label": label,
      "data-key": `${this.light.name} ${key}`,
      focus: () => this.marked = false,
      input: () => this.typed(field),
      change: () => {
        this.marked = false;
        this.show(this.isOfFile() ? void 0 : this.values);
      }
    });
    return field;
  }
  typed(field) {
    const x = Number(field.value), values = { ...this.values };
    let good = field.value !== "" && Number.isFinite(x) && Math.abs(x) <= MOST;
    if (field === this.times) {
      good &&= x >= 0;
      values.times = x;
    }
    const size = this.sizes.indexOf(field);
    if (size >= 0) {
      values.sizes = values.sizes.map((old, i) => i === size ? { ...old, value: x } : old);
      good &&= this.areSizes(values.sizes);
    }
    for (const { key, fields } of this.vectors) {
      const i = fields.indexOf(field);
      if (i < 0) continue;
      const vector2 = [...this.values[key]];
      vector2[i] = x;
      values[key] = vector2;
      good &&= key === "color" ? x >= 0 : key !== "direction" || vector2.some((c) => c !== 0);
    }
    if (good) field.removeAttribute("aria-invalid");
    else field.setAttribute("aria-invalid", "true");
    if (!good) return;
    this.values = values;
    this.reset.disabled = this.isOfFile();
    const mark = !this.marked;
    this.marked = true;
    this.changed(this.isOfFile() ? void 0 : values, mark);
  }
  // Positive, and a hole smaller than its surroundings.
  areSizes(sizes) {
    const radius = sizes.find((s) => s.name === "radius")?.value ?? 0;
    return sizes.every(({ name, value }) => name === "inner radius" ? value >= 0 && value < radius : value > 0);
  }
  isOfFile() {
    const file = this.ofFile();
    return this.values.times === 1 && this.values.sizes.every((s, i) => s.value === file.sizes[i].value) && this.vectors.every(({ key }) => this.values[key].every((x, i) => x === file[key][i]));
  }
};

// apps/viewer/page/lights.ts
var LightList = class {
  // of the open lights only: there may be many
  constructor(listener) {
    this.listener = listener;
  }
  summary = element("summary", { "data-key": "summary" });
  list = element("div", { class: "lights" });
  block = element("textarea", {
    id: "light-blocks",
    rows: 6,
    readonly: true,
    hidden: true,
    "data-key": "text",
    "aria-label": "Blocks of the changed lights"
  });
  blockButton = element("button", {
    type: "button",
    "aria-expanded": "false",
    "aria-controls": "light-blocks",
    "data-key": "blocks",
    click: () => this.toggleBlocks()
  }, "Light blocks");
  buttons = element("div", { class: "row" }, this.all("All on", true), this.all("All off", false), this.blockButton);
  element = element("details", { id: "lights" }, this.summary, this.list, this.buttons, this.block);
  dark = /* @__PURE__ */ new Set();
  // names of lights that are off
  values = /* @__PURE__ */ new Map();
  open = /* @__PURE__ */ new Set();
  // names of lights whose fields are shown
  lights = [];
  boxes = [];
  fields = /* @__PURE__ */ new Map();
  /** Names of the lights that are off. */
  off() {
    return this.boxes.filter((b) => !b.checked).map((b) => b.name);
  }
  /** The lights that differ from the file. `placed`: with the places of those that have not moved. */
  changes(placed = false) {
    return this.lights.flatMap((light) => {
      const values = this.values.get(light.name);
      if (!values) return [];
      const { color, times } = values, sizes = chosenSizes(light, values);
      const position = values.position ?? (placed ? light.position : void 0);
      const direction = values.direction ?? (placed ? light.direction : void 0);
      return [{
        name: light.name,
        ...light.position && position ? { position } : {},
        ...light.direction && direction ? { direction } : {},
        ...sizes?.length ? { sizes: sizes.map((s) => s.value) } : {},
        color: color.map((c) => c * times)
      }];
    });
  }
  state() {
    return { dark: new Set(this.dark), values: new Map(this.values) };
  }
  restore({ dark, values }) {
    this.dark = new Set(dark);
    this.values = new Map(values);
    for (const box of this.boxes) box.checked = !this.dark.has(box.name);
    for (const [name, fields] of this.fields) fields.show(this.values.get(name));
    this.tell();
  }
  /** The focus and the scroll position of the list, to restore them. */
  place() {
    const active = document.activeElement;
    const key = active instanceof HTMLElement && this.element.contains(active) ? active.dataset.key : void 0;
    return { key, top: this.list.scrollTop };
  }
  comeBack({ key, top }) {
    this.list.scrollTop = top;
    if (key === void 0) return;
    const all = [...this.element.querySelectorAll("[data-key]")];
    (all.find((e) => e.dataset.key === key) ?? this.summary).focus({ preventScroll: true });
  }
  /** Keeps choices that still exist. */
  fill(lights) {
    this.lights = lights;
    this.boxes = lights.map((light) => element("input", {
      type: "checkbox",
      name: light.name,
      checked: !this.dark.has(light.name),
      "data-key": `on ${light.name}`,
      change: () => this.turned()
    }));
    this.fields.clear();
    this.list.replaceChildren(...lights.flatMap((light, i) => this.row(light, i)));
    this.element.hidden = lights.length === 0;
    this.tell();
  }
  row(light, i) {
    const name = light.name, id = `light-${i}`;
    const button = element("button", {
      type: "button",
      class: "link",
      "aria-expanded": String(this.open.has(name)),
      "aria-controls": id,
      "aria-label": `Change ${name}`,
      "data-key": `change ${name}`,
      click: () => {
        const shown = !this.open.delete(name);
        if (shown) {
          this.open.add(name);
          row2.after(this.fieldsOf(light, id));
        } else {
          this.fields.get(name)?.element.remove();
          this.fields.delete(name);
        }
        button.setAttribute("aria-expanded", String(shown));
      }
    }, "Change");
    const label = element("label", { title: light.what ?? "" }, this.boxes[i], element("span", {}, name));
    const row2 = element("div", { class: "light" }, label, button);
    return this.open.has(name) ? [row2, this.fieldsOf(light, id)] : [row2];
  }
  fieldsOf(light, id) {
    const fields = new LightFields(light, id, (values, mark) => this.edited(light, values, mark));
    fields.show(this.values.get(light.name));
    this.fields.set(light.name, fields);
    return fields.element;
  }
  all(text, on) {
    return element("button", { type: "button", "data-key": text, click: () => {
      for (const box of this.boxes) box.checked = on;
      this.turned();
    } }, text);
  }
  turned() {
    for (const box of this.boxes) {
      if (box.checked) this.dark.delete(box.name);
      else this.dark.add(box.name);
    }
    this.tell();
    this.listener.changed("lights", true);
  }
  // A headlight that has only another colour still goes with the view.
  edited(light, values, mark) {
    const moved = (key) => values?.[key]?.some((x, i) => x !== light[key]?.[i]) ? values[key] : void 0;
    if (values) this.values.set(light.name, { ...values, position: moved("position"), direction: moved("direction") });
    else this.values.delete(light.name);
    this.tell();
    this.listener.changed("light", mark);
  }
  toggleBlocks() {
    this.block.hidden = !this.block.hidden;
    this.blockButton.setAttribute("aria-expanded", String(!this.block.hidden));
    this.tell();
  }
  // Updates the summary, and the blocks if they are shown.
  tell() {
    const on = this.boxes.filter((b) => b.checked).length, changes = this.changes();
    const changed = changes.length ? `, ${changes.length} changed` : "";
    this.summary.textContent = `lights: ${on === this.boxes.length ? "all" : on} of ${this.boxes.length} on${changed}`;
    this.buttons.children[0].toggleAttribute("hidden", this.boxes.length < 2);
    this.buttons.children[1].toggleAttribute("hidden", this.boxes.length < 2);
    if (this.block.hidden) return;
    if (!changes.length) this.block.value = "// No light differs from the file.\n";
    else void this.listener.blocks(this.changes(true)).then((text) => this.block.value = text);
  }
};

// apps/viewer/page/controls.ts
var MOVING = [
  { name: "steady", what: "the same renderer, 20 pictures a second: fewer generations of rays, then fewer pixels; shades between rays where they agree" },
  { name: "coarser", what: "the same renderer at its depth: as many pixels as 20 pictures a second allow" },
  { name: "flat", what: "ray_casting: no shadows, mirrors, glass" }
];
var NUMBERS = ["samples", "depth", "exposure"];
var LIMITS = {
  samples: { label: "samples", min: 1, max: 1024, step: 1, whole: true },
  depth: { label: "depth", min: 0, max: 100, step: 1, whole: true },
  exposure: { label: "exposure", min: -64, max: 64, step: 0.5, whole: false }
};
var isNumber = (key) => NUMBERS.includes(key);
function fault({ label, min, max, whole }, field) {
  const x = Number(field.value);
  if (!field.value && !field.validity.badInput) return "";
  if (field.value && x >= min && x <= max && (!whole || Number.isInteger(x))) return "";
  return `${label} must be a ${whole ? "whole " : ""}number from ${min} to ${max}`;
}
var Controls = class {
  /** `changed` gets the previous choices, unless it continues the previous change; `refused` why numbers are not used. */
  constructor(changed, refused, blocks) {
    this.changed = changed;
    this.refused = refused;
    this.lights = new LightList({ changed: (which, mark) => this.tell(which, mark), blocks });
  }
  form = element("form", { class: "controls", "aria-label": "Settings", submit: (e) => e.preventDefault() });
  lights;
  fields = /* @__PURE__ */ new Map();
  usual = /* @__PURE__ */ new Map();
  numbers = /* @__PURE__ */ new Map();
  // the last valid ones
  wishes = /* @__PURE__ */ new Set();
  // chosen numbers; others have their defaults
  reasons = /* @__PURE__ */ new Map();
  // why menus have no effect
  last;
  get(key) {
    return this.fields.get(key)?.value ?? "";
  }
  number(key) {
    return this.numbers.get(key) ?? 0;
  }
  /** Undefined if nothing was chosen. */
  wished(key) {
    return this.wishes.has(key) ? this.number(key) : void 0;
  }
  /** The value if nothing is chosen. */
  setUsual(key, value) {
    this.usual.set(key, value);
    if (!this.wishes.has(key)) this.set(key, String(value));
  }
  set(key, value) {
    this.show(key, value);
    this.last = this.settings();
  }
  show(key, value) {
    const field = this.fields.get(key);
    if (!field) return;
    field.value = value;
    if (!isNumber(key)) return;
    this.numbers.set(key, Number(value));
    this.check();
  }
  // Marks the numbers that are not used.
  check() {
    const reasons = NUMBERS.flatMap((key) => {
      const field = this.fields.get(key), reason = field instanceof HTMLInputElement ? fault(LIMITS[key], field) : "";
      if (reason) field?.setAttribute("aria-invalid", "true");
      else field?.removeAttribute("aria-invalid");
      return reason ? [reason] : [];
    });
    this.refused(reasons.join("\n"));
  }
  /** As a user would. */
  choose(key, value) {
    const field = this.fields.get(key);
    if (field) field.value = value;
    field?.dispatchEvent(new Event("change"));
  }
  /** A menu without effect. */
  disable(key, off, why) {
    const field = this.fields.get(key);
    if (!field) return;
    field.disabled = off;
    this.reasons.get(key)?.remove();
    this.reasons.delete(key);
    field.removeAttribute("aria-describedby");
    if (!off) return;
    const reason = element("p", { class: "why", id: `why-${key}` }, why);
    this.reasons.set(key, reason);
    field.closest("label")?.after(reason);
    field.setAttribute("aria-describedby", reason.id);
  }
  settings() {
    const values = new Map([...this.fields].map(([key, field]) => [key, isNumber(key) ? String(this.number(key)) : field.value]));
    return { values, wishes: new Set(this.wishes), lights: this.lights.state() };
  }
  /** Keeps choices that the scene does not have. */
  restore({ values, wishes, lights }) {
    for (const [key, field] of this.fields) {
      const now = field.value;
      this.show(key, values.get(key) ?? now);
      if (field instanceof HTMLSelectElement && field.selectedIndex < 0) field.value = now;
    }
    this.wishes.clear();
    for (const key of wishes) this.wishes.add(key);
    this.lights.restore(lights);
    this.last = this.settings();
  }
  tell(key, mark = true) {
    const before = this.last;
    this.last = this.settings();
    this.changed(key, mark ? before ?? this.last : void 0);
  }
  options(key) {
    const field = this.fields.get(key);
    return field instanceof HTMLSelectElement ? [...field.options].map((o) => o.text) : [];
  }
  // An emptied field gets its default again.
  typed(key) {
    const field = this.fields.get(key);
    if (!(field instanceof HTMLInputElement)) return;
    const empty = !field.value && !field.validity.badInput;
    if (empty) field.value = String(this.usual.get(key));
    this.check();
    if (field.hasAttribute("aria-invalid")) return;
    if (empty) this.wishes.delete(key);
    else this.wishes.add(key);
    this.numbers.set(key, Number(field.value));
    this.tell(key);
  }
  /** Keeps choices that still exist. */
  fill(scene) {
    const focus = [...this.fields].find(([, field2]) => field2 === document.activeElement)?.[0];
    const place = this.lights.place();
    const chosen = this.settings().values;
    this.form.replaceChildren();
    const add2 = (key, label, field2, value) => {
      const kept = field2 instanceof HTMLSelectElement || this.wishes.has(key);
      field2.value = (kept ? chosen.get(key) : void 0) ?? value;
      if (field2 instanceof HTMLSelectElement && field2.selectedIndex < 0) field2.value = value;
      if (field2 instanceof HTMLSelectElement && field2.selectedIndex < 0) field2.selectedIndex = 0;
      this.fields.set(key, field2);
      if (isNumber(key)) this.numbers.set(key, Number(field2.value));
      this.form.append(element("label", {}, label, field2));
    };
    const menu = (key, label, entries, value) => add2(key, label, element("select", { name: key, change: () => this.tell(key) }, ...entries.map((e) => element("option", { value: e.value ?? e.name, title: e.what }, e.name))), value);
    const field = (key, value) => {
      const { label, min, max, step } = LIMITS[key];
      this.usual.set(key, value);
      add2(key, label, element("input", { name: key, type: "number", min, max, step, change: () => this.typed(key) }), String(value));
    };
    menu("camera", "camera", scene.cameras.map((c, i) => ({ name: c.name || `camera ${i + 1}`, value: String(i) })), "0");
    menu("renderer", "renderer", scene.renderers, "whitted");
    const known = scene.accelerators.some((a) => a.name === scene.accelerator);
    menu("accelerator", "accelerator", [...known ? [] : [{ name: scene.accelerator }], ...scene.accelerators], scene.accelerator);
    this.lights.fill(scene.lights);
    this.form.append(this.lights.element);
    menu("environment", "environment", [{ name: "of the scene", value: "" }, ...scene.environments], "");
    menu("layer", "layer", [{ name: "colours", value: "", what: "the picture" }, ...scene.layers], "");
    menu("moving", "moving", MOVING, "steady");
    field("samples", 4);
    field("depth", scene.depth);
    field("exposure", 0);
    menu("curve", "tone curve", scene.curves.map((name) => ({ name })), "none");
    menu("steps", "steps of", scene.steps.split(", ").map((name) => ({ name })), "kay_kajiya");
    if (focus) this.fields.get(focus)?.focus();
    this.lights.comeBack(place);
    this.check();
    this.last = this.settings();
  }
  /** Shows other lights. */
  setLights(lights) {
    const place = this.lights.place();
    this.lights.fill(lights);
    this.lights.comeBack(place);
    this.last = this.settings();
  }
};

// apps/viewer/page/input.ts
var KEYS = {
  ArrowLeft: (c) => c.orbit(-0.1, 0),
  ArrowRight: (c) => c.orbit(0.1, 0),
  ArrowUp: (c) => c.orbit(0, 0.1),
  ArrowDown: (c) => c.orbit(0, -0.1),
  "+": (c) => c.zoom(0.87),
  "-": (c) => c.zoom(1 / 0.87),
  w: (c) => c.walk(0, 0, 0.07),
  s: (c) => c.walk(0, 0, -0.07),
  a: (c) => c.walk(-0.07, 0, 0),
  d: (c) => c.walk(0.07, 0, 0)
};
var WITH_SHIFT = {
  ArrowLeft: (c) => c.walk(-0.07, 0, 0),
  ArrowRight: (c) => c.walk(0.07, 0, 0),
  ArrowUp: (c) => c.walk(0, 0.07, 0),
  ArrowDown: (c) => c.walk(0, -0.07, 0)
};
var CLICK = 4;
function listen(image, target) {
  const touches = /* @__PURE__ */ new Map();
  let moved = 0, spread = 0;
  image.addEventListener("pointerdown", (e) => {
    image.setPointerCapture(e.pointerId);
    touches.set(e.pointerId, [e.clientX, e.clientY]);
    moved = spread = 0;
  });
  image.addEventListener("pointermove", (e) => {
    const before = touches.get(e.pointerId);
    if (!before) return;
    const dx = e.clientX - before[0], dy = e.clientY - before[1], height = image.clientHeight;
    const still = moved < CLICK;
    moved += Math.abs(dx) + Math.abs(dy);
    touches.set(e.pointerId, [e.clientX, e.clientY]);
    if (moved < CLICK) return;
    if (touches.size === 2) {
      const [a, b] = [...touches.values()], now = Math.hypot(a[0] - b[0], a[1] - b[1]), was = spread;
      if (was) target.move((c) => c.zoom(was / now), still);
      spread = now;
    } else if (e.shiftKey || e.buttons & 2) target.move((c) => c.walk(-dx / height, dy / height, 0), still);
    else target.move((c) => c.orbit(3 * dx / height, -3 * dy / height), still);
  });
  const up = (e) => {
    if (!touches.delete(e.pointerId) || moved >= CLICK || e.type !== "pointerup") return;
    const box = image.getBoundingClientRect();
    target.explain((e.clientX - box.left) / box.width, (e.clientY - box.top) / box.height);
  };
  image.addEventListener("pointerup", up);
  image.addEventListener("pointercancel", up);
  image.addEventListener("contextmenu", (e) => e.preventDefault());
  image.addEventListener("wheel", (e) => {
    e.preventDefault();
    target.move((c) => c.zoom(Math.exp(12e-4 * e.deltaY)), true);
  }, { passive: false });
  image.addEventListener("keydown", (e) => {
    if (e.key === "Enter") return target.explain(0.5, 0.5);
    const held = e.ctrlKey || e.metaKey;
    const key = e.key.length === 1 ? e.key.toLowerCase() : e.key;
    const change = (e.shiftKey ? WITH_SHIFT[key] : void 0) ?? KEYS[key];
    if (!change || held || e.altKey) return;
    e.preventDefault();
    target.move(change, true);
  });
}
function listenAnywhere(target) {
  let typed = null;
  document.addEventListener("input", (e) => typed = e.target);
  for (const end of ["change", "focusout"]) document.addEventListener(end, () => typed = null);
  document.addEventListener("keydown", (e) => {
    if (typed !== null && typed === e.target) return;
    if (e.key === "Escape") return target.stop();
    if (e.key.toLowerCase() !== "z" || !(e.ctrlKey || e.metaKey) || e.shiftKey || e.altKey) return;
    e.preventDefault();
    target.undo();
  });
}

// apps/viewer/page/link.ts
var SILENCE = 4e3;
var PAUSE = 500;
var POLICY_VIOLATION = 1008;
var FrameLink = class {
  // time of the last message
  constructor(token, events) {
    this.token = token;
    this.events = events;
    this.connect();
    setInterval(() => this.watch(), PAUSE);
  }
  socket;
  open = false;
  since = 0;
  get connected() {
    return this.open;
  }
  /** False if the server is not connected. */
  send(message) {
    if (!this.open) return false;
    this.socket?.send(JSON.stringify(message));
    return true;
  }
  connect() {
    const socket = new WebSocket(`ws://${location.host}/frames`);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    this.since = performance.now();
    socket.onopen = () => socket.send(JSON.stringify({ token: this.token }));
    socket.onmessage = (e) => {
      this.since = performance.now();
      if (typeof e.data === "string") this.read(JSON.parse(e.data));
      else this.readPicture(e.data);
    };
    socket.onclose = (e) => {
      if (e.code === POLICY_VIOLATION) {
        this.open = false;
        this.socket = void 0;
        this.events.refused();
      } else this.drop();
    };
  }
  read(state) {
    if (!this.open) {
      this.open = true;
      this.events.opened();
    }
    this.events.state(state);
  }
  readPicture(data) {
    const size = new DataView(data).getUint32(0, true);
    const head = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, size)));
    this.events.picture(head, new Uint8Array(data, 4 + size));
    this.send({ shown: head.id });
  }
  watch() {
    if (this.socket && performance.now() - this.since > SILENCE) this.drop();
  }
  drop() {
    const socket = this.socket;
    if (!socket) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close();
    this.socket = void 0;
    this.open = false;
    this.events.lost();
    setTimeout(() => this.connect(), PAUSE);
  }
};

// apps/viewer/page/notices.ts
var Messages = class {
  constructor(place) {
    this.place = place;
  }
  texts = /* @__PURE__ */ new Map();
  say(topic, text) {
    if ((this.texts.get(topic) ?? "") === text) return;
    this.texts.set(topic, text);
    const all = [...this.texts.values()].filter((t) => t).join("\n");
    this.place.hidden = !all;
    if (this.place.textContent !== all) this.place.textContent = all;
  }
};
var WorkLine = class {
  what = element("span");
  time = element("span", { "aria-hidden": "true" });
  bar = element("progress", { max: 1, "aria-label": "Part that is done", hidden: true });
  line = element("p", { id: "work", role: "status" }, this.what, this.time, this.bar);
  show(work) {
    const what = work ? `${work.what} \u2026 ` : "";
    if (this.what.textContent !== what) this.what.textContent = what;
    this.time.textContent = work ? `${work.seconds.toFixed(1)} s ` : "";
    this.bar.hidden = work?.part === void 0;
    this.bar.value = work?.part ?? 0;
  }
};
function statusText(shown, full, depth, memory) {
  const { facts, samples, moving } = shown;
  const parts = [`${facts.width} \xD7 ${facts.height}`, `${samples} sample${samples > 1 ? "s" : ""} a pixel`];
  if (moving) {
    const less = [
      facts.width < full ? `${full} wide when it rests` : "",
      moving.depth < depth ? `depth ${moving.depth} of ${depth}` : "",
      shown.selected ? "pixels selected" : ""
    ];
    parts.splice(1, 1, [`moving, ${moving.rate.toFixed(0)} pictures/s`, ...less.filter((t) => t)].join(", "));
  }
  parts.push(
    `${timeText(1e3 * facts.seconds)}, ${timeText(shown.way)} with the way here`,
    `${(facts.rays / facts.seconds / 1e6).toFixed(2)} M rays/s on ${facts.threads} threads`,
    `${(memory / 1048576).toFixed(0)} MiB`
  );
  return parts.join(" \xB7 ");
}
function pictureName(scene, camera, there, renderer, layer) {
  const from = `from ${there ? "" : "a view that began at "}camera ${camera.name || "without a name"}`;
  return `Picture of ${scene}, ${layer ? `layer ${layer}, ` : ""}${from}, by ${renderer}`;
}
function doneText({ width, height, seconds }, samples) {
  return `The picture is done: ${width} by ${height}, ${samples} sample${samples > 1 ? "s" : ""} a pixel, ${timeText(1e3 * seconds)}`;
}
function timeText(ms) {
  return ms < 1e3 ? `${ms.toFixed(ms < 100 ? 1 : 0)} ms` : `${(ms / 1e3).toFixed(ms < 1e4 ? 2 : 1)} s`;
}
function drawScale(place, layer, scales) {
  place.hidden = !layer;
  if (!layer) return;
  const { name, meaning, colors, low, high } = layer;
  if (!colors || low === void 0 || high === void 0) {
    place.replaceChildren(element("b", {}, name), `: ${meaning}`);
    return;
  }
  const bar2 = element("div", { class: "bar-of-scale", "aria-hidden": "true" });
  bar2.style.background = `linear-gradient(90deg, ${scales[colors].join(", ")})`;
  place.replaceChildren(element("b", {}, name), bar2, element(
    "div",
    { class: "marks" },
    ...[low, (low + high) / 2, high].map((m) => element("span", {}, number(m)))
  ));
}

// apps/viewer/page/pace.ts
var AIM = 48;
var GROWTH = 1.6;
var GUESS = 1.3;
var LATE = 0.4;
var FADE = 2e-3;
var Pace = class {
  width;
  depth;
  cost;
  // mean, at this depth and half the width
  late = [];
  // the last three costs at most, at this depth and half the width
  ratios = [];
  // [depth] ratio of its cost to that of one less
  left;
  // the previous depth, until a picture has this depth
  /** Forgets all times, for another scene or renderer. */
  forget() {
    this.width = this.depth = this.cost = this.left = void 0;
    this.ratios = [];
    this.late = [];
  }
  /** Width and depth of the next picture. Without known times an eighth as wide, and two generations. */
  next(limits) {
    this.width = clamped(this.width ?? limits.full / 8, 48, limits.full / 2);
    this.depth = Math.max(0, Math.min(this.depth ?? 2, limits.depth));
    return { width: Math.round(this.width), depth: limits.deepens ? this.depth : limits.depth };
  }
  /** `cost`: milliseconds since the previous picture, or since the request; `depth`: that of the picture. */
  learn(cost, facts, depth, limits) {
    if (this.width === void 0 || this.depth === void 0 || Math.abs(facts.width - this.width) > 0.5 * this.width) return;
    if (limits.deepens && depth !== this.depth) return;
    const most = limits.full / 2, whole = cost * (most / facts.width) ** GROWTH;
    if (this.left) this.compare(whole, facts.width > 0.7 * most);
    this.late = [...this.late.slice(-2), whole];
    const median = [...this.late].sort((a, b) => a - b)[this.late.length >> 1], known = this.cost ?? whole;
    this.cost = known + LATE * (median - known);
    if (limits.deepens) this.choose(limits);
    this.width = Math.min(most, widthFor(this.cost, most), 1.5 * facts.width);
  }
  /** The first picture of another depth; `wide`: wide enough to measure the cost of the depth. */
  compare(whole, wide) {
    const { depth, cost } = this.left, deeper = Math.max(depth, this.depth);
    if (wide && Math.abs(depth - this.depth) === 1) {
      this.ratios[deeper] = clamped(depth < this.depth ? whole / cost : cost / whole, 1, 8);
    }
    this.left = void 0;
    this.cost = whole;
  }
  choose(limits) {
    const most = limits.full / 2, depth = this.depth;
    this.ratios.forEach((ratio, k) => this.ratios[k] = ratio + FADE * (GUESS - ratio));
    let best = depth, cost = this.cost;
    while (best > 0 && widthFor(cost, most) < 0.96 * leastWidth(best, limits)) cost /= this.ratios[best--] ?? GUESS;
    if (best === depth && depth < limits.depth) {
      const deeper = cost * (this.ratios[depth + 1] ?? GUESS);
      if (widthFor(deeper, most) >= leastWidth(depth + 1, limits)) {
        best = depth + 1;
        cost = deeper;
      }
    }
    if (best === depth) return;
    this.left = { depth, cost: this.cost };
    this.late = [];
    this.depth = best;
    this.cost = cost;
  }
};
function widthFor(cost, most) {
  return most * (AIM / Math.max(cost, 0.1)) ** (1 / GROWTH);
}
function leastWidth(depth, limits) {
  return depth > 0 ? limits.full / 2 : 0;
}
function clamped(x, lo, hi) {
  return Math.min(hi, Math.max(lo, x));
}

// apps/viewer/page/pixel_choice.ts
var PixelChoice = class {
  column = this.field("Column of the pixel, from the left");
  row = this.field("Row of the pixel, from the top");
  element;
  width = 0;
  height = 0;
  constructor(explain) {
    this.element = element("form", { class: "row pixel-choice", "aria-label": "Pixel", submit: (e) => {
      e.preventDefault();
      explain(this.column.valueAsNumber, this.row.valueAsNumber);
    } }, element("span", { "aria-hidden": "true" }, "pixel"), this.column, this.row, element("button", {}, "Explain"));
  }
  /** For a picture of another size, chooses the pixel in the middle. */
  fit(width, height) {
    if (width === this.width && height === this.height) return;
    [this.width, this.height] = [width, height];
    this.column.max = String(width - 1);
    this.row.max = String(height - 1);
    this.show(width >> 1, height >> 1);
  }
  show(x, y) {
    this.column.value = String(x);
    this.row.value = String(y);
  }
  field(label) {
    return element("input", { type: "number", min: 0, required: true, "aria-label": label });
  }
};

// apps/viewer/page/viewer.ts
var MOST_SIDE = 4096;
var MOST_RAW = 15e5;
var STOPPED = "Reading the file was ended.";
var NO_ENVIRONMENT = "This renderer shows the background of the scene; those that follow light see an environment.";
var OTHER_SERVER = "The server was replaced, and this page has no key to the new one: open the address that `alhazen view` printed.";
var SILENT = "The server does not answer: waiting for it.";
var BUSY = "The server is busy with other pages: it has 8 clients at most. Close one of them.";
var REST = 300;
var BUSY_PATIENCE = 6e3;
var NO_KEY = "This page has no key to the server: open the address that `alhazen view` printed.";
var Viewer = class {
  // Tests read these, too.
  client = Math.random().toString(36).slice(2);
  image = element("canvas", {
    class: "picture",
    tabindex: "0",
    role: "application",
    "aria-label": "No picture yet",
    "aria-describedby": "help"
  });
  scale = element("div", { class: "scale", hidden: true });
  controls = new Controls(
    (key, before) => this.chosen(key, before),
    (reasons) => this.messages.say("choice", reasons),
    (changes) => this.lightBlocks(changes)
  );
  scene;
  camera;
  frames = 0;
  level = 0;
  // index of the requested level
  generation = 0;
  // of the view
  shownGeneration = 0;
  firstPicture;
  // milliseconds from the request of the page
  token;
  messages = new Messages(document.getElementById("message"));
  work = new WorkLine();
  status = element("p", { id: "status" });
  // Announced by screen readers; the numbers of each picture would be too much.
  spoken = element("p", { id: "spoken", class: "unseen", role: "status" });
  pixel = new PixelChoice((x, y) => this.explainPixel(x, y));
  block = element("textarea", { id: "block", rows: 6, readonly: true, "aria-label": "Camera of the view", hidden: true });
  readAgain = element("button", { type: "button", hidden: true, click: () => void this.ask("/read") }, "Read again");
  g = this.image.getContext("2d");
  pace = new Pace();
  link;
  undone = [];
  asked = /* @__PURE__ */ new Map();
  lastId = 0;
  held;
  // work during which nothing is requested
  explaining;
  halted = false;
  // by Stop, until something changes
  busy = false;
  // the server refused this page a place
  movedAt = -Infinity;
  // when the view was moved last
  resting;
  shownAccelerator;
  described = "";
  // of the displayed picture
  shownAt = 0;
  movingShown = [];
  // times
  constructor() {
    this.token = location.hash.slice(1) || sessionStorage.getItem("token") || "";
    if (location.hash) {
      sessionStorage.setItem("token", this.token);
      history.replaceState(null, "", location.pathname);
    }
    this.build();
    this.link = new FrameLink(this.token, {
      opened: () => {
        this.messages.say("server", "");
        if (this.scene) this.changed();
      },
      state: (state) => this.take(state),
      picture: (head, body) => void this.received(head, body),
      lost: () => {
        this.asked.clear();
        this.work.show(void 0);
        void this.sayWhyLost();
      },
      refused: () => this.messages.say("server", this.scene ? OTHER_SERVER : NO_KEY)
    });
  }
  // A server without a place refuses this page, too.
  async sayWhyLost() {
    if (!this.busy) this.messages.say("server", SILENT);
    const answer = await this.post("/state", {});
    this.busy = answer?.status === 503;
    if (!this.link.connected) this.messages.say("server", this.busy ? BUSY : SILENT);
  }
  build() {
    const block = this.block;
    const button = (text, click) => element("button", { type: "button", click }, text);
    const camera = element("button", { type: "button", "aria-expanded": "false", "aria-controls": "block", click: () => {
      block.value = this.camera?.block() ?? "";
      block.hidden = !block.hidden;
      camera.setAttribute("aria-expanded", String(!block.hidden));
    } }, "Camera block");
    const buttons = element(
      "div",
      { class: "row" },
      button("Undo", () => this.undo()),
      button("Home", () => this.goHome()),
      button("Stop", () => this.stop()),
      camera,
      button("Save picture", () => void this.save()),
      this.readAgain
    );
    const help = element("p", { id: "help" }, "Drag or arrow keys turn, with shift they move; wheel, two fingers, + and \u2212 zoom; W A S D walk. Click or Enter: why a pixel has its colour. Escape ends what is computed.");
    document.getElementById("viewer").append(
      element("div", {}, element("div", { class: "stage" }, this.image), this.scale, this.status, this.spoken, this.work.line, help),
      element("section", { "aria-label": "Settings and actions" }, this.controls.form, buttons, block, this.pixel.element)
    );
    listen(this.image, this);
    listenAnywhere(this);
  }
  // Null if the server does not respond, which the link reports.
  post(path, wish) {
    return fetch(path, {
      method: "POST",
      body: JSON.stringify({ ...wish, client: this.client }),
      headers: { Authorization: `Bearer ${this.token}` }
    }).catch(() => null);
  }
  // Waits for a place among the clients of the server.
  async ask(path, wish = {}, goesOn = () => true) {
    const begin = performance.now();
    for (; ; ) {
      const answer = await this.post(path, wish);
      if (answer?.status !== 503 || performance.now() - begin > BUSY_PATIENCE || !goesOn()) return answer;
      await new Promise((go) => setTimeout(go, 300));
    }
  }
  // The response to work that frames requested earlier may end by arriving after it; null if the page gave it up.
  async askUndisturbed(path, wish, own) {
    let answer = null;
    const goesOn = () => this.held === own;
    for (let tries = 0; tries < 3 && goesOn() && (answer?.status ?? 204) === 204; ++tries) {
      answer = await this.ask(path, wish, goesOn);
    }
    return goesOn() ? answer : null;
  }
  async lightBlocks(lights) {
    const answer = await this.ask("/blocks", { lights, of: this.chosenCamera() });
    if (!answer) return "// The server does not answer.\n";
    if (answer.status === 503) return `// ${BUSY}
`;
    const { text, error } = await answer.json();
    return text ?? `// ${error}
`;
  }
  // ---- The scene.
  take(state) {
    const known = this.scene;
    this.messages.say("file", state.error || (state.stopped ? STOPPED : ""));
    this.work.show(state.work.find((w) => w.seconds > 0.3 && (w.client ?? this.client) === this.client));
    this.readAgain.hidden = !state.stopped;
    if (state.version === 0 || !(state.scene || known)) return;
    const scene = this.scene = { ...known, ...state };
    if (!known) {
      document.title = `${scene.scene} \u2013 Alhazen`;
      document.getElementById("title").textContent = scene.scene;
      this.fill(scene);
      this.see(scene.cameras[0]);
    } else if (known.version !== scene.version) {
      this.refill(known, scene);
      this.changed();
    }
  }
  // The file has changed: finds the chosen camera, by name if it has one, and moves a view that was still that camera's.
  refill(before, scene) {
    const chosen = this.chosenCamera(), old = before.cameras[chosen];
    const same = scene.cameras[chosen]?.name === old.name || !old.name ? -1 : scene.cameras.findIndex((c) => c.name === old.name);
    const index = same >= 0 ? same : Math.min(chosen, scene.cameras.length - 1);
    this.fill(scene);
    this.controls.set("camera", String(index));
    this.fitLights(scene);
    if (this.camera?.isAt(old)) this.see(scene.cameras[index]);
  }
  fill(scene) {
    this.controls.fill(scene);
    this.fitRenderer(scene);
  }
  // Renderers that trace paths have their own default depth; renderers that are not physically based show only the
  // background of an environment.
  fitRenderer(scene) {
    const renderer = this.renders(this.controls.get("renderer"));
    this.controls.setUsual("depth", renderer?.depth ?? scene.depth);
    this.controls.disable("environment", !renderer?.follows_light, NO_ENVIRONMENT);
    this.fitLights(scene);
  }
  // A light that was added to the scene belongs to the view, and may be left out by renderers that follow light.
  fitLights(scene) {
    const added = scene.added_light;
    if (!added) return;
    const follows = this.renders(this.controls.get("renderer"))?.follows_light;
    const without = follows && (!added.follows_light || this.controls.get("environment") !== "");
    const own = this.frame().headlight, lights = scene.lights.filter((l) => !without || l.name !== added.name);
    this.controls.setLights(lights.map((l) => l.name === added.name ? this.atView(own ?? l) : l));
  }
  // The headlight of a camera where the view is.
  atView(light) {
    const view = this.camera;
    if (!view || view.isAt(this.frame())) return light;
    return { ...light, ...light.position ? { position: view.eye } : {}, ...light.direction ? { direction: view.look } : {} };
  }
  see(camera) {
    this.camera = new ViewCamera(camera, this.scene?.up ?? "y");
    if (this.scene) this.fitLights(this.scene);
    this.changed();
  }
  chosen(key, before) {
    if (before) this.remember(before);
    if (["renderer", "accelerator", "lights", "environment", "layer", "moving"].includes(key)) this.pace.forget();
    if (key === "renderer" && this.scene) this.fitRenderer(this.scene);
    if ((key === "environment" || key === "camera") && this.scene) this.fitLights(this.scene);
    if (key === "camera") this.seeChosen();
    else if (key !== "steps") this.changed();
  }
  // ---- Requests.
  chosenCamera() {
    return Number(this.controls.get("camera"));
  }
  // The camera of the scene whose picture is shown.
  frame() {
    return this.scene.cameras[this.chosenCamera()];
  }
  // The width of the whole picture; one with a side that is too large is made smaller.
  full() {
    const { width, height } = this.frame();
    return Math.max(1, Math.floor(Math.min(width, MOST_SIDE, MOST_SIDE * width / height)));
  }
  renders(name) {
    return this.scene?.renderers.find((r) => r.name === name);
  }
  wish(camera, width) {
    const { eye, look, right, up, parallel, aspect, lens } = camera, controls = this.controls;
    return {
      camera: { eye, look, right, up, parallel, aspect, lens, of: this.chosenCamera() },
      width,
      height: this.heightFor(width),
      renderer: controls.get("renderer"),
      accelerator: controls.get("accelerator"),
      layer: controls.get("layer"),
      depth: controls.wished("depth"),
      exposure: controls.number("exposure"),
      curve: controls.get("curve"),
      samples: 1,
      environment: controls.get("environment"),
      lights_off: controls.lights.off(),
      lights: controls.lights.changes()
    };
  }
  // Only renderers that compute single rays can select pixels; layers need rays for each pixel.
  selects() {
    return this.controls.get("moving") === "steady" && !this.controls.get("layer") && !!this.renders(this.controls.get("renderer"))?.selects;
  }
  limits() {
    return { full: this.full(), depth: this.controls.number("depth"), deepens: this.selects() };
  }
  movingWish(camera) {
    const { width, depth } = this.pace.next(this.limits()), wish = this.wish(camera, width);
    if (this.selects()) return { ...wish, depth, selected: true };
    if (this.controls.get("moving") !== "flat" || wish.layer || !this.renders("ray_casting")) return wish;
    return { ...wish, renderer: "ray_casting" };
  }
  // [width relative to the whole, samples] of the levels after the moving picture
  levels() {
    const samples = this.controls.number("samples");
    return [[0, 1], [1 / 4, 1], [1 / 2, 1], [1, 1], ...samples > 1 ? [[1, samples]] : []];
  }
  done() {
    return this.level >= this.levels().length;
  }
  // The view has changed: requests a coarse picture, then finer ones.
  changed() {
    if (!this.camera || !this.scene) return;
    if (!this.block.hidden) this.block.value = this.camera.block();
    this.name();
    ++this.generation;
    this.level = 0;
    this.halted = false;
    if (this.held) {
      this.explaining = this.held = void 0;
      this.status.textContent = this.described;
      this.spoken.textContent = "";
    }
    this.messages.say("explain", "");
    this.request();
  }
  // The description of the picture.
  name() {
    const scene = this.scene, camera = this.frame(), width = this.full();
    const name = pictureName(scene.scene, camera, !!this.camera?.isAt(camera), this.controls.get("renderer"), this.controls.get("layer"));
    if (this.image.getAttribute("aria-label") !== name) this.image.setAttribute("aria-label", name);
    this.pixel.fit(width, this.heightFor(width));
  }
  widthOf(part) {
    return Math.max(1, Math.round(this.full() * part));
  }
  heightFor(width) {
    const frame = this.frame();
    return Math.min(MOST_SIDE, Math.max(1, Math.round(width * frame.height / frame.width)));
  }
  request() {
    if (!this.camera || this.held || this.halted || this.done()) return;
    const [part, samples] = this.levels()[this.level], moving = this.level === 0;
    const wish = moving ? this.movingWish(this.camera) : { ...this.wish(this.camera, this.widthOf(part)), samples };
    const id = ++this.lastId;
    this.asked.set(id, { id, generation: this.generation, level: this.level, wish, begin: performance.now() });
    this.link.send({ ...wish, id, moving, client: this.client, raw: wish.width * wish.height <= MOST_RAW });
  }
  // ---- Responses.
  async received(head, body) {
    const asked = this.asked.get(head.id);
    for (const id of this.asked.keys()) if (id <= head.id) this.asked.delete(id);
    if (!asked) return;
    const newest = asked.id === this.lastId;
    if (head.status === 204) {
      setTimeout(() => {
        if (newest && asked.id === this.lastId) this.request();
      }, 50);
      return;
    }
    if (head.status !== 200 || !head.facts) {
      this.messages.say("frame", JSON.parse(new TextDecoder().decode(body)).error);
      if (newest) this.level = this.levels().length;
      return;
    }
    this.messages.say("frame", "");
    if (asked.generation < this.shownGeneration) return;
    this.shownGeneration = asked.generation;
    await this.draw(head, head.facts, body);
    this.describe(asked, head.facts);
    if (!newest || asked.id !== this.lastId) return;
    const deepest = this.controls.number("depth"), least = head.facts.width + (this.isLess(asked.wish, deepest) ? 0 : 1);
    do
      ++this.level;
    while (this.level < 3 && this.widthOf(this.levels()[this.level][0]) < least);
    if (this.done()) this.sayAtRest(doneText(head.facts, asked.wish.samples));
    this.request();
  }
  // Announces a picture that is done, but none between two steps of a movement.
  sayAtRest(text) {
    const generation = this.generation, wait = this.movedAt + REST - performance.now();
    const say = () => {
      if (generation === this.generation && this.done() && !this.held) this.spoken.textContent = text;
    };
    if (wait > 0) setTimeout(say, wait);
    else say();
  }
  // True if a picture has less than the chosen depth, or another renderer.
  isLess(wish, deepest) {
    return (wish.depth ?? deepest) < deepest || wish.renderer !== this.controls.get("renderer");
  }
  async draw(head, facts, body) {
    const { width, height } = facts, raw = head.type === "application/octet-stream";
    const picture = raw ? new ImageData(new Uint8ClampedArray(body.buffer, body.byteOffset, body.length), width, height) : await createImageBitmap(new Blob([body], { type: head.type }));
    this.image.width = width;
    this.image.height = height;
    if (picture instanceof ImageData) this.g.putImageData(picture, 0, 0);
    else this.g.drawImage(picture, 0, 0);
    const frame = this.frame();
    document.documentElement.style.setProperty("--aspect", String(frame.width / frame.height));
    this.firstPicture ??= performance.now();
    ++this.frames;
  }
  describe(asked, facts) {
    const now = performance.now(), scene = this.scene, moving = asked.level === 0, deepest = this.controls.number("depth");
    if (moving) {
      const busy = asked.begin < this.shownAt;
      this.pace.learn(now - (busy ? this.shownAt : asked.begin), facts, asked.wish.depth ?? deepest, this.limits());
      this.movingShown = [...this.movingShown.filter((t) => t > now - 1e3), now];
    }
    this.shownAt = now;
    this.shownAccelerator = asked.wish.accelerator;
    const span = now - this.movingShown[0], rate = span > 0 ? 1e3 * (this.movingShown.length - 1) / span : 0;
    drawScale(this.scale, facts.layer, scene.scales);
    this.status.textContent = this.described = statusText(
      {
        facts,
        samples: asked.wish.samples,
        selected: !!asked.wish.selected,
        way: now - asked.begin,
        moving: moving ? { depth: asked.wish.depth ?? deepest, rate } : null
      },
      this.full(),
      deepest,
      scene.memory
    );
  }
  // ---- Actions.
  move(change, mark) {
    if (!this.camera) return;
    if (mark) this.remember();
    change(this.camera);
    this.movedAt = performance.now();
    clearTimeout(this.resting);
    this.resting = setTimeout(() => this.scene && this.fitLights(this.scene), REST);
    this.changed();
  }
  goHome() {
    this.remember();
    this.seeChosen();
  }
  seeChosen() {
    if (this.scene) this.see(this.frame());
  }
  remember(settings = this.controls.settings()) {
    this.messages.say("save", "");
    if (this.camera) this.undone.push({ camera: this.camera.copy(), settings });
    if (this.undone.length > 100) this.undone.shift();
  }
  undo() {
    const before = this.undone.pop();
    if (!before || !this.scene) return;
    this.camera = before.camera;
    this.controls.restore(before.settings);
    this.fitRenderer(this.scene);
    this.pace.forget();
    this.changed();
  }
  // Ends the running frame, explanation, reading or building; the displayed picture stays.
  stop() {
    this.explaining = this.held = void 0;
    this.halted = true;
    this.asked.clear();
    if (this.scene) this.controls.set("accelerator", this.shownAccelerator ?? this.scene.accelerator);
    const sent = this.link.send({ stop: true, client: this.client });
    this.spoken.textContent = sent ? "Stopped" : "";
    for (const topic of ["explain", "save"]) this.messages.say(topic, "");
    this.status.textContent = this.described;
  }
  // Requests no frames until the work is done, or given up for a change.
  async hold(work) {
    const own = this.held = {};
    try {
      await work(own);
    } finally {
      if (this.held === own) {
        this.held = void 0;
        this.request();
      }
    }
  }
  save() {
    this.messages.say("save", "");
    return this.hold(async (own) => {
      if (!this.camera) return;
      const wish = { ...this.wish(this.camera, this.full()), samples: this.controls.number("samples"), png: true };
      const answer = await this.askUndisturbed("/frame", wish, own);
      if (this.held !== own) return this.messages.say("save", "The picture was not saved: it was ended.");
      if (!answer) return;
      if (answer.status !== 200) return this.messages.say("save", `The picture was not saved: ${await reasonOf(answer)}`);
      const link = element("a", { href: URL.createObjectURL(await answer.blob()), download: "view.png" });
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1e4);
    });
  }
  /** `u`, `v`: position relative to width and height. */
  explain(u, v) {
    if (!this.camera) return;
    const width = this.full(), at = (w, n) => Math.min(n - 1, Math.max(0, Math.floor(w * n)));
    this.explainPixel(at(u, width), at(v, this.heightFor(width)));
  }
  explainPixel(x, y) {
    if (!this.camera) return;
    this.explainSample({ ...this.wish(this.camera, this.full()), samples: this.controls.number("samples"), x, y }, 0);
  }
  /** `picture`: set if the explained picture is not the displayed one. */
  explainSample(wish, sample, picture) {
    const { x, y } = wish, own = this.explaining = {};
    this.pixel.show(x, y);
    this.status.textContent = this.spoken.textContent = "Explaining \u2026 (Escape ends it)";
    void this.hold(async (held) => {
      const answer = await this.askUndisturbed("/explain", { ...wish, sample, steps: this.controls.get("steps") }, held);
      if (this.explaining !== own) return;
      this.explaining = void 0;
      this.status.textContent = this.described;
      this.spoken.textContent = answer?.status === 204 ? "The explanation was ended" : "";
      if (!answer || answer.status === 204) return;
      this.messages.say("explain", answer.ok ? "" : await reasonOf(answer));
      if (!answer.ok) return;
      const data = await answer.json();
      const root = document.getElementById("explanation");
      root.hidden = false;
      root.ariaLabel = `Explanation of pixel ${x},${y}`;
      const shown = picture ?? this.image.toDataURL("image/jpeg", 0.9);
      showExplanation(root, data, shown, (i) => this.explainSample(wish, i, shown));
      root.scrollIntoView({ behavior: scrollBehavior() });
      root.focus({ preventScroll: true });
    });
  }
};
async function reasonOf(answer) {
  if (answer.status === 204) return "it was ended";
  const { error } = await answer.json().catch(() => ({}));
  return error ?? (answer.status === 503 ? BUSY : `${answer.status} ${answer.statusText}`);
}

// apps/viewer/page/view.ts
globalThis.viewer = new Viewer();
