// The lights of the scene, which can be turned off, moved and given another colour.

import {element} from "../../../src/alhazen/explain/page/basics";
import type {Vec3} from "../../../src/alhazen/explain/page/basics";
import {chosenSizes, LightFields} from "./light_fields";
import type {LightValues} from "./light_fields";
import type {LightChange, LightEntry} from "./state";

/** All changes relative to the file, including those of lights that the scene no longer has. */
export interface LightState {
  dark: Set<string>;
  values: Map<string, LightValues>;
}
export interface LightListener {
  /** `mark`: undo returns to the state before; `which`: lights switched or changed. */
  changed(which: "lights" | "light", mark: boolean): void;
  /** The blocks of these lights for the scene file. */
  blocks(changes: LightChange[]): Promise<string>;
}

export class LightList {
  private readonly summary = element("summary", {"data-key": "summary"});
  private readonly list = element("div", {class: "lights"});
  private readonly block = element("textarea", {id: "light-blocks", rows: 6, readonly: true, hidden: true, "data-key": "text",
                                                "aria-label": "Blocks of the changed lights"});
  private readonly blockButton = element("button", {type: "button", "aria-expanded": "false", "aria-controls": "light-blocks",
                                                    "data-key": "blocks", click: () => this.toggleBlocks()}, "Light blocks");
  private readonly buttons = element("div", {class: "row"}, this.all("All on", true), this.all("All off", false), this.blockButton);
  readonly element = element("details", {id: "lights"}, this.summary, this.list, this.buttons, this.block);
  private dark = new Set<string>();  // names of lights that are off
  private values = new Map<string, LightValues>();
  private readonly open = new Set<string>();  // names of lights whose fields are shown
  private lights: LightEntry[] = [];
  private boxes: HTMLInputElement[] = [];
  private readonly fields = new Map<string, LightFields>();  // of the open lights only: there may be many

  constructor(private readonly listener: LightListener) {}

  /** Names of the lights that are off. */
  off() {
    return this.boxes.filter(b => !b.checked).map(b => b.name);
  }
  /** The lights that differ from the file. `placed`: with the places of those that have not moved. */
  changes(placed = false): LightChange[] {
    return this.lights.flatMap(light => {
      const values = this.values.get(light.name);
      if (!values) return [];
      const {color, times} = values, sizes = chosenSizes(light, values);
      const position = values.position ?? (placed ? light.position : undefined);
      const direction = values.direction ?? (placed ? light.direction : undefined);
      return [{name: light.name, ...(light.position && position ? {position} : {}),
               ...(light.direction && direction ? {direction} : {}),
               ...(sizes?.length ? {sizes: sizes.map(s => s.value)} : {}),
               color: color.map(c => c * times) as Vec3}];
    });
  }
  state(): LightState {
    return {dark: new Set(this.dark), values: new Map(this.values)};
  }
  restore({dark, values}: LightState) {
    this.dark = new Set(dark);
    this.values = new Map(values);
    for (const box of this.boxes) box.checked = !this.dark.has(box.name);
    for (const [name, fields] of this.fields) fields.show(this.values.get(name));
    this.tell();
  }
  /** The focus and the scroll position of the list, to restore them. */
  place() {
    const active = document.activeElement;
    const key = active instanceof HTMLElement && this.element.contains(active) ? active.dataset.key : undefined;
    return {key, top: this.list.scrollTop};
  }
  comeBack({key, top}: {key?: string; top: number}) {
    this.list.scrollTop = top;
    if (key === undefined) return;
    const all = [...this.element.querySelectorAll<HTMLElement>("[data-key]")];
    (all.find(e => e.dataset.key === key) ?? this.summary).focus({preventScroll: true});
  }
  /** Keeps choices that still exist. */
  fill(lights: LightEntry[]) {
    this.lights = lights;
    this.boxes = lights.map(light => element("input", {type: "checkbox", name: light.name, checked: !this.dark.has(light.name),
                                                      "data-key": `on ${light.name}`, change: () => this.turned()}));
    this.fields.clear();
    this.list.replaceChildren(...lights.flatMap((light, i) => this.row(light, i)));
    this.element.hidden = lights.length === 0;
    this.tell();
  }
  private row(light: LightEntry, i: number) {
    const name = light.name, id = `light-${i}`;
    const button = element("button", {
      type: "button", class: "link", "aria-expanded": String(this.open.has(name)), "aria-controls": id,
      "aria-label": `Change ${name}`, "data-key": `change ${name}`, click: () => {
        const shown = !this.open.delete(name);
        if (shown) {
          this.open.add(name);
          row.after(this.fieldsOf(light, id));
        } else {
          this.fields.get(name)?.element.remove();
          this.fields.delete(name);
        }
        button.setAttribute("aria-expanded", String(shown));
      }}, "Change");
    const label = element("label", {title: light.what ?? ""}, this.boxes[i], element("span", {}, name));
    const row = element("div", {class: "light"}, label, button);
    return this.open.has(name) ? [row, this.fieldsOf(light, id)] : [row];
  }
  private fieldsOf(light: LightEntry, id: string) {
    const fields = new LightFields(light, id, (values, mark) => this.edited(light, values, mark));
    fields.show(this.values.get(light.name));
    this.fields.set(light.name, fields);
    return fields.element;
  }
  private all(text: string, on: boolean) {
    return element("button", {type: "button", "data-key": text, click: () => {
      for (const box of this.boxes) box.checked = on;
      this.turned();
    }}, text);
  }
  private turned() {
    for (const box of this.boxes) {
      if (box.checked) this.dark.delete(box.name);
      else this.dark.add(box.name);
    }
    this.tell();
    this.listener.changed("lights", true);
  }
  // A headlight that has only another colour still goes with the view.
  private edited(light: LightEntry, values: LightValues | undefined, mark: boolean) {
    const moved = (key: "position" | "direction") => values?.[key]?.some((x, i) => x !== light[key]?.[i]) ? values[key] : undefined;
    if (values) this.values.set(light.name, {...values, position: moved("position"), direction: moved("direction")});
    else this.values.delete(light.name);
    this.tell();
    this.listener.changed("light", mark);
  }
  private toggleBlocks() {
    this.block.hidden = !this.block.hidden;
    this.blockButton.setAttribute("aria-expanded", String(!this.block.hidden));
    this.tell();
  }
  // Updates the summary, and the blocks if they are shown.
  private tell() {
    const on = this.boxes.filter(b => b.checked).length, changes = this.changes();
    const changed = changes.length ? `, ${changes.length} changed` : "";
    this.summary.textContent = `lights: ${on === this.boxes.length ? "all" : on} of ${this.boxes.length} on${changed}`;
    this.buttons.children[0].toggleAttribute("hidden", this.boxes.length < 2);
    this.buttons.children[1].toggleAttribute("hidden", this.boxes.length < 2);
    if (this.block.hidden) return;
    if (!changes.length) this.block.value = "// No light differs from the file.\n";
    else void this.listener.blocks(this.changes(true)).then(text => this.block.value = text);
  }
}
