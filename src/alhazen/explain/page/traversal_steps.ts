// The steps of an accelerator, one by one, and its work beside that of others.

import {element, headRow, number, scrolling} from "./basics";
import type {AcceleratorWork, Traversal, TraversalStep} from "./explanation_data";
import type {SceneView} from "./scene_view";

export class TraversalSteps {
  private readonly steps: TraversalStep[];
  private readonly range: HTMLInputElement;
  private readonly text: HTMLOutputElement;
  private readonly playButton: HTMLButtonElement;
  private readonly items: HTMLElement[];
  private timer: number | undefined;

  constructor(root: HTMLElement, traversal: Traversal, private readonly view: SceneView) {
    const {steps, accelerator, work} = traversal;
    this.steps = steps;
    this.range = element("input", {type: "range", min: 0, max: steps.length, value: 0, "aria-label": "Step", input: () => this.show()});
    this.text = element("output", {class: "step", "aria-live": "polite"});
    const move = (by: number) => () => { this.range.value = String(Number(this.range.value) + by); this.show(); };
    const play = element("button", {type: "button", click: () => this.play()}, "Play");
    this.playButton = play;
    root.append(
      element("p", {}, `Steps of `, element("b", {}, accelerator), ` for the eye ray, in their order; drawn in space above.`),
      element("div", {class: "stepper"},
        element("button", {type: "button", "aria-label": "One step back", click: move(-1)}, "\u25c0"),
        element("button", {type: "button", "aria-label": "One step on", click: move(1)}, "\u25b6"), play, this.range),
      this.text);
    const tested = element("ol", {class: "candidates"});
    this.items = steps.map((s, i) => element("li", {class: s.kind}, element("button", {type: "button", class: "link",
      click: () => { this.range.value = String(i + 1); this.show(); }}, this.describe(s))));
    tested.append(...this.items);
    root.append(element("details", {}, element("summary", {}, `all ${steps.length} steps`), tested),
      traversal.left_out ? element("p", {class: "cut"}, `The steps are cut: ${traversal.left_out} more are not shown.`) : "", this.table(work));
    this.show();
  }
  private describe(s: TraversalStep) {
    if (s.kind === "cell") return `cell ${s.number} entered`;
    if (s.kind === "bound") return `bound of node ${s.number}: ${s.met ? "met" : "missed"}`;
    if (s.kind === "beam") return "region swept by the class of the ray";
    return `\u2018${s.object}\u2019 tested: ${s.met ? "hit" : "no hit"}`;
  }
  private show() {
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
  private play() {
    if (this.timer !== undefined) return this.stop();
    if (Number(this.range.value) >= this.steps.length) this.range.value = "0";
    this.playButton.textContent = "Stop";
    this.text.ariaLive = "off";  // screen readers announce the last step
    this.timer = setInterval(() => {
      this.range.value = String(Number(this.range.value) + 1);
      this.show();
      if (Number(this.range.value) >= this.steps.length) this.stop();
    }, Math.max(40, Math.min(600, 8000 / (this.steps.length || 1))));
  }
  private stop() {
    clearInterval(this.timer);
    this.timer = undefined;
    this.text.ariaLive = "polite";
    this.show();
    this.playButton.textContent = "Play";
  }
  private table(work: AcceleratorWork[]) {
    const columns = ["node_visits", "empty_cells", "box_tests", "primitive_tests", "mailbox_saved"] as const;
    const heads = ["accelerator", "nodes or cells", "empty cells", "bounds tested", "primitives tested", "saved by mailbox", "t of the hit"];
    return scrolling("Work of accelerators", element("table", {},
      element("caption", {}, "Work for this ray"), headRow(heads),
      element("tbody", {}, ...work.map(w => element("tr", {}, element("th", {scope: "row"}, w.accelerator),
        ...(w.unavailable ? [element("td", {colspan: 6}, w.unavailable)]
                          : [...columns.map(c => element("td", {}, String(w[c]))), element("td", {}, number(w.t))]))))));
  }
}
