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

  constructor(private readonly changed: (key: Key) => void) {}

  get(key: MenuKey) {
    return this.fields.get(key)?.value ?? "";
  }
  number(key: NumberKey) {
    return Number(this.fields.get(key)?.value);
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

  /** What was chosen stays where it still is. */
  fill(scene: Scene) {
    const focus = [...this.fields].find(([, field]) => field === document.activeElement)?.[0];
    const chosen = new Map([...this.fields].map(([key, field]) => [key, field.value]));
    this.form.replaceChildren();
    const add = (key: Key, label: string, field: HTMLSelectElement | HTMLInputElement, value: string) => {
      field.value = chosen.get(key) ?? value;
      if (field instanceof HTMLSelectElement && field.selectedIndex < 0) field.value = value;
      if (field instanceof HTMLSelectElement && field.selectedIndex < 0) field.selectedIndex = 0;
      this.fields.set(key, field);
      this.form.append(element("label", {}, label, field));
    };
    const menu = (key: MenuKey, label: string, entries: Choice[], value: string) =>
      add(key, label, element("select", {name: key, change: () => this.changed(key)}, ...entries.map(e =>
        element("option", {value: e.value ?? e.name, title: e.what}, e.name))), value);
    const field = (key: NumberKey, label: string, value: number, min: number, max: number, step = 1) =>
      add(key, label, element("input", {name: key, type: "number", min, max, step, change: () => this.changed(key)}), String(value));

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
