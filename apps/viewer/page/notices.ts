// The texts of the page: messages, running work, the numbers below the picture, the scale of a layer.

import {element, number} from "../../../src/alhazen/explain/page/basics";
import type {CameraData, FrameFacts, LayerFacts, Scene, Work} from "./state";

export type Topic = "server" | "file" | "choice" | "frame" | "explain" | "save";

/** One message per topic; an empty one removes it. */
export class Messages {
  private readonly texts = new Map<Topic, string>();

  constructor(private readonly place: HTMLElement) {}

  say(topic: Topic, text: string) {
    if ((this.texts.get(topic) ?? "") === text) return;
    this.texts.set(topic, text);
    const all = [...this.texts.values()].filter(t => t).join("\n");
    this.place.hidden = !all;
    if (this.place.textContent !== all) this.place.textContent = all;
  }
}

/** Work that takes longer. Screen readers announce its name, not each second of it. */
export class WorkLine {
  private readonly what = element("span");
  private readonly time = element("span", {"aria-hidden": "true"});
  private readonly bar = element("progress", {max: 1, "aria-label": "Part that is done", hidden: true});
  readonly line = element("p", {id: "work", role: "status"}, this.what, this.time, this.bar);

  show(work: Work | undefined) {
    const what = work ? `${work.what} \u2026 ` : "";
    if (this.what.textContent !== what) this.what.textContent = what;
    this.time.textContent = work ? `${work.seconds.toFixed(1)} s ` : "";
    this.bar.hidden = work?.part === undefined;
    this.bar.value = work?.part ?? 0;
  }
}

export interface Shown {
  facts: FrameFacts;
  samples: number;
  selected: boolean;
  moving: {depth: number; rate: number} | null;
  way: number;  // milliseconds since the request
}
export function statusText(shown: Shown, full: number, depth: number, memory: number) {
  const {facts, samples, moving} = shown;
  const parts = [`${facts.width} \u00d7 ${facts.height}`, `${samples} sample${samples > 1 ? "s" : ""} a pixel`];
  if (moving) {
    const less = [facts.width < full ? `${full} wide when it rests` : "",
                  moving.depth < depth ? `depth ${moving.depth} of ${depth}` : "", shown.selected ? "pixels selected" : ""];
    parts.splice(1, 1, [`moving, ${moving.rate.toFixed(0)} pictures/s`, ...less.filter(t => t)].join(", "));
  }
  parts.push(`${timeText(1000 * facts.seconds)}, ${timeText(shown.way)} with the way here`,
             `${(facts.rays / facts.seconds / 1e6).toFixed(2)} M rays/s on ${facts.threads} threads`,
             `${(memory / 1048576).toFixed(0)} MiB`);
  return parts.join(" \u00b7 ");
}

/** The picture in words; `there`: true if the view is still that of the camera. */
export function pictureName(scene: string, camera: CameraData, there: boolean, renderer: string, layer: string) {
  const from = `from ${there ? "" : "a view that began at "}camera ${camera.name || "without a name"}`;
  return `Picture of ${scene}, ${layer ? `layer ${layer}, ` : ""}${from}, by ${renderer}`;
}
/** Announced once, when no finer picture follows. */
export function doneText({width, height, seconds}: FrameFacts, samples: number) {
  return `The picture is done: ${width} by ${height}, ${samples} sample${samples > 1 ? "s" : ""} a pixel, ${timeText(1000 * seconds)}`;
}

function timeText(ms: number) {
  return ms < 1000 ? `${ms.toFixed(ms < 100 ? 1 : 0)} ms` : `${(ms / 1000).toFixed(ms < 10000 ? 2 : 1)} s`;
}

/** The meaning of the colours of a layer. */
export function drawScale(place: HTMLElement, layer: LayerFacts | undefined, scales: Scene["scales"]) {
  place.hidden = !layer;
  if (!layer) return;
  const {name, meaning, colors, low, high} = layer;
  if (!colors || low === undefined || high === undefined) {
    place.replaceChildren(element("b", {}, name), `: ${meaning}`);
    return;
  }
  const bar = element("div", {class: "bar-of-scale", "aria-hidden": "true"});
  bar.style.background = `linear-gradient(90deg, ${scales[colors].join(", ")})`;
  place.replaceChildren(element("b", {}, name), bar, element("div", {class: "marks"},
    ...[low, (low + high) / 2, high].map(m => element("span", {}, number(m)))));
}
