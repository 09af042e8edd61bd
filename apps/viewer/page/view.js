// The viewer: a picture that refines while nothing moves. Joined behind the files of the explanation's page.

// The camera: where it is, the frame it looks along, and what it turns around.
class ViewCamera {
  constructor(given, up) {
    Object.assign(this, {eye: given.eye, look: given.look, right: given.right, up: given.up, parallel: given.parallel});
    this.aspect = norm(given.right) / norm(given.up);
    this.world = up === "z" ? [0, 0, 1] : [0, 1, 0];
    this.distance = given.distance ?? 0;
  }
  copy() {
    return Object.assign(Object.create(ViewCamera.prototype), this);
  }
  turn(axis, angle) {
    const c = Math.cos(angle), s = Math.sin(angle), k = unit(axis);
    const by = v => add(add(scaled(c, v), scaled(s, cross(k, v))), scaled((1 - c) * dot(k, v), k));
    for (const key of ["look", "right", "up"]) this[key] = by(this[key]);
  }
  // Around the point at `distance`; the pole is not crossed.
  orbit(dx, dy) {
    const center = add(this.eye, scaled(this.distance, unit(this.look)));
    this.turn(this.world, -dx);
    const rise = Math.asin(Math.max(-1, Math.min(1, dot(unit(this.look), this.world))));
    const to = Math.max(-1.5, Math.min(1.5, rise - dy));
    this.turn(this.right, to - rise);
    this.eye = sub(center, scaled(this.distance, unit(this.look)));
  }
  walk(right, up, forward) {
    const by = add(add(scaled(right, unit(this.right)), scaled(up, unit(this.up))), scaled(forward, unit(this.look)));
    this.eye = add(this.eye, scaled(this.distance, by));
  }
  zoom(factor) {
    if (this.parallel) {
      this.right = scaled(factor, this.right);
      this.up = scaled(factor, this.up);
    } else this.eye = add(this.eye, scaled(this.distance * (1 - factor), unit(this.look)));
    this.distance *= factor;
  }
  block() {
    const v = a => `(${a.map(x => String(Number(x.toPrecision(9)))).join(", ")})`;
    const size = this.parallel ? `height = ${Number(norm(this.up).toPrecision(9))}`
      : `fov_deg = ${Number((2 * Math.atan2(norm(this.up) / 2, norm(this.look)) * 180 / Math.PI).toPrecision(9))}`;
    return `${this.parallel ? "orthographic" : "perspective"}_camera "view" {\n    eye = ${v(this.eye)}\n    look_at = ` +
           `${v(add(this.eye, scaled(this.distance || 1, unit(this.look))))}\n    up = ${v(unit(this.up))}\n    ${size}\n}\n`;
  }
}

class Viewer {
  constructor() {
    this.token = location.hash.slice(1) || sessionStorage.getItem("token") || "";
    if (location.hash) {
      sessionStorage.setItem("token", this.token);
      history.replaceState(null, "", location.pathname);
    }
    // What one page asks for ends what it asked for before; other pages are left alone.
    this.client = Math.random().toString(36).slice(2);
    this.level = this.generation = this.chain = this.frames = 0;
    this.undo = [];
    this.problems = {};
    this.build();
    this.poll();
  }
  async ask(path, wish = {}) {
    return fetch(path, {method: "POST", body: JSON.stringify({...wish, client: this.client}),
                        headers: {Authorization: `Bearer ${this.token}`}});
  }
  // One message of each kind; an empty one takes it back.
  say(kind, text) {
    this.problems[kind] = text;
    const place = document.getElementById("message"), all = Object.values(this.problems).filter(t => t).join("\n");
    place.hidden = !all;
    if (place.textContent !== all) place.textContent = all;
  }

  build() {
    this.image = element("img", {class: "picture", tabindex: "0", alt: "The scene. Drag or arrow keys turn, shift moves, " +
      "wheel or plus and minus zoom, W A S D walk, a click or Enter explains a pixel, Escape ends what is computed.",
      draggable: "false"});
    this.scale = element("div", {class: "scale", hidden: true});
    this.controls = element("form", {class: "controls", submit: e => e.preventDefault()});
    this.status = element("p", {id: "status", "aria-live": "off"});
    const block = element("textarea", {id: "block", rows: 6, readonly: true, "aria-label": "Camera of the view", hidden: true});
    const button = (text, click) => element("button", {type: "button", click}, text);
    this.buttons = element("div", {class: "row"},
      button("Undo", () => this.back()), button("Home", () => this.goHome()), button("Stop", () => this.stop()),
      button("Camera block", () => {
        block.value = this.camera.block();
        block.hidden = !block.hidden;
      }),
      button("Save picture", () => this.save()));
    document.getElementById("viewer").append(element("div", {}, this.image, this.scale, this.status),
      element("section", {"aria-label": "Settings"}, this.controls, this.buttons, block));
    this.listen();
  }
  // Menus of what the program says that there is. What was chosen stays where it still is.
  fill(state) {
    const chosen = Object.fromEntries([...this.controls.elements].map(e => [e.name, e.value]));
    const focus = this.controls.contains(document.activeElement) ? document.activeElement.name : "";
    const menu = (key, label, entries, value) => {
      const select = element("select", {name: key, change: () => this.changed()}, ...entries.map(e =>
        element("option", {value: e.value ?? e.name, title: e.what}, e.name)));
      const has = v => entries.some(e => (e.value ?? e.name) === v);
      select.value = has(chosen[key]) ? chosen[key] : has(value) ? value : entries[0]?.value ?? entries[0]?.name;
      this[key] = select;
      return element("label", {}, label, select);
    };
    const field = (key, label, value, min, max, step = 1) => {
      const input = element("input", {name: key, type: "number", min, max, step, value: chosen[key] ?? value,
                                      change: () => this.changed()});
      this[key] = input;
      return element("label", {}, label, input);
    };
    const cameras = state.cameras.map((c, i) => ({name: c.name || `camera ${i + 1}`, value: String(i)}));
    this.controls.replaceChildren(
      menu("cameraMenu", "camera", cameras, "0"), menu("renderer", "renderer", state.renderers, "whitted"),
      menu("accelerator", "accelerator", state.accelerators, state.accelerator),
      menu("layer", "layer", [{name: "colours", value: "", what: "the picture"}, ...state.layers], ""),
      menu("moving", "moving", [{name: "coarser", what: "the same renderer, as many pixels as 40 ms allow"},
        {name: "selected", what: "the same renderer at half the width: rays for some pixels, shades between them where they " +
          "agree, as deep as 50 ms allow"},
        {name: "flat", what: "ray_casting at half the width: no shadows, mirrors, glass"}], "coarser"),
      field("samples", "samples", 4, 1, 1024), field("depth", "depth", state.depth, 0, 100),
      field("exposure", "exposure", 0, -16, 16, 0.5),
      menu("curve", "tone curve", state.curves.map(c => ({name: c})), "none"),
      menu("steps", "steps of", state.steps.split(", ").map(s => ({name: s})), "kay_kajiya"));
    this.cameraMenu.addEventListener("change", () => {
      this.remember();
      this.take(this.scene.cameras[Number(this.cameraMenu.value)]);
    });
    if (focus) this[focus].focus();
  }
  // The file has changed: the chosen camera by its name, and the view where it still was that camera's.
  refill(before, state) {
    const old = before.cameras[Number(this.cameraMenu.value)];
    const same = state.cameras.findIndex(c => c.name === old.name);
    const index = same >= 0 ? same : Math.min(Number(this.cameraMenu.value), state.cameras.length - 1);
    const depth = Number(this.depth.value) === before.depth;
    this.fill(state);
    if (depth) this.depth.value = String(state.depth);
    this.cameraMenu.value = String(index);
    if (["eye", "look", "right", "up"].every(k => norm(sub(this.camera[k], old[k])) === 0)) this.take(state.cameras[index]);
  }
  take(camera) {
    this.camera = new ViewCamera(camera, this.scene.up);
    if (!this.camera.distance) this.camera.distance = 0.5 * norm(this.camera.eye) + 1;
    this.changed();
  }
  goHome() {
    this.remember();
    this.take(this.scene.cameras[Number(this.cameraMenu.value)]);
  }

  // What the server knows: at the start, and when the file changes.
  async poll() {
    try {
      const answer = await this.ask("/state");
      if (answer.status === 401) {
        this.say("server", "This page has no key to the server: open the address that `alhazen view` printed.");
        return;
      }
      const state = await answer.json(), known = this.scene;
      this.memory = state.memory;
      this.say("server", "");
      this.say("file", state.error);
      this.scene = state;
      if (!known) {
        document.title = `${state.scene} \u2013 Alhazen`;
        this.fill(state);
        this.take(state.cameras[0]);
      } else if (known.version !== state.version) {
        this.refill(known, state);
        this.changed();
      } else if (this.lost) this.changed();
      this.lost = false;
    } catch {
      this.lost = true;
      this.say("server", "The server does not answer: waiting for it.");
    }
    setTimeout(() => this.poll(), 500);
  }

  wish(camera, width) {
    const height = Math.max(1, Math.round(width / camera.aspect));
    const {eye, look, right, up, parallel} = camera;
    return {camera: {eye, look, right, up, parallel}, width, height, renderer: this.renderer.value,
            accelerator: this.accelerator.value, layer: this.layer.value, depth: Number(this.depth.value),
            exposure: Number(this.exposure.value), curve: this.curve.value};
  }
  full() {
    return Math.max(64, Math.min(this.scene.width, 4096));
  }
  // As wide as 40 ms allow, by the last frame; an eighth where nothing is known, half of the picture at most.
  coarse() {
    const full = this.full();
    if (this.flat() || this.selects()) return full / 2;
    if (!this.perPixel) return full / 8;
    return Math.min(full / 2, Math.max(64, Math.sqrt(0.04 / this.perPixel * this.camera.aspect)));
  }
  // The view is another one: coarse at first, and finer with each frame.
  changed() {
    if (!this.camera || !this.scene) return;
    ++this.generation;
    this.level = 0;
    if (this.explaining) this.explaining = this.held = undefined;  // the server ends it
    // While the view moves, one small frame at a time: the next has the newest camera.
    if (!this.small) this.refine();
  }
  flat() {
    return this.moving.value === "flat" && !this.layer.value && this.scene.renderers.some(r => r.name === "ray_casting");
  }
  // Only renderers that answer single rays can.
  selects() {
    return this.moving.value === "selected" && !this.layer.value &&
      this.scene.renderers.some(r => r.name === this.renderer.value && r.selects);
  }
  // As deep as the last frame that moved allows, beginning with eye rays and their shadows.
  movingDepth(seconds) {
    const depth = this.deep ?? 0;
    if (seconds !== undefined) this.deep = seconds > 0.05 ? Math.max(0, depth - 1) : seconds < 0.025 ? depth + 1 : depth;
    return Math.min(this.deep ?? 0, Number(this.depth.value));
  }
  // [width as a part of the whole, samples]
  levels() {
    const samples = Number(this.samples.value);
    return [[1 / 4, 1], [1 / 2, 1], [1, 1], ...(samples > 1 ? [[1, samples]] : [])];
  }
  done() {
    return this.level >= this.levels().length;
  }
  async refine() {
    const chain = ++this.chain;
    while (chain === this.chain && !this.held && !this.done()) {
      const generation = this.generation;
      this.small = this.level === 0;
      const outcome = await this.frame(...this.levels()[this.level], generation).catch(() => "lost");
      if (chain === this.chain) this.small = false;
      if (outcome === "lost") return;  // poll begins again
      if (outcome === "ended") await new Promise(go => setTimeout(go, 50));  // by an explanation, say: once more
      else if (generation === this.generation) this.level = outcome === "shown" ? this.level + 1 : this.levels().length;
    }
  }
  // Nothing is refined until the work is done.
  async hold(work) {
    const own = this.held = {};
    await work();
    if (this.held !== own) return;
    this.held = undefined;
    this.refine();
  }
  async frame(scale, samples, generation) {
    const first = this.level === 0, flat = first && this.flat(), selects = first && this.selects(), begin = performance.now();
    const width = Math.round(first ? this.coarse() : this.full() * scale), wish = this.wish(this.camera, width);
    const answer = await this.ask("/frame", {...wish, samples, ...(flat ? {renderer: "ray_casting"} : {}),
      ...(selects ? {selected: true, depth: this.movingDepth()} : {})});
    if (answer.status === 204) return "ended";
    if (!answer.ok) {
      this.say("frame", (await answer.json()).error);
      return "refused";
    }
    const facts = JSON.parse(answer.headers.get("X-Alhazen")), blob = await answer.blob();
    this.say("frame", "");
    if (generation >= (this.shownGeneration ?? 0)) this.show(blob, generation, facts, width, begin, samples);
    if (selects) this.movingDepth(facts.seconds);
    else if (samples === 1 && !flat) this.perPixel = facts.seconds / (width * width / this.camera.aspect);
    return "shown";
  }
  show(blob, generation, facts, width, begin, samples) {
    const url = URL.createObjectURL(blob), old = this.image.src, now = performance.now();
    this.shownGeneration = generation;
    this.image.src = url;
    if (old.startsWith("blob:")) URL.revokeObjectURL(old);
    this.image.style.maxWidth = `calc(82vh * ${this.camera.aspect})`;
    this.image.width = this.full();
    this.image.height = Math.round(this.full() / this.camera.aspect);
    ++this.frames;
    const rate = this.small && now - (this.shownAt ?? 0) < 500 ? `${(1000 / (now - this.shownAt)).toFixed(0)} frames/s \u00b7 ` : "";
    this.shownAt = now;
    this.drawScale(facts.layer);
    this.status.textContent = `${width} wide, ${samples} sample${samples > 1 ? "s" : ""} a pixel \u00b7 ${rate}` +
      `${(1000 * facts.seconds).toFixed(1)} ms, ${(now - begin).toFixed(0)} ms with the way here \u00b7 ` +
      `${(facts.rays / facts.seconds / 1e6).toFixed(2)} M rays/s on ${facts.threads} threads \u00b7 ` +
      `${(this.memory / 1048576).toFixed(0)} MiB`;
  }
  // What the colours of a layer mean.
  drawScale(layer) {
    this.scale.hidden = !layer;
    if (!layer) return;
    const marks = layer.colors ? [layer.low, (layer.low + layer.high) / 2, layer.high] : [];
    const bar = element("div", {class: "bar-of-scale", "aria-hidden": "true"});
    if (layer.colors) bar.style.background = `linear-gradient(90deg, ${this.scene.scales[layer.colors].join(", ")})`;
    this.scale.replaceChildren(element("b", {}, layer.name), layer.colors ? "" : `: ${layer.meaning}`,
      ...(layer.colors ? [bar, element("div", {class: "marks"}, ...marks.map(m => element("span", {}, number(m))))] : []));
  }
  async save() {
    let answer;
    await this.hold(async () => {
      answer = await this.ask("/frame", {...this.wish(this.camera, this.full()), samples: Number(this.samples.value), png: true});
      if (answer.status !== 200) return;
      const link = element("a", {href: URL.createObjectURL(await answer.blob()), download: "view.png"});
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    });
  }
  // Ends the frame or the explanation in hand; what is shown stays.
  stop() {
    this.explaining = undefined;
    this.held = undefined;
    ++this.chain;
    this.small = false;
    this.ask("/stop").catch(() => {});
    this.say("explain", "");
  }
  remember() {
    this.undo.push(this.camera.copy());
    if (this.undo.length > 100) this.undo.shift();
  }
  back() {
    const camera = this.undo.pop();
    if (!camera) return;
    this.camera = camera;
    this.changed();
  }

  async explain(u, v) {
    const width = this.full(), wish = this.wish(this.camera, width), own = this.explaining = {};
    const at = (w, n) => Math.min(n - 1, Math.max(0, Math.floor(w * n)));
    this.status.textContent = "Explaining \u2026 (Escape ends it)";
    await this.hold(async () => {
      const answer = await this.ask("/explain", {...wish, samples: 1, x: at(u, width), y: at(v, wish.height), steps: this.steps.value})
        .catch(() => null);
      if (this.explaining !== own) return;
      this.explaining = undefined;
      if (!answer || answer.status === 204) return;
      const data = await answer.json();
      this.say("explain", answer.ok ? "" : data.error);
      if (!answer.ok) return;
      const root = document.getElementById("explanation");
      showExplanation(root, data, this.image.src);
      root.scrollIntoView({behavior: "smooth"});
      root.focus({preventScroll: true});
    });
  }

  listen() {
    const image = this.image, touches = new Map();
    let moved = 0, spread = 0;
    image.addEventListener("pointerdown", e => {
      image.setPointerCapture(e.pointerId);
      touches.set(e.pointerId, [e.clientX, e.clientY]);
      moved = spread = 0;
    });
    image.addEventListener("pointermove", e => {
      const before = touches.get(e.pointerId);
      if (!before || !this.camera) return;
      const dx = e.clientX - before[0], dy = e.clientY - before[1], height = image.clientHeight;
      if (moved < 4 && moved + Math.abs(dx) + Math.abs(dy) >= 4) this.remember();
      moved += Math.abs(dx) + Math.abs(dy);
      touches.set(e.pointerId, [e.clientX, e.clientY]);
      if (moved < 4) return;
      if (touches.size === 2) {
        const [a, b] = [...touches.values()], now = Math.hypot(a[0] - b[0], a[1] - b[1]);
        if (spread) this.camera.zoom(spread / now);
        spread = now;
      } else if (e.shiftKey || e.buttons & 2) this.camera.walk(-dx / height, dy / height, 0);
      else this.camera.orbit(3 * dx / height, -3 * dy / height);
      this.changed();
    });
    const up = e => {
      if (!touches.delete(e.pointerId) || moved >= 4 || e.type !== "pointerup") return;
      const box = image.getBoundingClientRect();
      this.explain((e.clientX - box.left) / box.width, (e.clientY - box.top) / box.height);
    };
    image.addEventListener("pointerup", up);
    image.addEventListener("pointercancel", up);
    image.addEventListener("contextmenu", e => e.preventDefault());
    image.addEventListener("wheel", e => {
      if (!this.camera) return;
      e.preventDefault();
      this.remember();
      this.camera.zoom(Math.exp(0.0012 * e.deltaY));
      this.changed();
    }, {passive: false});
    const keys = {
      ArrowLeft: c => c.orbit(-0.1, 0), ArrowRight: c => c.orbit(0.1, 0), ArrowUp: c => c.orbit(0, 0.1),
      ArrowDown: c => c.orbit(0, -0.1), "+": c => c.zoom(0.87), "-": c => c.zoom(1 / 0.87), w: c => c.walk(0, 0, 0.07),
      s: c => c.walk(0, 0, -0.07), a: c => c.walk(-0.07, 0, 0), d: c => c.walk(0.07, 0, 0)};
    image.addEventListener("keydown", e => {
      if (!this.camera) return;
      if (e.key === "Enter") return void this.explain(0.5, 0.5);
      if (e.key === "Escape") return void this.stop();
      if (e.key === "z" && (e.ctrlKey || e.metaKey)) return void this.back();
      if (!keys[e.key] || e.ctrlKey || e.metaKey) return;
      e.preventDefault();
      this.remember();
      keys[e.key](this.camera);
      this.changed();
    });
  }
}

globalThis.viewer = new Viewer();
