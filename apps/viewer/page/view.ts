// The page of `alhazen view`.

import {Viewer} from "./viewer";

declare global {
  var viewer: Viewer;
}
globalThis.viewer = new Viewer();
