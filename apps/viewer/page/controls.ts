// What can be chosen: menus of what the program says that there is, and numbers.

import {element} from "../../../src/alhazen/explain/page/basics";
import type {Choice, Scene} from "./state";

const MOVING: Choice[] = [
  {name: "steady", what: "the same renderer, 20 pictures a second: fewer pixels, then fewer generations of rays; shades between " +
                         "rays where they agree"},
  {name: "coarser", what: "the same renderer at its depth: as many pixels as 20 pictures a second allow"},
  {name: "flat", what: "ray_casting: no shadows, mirrors, glass"}];
const MENUS = ["camera", "renderer", "accelerator", "layer", "moving", "curve", "steps"] as const;
const NUMBERS = ["samples", "depth", "exposure"] as const;

export type MenuKey = typeof MENUS[number];
export type NumberKey = typeof NUMBERS[number];
type Key = MenuKey | NumberKey;

export class Controls {
  readonly form = element("form", {class: "controls", "aria-label": "Settings", submit: e => e.preventDefault()});
  private readonly fields = new Map<Key, HTMLSelectElement | HTMLInputElement>();
  private readonly usual = new Map<NumberKey, number>();
  private readonly wishes = new Set<NumberKey>();  // numbers that were chosen; others are the usual ones

  constructor(private readonly changed: (key: Key) => void) {}

  get(key: MenuKey) {
    return this.fields.get(key)?.value ?? "";
  }
  number(key: NumberKey) {
    return Number(this.fields.get(key)?.value);
  }
  /** Undefined where nothing was chosen. */
  wished(key: NumberKey) {
    return this.wishes.has(key) ? this.number(key) : undefined;
  }
  /** What it is where nothing is chosen. */
  setUsual(key: NumberKey, value: number) {
    this.usual.set(key, value);
    if (!this.wishes.has(key)) this.set(key, String(value));
  }
  set(key: Key, value: string) {
    const field = this.fields.get(key);
    if (field) field.value = value;
  }
  /** As a person would. */
  choose(key: Key, value: string) {
    this.set(key, value);
    this.fields.get(key)?.dispatchEvent(new Event("change"));
  }
  options(key: MenuKey) {
    const field = this.fields.get(key);
    return field instanceof HTMLSelectElement ? [...field.options].map(o => o.text) : [];
  }

  // A field that was emptied is as usual again.
  private typed(key: NumberKey) {
    if (this.fields.get(key)?.value) this.wishes.add(key);
    else {
      this.wishes.delete(key);
      this.set(key, String(this.usual.get(key)));
    }
    this.changed(key);
  }
  /** What was chosen stays where it still is. */
  fill(scene: Scene) {
    const focus = [...this.fields].find(([, field]) => field === document.activeElement)?.[0];
    const chosen = new Map([...this.fields].map(([key, field]) => [key, field.value]));
    this.form.replaceChildren();
    const add = (key: Key, label: string, field: HTMLSelectElement | HTMLInputElement, value: string) => {
      const kept = field instanceof HTMLSelectElement || this.wishes.has(key as NumberKey);
      field.value = (kept ? chosen.get(key) : undefined) ?? value;
      if (field instanceof HTMLSelectElement && field.selectedIndex < 0) field.value = value;
      if (field instanceof HTMLSelectElement && field.selectedIndex < 0) field.selectedIndex = 0;
      this.fields.set(key, field);
      this.form.append(element("label", {}, label, field));
    };
    const menu = (key: MenuKey, label: string, entries: Choice[], value: string) =>
      add(key, label, element("select", {name: key, change: () => this.changed(key)}, ...entries.map(e =>
        element("option", {value: e.value ?? e.name, title: e.what}, e.name))), value);
    const field = (key: NumberKey, label: string, value: number, min: number, max: number, step = 1) => {
      this.usual.set(key, value);
      add(key, label, element("input", {name: key, type: "number", min, max, step, change: () => this.typed(key)}), String(value));
    };

    menu("camera", "camera", scene.cameras.map((c, i) => ({name: c.name || `camera ${i + 1}`, value: String(i)})), "0");
    menu("renderer", "renderer", scene.renderers, "whitted");
    menu("accelerator", "accelerator", scene.accelerators, scene.accelerator);
    menu("layer", "layer", [{name: "colours", value: "", what: "the picture"}, ...scene.layers], "");
    menu("moving", "moving", MOVING, "steady");
    field("samples", "samples", 4, 1, 1024);
    field("depth", "depth", scene.depth, 0, 100);
    field("exposure", "exposure", 0, -16, 16, 0.5);
    menu("curve", "tone curve", scene.curves.map(name => ({name})), "none");
    menu("steps", "steps of", scene.steps.split(", ").map(name => ({name})), "kay_kajiya");
    if (focus) this.fields.get(focus)?.focus();
  }
}
