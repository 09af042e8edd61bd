// The whole explanation of a pixel: showExplanation(root, data, picture).

import {KINDS, css, element, headRow, number, scrolling, swatch, triple} from "./basics";
import type {Child} from "./basics";
import {beamPieces} from "./beam_pieces";
import {ConeTree} from "./cone_tree";
import type {Explanation, RayKind} from "./explanation_data";
import {patchParts} from "./patch_parts";
import {pathSteps} from "./path_steps";
import {polynomialPlots} from "./polynomial_plot";
import {RayOutline, raysOf} from "./ray_outline";
import type {AnyRay} from "./ray_outline";
import {SceneView} from "./scene_view";
import {spanBars} from "./span_bars";
import {TraversalSteps} from "./traversal_steps";

/** `choose`: shows the explanation of another sample; left out where there is none to be had. */
export function showExplanation(root: HTMLElement, data: Explanation, picture: string | null, choose?: (sample: number) => void) {
  const rays = raysOf(data.tree);
  let view: SceneView, outline: RayOutline;
  const select = (ray: AnyRay, reveal = true) => {
    view.select(ray);
    outline.select(ray, reveal);
  };
  const canvas = element("canvas", {class: "space", tabindex: "0", role: "application", "aria-label":
    `${rays.length} rays in space`, "aria-describedby": "space-keys"});
  const section = (id: string, title: string, ...children: Child[]) => element("section", {id, "aria-labelledby": `${id}-title`},
    element("h2", {id: `${id}-title`}, title), ...children);
  const tree = element("div", {class: "outline"});
  const cones = element("div"), beams = element("div"), path = element("div"), patches = element("div", {class: "plots"});
  const spans = element("div"), plots = element("div", {class: "plots"}), steps = element("div");
  root.replaceChildren(
    header(data, picture),
    element("div", {class: "top"},
      section("space", "The rays in space", canvas, element("p", {id: "space-keys", class: "unseen"},
        "Arrow keys turn the view, with shift they move it, plus and minus come nearer and go back, 0 is the view of the beginning. " +
        "The outline below tells the same rays."), legend(data, () => view)),
      section("tree", "The tree of rays", element("p", {class: "soft"},
        "I = ke + \u03a3 ka Ia + \u03a3 S I [kd (N\u00b7L) + ks highlight] + kr I(reflected) + kt I(refracted). " +
        "The numbers are those of the renderer; each table adds up to the colour of its ray."),
        data.cut === false ? null : element("p", {class: "cut"}, `The tree is cut at depth ${data.cut}: deeper ones have too ` +
          "many rays to be shown. All colours here are those of a picture of that depth."), tree)),
    data.cones ? section("cones", "Cones and what covers them", cones) : "",
    data.beams ? section("beams", "Pieces of the beams", beams) : "",
    data.path ? section("path", `One path of a picture with ${data.samples.length} sample${data.samples.length > 1 ? "s" : ""}`, path) : "",
    section("spans", "Inside which solids the eye ray is", spans),
    data.polynomials.length ? section("roots", "Polynomials on the ray and their roots", plots) : "",
    data.patches.length ? section("patches", "Patches subdivided for the ray", patches) : "",
    data.traversal ? section("steps", "How the first surface is found", steps) : "",
    data.samples.length > 1 ? section("samples", "The samples of the pixel", sampleTable(data, choose)) : "");
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
  return {view, outline, select};
}

function header(data: Explanation, picture: string | null) {
  const facts = [`(${triple(data.pixel)})`, `${data.width} \u00d7 ${data.height}`, `depth ${data.max_depth}`,
    `${data.samples.length} sample${data.samples.length > 1 ? `s, number ${data.sample} shown` : ""}`,
    ...Object.entries(data.rays).filter(([, n]) => n).map(([kind, n]) => `${n} ${kind}`)];
  const head = element("header", {}, element("div", {},
    element("h1", {}, swatch(data.pixel), ` Pixel ${data.x},${data.y} of ${data.scene}`),
    element("p", {class: "soft"}, facts.join(" \u00b7 ")), otherRenderer(data)));
  if (picture) {
    const image = element("img", {src: picture, alt: `The scene; the pixel is marked`});
    const mark = element("span", {class: "mark", "aria-hidden": "true"});
    mark.style.left = `${100 * (data.x + 0.5) / data.width}%`;
    mark.style.top = `${100 * (data.y + 0.5) / data.height}%`;
    head.append(element("div", {class: "preview"}, image, mark));
  }
  return head;
}
// The tree is that of whitted, whichever renderer made the picture.
function otherRenderer({renderer, draws_at_random, path}: Explanation) {
  if (renderer === "whitted") return null;
  return element("p", {class: "cut", id: "other"}, draws_at_random
    ? `The picture is by ${renderer}, which draws rays at random for each sample. The tree shows the rays that whitted traces ` +
      "for this pixel: towards points of lights, in mirror directions and through glass. Its colour may differ." +
      (path ? " One path of the picture follows below the tree." : "")
    : `The picture is by ${renderer}; the tree of rays is that of whitted, whose colour may differ.`);
}
function legend(data: Explanation, view: () => SceneView) {
  const shadows = element("input", {type: "checkbox", checked: true, change: () => {
    view().showShadows = shadows.checked;
    view().draw();
  }});
  const kinds = Object.entries(KINDS).filter(([kind]) => data.rays[kind as RayKind]);
  return element("div", {class: "legend"},
    ...kinds.map(([kind, text]) => element("span", {class: kind}, element("i", {class: "key", "aria-hidden": "true"}), text)),
    element("label", {}, shadows, " show shadow rays"),
    element("button", {type: "button", click: () => view().home()}, "Home view"));
}
function sampleTable(data: Explanation, choose?: (sample: number) => void) {
  const plot = element("svg:svg", {class: "pixel", viewBox: "0 0 100 100", role: "img", "aria-label": "Where the samples lie in the pixel"},
    element("svg:rect", {class: "frame", x: 0, y: 0, width: 100, height: 100}));
  data.samples.forEach((s, i) => {
    const dot = element("svg:circle", {cx: 100 * s.place[0], cy: 100 * s.place[1], r: i === data.sample ? 5 : 3.5,
                                       class: i === data.sample ? "chosen" : ""});
    dot.style.fill = css(s.radiance);
    plot.append(dot);
  });
  const name = (i: number) => choose && i !== data.sample
    ? element("button", {type: "button", class: "link", "aria-label": `Explain sample ${i}`, click: () => choose(i)}, String(i)) : String(i);
  const rows = data.samples.map((s, i) => element("tr", i === data.sample ? {class: "selected", "aria-current": "true"} : {},
    element("th", {scope: "row"}, name(i)),
    ...s.radiance.map(c => element("td", {}, number(c))), element("td", {}, swatch(s.radiance))));
  return element("div", {class: "samples"}, plot, scrolling("Samples", element("table", {},
    headRow(["sample", "red", "green", "blue", ""]), element("tbody", {}, ...rows))));
}
