// The page of `alhazen explain`: shows the data that the page contains.

import type {Explanation} from "./explanation_data";
import {showExplanation} from "./explanation_view";

const textOf = (id: string) => document.getElementById(id)?.textContent ?? "null";
const root = document.getElementById("explanation");
if (root) showExplanation(root, JSON.parse(textOf("data")) as Explanation, JSON.parse(textOf("preview")) as string | null);
