// Pointers, wheel and keys on the picture.

import type {Pair} from "../../../src/alhazen/explain/page/basics";
import type {ViewCamera} from "./camera";

export interface InputTarget {
  /** Moves the view, if there is one; `mark`: undo returns to the view before. */
  move(change: (camera: ViewCamera) => void, mark: boolean): void;
  undo(): void;
  explain(u: number, v: number): void;
  stop(): void;
}

const KEYS: Record<string, (camera: ViewCamera) => void> = {
  ArrowLeft: c => c.orbit(-0.1, 0), ArrowRight: c => c.orbit(0.1, 0), ArrowUp: c => c.orbit(0, 0.1),
  ArrowDown: c => c.orbit(0, -0.1), "+": c => c.zoom(0.87), "-": c => c.zoom(1 / 0.87), w: c => c.walk(0, 0, 0.07),
  s: c => c.walk(0, 0, -0.07), a: c => c.walk(-0.07, 0, 0), d: c => c.walk(0.07, 0, 0)};
const WITH_SHIFT: Record<string, (camera: ViewCamera) => void> = {
  ArrowLeft: c => c.walk(-0.07, 0, 0), ArrowRight: c => c.walk(0.07, 0, 0), ArrowUp: c => c.walk(0, 0.07, 0),
  ArrowDown: c => c.walk(0, -0.07, 0)};
const CLICK = 4;  // largest movement of a click, pixels

export function listen(image: HTMLElement, target: InputTarget) {
  const touches = new Map<number, Pair>();
  let moved = 0, spread = 0;
  image.addEventListener("pointerdown", e => {
    image.setPointerCapture(e.pointerId);
    touches.set(e.pointerId, [e.clientX, e.clientY]);
    moved = spread = 0;
  });
  image.addEventListener("pointermove", e => {
    const before = touches.get(e.pointerId);
    if (!before) return;
    const dx = e.clientX - before[0], dy = e.clientY - before[1], height = image.clientHeight;
    const still = moved < CLICK;
    moved += Math.abs(dx) + Math.abs(dy);
    touches.set(e.pointerId, [e.clientX, e.clientY]);
    if (moved < CLICK) return;
    if (touches.size === 2) {
      const [a, b] = [...touches.values()], now = Math.hypot(a[0] - b[0], a[1] - b[1]), was = spread;
      if (was) target.move(c => c.zoom(was / now), still);
      spread = now;
    } else if (e.shiftKey || e.buttons & 2) target.move(c => c.walk(-dx / height, dy / height, 0), still);
    else target.move(c => c.orbit(3 * dx / height, -3 * dy / height), still);
  });
  const up = (e: PointerEvent) => {
    if (!touches.delete(e.pointerId) || moved >= CLICK || e.type !== "pointerup") return;
    const box = image.getBoundingClientRect();
    target.explain((e.clientX - box.left) / box.width, (e.clientY - box.top) / box.height);
  };
  image.addEventListener("pointerup", up);
  image.addEventListener("pointercancel", up);
  image.addEventListener("contextmenu", e => e.preventDefault());
  image.addEventListener("wheel", e => {
    e.preventDefault();
    target.move(c => c.zoom(Math.exp(0.0012 * e.deltaY)), true);
  }, {passive: false});
  image.addEventListener("keydown", e => {
    if (e.key === "Enter") return target.explain(0.5, 0.5);
    const held = e.ctrlKey || e.metaKey;
    const key = e.key.length === 1 ? e.key.toLowerCase() : e.key;  // letters regardless of Caps Lock
    const change = (e.shiftKey ? WITH_SHIFT[key] : undefined) ?? KEYS[key];
    if (!change || held || e.altKey) return;
    e.preventDefault();
    target.move(change, true);
  });
}

/** Keys of the whole page, except in a field whose text is being changed. */
export function listenAnywhere(target: InputTarget) {
  let typed: EventTarget | null = null;
  document.addEventListener("input", e => typed = e.target);
  for (const end of ["change", "focusout"]) document.addEventListener(end, () => typed = null);
  document.addEventListener("keydown", e => {
    if (typed !== null && typed === e.target) return;
    if (e.key === "Escape") return target.stop();
    if (e.key.toLowerCase() !== "z" || !(e.ctrlKey || e.metaKey) || e.shiftKey || e.altKey) return;
    e.preventDefault();  // the browser's own undo of texts
    target.undo();
  });
}
