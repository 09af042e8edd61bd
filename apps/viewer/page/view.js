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
    this.level = 0;
    this.generation = 0;
    this.undo = [];
    this.build();
    this.poll();
  }
  async ask(path, wish = {}) {
    return fetch(path, {method: "POST", body: JSON.stringify(wish), headers: {Authorization: `Bearer ${this.token}`}});
  }
  say(text) {
    const place = document.getElementById("message");
    place.hidden = !text;
    if (place.textContent !== text) place.textContent = text;
  }

  build() {
    this.image = element("img", {class: "picture", tabindex: "0", alt: "The scene. Drag or arrow keys turn, shift moves, " +
      "wheel or plus and minus zoom, W A S D walk, a click or Enter explains a pixel.", draggable: "false"});
    this.controls = element("form", {class: "controls", submit: e => e.preventDefault()});
    this.status = element("p", {id: "status", "aria-live": "off"});
    const block = element("textarea", {id: "block", rows: 6, readonly: true, "aria-label": "Camera of the view", hidden: true});
    const button = (text, click) => element("button", {type: "button", click}, text);
    this.buttons = element("div", {class: "row"},
      button("Undo", () => this.back()), button("Home", () => this.goHome()),
      button("Camera block", () => {
        block.value = this.camera.block();
        block.hidden = !block.hidden;
      }),
      button("Save picture", () => this.save()));
    document.getElementById("viewer").append(element("div", {}, this.image, this.status),
      element("section", {"aria-label": "Settings"}, this.controls, this.buttons, block));
    this.listen();
  }
  // Menus of what the program says that there is.
  fill(state) {
    const menu = (key, label, entries, value) => {
      const select = element("select", {change: () => this.changed()}, ...entries.map(e =>
        element("option", {value: e.value ?? e.name, title: e.what}, e.name)));
      select.value = value;
      this[key] = select;
      return element("label", {}, label, select);
    };
    const field = (key, label, value, min, max, step = 1) => {
      const input = element("input", {type: "number", min, max, step, value, change: () => this.changed()});
      this[key] = input;
      return element("label", {}, label, input);
    };
    const cameras = state.cameras.map((c, i) => ({name: c.name || `camera ${i + 1}`, value: String(i)}));
    this.controls.replaceChildren(
      menu("cameraMenu", "camera", cameras, "0"), menu("renderer", "renderer", state.renderers, "whitted"),
      menu("accelerator", "accelerator", state.accelerators, state.accelerator),
      field("samples", "samples", 4, 1, 1024), field("depth", "depth", state.depth, 0, 100),
      field("exposure", "exposure", 0, -16, 16, 0.5),
      menu("curve", "tone curve", state.curves.map(c => ({name: c})), "none"),
      menu("steps", "steps of", state.steps.split(", ").map(s => ({name: s})), "kay_kajiya"));
    this.cameraMenu.addEventListener("change", () => {
      this.remember();
      this.take(state.cameras[Number(this.cameraMenu.value)]);
    });
    this.home = state.cameras[0];
  }
  take(camera) {
    this.camera = new ViewCamera(camera, this.scene.up);
    if (!this.camera.distance) this.camera.distance = this.range ?? 0.5 * norm(this.camera.eye) + 1;
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
        this.say("This page has no key to the server: open the address that `alhazen view` printed.");
        return;
      }
      const state = await answer.json();
      this.memory = state.memory;
      this.say(state.error);
      const known = this.scene;
      this.scene = state;
      if (!known) {
        document.title = `${state.scene} \u2013 Alhazen`;
        this.fill(state);
        await this.findRange(state.cameras[0]);
        this.take(state.cameras[0]);
      } else if (known.version !== state.version || this.lost) this.changed();
      this.lost = false;
    } catch {
      this.lost = true;
      this.say("The server does not answer: waiting for it.");
    }
    setTimeout(() => this.poll(), 500);
  }
  // The distance of what is in the middle: what the view turns around.
  async findRange(camera) {
    const wish = {...this.wish(new ViewCamera(camera, "y"), 64), samples: 1, x: 32, y: 18, steps: "list"};
    const answer = await this.ask("/explain", {...wish, height: 36});
    if (!answer.ok) return;
    const first = (await answer.json()).tree.surfaces[0];
    if (first) this.range = first.t;
  }

  wish(camera, width) {
    const height = Math.max(1, Math.round(width / camera.aspect));
    const {eye, look, right, up, parallel} = camera;
    return {camera: {eye, look, right, up, parallel}, width, height, renderer: this.renderer.value,
            accelerator: this.accelerator.value, depth: Number(this.depth.value), exposure: Number(this.exposure.value),
            curve: this.curve.value};
  }
  full() {
    return Math.max(64, Math.min(this.scene.width, 4096));
  }
  // As wide as 40 ms allow, by the last frame; a quarter where nothing is known, half of the picture at most.
  coarse() {
    const full = this.full();
    if (!this.perPixel) return full / 4;
    return Math.min(full / 2, Math.max(64, Math.sqrt(0.04 / this.perPixel * this.camera.aspect)));
  }
  // The view is another one: coarse at first, and finer with each frame.
  changed() {
    if (!this.camera || !this.scene) return;
    ++this.generation;
    this.level = 0;
    this.next();
  }
  async next() {
    const levels = [[1 / 4, 1], [1 / 2, 1], [1, 1], [1, Number(this.samples.value)]];
    if (this.level >= levels.length || (this.level === 3 && levels[3][1] === 1)) return;
    // While the view moves, one small frame at a time: the next has the newest camera.
    if (this.flying && this.level === 0) return;
    const generation = this.generation, [scale, samples] = levels[this.level];
    const small = this.level === 0;
    if (small) this.flying = true;
    const width = Math.round(small ? this.coarse() : this.full() * scale);
    const begin = performance.now();
    try {
      const answer = await this.ask("/frame", {...this.wish(this.camera, width), samples});
      if (answer.status === 204) {  // a newer one was asked for, or an explanation
        if (generation === this.generation) {
          this.ended = this.level;
          this.level = levels.length;
        }
      } else if (answer.ok) {
        const facts = JSON.parse(answer.headers.get("X-Alhazen"));
        const blob = await answer.blob();
        if (generation >= (this.shownGeneration ?? 0)) this.show(blob, generation, facts, width, begin, samples);
        if (samples === 1) this.perPixel = facts.seconds / (width * width / this.camera.aspect);
        if (generation === this.generation) this.level += 1;
      } else {
        this.say((await answer.json()).error);
        this.level = levels.length;
      }
    } catch {
      this.level = levels.length;  // the server is gone; poll brings it back
    }
    if (small) this.flying = false;
    if (generation === this.generation || small) this.next();
  }
  show(blob, generation, facts, width, begin, samples) {
    const url = URL.createObjectURL(blob);
    this.shownGeneration = generation;
    const old = this.image.src;
    this.image.src = url;
    if (old.startsWith("blob:")) URL.revokeObjectURL(old);
    this.image.style.maxWidth = `calc(82vh * ${this.camera.aspect})`;
    this.image.width = this.full();
    this.image.height = Math.round(this.full() / this.camera.aspect);
    this.frames = (this.frames ?? 0) + 1;
    this.status.textContent = `${width} wide, ${samples} sample${samples > 1 ? "s" : ""} a pixel \u00b7 ` +
      `${(1000 * facts.seconds).toFixed(1)} ms, ${(performance.now() - begin).toFixed(0)} ms with the way here \u00b7 ` +
      `${(facts.rays / facts.seconds / 1e6).toFixed(2)} M rays/s on ${facts.threads} threads \u00b7 ` +
      `${(this.memory / 1048576).toFixed(0)} MiB`;
  }
  async save() {
    const answer = await this.ask("/frame", {...this.wish(this.camera, this.full()), samples: Number(this.samples.value), png: true});
    if (answer.status !== 200) return;
    const link = element("a", {href: URL.createObjectURL(await answer.blob()), download: "view.png"});
    link.click();
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
    const width = this.full(), wish = this.wish(this.camera, width);
    const at = (w, n) => Math.min(n - 1, Math.max(0, Math.floor(w * n)));
    const answer = await this.ask("/explain", {...wish, samples: 1, x: at(u, width), y: at(v, wish.height), steps: this.steps.value});
    const data = await answer.json();
    if (this.ended !== undefined && this.level > this.ended) {
      this.level = this.ended;
      this.next();
    }
    this.ended = undefined;
    if (!answer.ok) return this.say(data.error);
    const root = document.getElementById("explanation");
    showExplanation(root, data, this.image.src);
    root.scrollIntoView({behavior: "smooth"});
    root.focus({preventScroll: true});
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
