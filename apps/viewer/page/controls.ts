// The controls: menus of the choices that the program offers, and numbers.

import {element} from "../../../src/alhazen/explain/page/basics";
import {LightList} from "./lights";
import type {LightState} from "./lights";
import type {Choice, LightChange, LightEntry, Scene} from "./state";

const MOVING: Choice[] = [
  {name: "steady", what: "the same renderer, 20 pictures a second: fewer generations of rays, then fewer pixels; shades between " +
                         "rays where they agree"},
  {name: "coarser", what: "the same renderer at its depth: as many pixels as 20 pictures a second allow"},
  {name: "flat", what: "ray_casting: no shadows, mirrors, glass"}];
const MENUS = ["camera", "renderer", "accelerator", "environment", "layer", "moving", "curve", "steps"] as const;
const NUMBERS = ["samples", "depth", "exposure"] as const;
interface Limits {
  label: string;
  min: number;
  max: number;
  step: number;
  whole: boolean;
}
// Those of the server.
const LIMITS: Record<typeof NUMBERS[number], Limits> = {
  samples: {label: "samples", min: 1, max: 1024, step: 1, whole: true},
  depth: {label: "depth", min: 0, max: 100, step: 1, whole: true},
  exposure: {label: "exposure", min: -64, max: 64, step: 0.5, whole: false}};

const isNumber = (key: string): key is NumberKey => (NUMBERS as readonly string[]).includes(key);
/** Why the text of a field is not used; empty if it is, or if nothing is chosen. */
function fault({label, min, max, whole}: Limits, field: HTMLInputElement) {
  const x = Number(field.value);
  if (!field.value && !field.validity.badInput) return "";
  if (field.value && x >= min && x <= max && (!whole || Number.isInteger(x))) return "";
  return `${label} must be a ${whole ? "whole " : ""}number from ${min} to ${max}`;
}

export type MenuKey = typeof MENUS[number];
export type NumberKey = typeof NUMBERS[number];
/** "lights": a light was switched; "light": a light was changed. */
export type Key = MenuKey | NumberKey | "lights" | "light";
type FieldKey = MenuKey | NumberKey;
/** All choices, for undo. */
export interface Settings {
  values: Map<FieldKey, string>;
  wishes: Set<NumberKey>;
  lights: LightState;
}

export class Controls {
  readonly form = element("form", {class: "controls", "aria-label": "Settings", submit: e => e.preventDefault()});
  readonly lights: LightList;
  private readonly fields = new Map<FieldKey, HTMLSelectElement | HTMLInputElement>();
  private readonly usual = new Map<NumberKey, number>();
  private readonly numbers = new Map<NumberKey, number>();  // the last valid ones
  private readonly wishes = new Set<NumberKey>();  // chosen numbers; others have their defaults
  private readonly reasons = new Map<MenuKey, HTMLElement>();  // why menus have no effect
  private last: Settings | undefined;

  /** `changed` gets the previous choices, unless it continues the previous change; `refused` why numbers are not used. */
  constructor(private readonly changed: (key: Key, before: Settings | undefined) => void,
              private readonly refused: (reasons: string) => void, blocks: (changes: LightChange[]) => Promise<string>) {
    this.lights = new LightList({changed: (which, mark) => this.tell(which, mark), blocks});
  }

  get(key: MenuKey) {
    return this.fields.get(key)?.value ?? "";
  }
  number(key: NumberKey) {
    return this.numbers.get(key) ?? 0;
  }
  /** Undefined if nothing was chosen. */
  wished(key: NumberKey) {
    return this.wishes.has(key) ? this.number(key) : undefined;
  }
  /** The value if nothing is chosen. */
  setUsual(key: NumberKey, value: number) {
    this.usual.set(key, value);
    if (!this.wishes.has(key)) this.set(key, String(value));
  }
  set(key: FieldKey, value: string) {
    this.show(key, value);
    this.last = this.settings();
  }
  private show(key: FieldKey, value: string) {
    const field = this.fields.get(key);
    if (!field) return;
    field.value = value;
    if (!isNumber(key)) return;
    this.numbers.set(key, Number(value));
    this.check();
  }
  // Marks the numbers that are not used.
  private check() {
    const reasons = NUMBERS.flatMap(key => {
      const field = this.fields.get(key), reason = field instanceof HTMLInputElement ? fault(LIMITS[key], field) : "";
      if (reason) field?.setAttribute("aria-invalid", "true");
      else field?.removeAttribute("aria-invalid");
      return reason ? [reason] : [];
    });
    this.refused(reasons.join("\n"));
  }
  /** As a user would. */
  choose(key: FieldKey, value: string) {
    const field = this.fields.get(key);
    if (field) field.value = value;
    field?.dispatchEvent(new Event("change"));
  }
  /** A menu without effect. */
  disable(key: MenuKey, off: boolean, why: string) {
    const field = this.fields.get(key);
    if (!field) return;
    field.disabled = off;
    this.reasons.get(key)?.remove();
    this.reasons.delete(key);
    field.removeAttribute("aria-describedby");
    if (!off) return;
    const reason = element("p", {class: "why", id: `why-${key}`}, why);
    this.reasons.set(key, reason);
    field.closest("label")?.after(reason);
    field.setAttribute("aria-describedby", reason.id);
  }
  settings(): Settings {
    const values = new Map([...this.fields].map(([key, field]) => [key, isNumber(key) ? String(this.number(key)) : field.value]));
    return {values, wishes: new Set(this.wishes), lights: this.lights.state()};
  }
  /** Keeps choices that the scene does not have. */
  restore({values, wishes, lights}: Settings) {
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
  private tell(key: Key, mark = true) {
    const before = this.last;
    this.last = this.settings();
    this.changed(key, mark ? before ?? this.last : undefined);
  }
  options(key: MenuKey) {
    const field = this.fields.get(key);
    return field instanceof HTMLSelectElement ? [...field.options].map(o => o.text) : [];
  }

  // An emptied field gets its default again.
  private typed(key: NumberKey) {
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
  fill(scene: Scene) {
    const focus = [...this.fields].find(([, field]) => field === document.activeElement)?.[0];
    const place = this.lights.place();
    const chosen = this.settings().values;
    this.form.replaceChildren();
    const add = (key: FieldKey, label: string, field: HTMLSelectElement | HTMLInputElement, value: string) => {
      const kept = field instanceof HTMLSelectElement || this.wishes.has(key as NumberKey);
      field.value = (kept ? chosen.get(key) : undefined) ?? value;
      if (field instanceof HTMLSelectElement && field.selectedIndex < 0) field.value = value;
      if (field instanceof HTMLSelectElement && field.selectedIndex < 0) field.selectedIndex = 0;
      this.fields.set(key, field);
      if (isNumber(key)) this.numbers.set(key, Number(field.value));
      this.form.append(element("label", {}, label, field));
    };
    const menu = (key: MenuKey, label: string, entries: Choice[], value: string) =>
      add(key, label, element("select", {name: key, change: () => this.tell(key)}, ...entries.map(e =>
        element("option", {value: e.value ?? e.name, title: e.what}, e.name))), value);
    const field = (key: NumberKey, value: number) => {
      const {label, min, max, step} = LIMITS[key];
      this.usual.set(key, value);
      add(key, label, element("input", {name: key, type: "number", min, max, step, change: () => this.typed(key)}), String(value));
    };

    menu("camera", "camera", scene.cameras.map((c, i) => ({name: c.name || `camera ${i + 1}`, value: String(i)})), "0");
    menu("renderer", "renderer", scene.renderers, "whitted");
    const known = scene.accelerators.some(a => a.name === scene.accelerator);
    menu("accelerator", "accelerator", [...(known ? [] : [{name: scene.accelerator}]), ...scene.accelerators], scene.accelerator);
    this.lights.fill(scene.lights);
    this.form.append(this.lights.element);
    menu("environment", "environment", [{name: "of the scene", value: ""}, ...scene.environments], "");
    menu("layer", "layer", [{name: "colours", value: "", what: "the picture"}, ...scene.layers], "");
    menu("moving", "moving", MOVING, "steady");
    field("samples", 4);
    field("depth", scene.depth);
    field("exposure", 0);
    menu("curve", "tone curve", scene.curves.map(name => ({name})), "none");
    menu("steps", "steps of", scene.steps.split(", ").map(name => ({name})), "kay_kajiya");
    if (focus) this.fields.get(focus)?.focus();
    this.lights.comeBack(place);
    this.check();
    this.last = this.settings();
  }
  /** Shows other lights. */
  setLights(lights: LightEntry[]) {
    const place = this.lights.place();
    this.lights.fill(lights);
    this.lights.comeBack(place);
    this.last = this.settings();
  }
}
