// The fields of a light: position, direction, colour, sizes.

import {element} from "../../../src/alhazen/explain/page/basics";
import type {Vec3} from "../../../src/alhazen/explain/page/basics";
import type {LightEntry} from "./state";

type LightSize = NonNullable<LightEntry["sizes"]>[number];
/** Changed fields of a light; its colour is `times` `color`. */
export interface LightValues {
  position?: Vec3;
  direction?: Vec3;
  color: Vec3;
  times: number;
  sizes: LightSize[];
}
type VectorKey = "position" | "direction" | "color";
const AXES: Record<VectorKey, string[]> = {
  position: ["x", "y", "z"], direction: ["x", "y", "z"], color: ["red", "green", "blue"]};
const LABELS: Record<VectorKey, string> = {position: "position", direction: "direction", color: "colour"};
const MOST = 1e15;

/** The chosen sizes; undefined if the light has other sizes now, as its kind in the file changed. */
export function chosenSizes(light: LightEntry, values: LightValues | undefined) {
  const own = light.sizes ?? [], chosen = values?.sizes;
  return chosen?.length === own.length && chosen.every((s, i) => s.name === own[i].name) ? chosen : undefined;
}
function capital(text: string) {
  return text[0].toUpperCase() + text.slice(1);
}

export class LightFields {
  readonly element: HTMLElement;
  private values: LightValues;
  private readonly vectors: {key: VectorKey; fields: HTMLInputElement[]}[];
  private readonly times: HTMLInputElement;
  private readonly sizes: HTMLInputElement[];
  private readonly reset: HTMLButtonElement;
  private marked = false;  // since a field got the focus

  /** `changed` has no values if they are those of the file. */
  constructor(readonly light: LightEntry, id: string,
              private readonly changed: (values: LightValues | undefined, mark: boolean) => void) {
    this.values = this.ofFile();
    const keys = (["position", "direction", "color"] as const).filter(key => light[key]);
    this.vectors = keys.map(key => ({key, fields: AXES[key].map((axis, i) =>
      this.field(`${axis} of the ${LABELS[key]} of ${light.name}`, `${key} ${i}`))}));
    this.sizes = (light.sizes ?? []).map(size => this.field(`${capital(size.name)} of ${light.name}`, size.name));
    this.times = this.field(`Strength of ${light.name}, times its colour`, "times");
    this.reset = element("button", {type: "button", class: "link", "data-key": `reset ${light.name}`, click: () => {
      this.values = this.ofFile();
      this.show(undefined);
      this.changed(undefined, true);
    }}, "As in the file");
    const line = (label: string, ...fields: HTMLElement[]) =>
      element("div", {class: "numbers"}, element("span", {"aria-hidden": "true"}, label), ...fields);
    this.element = element("fieldset", {id}, element("legend", {}, `${light.name}: ${light.what ?? "light"}`),
      ...this.vectors.map(v => line(LABELS[v.key], ...v.fields)),
      ...this.sizes.map((field, i) => line(light.sizes![i].name, field)), line("strength", this.times, this.reset));
    this.show(undefined);
  }
  /** Undefined: those of the file. */
  show(values: LightValues | undefined) {
    const file = this.ofFile();
    // The light in the file may have another kind by now.
    this.values = {position: values?.position ?? file.position, direction: values?.direction ?? file.direction,
                   color: values?.color ?? file.color, times: values?.times ?? 1,
                   sizes: chosenSizes(this.light, values) ?? file.sizes};
    for (const {key, fields} of this.vectors) {
      fields.forEach((field, i) => this.set(field, this.values[key]![i]));
    }
    this.set(this.times, this.values.times);
    this.sizes.forEach((field, i) => this.set(field, this.values.sizes[i].value));
    this.reset.disabled = values === undefined;
  }

  private ofFile(): LightValues {
    const {position, direction, color, sizes} = this.light;
    return {position, direction, color, times: 1, sizes: sizes ?? []};
  }
  private set(field: HTMLInputElement, x: number) {
    field.removeAttribute("aria-invalid");
    // Text being typed is not changed.
    if (field === document.activeElement && Number(field.value) === x && field.value) return;
    field.value = String(Number(x.toPrecision(7)));
  }
  private field(label: string, key: string) {
    const field = element("input", {
      type: "number", step: "any", "aria-label": label, "data-key": `${this.light.name} ${key}`,
      focus: () => this.marked = false, input: () => this.typed(field),
      change: () => {
        this.marked = false;
        // Invalid input is reset.
        this.show(this.isOfFile() ? undefined : this.values);
      }});
    return field;
  }
  private typed(field: HTMLInputElement) {
    const x = Number(field.value), values = {...this.values};
    let good = field.value !== "" && Number.isFinite(x) && Math.abs(x) <= MOST;
    if (field === this.times) {
      good &&= x >= 0;
      values.times = x;
    }
    const size = this.sizes.indexOf(field);
    if (size >= 0) {
      values.sizes = values.sizes.map((old, i) => i === size ? {...old, value: x} : old);
      good &&= this.areSizes(values.sizes);
    }
    for (const {key, fields} of this.vectors) {
      const i = fields.indexOf(field);
      if (i < 0) continue;
      const vector = [...this.values[key]!] as Vec3;
      vector[i] = x;
      values[key] = vector;
      good &&= key === "color" ? x >= 0 : key !== "direction" || vector.some(c => c !== 0);
    }
    if (good) field.removeAttribute("aria-invalid");
    else field.setAttribute("aria-invalid", "true");
    if (!good) return;
    this.values = values;
    this.reset.disabled = this.isOfFile();
    const mark = !this.marked;
    this.marked = true;
    this.changed(this.isOfFile() ? undefined : values, mark);
  }
  // Positive, and a hole smaller than its surroundings.
  private areSizes(sizes: LightSize[]) {
    const radius = sizes.find(s => s.name === "radius")?.value ?? 0;
    return sizes.every(({name, value}) => name === "inner radius" ? value >= 0 && value < radius : value > 0);
  }
  private isOfFile() {
    const file = this.ofFile();
    return this.values.times === 1 && this.values.sizes.every((s, i) => s.value === file.sizes[i].value) && this.vectors.every(({key}) => this.values[key]!.every((x, i) => x === file[key]![i]));
  }
}
