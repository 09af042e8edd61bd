// The tree of rays as a collapsible outline: each ray, each surface that it hits, and the shading equation there, term
// by term.

import {KINDS, element, headRow, listItem, number, scrollBehavior, scrolling, swatch, triple} from "./basics";
import type {Vec3} from "./basics";
import type {Explanation, LightTerm, OnwardTerm, SurfacePoint, TreeRay} from "./explanation_data";

// A line of the equation: its value, and its light.
type Row = (name: string, how: string, value: Vec3 | null | undefined, light?: LightTerm) => void;

const REASONS: Record<string, string> = {
  no_coefficient: "the material has none", deepest: "the tree ends at this depth",
  too_weak: "its share of the pixel would be below the least contribution",
  total_reflection: "total internal reflection: Snell\u2019s law has no solution",
  not_traced: "this scene\u2019s conventions trace none"};

// A light's term as a ray to draw: it ends where it is blocked; `distance` is that of the light.
export interface ShadowRay extends LightTerm {
  kind: "shadow";
  blocked: boolean;
  distance: number | null;
}
export type AnyRay = TreeRay | ShadowRay;
type Select = (ray: AnyRay, reveal?: boolean) => void;

// All rays of the tree, shadow rays included, outermost first; sets the fields of lights that drawing needs.
export function raysOf(tree: TreeRay) {
  const list: AnyRay[] = [];
  const visit = (ray: TreeRay) => {
    list.push(ray);
    for (const surface of ray.surfaces) {
      for (const light of surface.lights ?? []) {
        if (!light.cast) continue;
        const blocked = light.through.every(c => c === 0);
        const shadow: ShadowRay = Object.assign(light, {kind: "shadow" as const, blocked, distance: light.t});
        if (blocked) shadow.t = light.crossings.at(-1)?.t ?? light.t;
        list.push(shadow);
      }
      for (const term of [surface.reflected, surface.refracted]) if (term?.ray) visit(term.ray);
    }
  };
  visit(tree);
  return list;
}

function isShadow(light: LightTerm | undefined): light is ShadowRay {
  return light !== undefined && (light as ShadowRay).kind === "shadow";
}

export class RayOutline {
  private readonly places = new Map<AnyRay, HTMLElement>();
  private readonly whole: string;  // denominator of the weights

  constructor(root: HTMLElement, data: Explanation, private readonly onSelect: Select) {
    this.whole = data.samples.length > 1 ? "sample" : "pixel";
    root.append(element("ul", {"aria-label": "Rays"}, listItem(1, this.ray(data.tree))));
  }
  select(ray: AnyRay, reveal: boolean) {
    for (const [other, place] of this.places) {
      place.classList.toggle("selected", other === ray);
      if (other === ray) place.setAttribute("aria-current", "true");
      else place.removeAttribute("aria-current");
    }
    const place = this.places.get(ray);
    if (!place || !reveal) return;
    for (let at = place.parentElement; at; at = at.parentElement) if (at instanceof HTMLDetailsElement) at.open = true;
    place.scrollIntoView({block: "nearest", behavior: scrollBehavior()});
  }

  private ray(ray: TreeRay) {
    const met = ray.surfaces.map(s => `\u2018${s.object}\u2019`).join(", then ");
    const first = ray.surfaces.at(0);
    const summary = element("summary", {class: ray.kind},
      element("b", {class: "badge"}, `${ray.id}`), ` ${KINDS[ray.kind]} `,
      first ? `meets ${met} at t = ${number(first.t)}` : "meets nothing", " ", swatch(ray.radiance));
    const body = element("details", {open: ray.depth < 3, class: "ray"}, summary,
      element("p", {class: "soft"}, `radiance (${triple(ray.radiance)}) \u00d7 weight (${triple(ray.weight)}) = ` +
              `(${triple(ray.in_pixel)}) of the ${this.whole}`),
      element("details", {}, element("summary", {class: "soft"}, "where it runs"), element("p", {class: "mono"},
              `origin (${triple(ray.origin)}), direction (${triple(ray.direction)})`,
              ray.inside ? "; it starts inside something transparent" : "")));
    summary.addEventListener("click", () => this.onSelect(ray));
    summary.addEventListener("focus", () => this.onSelect(ray, false));
    this.places.set(ray, summary);
    ray.surfaces.forEach(s => body.append(this.surface(s, ray.depth + 2)));
    if (ray.left) body.append(element("p", {}, ray.given_up
      ? `It ends here: it has passed as many surfaces as a ray may, and (${triple(ray.left)}) of its light is not known.`
      : `It leaves the scene and takes (${triple(ray.left)}) of the background.`));
    return body;
  }

  // `level`: level in the outline of the rays that leave it.
  private surface(s: SurfacePoint, level: number) {
    const box = element("div", {class: "surface"});
    box.append(element("p", {}, element("b", {}, `\u2018${s.object}\u2019`),
      s.material ? `, material \u2018${s.material}\u2019` : "", `, t = ${number(s.t)}, `,
      s.entering ? "from outside" : "from inside",
      s.share.some(c => c !== 1) ? `, share of the ray (${triple(s.share)})` : ""));
    box.append(this.equation(s));
    const onward = [s.reflected, s.refracted].flatMap(term => term?.ray ? [listItem(level, this.ray(term.ray))] : []);
    if (onward.length) box.append(element("ul", {"aria-label": `Rays from ${s.object}`}, ...onward));
    return box;
  }

  private equation(s: SurfacePoint) {
    const rows: HTMLElement[] = [];
    const row: Row = (name, how, value, light) => {
      const head = element("th", {scope: "row"}, name);
      const line = element("tr", {}, head, element("td", {class: "how"}, how),
        ...(value ?? [null, null, null]).map(c => element("td", {title: String(c)}, value ? number(c) : "\u2013")),
        element("td", {}, value ? swatch(value) : ""));
      if (isShadow(light)) {
        head.replaceChildren(element("button", {type: "button", class: "link shadow", click: () => this.onSelect(light)}, name));
        this.places.set(light, line);
      }
      rows.push(line);
    };
    row("emission", "ke", s.emission);
    if (!s.unlit) {
      for (const a of s.ambient) {
        row(`ambient, ${a.light}`, `ka (${triple(s.ambient_factor)}) \u00d7 Ia (${triple(a.intensity)})`, a.value);
      }
      for (const light of s.lights) row(light.light, this.lightText(light), light.value, light);
      this.onward("reflected", "kr", s.reflected, row);
      this.onward("refracted", "kt", s.refracted, row);
      if (s.filter) row("medium", `all of it \u00d7 (${triple(s.filter)}): what the medium lets through`, null);
    }
    return scrolling(`Shading of ${s.object}`, element("table", {class: "equation"},
      headRow(["term", "factors", "red", "green", "blue", ""]), element("tbody", {}, ...rows),
      element("tfoot", {}, element("tr", {}, element("th", {scope: "row", colspan: 2}, "sum"),
        ...s.color.map(c => element("td", {title: String(c)}, number(c))), element("td", {}, swatch(s.color))))));
  }
  private lightText(light: LightTerm) {
    const names = light.crossings.map(c => `\u2018${c.object}\u2019`);
    if (light.intensity.every(c => c === 0)) return `emits nothing towards this point: I (0, 0, 0), N\u00b7L = ${number(light.cosine)}`;
    const through = !light.cast ? "no shadow rays are cast"
      : isShadow(light) && light.blocked ? `blocked${names.length ? ` by ${names.at(-1)}` : ""}`
      : names.length ? `(${triple(light.through)}) comes through ${names.join(", ")}` : "unhindered";
    return `${through}; I (${triple(light.intensity)}) \u00d7 [kd (N\u00b7L) (${triple(light.diffuse)}) + ` +
           `ks highlight (${triple(light.highlight)})], N\u00b7L = ${number(light.cosine)}`;
  }
  private onward(name: string, factor: string, term: OnwardTerm | undefined, row: Row) {
    if (!term) return;
    if (term.ray && term.factor) row(name, `${factor} (${triple(term.factor)}) \u00d7 ray ${term.ray.id} (${triple(term.ray.radiance)})`,
                      term.value);
    else if (term.reason !== "no_coefficient") row(name, `not sent: ${REASONS[term.reason]}`, null);
  }
}
