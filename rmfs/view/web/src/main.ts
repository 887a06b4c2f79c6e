/** Starts the page. */

import "./style.css";
import { Run } from "./data/run";
import { App } from "./page/app";
import { fail } from "./page/messages";
import { ask, embedded, type Session, unpack } from "./page/sources";

declare global {
  interface Window {
    /** The page, for tests and for the curious at the console. */
    rmfs?: App;
  }
}

async function start(): Promise<void> {
  window.rmfs = new App((await scenes()).map((buffer) => new Run(buffer)));
}

async function scenes(): Promise<ArrayBuffer[]> {
  const inside = embedded();
  if (inside.length > 0) return Promise.all(inside.map(unpack));
  const session = (await (await ask("session")).json()) as Session;
  const numbers = Array.from({ length: session.runs }, (_, number) => number);
  return Promise.all(numbers.map(async (number) => (await ask(`runs/${number}`)).arrayBuffer()));
}

start().catch((reason: unknown) => {
  fail(reason instanceof Error ? reason.message : String(reason));
});
