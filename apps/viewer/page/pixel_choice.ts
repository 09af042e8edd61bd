// The explained pixel as numbers, to choose any pixel without a mouse.

import {element} from "../../../src/alhazen/explain/page/basics";

export class PixelChoice {
  private readonly column = this.field("Column of the pixel, from the left");
  private readonly row = this.field("Row of the pixel, from the top");
  readonly element: HTMLElement;
  private width = 0;
  private height = 0;

  constructor(explain: (x: number, y: number) => void) {
    this.element = element("form", {class: "row pixel-choice", "aria-label": "Pixel", submit: e => {
      e.preventDefault();
      explain(this.column.valueAsNumber, this.row.valueAsNumber);
    }}, element("span", {"aria-hidden": "true"}, "pixel"), this.column, this.row, element("button", {}, "Explain"));
  }
  /** For a picture of another size, chooses the pixel in the middle. */
  fit(width: number, height: number) {
    if (width === this.width && height === this.height) return;
    [this.width, this.height] = [width, height];
    this.column.max = String(width - 1);
    this.row.max = String(height - 1);
    this.show(width >> 1, height >> 1);
  }
  show(x: number, y: number) {
    this.column.value = String(x);
    this.row.value = String(y);
  }
  private field(label: string) {
    return element("input", {type: "number", min: 0, required: true, "aria-label": label});
  }
}
