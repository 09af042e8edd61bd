// The connection to the server: a WebSocket (frame_socket.h) for states and pictures that reconnects.

import type {FrameHead, State} from "./state";

export interface LinkEvents {
  /** The server is connected, and nothing has been requested on this connection. */
  opened(): void;
  state(state: State): void;
  picture(head: FrameHead, body: Uint8Array): void;
  lost(): void;
  /** The server refused the key. */
  refused(): void;
}

// The server sends a message each second.
const SILENCE = 4000, PAUSE = 500;
const POLICY_VIOLATION = 1008;

export class FrameLink {
  private socket: WebSocket | undefined;
  private open = false;
  private since = 0;  // time of the last message

  constructor(private readonly token: string, private readonly events: LinkEvents) {
    this.connect();
    setInterval(() => this.watch(), PAUSE);
  }

  get connected() {
    return this.open;
  }
  /** False if the server is not connected. */
  send(message: object) {
    if (!this.open) return false;
    this.socket?.send(JSON.stringify(message));
    return true;
  }

  private connect() {
    const socket = new WebSocket(`ws://${location.host}/frames`);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    this.since = performance.now();
    socket.onopen = () => socket.send(JSON.stringify({token: this.token}));
    socket.onmessage = e => {
      this.since = performance.now();
      if (typeof e.data === "string") this.read(JSON.parse(e.data) as State);
      else this.readPicture(e.data as ArrayBuffer);
    };
    socket.onclose = e => {
      if (e.code === POLICY_VIOLATION) {
        this.open = false;
        this.socket = undefined;
        this.events.refused();
      } else this.drop();
    };
  }
  private read(state: State) {
    if (!this.open) {
      this.open = true;
      this.events.opened();
    }
    this.events.state(state);
  }
  private readPicture(data: ArrayBuffer) {
    const size = new DataView(data).getUint32(0, true);
    const head = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, size))) as FrameHead;
    this.events.picture(head, new Uint8Array(data, 4 + size));
    this.send({shown: head.id});
  }

  private watch() {
    if (this.socket && performance.now() - this.since > SILENCE) this.drop();
  }
  private drop() {
    const socket = this.socket;
    if (!socket) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close();
    this.socket = undefined;
    this.open = false;
    this.events.lost();
    setTimeout(() => this.connect(), PAUSE);
  }
}
