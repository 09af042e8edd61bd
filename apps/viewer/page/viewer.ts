// The viewer: a picture that follows the view at once and is refined when nothing moves.

import {element, scrollBehavior} from "../../../src/alhazen/explain/page/basics";
import type {Explanation} from "../../../src/alhazen/explain/page/explanation_data";
import {showExplanation} from "../../../src/alhazen/explain/page/explanation_view";
import {ViewCamera} from "./camera";
import {Controls} from "./controls";
import type {Key, Settings} from "./controls";
import {listen, listenAnywhere} from "./input";
import {FrameLink} from "./link";
import {Messages, WorkLine, doneText, drawScale, pictureName, statusText} from "./notices";
import {Pace} from "./pace";
import {PixelChoice} from "./pixel_choice";
import type {CameraData, FrameFacts, FrameHead, LightChange, LightEntry, Scene, State, Wish} from "./state";

const MOST_SIDE = 4096;       // largest side of a picture of the server
const MOST_RAW = 1.5e6;       // most pixels sent uncompressed; larger pictures are JPEG
const STOPPED = "Reading the file was ended.";
const NO_ENVIRONMENT = "This renderer shows the background of the scene; those that follow light see an environment.";
const OTHER_SERVER = "The server was replaced, and this page has no key to the new one: open the address that " +
  "`alhazen view` printed.";
const SILENT = "The server does not answer: waiting for it.";
const BUSY = "The server is busy with other pages: it has 8 clients at most. Close one of them.";
const REST = 300;            // milliseconds without a step after which a movement is over
const BUSY_PATIENCE = 6000;   // milliseconds; the server disconnects idle clients after 5 s
const NO_KEY = "This page has no key to the server: open the address that `alhazen view` printed.";

interface Asked {
  id: number;
  generation: number;
  level: number;
  wish: Wish;
  begin: number;
}

export class Viewer {
  // Tests read these, too.
  readonly client = Math.random().toString(36).slice(2);
  readonly image = element("canvas", {class: "picture", tabindex: "0", role: "application", "aria-label": "No picture yet",
                                      "aria-describedby": "help"});
  readonly scale = element("div", {class: "scale", hidden: true});
  readonly controls = new Controls((key, before) => this.chosen(key, before),
                                   reasons => this.messages.say("choice", reasons), changes => this.lightBlocks(changes));
  scene: Scene | undefined;
  camera: ViewCamera | undefined;
  frames = 0;
  level = 0;       // index of the requested level
  generation = 0;  // of the view
  shownGeneration = 0;
  firstPicture: number | undefined;  // milliseconds from the request of the page

  private readonly token: string;
  private readonly messages = new Messages(document.getElementById("message")!);
  private readonly work = new WorkLine();
  private readonly status = element("p", {id: "status"});
  // Announced by screen readers; the numbers of each picture would be too much.
  private readonly spoken = element("p", {id: "spoken", class: "unseen", role: "status"});
  private readonly pixel = new PixelChoice((x, y) => this.explainPixel(x, y));
  private readonly block = element("textarea", {id: "block", rows: 6, readonly: true, "aria-label": "Camera of the view", hidden: true});
  private readonly readAgain = element("button", {type: "button", hidden: true, click: () => void this.ask("/read")}, "Read again");
  private readonly g = this.image.getContext("2d")!;
  private readonly pace = new Pace();
  private readonly link: FrameLink;
  private readonly undone: {camera: ViewCamera, settings: Settings}[] = [];
  private readonly asked = new Map<number, Asked>();
  private lastId = 0;
  private held: object | undefined;       // work during which nothing is requested
  private explaining: object | undefined;
  private halted = false;                 // by Stop, until something changes
  private busy = false;                   // the server refused this page a place
  private movedAt = -Infinity;            // when the view was moved last
  private resting: ReturnType<typeof setTimeout> | undefined;
  private shownAccelerator: string | undefined;
  private described = "";                 // of the displayed picture
  private shownAt = 0;
  private movingShown: number[] = [];     // times

  constructor() {
    this.token = location.hash.slice(1) || sessionStorage.getItem("token") || "";
    if (location.hash) {
      sessionStorage.setItem("token", this.token);
      history.replaceState(null, "", location.pathname);
    }
    this.build();
    this.link = new FrameLink(this.token, {
      opened: () => {
        this.messages.say("server", "");
        if (this.scene) this.changed();
      },
      state: state => this.take(state),
      picture: (head, body) => void this.received(head, body),
      lost: () => {
        this.asked.clear();
        this.work.show(undefined);
        void this.sayWhyLost();
      },
      refused: () => this.messages.say("server", this.scene ? OTHER_SERVER : NO_KEY)});
  }

  // A server without a place refuses this page, too.
  private async sayWhyLost() {
    if (!this.busy) this.messages.say("server", SILENT);
    const answer = await this.post("/state", {});
    this.busy = answer?.status === 503;
    if (!this.link.connected) this.messages.say("server", this.busy ? BUSY : SILENT);
  }

  private build() {
    const block = this.block;
    const button = (text: string, click: () => void) => element("button", {type: "button", click}, text);
    const camera = element("button", {type: "button", "aria-expanded": "false", "aria-controls": "block", click: () => {
      block.value = this.camera?.block() ?? "";
      block.hidden = !block.hidden;
      camera.setAttribute("aria-expanded", String(!block.hidden));
    }}, "Camera block");
    const buttons = element("div", {class: "row"},
      button("Undo", () => this.undo()), button("Home", () => this.goHome()), button("Stop", () => this.stop()), camera,
      button("Save picture", () => void this.save()), this.readAgain);
    const help = element("p", {id: "help"}, "Drag or arrow keys turn, with shift they move; wheel, two fingers, + and \u2212 " +
      "zoom; W A S D walk. Click or Enter: why a pixel has its colour. Escape ends what is computed.");
    document.getElementById("viewer")!.append(
      element("div", {}, element("div", {class: "stage"}, this.image), this.scale, this.status, this.spoken, this.work.line, help),
      element("section", {"aria-label": "Settings and actions"}, this.controls.form, buttons, block, this.pixel.element));
    listen(this.image, this);
    listenAnywhere(this);
  }
  // Null if the server does not respond, which the link reports.
  private post(path: string, wish: object) {
    return fetch(path, {method: "POST", body: JSON.stringify({...wish, client: this.client}),
                        headers: {Authorization: `Bearer ${this.token}`}}).catch(() => null);
  }
  // Waits for a place among the clients of the server.
  private async ask(path: string, wish: object = {}, goesOn = () => true) {
    const begin = performance.now();
    for (;;) {
      const answer = await this.post(path, wish);
      if (answer?.status !== 503 || performance.now() - begin > BUSY_PATIENCE || !goesOn()) return answer;
      await new Promise(go => setTimeout(go, 300));
    }
  }
  // The response to work that frames requested earlier may end by arriving after it; null if the page gave it up.
  private async askUndisturbed(path: string, wish: object, own: object) {
    let answer: Response | null = null;
    const goesOn = () => this.held === own;
    for (let tries = 0; tries < 3 && goesOn() && (answer?.status ?? 204) === 204; ++tries) {
      answer = await this.ask(path, wish, goesOn);
    }
    return goesOn() ? answer : null;
  }

  private async lightBlocks(lights: LightChange[]) {
    const answer = await this.ask("/blocks", {lights, of: this.chosenCamera()});
    if (!answer) return "// The server does not answer.\n";
    if (answer.status === 503) return `// ${BUSY}\n`;
    const {text, error} = await answer.json() as {text?: string; error?: string};
    return text ?? `// ${error}\n`;
  }

  // ---- The scene.
  private take(state: State) {
    const known = this.scene;
    this.messages.say("file", state.error || (state.stopped ? STOPPED : ""));
    this.work.show(state.work.find(w => w.seconds > 0.3 && (w.client ?? this.client) === this.client));
    this.readAgain.hidden = !state.stopped;
    if (state.version === 0 || !(state.scene || known)) return;
    const scene = this.scene = {...known, ...state} as Scene;
    if (!known) {
      document.title = `${scene.scene} \u2013 Alhazen`;
      document.getElementById("title")!.textContent = scene.scene;
      this.fill(scene);
      this.see(scene.cameras[0]);
    } else if (known.version !== scene.version) {
      this.refill(known, scene);
      this.changed();
    }
  }
  // The file has changed: finds the chosen camera, by name if it has one, and moves a view that was still that camera's.
  private refill(before: Scene, scene: Scene) {
    const chosen = this.chosenCamera(), old = before.cameras[chosen];
    const same = scene.cameras[chosen]?.name === old.name || !old.name ? -1 : scene.cameras.findIndex(c => c.name === old.name);
    const index = same >= 0 ? same : Math.min(chosen, scene.cameras.length - 1);
    this.fill(scene);
    this.controls.set("camera", String(index));
    this.fitLights(scene);
    if (this.camera?.isAt(old)) this.see(scene.cameras[index]);
  }
  private fill(scene: Scene) {
    this.controls.fill(scene);
    this.fitRenderer(scene);
  }
  // Renderers that trace paths have their own default depth; renderers that are not physically based show only the
  // background of an environment.
  private fitRenderer(scene: Scene) {
    const renderer = this.renders(this.controls.get("renderer"));
    this.controls.setUsual("depth", renderer?.depth ?? scene.depth);
    this.controls.disable("environment", !renderer?.follows_light, NO_ENVIRONMENT);
    this.fitLights(scene);
  }
  // A light that was added to the scene belongs to the view, and may be left out by renderers that follow light.
  private fitLights(scene: Scene) {
    const added = scene.added_light;
    if (!added) return;
    const follows = this.renders(this.controls.get("renderer"))?.follows_light;
    const without = follows && (!added.follows_light || this.controls.get("environment") !== "");
    const own = this.frame().headlight, lights = scene.lights.filter(l => !without || l.name !== added.name);
    this.controls.setLights(lights.map((l): LightEntry => l.name === added.name ? this.atView(own ?? l) : l));
  }
  // The headlight of a camera where the view is.
  private atView(light: LightEntry): LightEntry {
    const view = this.camera;
    if (!view || view.isAt(this.frame())) return light;
    return {...light, ...(light.position ? {position: view.eye} : {}), ...(light.direction ? {direction: view.look} : {})};
  }
  private see(camera: CameraData) {
    this.camera = new ViewCamera(camera, this.scene?.up ?? "y");
    if (this.scene) this.fitLights(this.scene);
    this.changed();
  }
  private chosen(key: Key, before: Settings | undefined) {
    if (before) this.remember(before);
    if (["renderer", "accelerator", "lights", "environment", "layer", "moving"].includes(key)) this.pace.forget();
    if (key === "renderer" && this.scene) this.fitRenderer(this.scene);
    if ((key === "environment" || key === "camera") && this.scene) this.fitLights(this.scene);
    if (key === "camera") this.seeChosen();
    else if (key !== "steps") this.changed();
  }

  // ---- Requests.
  private chosenCamera() {
    return Number(this.controls.get("camera"));
  }
  // The camera of the scene whose picture is shown.
  private frame() {
    return this.scene!.cameras[this.chosenCamera()];
  }
  // The width of the whole picture; one with a side that is too large is made smaller.
  private full() {
    const {width, height} = this.frame();
    return Math.max(1, Math.floor(Math.min(width, MOST_SIDE, MOST_SIDE * width / height)));
  }
  private renders(name: string) {
    return this.scene?.renderers.find(r => r.name === name);
  }
  private wish(camera: ViewCamera, width: number): Wish {
    const {eye, look, right, up, parallel, aspect, lens} = camera, controls = this.controls;
    return {camera: {eye, look, right, up, parallel, aspect, lens, of: this.chosenCamera()}, width, height: this.heightFor(width),
            renderer: controls.get("renderer"), accelerator: controls.get("accelerator"), layer: controls.get("layer"),
            depth: controls.wished("depth"), exposure: controls.number("exposure"), curve: controls.get("curve"), samples: 1,
            environment: controls.get("environment"), lights_off: controls.lights.off(), lights: controls.lights.changes()};
  }
  // Only renderers that compute single rays can select pixels; layers need rays for each pixel.
  private selects() {
    return this.controls.get("moving") === "steady" && !this.controls.get("layer") &&
      !!this.renders(this.controls.get("renderer"))?.selects;
  }
  private limits() {
    return {full: this.full(), depth: this.controls.number("depth"), deepens: this.selects()};
  }
  private movingWish(camera: ViewCamera): Wish {
    const {width, depth} = this.pace.next(this.limits()), wish = this.wish(camera, width);
    if (this.selects()) return {...wish, depth, selected: true};
    if (this.controls.get("moving") !== "flat" || wish.layer || !this.renders("ray_casting")) return wish;
    return {...wish, renderer: "ray_casting"};
  }
  // [width relative to the whole, samples] of the levels after the moving picture
  levels(): [number, number][] {
    const samples = this.controls.number("samples");
    return [[0, 1], [1 / 4, 1], [1 / 2, 1], [1, 1], ...(samples > 1 ? [[1, samples] as [number, number]] : [])];
  }
  done() {
    return this.level >= this.levels().length;
  }
  // The view has changed: requests a coarse picture, then finer ones.
  changed() {
    if (!this.camera || !this.scene) return;
    if (!this.block.hidden) this.block.value = this.camera.block();
    this.name();
    ++this.generation;
    this.level = 0;
    this.halted = false;
    if (this.held) {  // the server ends it
      this.explaining = this.held = undefined;
      this.status.textContent = this.described;
      this.spoken.textContent = "";
    }
    this.messages.say("explain", "");
    this.request();
  }
  // The description of the picture.
  private name() {
    const scene = this.scene!, camera = this.frame(), width = this.full();
    const name = pictureName(scene.scene, camera, !!this.camera?.isAt(camera), this.controls.get("renderer"), this.controls.get("layer"));
    if (this.image.getAttribute("aria-label") !== name) this.image.setAttribute("aria-label", name);
    this.pixel.fit(width, this.heightFor(width));
  }
  private widthOf(part: number) {
    return Math.max(1, Math.round(this.full() * part));
  }
  private heightFor(width: number) {
    const frame = this.frame();
    return Math.min(MOST_SIDE, Math.max(1, Math.round(width * frame.height / frame.width)));
  }
  private request() {
    if (!this.camera || this.held || this.halted || this.done()) return;
    const [part, samples] = this.levels()[this.level], moving = this.level === 0;
    const wish = moving ? this.movingWish(this.camera) : {...this.wish(this.camera, this.widthOf(part)), samples};
    const id = ++this.lastId;
    this.asked.set(id, {id, generation: this.generation, level: this.level, wish, begin: performance.now()});
    this.link.send({...wish, id, moving, client: this.client, raw: wish.width * wish.height <= MOST_RAW});
  }

  // ---- Responses.
  private async received(head: FrameHead, body: Uint8Array) {
    const asked = this.asked.get(head.id);
    for (const id of this.asked.keys()) if (id <= head.id) this.asked.delete(id);
    if (!asked) return;
    const newest = asked.id === this.lastId;
    if (head.status === 204) {  // ended, by an explanation for example: repeat
      setTimeout(() => { if (newest && asked.id === this.lastId) this.request(); }, 50);
      return;
    }
    if (head.status !== 200 || !head.facts) {
      this.messages.say("frame", (JSON.parse(new TextDecoder().decode(body)) as {error: string}).error);
      if (newest) this.level = this.levels().length;
      return;
    }
    this.messages.say("frame", "");
    if (asked.generation < this.shownGeneration) return;
    this.shownGeneration = asked.generation;
    await this.draw(head, head.facts, body);
    this.describe(asked, head.facts);
    if (!newest || asked.id !== this.lastId) return;
    // Skips levels that would not be larger than the displayed picture, except one of its size with full depth.
    const deepest = this.controls.number("depth"), least = head.facts.width + (this.isLess(asked.wish, deepest) ? 0 : 1);
    do ++this.level; while (this.level < 3 && this.widthOf(this.levels()[this.level][0]) < least);
    if (this.done()) this.sayAtRest(doneText(head.facts, asked.wish.samples));
    this.request();
  }
  // Announces a picture that is done, but none between two steps of a movement.
  private sayAtRest(text: string) {
    const generation = this.generation, wait = this.movedAt + REST - performance.now();
    const say = () => {
      if (generation === this.generation && this.done() && !this.held) this.spoken.textContent = text;
    };
    if (wait > 0) setTimeout(say, wait);
    else say();
  }
  // True if a picture has less than the chosen depth, or another renderer.
  private isLess(wish: Wish, deepest: number) {
    return (wish.depth ?? deepest) < deepest || wish.renderer !== this.controls.get("renderer");
  }
  private async draw(head: FrameHead, facts: FrameFacts, body: Uint8Array) {
    const {width, height} = facts, raw = head.type === "application/octet-stream";
    const picture = raw ? new ImageData(new Uint8ClampedArray(body.buffer, body.byteOffset, body.length), width, height)
      : await createImageBitmap(new Blob([body], {type: head.type}));
    this.image.width = width;
    this.image.height = height;
    if (picture instanceof ImageData) this.g.putImageData(picture, 0, 0);
    else this.g.drawImage(picture, 0, 0);
    const frame = this.frame();
    document.documentElement.style.setProperty("--aspect", String(frame.width / frame.height));
    this.firstPicture ??= performance.now();
    ++this.frames;
  }
  private describe(asked: Asked, facts: FrameFacts) {
    const now = performance.now(), scene = this.scene!, moving = asked.level === 0, deepest = this.controls.number("depth");
    if (moving) {
      // If the server was never idle: from picture to picture.
      const busy = asked.begin < this.shownAt;
      this.pace.learn(now - (busy ? this.shownAt : asked.begin), facts, asked.wish.depth ?? deepest, this.limits());
      this.movingShown = [...this.movingShown.filter(t => t > now - 1000), now];
    }
    this.shownAt = now;
    this.shownAccelerator = asked.wish.accelerator;
    const span = now - this.movingShown[0], rate = span > 0 ? 1000 * (this.movingShown.length - 1) / span : 0;
    drawScale(this.scale, facts.layer, scene.scales);
    this.status.textContent = this.described = statusText(
      {facts, samples: asked.wish.samples, selected: !!asked.wish.selected, way: now - asked.begin,
       moving: moving ? {depth: asked.wish.depth ?? deepest, rate} : null}, this.full(), deepest, scene.memory);
  }

  // ---- Actions.
  move(change: (camera: ViewCamera) => void, mark: boolean) {
    if (!this.camera) return;
    if (mark) this.remember();
    change(this.camera);
    this.movedAt = performance.now();
    clearTimeout(this.resting);
    this.resting = setTimeout(() => this.scene && this.fitLights(this.scene), REST);
    this.changed();
  }
  private goHome() {
    this.remember();
    this.seeChosen();
  }
  private seeChosen() {
    if (this.scene) this.see(this.frame());
  }
  private remember(settings = this.controls.settings()) {
    this.messages.say("save", "");
    if (this.camera) this.undone.push({camera: this.camera.copy(), settings});
    if (this.undone.length > 100) this.undone.shift();
  }
  undo() {
    const before = this.undone.pop();
    if (!before || !this.scene) return;
    this.camera = before.camera;
    this.controls.restore(before.settings);
    this.fitRenderer(this.scene);
    this.pace.forget();
    this.changed();
  }
  // Ends the running frame, explanation, reading or building; the displayed picture stays.
  stop() {
    this.explaining = this.held = undefined;
    this.halted = true;
    this.asked.clear();
    // Another is not built.
    if (this.scene) this.controls.set("accelerator", this.shownAccelerator ?? this.scene.accelerator);
    // Over the link, where this page has its place.
    const sent = this.link.send({stop: true, client: this.client});
    this.spoken.textContent = sent ? "Stopped" : "";
    for (const topic of ["explain", "save"] as const) this.messages.say(topic, "");
    this.status.textContent = this.described;
  }
  // Requests no frames until the work is done, or given up for a change.
  private async hold(work: (own: object) => Promise<void>) {
    const own = this.held = {};
    try {
      await work(own);
    } finally {
      if (this.held === own) {
        this.held = undefined;
        this.request();
      }
    }
  }
  private save() {
    this.messages.say("save", "");
    return this.hold(async own => {
      if (!this.camera) return;
      const wish = {...this.wish(this.camera, this.full()), samples: this.controls.number("samples"), png: true};
      const answer = await this.askUndisturbed("/frame", wish, own);
      if (this.held !== own) return this.messages.say("save", "The picture was not saved: it was ended.");
      if (!answer) return;
      if (answer.status !== 200) return this.messages.say("save", `The picture was not saved: ${await reasonOf(answer)}`);
      const link = element("a", {href: URL.createObjectURL(await answer.blob()), download: "view.png"});
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    });
  }
  /** `u`, `v`: position relative to width and height. */
  explain(u: number, v: number) {
    if (!this.camera) return;
    const width = this.full(), at = (w: number, n: number) => Math.min(n - 1, Math.max(0, Math.floor(w * n)));
    this.explainPixel(at(u, width), at(v, this.heightFor(width)));
  }
  private explainPixel(x: number, y: number) {
    if (!this.camera) return;
    this.explainSample({...this.wish(this.camera, this.full()), samples: this.controls.number("samples"), x, y}, 0);
  }
  /** `picture`: set if the explained picture is not the displayed one. */
  private explainSample(wish: Wish & {samples: number; x: number; y: number}, sample: number, picture?: string) {
    const {x, y} = wish, own = this.explaining = {};
    this.pixel.show(x, y);
    this.status.textContent = this.spoken.textContent = "Explaining \u2026 (Escape ends it)";
    void this.hold(async held => {
      const answer = await this.askUndisturbed("/explain", {...wish, sample, steps: this.controls.get("steps")}, held);
      if (this.explaining !== own) return;
      this.explaining = undefined;
      this.status.textContent = this.described;
      this.spoken.textContent = answer?.status === 204 ? "The explanation was ended" : "";
      if (!answer || answer.status === 204) return;
      this.messages.say("explain", answer.ok ? "" : await reasonOf(answer));
      if (!answer.ok) return;
      const data = await answer.json() as Explanation;
      const root = document.getElementById("explanation")!;
      root.hidden = false;
      root.ariaLabel = `Explanation of pixel ${x},${y}`;
      const shown = picture ?? this.image.toDataURL("image/jpeg", 0.9);
      showExplanation(root, data, shown, i => this.explainSample(wish, i, shown));
      root.scrollIntoView({behavior: scrollBehavior()});
      root.focus({preventScroll: true});
    });
  }
}

// Why there is no answer.
async function reasonOf(answer: Response) {
  if (answer.status === 204) return "it was ended";
  const {error} = await answer.json().catch(() => ({})) as {error?: string};
  return error ?? (answer.status === 503 ? BUSY : `${answer.status} ${answer.statusText}`);
}
