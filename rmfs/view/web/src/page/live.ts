/** A run that goes on: asks for what is new, and passes on pause, step, speed and exchanges. */

import type { Live } from "../data/layout";
import type { Run } from "../data/run";
import { button, choice, clock, h } from "./dom";
import { type Problems, ruleField } from "./rules";
import { ask } from "./sources";

const ASK_AGAIN_MS = 250;
const PATIENCE = 3;
const STEP_S = 10;
const FASTEST = "max";
const PACES = ["1", "2", "5", "10", "30", "60", "300", "1000", FASTEST];

export class LiveLink {
  readonly root: HTMLElement;
  /** Whether the page shows the present, which moves on. */
  following = true;
  private readonly page = crypto.randomUUID();
  private readonly status = h("output", { id: "live-status" });
  private readonly pause: HTMLButtonElement;
  private readonly pace: HTMLSelectElement;
  private readonly present: HTMLButtonElement;
  private failures = 0;
  private asking = Promise.resolve();

  /** `come` is called when something new is known, `say` shows a message. */
  constructor(
    private readonly run: Run,
    private readonly come: () => void,
    private readonly say: (text: string) => void,
  ) {
    this.pause = button("pause", "Let the run pause, or go on", () =>
      this.wish(this.live.paused ? { do: "run", speed: this.live.speed } : { do: "pause" }),
    );
    this.pause.id = "live-pause";
    const event = button("next event", "One instant further, then pause", () =>
      this.wish({ do: "step" }),
    );
    event.id = "live-step";
    const step = button(`${STEP_S} s`, `${STEP_S} simulated seconds further, then pause`, () =>
      this.wish({ do: "step", by_s: STEP_S }),
    );
    step.id = "live-step-seconds";
    const options = PACES.map(
      (pace) => [pace, pace === FASTEST ? "as fast as it goes" : `${pace} s/s`] as const,
    );
    const pace = choice("the run goes at", options, (value) =>
      this.wish({ do: "run", speed: value === FASTEST ? null : Number(value) }),
    );
    this.pace = pace.select;
    this.pace.id = "live-pace";
    this.present = button("● live", "Show the present", () => {
      this.following = true;
      this.update();
    });
    this.present.id = "live-present";
    const exchange = button("exchange a rule…", "Install another controller now", () => {
      this.exchange().catch((reason: unknown) => this.say(String(reason)));
    });
    exchange.id = "live-exchange";
    this.root = h(
      "div",
      { className: "live" },
      this.present,
      this.pause,
      event,
      step,
      pace.root,
      exchange,
      this.status,
    );
    window.addEventListener("pagehide", () => this.leave());
    // a page that was left is not there any more for the run, even if the browser had kept it
    window.addEventListener("pageshow", ({ persisted }) => persisted && location.reload());
    this.update();
    void this.listen();
  }

  private get live(): Live {
    if (this.run.live === undefined) throw new Error("not a live run");
    return this.run.live;
  }

  private async listen(): Promise<void> {
    while (this.live.ended === "" && this.failures < PATIENCE) {
      await new Promise((done) => setTimeout(done, ASK_AGAIN_MS));
      await this.askOnce();
    }
    if (this.live.ended === "") this.live.ended = "the run does not answer any more";
    this.update();
    this.say(this.live.ended);
  }

  /** Asks for what is new, one question after the other: none is answered twice. */
  private askOnce(): Promise<void> {
    this.asking = this.asking.then(() => this.fetchNews());
    return this.asking;
  }

  private async fetchNews(): Promise<void> {
    const { motion, events } = this.live.known;
    try {
      const answer = await ask(`live?motion=${motion}&events=${events}&page=${this.page}`);
      this.run.extend(await answer.arrayBuffer());
      this.failures = 0;
      this.come();
      this.update();
    } catch {
      this.failures++;
    }
  }

  /** Says how the run goes. */
  update(): void {
    const { ended, paused, speed, known_s } = this.live;
    const over = ended !== "";
    for (const control of this.root.querySelectorAll<HTMLButtonElement>("button, select")) {
      control.disabled = over && control !== this.present;
    }
    this.pause.textContent = paused ? "go on" : "pause";
    this.pace.value = speed === null ? FASTEST : String(speed);
    this.present.ariaPressed = String(this.following);
    const state = over ? ended : paused ? "paused" : "running";
    this.status.textContent = `${state} at ${clock(known_s)} of ${clock(this.run.header.end_s)} h`;
  }

  private wish(body: Record<string, unknown>): void {
    ask("control", { ...body, page: this.page }).then(
      () => this.askOnce(),
      (reason: unknown) => this.say(String(reason)),
    );
  }

  /** Says that nobody watches any more; the request outlives the page. */
  private leave(): void {
    void fetch("leave", {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify({ page: this.page }),
      keepalive: true,
    });
  }

  private async exchange(): Promise<void> {
    const problems = (await (await ask("problems")).json()) as Problems;
    const names = Object.keys(problems);
    const inside = h("div", {});
    const wrong = h("p", { className: "wrong", role: "alert" });
    let field = ruleField(problems[names[0]], this.live.controllers[names[0]]);
    const show = (problem: string) => {
      field = ruleField(problems[problem], this.live.controllers[problem]);
      inside.replaceChildren(field.root);
    };
    const options = names.map((name) => [name, `${name}: ${problems[name].meaning}`] as const);
    const problem = choice("problem", options, show);
    problem.select.id = "exchange-problem";
    show(names[0]);
    const install = button("install", "From this instant on", () => {
      ask("exchange", { problem: problem.select.value, rule: field.read() }).then(
        () => {
          dialog.close();
          this.say(`${problem.select.value} is exchanged`);
        },
        (reason: unknown) => {
          wrong.textContent = reason instanceof Error ? reason.message : String(reason);
        },
      );
    });
    install.id = "exchange-install";
    const dialog = h(
      "dialog",
      { id: "exchange", className: "start" },
      h("h2", {}, "Exchange a rule"),
      problem.root,
      inside,
      wrong,
      install,
      button("close", "Change nothing", () => dialog.close()),
    );
    dialog.addEventListener("close", () => dialog.remove());
    document.body.append(dialog);
    dialog.showModal();
  }
}
