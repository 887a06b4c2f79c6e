/** Starts the page. */

import "./style.css";
import "./panel.css";
import "./orders.css";
import "./start.css";
import { Run } from "./data/run";
import { App } from "./page/app";
import { fail } from "./page/messages";
import { ask, embedded, type Session, unpack } from "./page/sources";
import { startForm } from "./page/start";

declare global {
  interface Window {
    /** The page, for tests and for the curious at the console. */
    rmfs?: App;
  }
}

async function start(): Promise<void> {
  const inside = embedded();
  if (inside.length > 0) {
    show(await Promise.all(inside.map(unpack)), { runs: inside.length, live: false, form: false });
    return;
  }
  const session = (await (await ask("session")).json()) as Session;
  if (session.runs === 0) {
    await startForm(document.body);
    return;
  }
  const numbers = Array.from({ length: session.runs }, (_, number) => number);
  const scenes = numbers.map(async (number) => (await ask(`runs/${number}`)).arrayBuffer());
  show(await Promise.all(scenes), session);
}

function show(scenes: ArrayBuffer[], session: Session): void {
  const runs = scenes.map((buffer) => new Run(buffer));
  window.rmfs = new App(runs, session);
}

start().catch((reason: unknown) => {
  fail(reason instanceof Error ? reason.message : String(reason));
});
