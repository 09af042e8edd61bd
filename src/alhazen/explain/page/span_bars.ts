// The spans of the solids along the ray as bars, and their combination by the operators of a CSG solid: the table of
// Roth, span by span.

import {element, headRow, number, scrolling} from "./basics";
import type {Pair} from "./basics";
import type {Combination, Explanation, Span} from "./explanation_data";

const SIGNS = {union: "\u222a", intersection: "\u2229", difference: "\u2212"};

export function spanBars(root: HTMLElement, data: Explanation) {
  const solids = data.solids;
  if (!solids.length) {
    root.append(element("p", {}, "The eye ray enters no solid."));
    return;
  }
  const ends = solids.flatMap(s => allEnds(s.combination ?? s)).filter(isFinite);
  const lo = Math.min(...ends), hi = Math.max(...ends), room = 0.06 * (hi - lo || 1);
  const range: Pair = [Math.max(0, lo - room), hi + room];
  const rows = element("div", {class: "spans"});
  for (const solid of solids) {
    const block = element("div", {class: "solid"});
    block.append(bar(solid.name, solid.spans, range, 0, true));
    if (solid.combination) {
      const more = element("details", {open: solids.length < 4}, element("summary", {}, "how its leaves combine"));
      nodeBars(more, solid.combination, range, 0);
      block.append(more);
    }
    rows.append(block);
  }
  rows.append(axis(range));
  root.append(rows);
}
function isFinite(t: number | null): t is number {
  return t !== null;
}
function allEnds(node: Combination): (number | null)[] {
  return [...node.spans.flat(), ...(node.operands ?? []).flatMap(allEnds)];
}
const labelOf = (node: Combination) => node.operator ? `${SIGNS[node.operator]} ${node.operator}` : node.name ?? "";

function nodeBars(root: HTMLElement, node: Combination, range: Pair, depth: number) {
  root.append(bar(labelOf(node), node.spans, range, depth, !!node.operator));
  for (const operand of node.operands ?? []) nodeBars(root, operand, range, depth + 1);
  if (node.operator && node.operands && node.operands.length > 1) root.append(rothTable(node, node.operator, node.operands));
}
function bar(label: string, spans: Span[], range: Pair, depth: number, strong: boolean) {
  const at = (t: number | null) => 100 * ((t ?? range[1]) - range[0]) / (range[1] - range[0]);
  const text = spans.length ? spans.map(([a, b]) => `${number(a)} to ${number(b)}`).join(", ") : "nowhere";
  const track = element("svg:svg", {class: "track", viewBox: "0 0 100 10", preserveAspectRatio: "none", role: "img",
                                    "aria-label": `${label}: inside from ${text}`});
  track.append(element("svg:rect", {class: "line", x: 0, y: 4.7, width: 100, height: 0.6}));
  for (const [a, b] of spans) {
    track.append(element("svg:rect", {class: strong ? "in strong" : "in", x: at(a), y: 1, height: 8,
                                      width: Math.max(0.3, Math.min(100, at(b)) - at(a))}));
  }
  const name = element("span", {class: "name"}, label);
  name.style.paddingLeft = `${depth}rem`;
  return element("div", {class: spans.length ? "bar" : "bar none"}, name, track, element("span", {class: "soft number"}, text));
}
function axis(range: Pair) {
  const marks = [0, 0.25, 0.5, 0.75, 1].map(u => {
    const mark = element("span", {}, `${u === 0 ? "t = " : ""}${number(range[0] + u * (range[1] - range[0]))}`);
    return mark;
  });
  return element("div", {class: "bar axis"}, element("span"), element("div", {class: "marks soft"}, ...marks), element("span"));
}

// Each span between two changes: inside or outside each operand, and the result.
function rothTable(node: Combination, operator: keyof typeof SIGNS, operands: Combination[]) {
  const changes = [...new Set(operands.flatMap(o => o.spans.flat()).filter(isFinite))].sort((a, b) => a - b);
  const inside = (spans: Span[], a: number, b: number) =>
    spans.some(([from, to]) => (from ?? -Infinity) <= a && b <= (to ?? Infinity));
  const cell = (yes: boolean) => element("td", {class: yes ? "yes" : "no"}, yes ? "in" : "out");
  const rows = changes.slice(0, -1).map((a, i) => [a, changes[i + 1]]).map(([a, b]) => element("tr", {},
    element("th", {scope: "row"}, `${number(a)} \u2013 ${number(b)}`),
    ...operands.map(o => cell(inside(o.spans, a, b))), cell(inside(node.spans, a, b))));
  if (!rows.length) return "";
  const heads = ["stretch of t", ...operands.map((o, i) => (i ? `${SIGNS[operator]} ` : "") + labelOf(o)), "result"];
  return element("details", {class: "roth"}, element("summary", {}, `table of the ${operator}`),
    scrolling(`Table of the ${operator}`, element("table", {}, headRow(heads), element("tbody", {}, ...rows))));
}
