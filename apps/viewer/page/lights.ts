// The lights of the scene, each of which can be turned off.

import {element} from "../../../src/alhazen/explain/page/basics";
import type {Choice} from "./state";

export class LightList {
  private readonly summary = element("summary");
  private readonly list = element("div", {class: "lights"});
  readonly element = element("details", {id: "lights"}, this.summary, this.list);
  private readonly dark = new Set<string>();  // names; of lights that the scene no longer has, too
  private boxes: HTMLInputElement[] = [];

  constructor(private readonly changed: () => void) {}

  /** Names of those that are off. */
  off() {
    return this.boxes.filter(b => !b.checked).map(b => b.name);
  }
  setOff(names: string[]) {
    this.dark.clear();
    for (const name of names) this.dark.add(name);
    for (const box of this.boxes) box.checked = !this.dark.has(box.name);
    this.count();
  }
  focused() {
    return this.boxes.find(b => b === document.activeElement)?.name;
  }
  focus(name: string) {
    this.boxes.find(b => b.name === name)?.focus();
  }
  /** What was turned off stays off where it still is. */
  fill(lights: Choice[]) {
    this.boxes = lights.map(light => element("input", {type: "checkbox", name: light.name, checked: !this.dark.has(light.name),
                                                      change: () => this.turned()}));
    const all = (text: string, on: boolean) => element("button", {type: "button", click: () => {
      for (const box of this.boxes) box.checked = on;
      this.turned();
    }}, text);
    this.list.replaceChildren(
      ...lights.map((light, i) => element("label", {title: light.what ?? ""}, this.boxes[i], element("span", {}, light.name))),
      ...(lights.length > 1 ? [element("div", {class: "row"}, all("All on", true), all("All off", false))] : []));
    this.element.hidden = lights.length === 0;
    this.count();
  }
  private turned() {
    for (const box of this.boxes) {
      if (box.checked) this.dark.delete(box.name);
      else this.dark.add(box.name);
    }
    this.count();
    this.changed();
  }
  private count() {
    const on = this.boxes.filter(b => b.checked).length;
    this.summary.textContent = `lights: ${on === this.boxes.length ? "all" : on} of ${this.boxes.length} on`;
  }
}
