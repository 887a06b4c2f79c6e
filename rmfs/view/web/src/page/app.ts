/** The page: panes, controls and figures around one state and one clock. */

import type { Run } from "../data/run";
import { type Range, rangeOf } from "../draw/heat";
import { charts } from "./charts";
import { nextEvent } from "./details";
import { button, h } from "./dom";
import { keyList, listen } from "./keys";
import { legend } from "./legend";
import { fromFragment, toFragment } from "./link";
import { LiveLink } from "./live";
import { Pane } from "./pane";
import { panel } from "./panel";
import { aside, folding } from "./room";
import type { Session } from "./sources";
import { startForm } from "./start";
import { Store, type ViewState } from "./state";
import { timeline, toggle } from "./timeline";
import { toolbar } from "./toolbar";

/** Figures beside the picture are worked out anew after so much wall time. */
const FIGURES_MS = 250;
/** How long it takes (s) to come closer to the present by two thirds. */
const CATCHING_UP_S = 0.15;
/** Further from the present than this (simulated s) nobody could follow the robots: it is shown at once. */
const FAR_S = 30;
/** A frame that took longer counts as so long: a page that was hidden does not jump ahead. */
const LONGEST_FRAME_S = 0.25;
const HEAT_PARTS: (keyof ViewState)[] = [
  "heat",
  "overlay",
  "from_s",
  "to_s",
  "theme",
  "mode",
  "tier",
];

/** Returns when the warm-up of a run is over: what is measured, and shown first, begins there. */
function measuredFrom({ header, known_us }: Run): number {
  return header.warmup_s < known_us / 1e6 ? header.warmup_s : 0;
}

function greatest(values: Float64Array): number {
  return values.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
}

export class App {
  readonly store: Store;
  readonly panes: Pane[];
  /** Frames drawn so far. */
  frames = 0;
  private range: Range = { least: 1, most: 1 };
  private dirty = true;
  /** Whether the time moves on because the run does. */
  private following = false;
  private heatStale = true;
  private figures_ms = Number.NEGATIVE_INFINITY;
  private figuresStale = true;
  private last_ms = performance.now();
  private readonly side: { update(): void }[];
  private readonly notice = h("div", { className: "notice", role: "status" });

  private readonly captions: string[];

  /** The run that goes on, if one does. */
  readonly live: LiveLink | undefined;

  constructor(
    readonly runs: Run[],
    session: Session,
  ) {
    const begin_s = session.live ? this.end_s : Math.max(...runs.map(measuredFrom));
    const { state, cameras } = fromFragment(location.hash, begin_s, this.end_s);
    state.selection = this.existing(state.selection);
    this.store = new Store(state);
    this.captions = runs.map(({ header }, n) => {
      const { layout, scenario, controllers } = header.names;
      const letter = runs.length > 1 ? `${"AB"[n] ?? n}: ` : "";
      return `${letter}${header.title} · ${layout}, ${scenario}, ${controllers}, seed ${header.seed}`;
    });
    const changed = () => {
      this.dirty = true;
    };
    this.panes = runs.map((run, n) => new Pane(run, n, this.store, this.captions[n], changed));
    if (session.live) {
      const come = () => {
        this.dirty = true;
        this.figures_ms = Math.min(this.figures_ms, this.last_ms - FIGURES_MS);
      };
      this.live = new LiveLink(runs[0], come, (text) => this.say(text));
    }
    this.side = this.build(session);
    document.title = `rmfs · ${runs.map(({ header }) => header.title).join(" | ")}`;
    document.documentElement.dataset.theme = state.theme;
    this.panes.forEach((pane, n) => {
      if (cameras[n] !== undefined) pane.stage.cameraState = cameras[n];
    });
    this.store.listen((names) => this.react(names));
    requestAnimationFrame((now_ms) => this.frame(now_ms));
  }

  /** How far the runs are known, in seconds. */
  get end_s(): number {
    return Math.max(...this.runs.map(({ known_us }) => known_us)) / 1e6;
  }

  /** Shows a short message for some seconds. */
  say(text: string): void {
    this.notice.textContent = text;
    this.notice.classList.add("shown");
    setTimeout(() => this.notice.classList.remove("shown"), 4000);
  }

  /** Draws at once, whatever is due; returns the pictures of all panes side by side. */
  picture(): string {
    this.draw(performance.now());
    const canvases = this.panes.map(({ stage }) => stage.canvas);
    const width = canvases.reduce((sum, canvas) => sum + canvas.width, 0);
    const sheet = h("canvas", { width, height: Math.max(...canvases.map(({ height }) => height)) });
    const pen = sheet.getContext("2d");
    let left = 0;
    this.panes.forEach(({ stage }) => {
      stage.render();
      pen?.drawImage(stage.canvas, left, 0);
      left += stage.canvas.width;
    });
    return sheet.toDataURL("image/png");
  }

  /** Returns a link that restores the view. */
  link(): string {
    const cameras = this.panes.map(({ stage }) => stage.cameraState);
    return location.href.replace(/#.*$/, "") + toFragment(this.store.state, cameras);
  }

  private existing(selection: ViewState["selection"]): ViewState["selection"] {
    if (selection === null) return null;
    const run = this.runs[selection.run];
    if (selection.what === "order") return run?.orders.exists(selection.index) ? selection : null;
    const layout = run?.layout;
    const counts = {
      robot: layout?.robotWaypoint.length,
      pod: layout?.podWaypoint.length,
      station: layout?.header.stations.length,
    };
    return selection.index < (counts[selection.what] ?? 0) ? selection : null;
  }

  private build(session: Session): { update(): void }[] {
    const { store, panes, runs } = this;
    const tiers = Math.max(...runs.map(({ header }) => header.tiers.length));
    const end_s = () => this.end_s;
    const keys = keyList();
    const commands = {
      toggle: () => toggle(store, this.end_s),
      screenshot: () => this.savePicture(),
      copyLink: () => this.copyLink(),
      fit: () => this.fit(),
      next: () => nextEvent(store, panes),
      help: () => keys.showModal(),
      time: () => document.querySelector<HTMLInputElement>("#time")?.select(),
    };
    listen(store, commands, tiers, end_s);
    const details = panel(store, panes);
    const course = folding("charts", "Charts", charts(store, runs, end_s));
    const colours = folding(
      "legend",
      "Legend",
      legend(store, runs[0].header, () => this.range),
    );
    document.body.replaceChildren(
      toolbar(
        store,
        tiers,
        this.comparable,
        session.form ? { ...commands, start: () => this.start() } : commands,
      ),
      h(
        "main",
        {},
        h("div", { className: "panes" }, ...panes.map(({ root }) => root)),
        colours.root,
      ),
      aside(details.root, course.root),
      timeline(store, runs[0].header.warmup_s, end_s, this.live?.root),
      this.notice,
      keys,
    );
    return [details, course, colours];
  }

  private react(names: ReadonlySet<keyof ViewState>): void {
    this.dirty = true;
    if (names.has("theme")) document.documentElement.dataset.theme = this.store.state.theme;
    const { overlay, heat } = this.store.state;
    if (names.has("overlay") && overlay && heat === "off") this.store.set({ heat: "visits" });
    if (HEAT_PARTS.some((name) => names.has(name))) this.heatStale = true;
    const seeking = names.has("time_s") && !this.store.state.playing && !this.following;
    if (this.live && !this.following && (seeking || this.store.state.playing)) {
      this.live.following = false;
      this.live.update();
    }
    if (names.has("selection") || names.has("board") || names.has("grouping") || seeking)
      this.figures_ms = Number.NEGATIVE_INFINITY;
    if (seeking) for (const pane of this.panes) pane.repaint();
  }

  private frame(now_ms: number): void {
    // the time of a frame may lie before the moment at which it was asked for
    const passed_s = Math.min(Math.max((now_ms - this.last_ms) / 1000, 0), LONGEST_FRAME_S);
    this.last_ms = now_ms;
    const { state } = this.store;
    if (this.live?.following) this.follow(passed_s);
    else if (state.playing) {
      const time_s = Math.min(state.time_s + passed_s * state.speed, this.end_s);
      this.store.set({ time_s, playing: time_s < this.end_s });
    }
    if (this.dirty) this.draw(now_ms);
    this.refreshFigures(now_ms);
    requestAnimationFrame((next_ms) => this.frame(next_ms));
  }

  /** Comes closer to the present of a run that goes on. */
  private follow(passed_s: number): void {
    const missing_s = this.end_s - this.store.state.time_s;
    if (Math.abs(missing_s) < 1e-6) return;
    const near = Math.abs(missing_s) > 0.01 && Math.abs(missing_s) < FAR_S;
    const share = near ? 1 - Math.exp(-passed_s / CATCHING_UP_S) : 1;
    this.following = true;
    this.store.set({ time_s: this.store.state.time_s + share * missing_s, playing: false });
    this.following = false;
  }

  private draw(now_ms: number): void {
    this.dirty = false;
    if (this.heatStale) this.countHeat();
    for (const pane of this.panes) pane.frame(now_ms);
    this.frames++;
    this.figuresStale = true;
  }

  /** Works out the figures beside the picture anew; what changes too soon after the last time waits. */
  private refreshFigures(now_ms: number): void {
    if (!this.figuresStale || now_ms - this.figures_ms <= FIGURES_MS) return;
    this.figuresStale = false;
    this.figures_ms = now_ms;
    for (const part of this.side) part.update();
  }

  private countHeat(): void {
    this.heatStale = false;
    const { heat, overlay, from_s, to_s } = this.store.state;
    if (heat !== "off") {
      for (const pane of this.panes) {
        pane.counts = pane.run.passages.count(heat, from_s * 1e6, to_s * 1e6);
      }
      this.range = rangeOf(this.panes.flatMap(({ counts }) => (counts ? [counts] : [])));
    }
    for (const pane of this.panes) pane.showHeat(this.range);
    if (this.comparable) this.compare(overlay && heat !== "off");
  }

  /** Shows the difference of the heat maps of two runs in one picture, or the runs side by side. */
  private compare(overlaid: boolean): void {
    const [a, b] = this.panes;
    b.root.hidden = overlaid;
    const differences = overlaid
      ? b.counts?.map((count, v) => count - (a.counts?.[v] ?? 0))
      : undefined;
    this.range = differences === undefined ? this.range : { least: 0, most: greatest(differences) };
    a.showDifference(differences, this.range.most);
    a.caption = overlaid ? `${this.captions[1]}, less ${this.captions[0]}` : this.captions[0];
  }

  /** Whether there are two runs on one floor. */
  private get comparable(): boolean {
    const [a, b] = this.runs.map(({ layout }) => layout);
    return (
      b !== undefined &&
      a.x.length === b.x.length &&
      a.x.every((x, v) => x === b.x[v]) &&
      a.y.every((y, v) => y === b.y[v])
    );
  }

  private fit(): void {
    for (const pane of this.panes) pane.stage.overlook(pane.placement);
  }

  private start(): void {
    const dialog = h("dialog", { id: "start" });
    const inside = h("div", {});
    dialog.append(
      inside,
      button("close", "Start nothing", () => dialog.close()),
    );
    dialog.addEventListener("close", () => dialog.remove());
    document.body.append(dialog);
    dialog.showModal();
    startForm(inside).catch((reason: unknown) => this.say(String(reason)));
  }

  private savePicture(): void {
    const name = `${this.runs[0].header.title}-${Math.round(this.store.state.time_s)}s.png`;
    h("a", { href: this.picture(), download: name }).click();
    this.say(`saved as ${name}`);
  }

  private copyLink(): void {
    // a page in a frame of a notebook has no address of its own
    if (location.protocol === "about:") {
      this.say("this page has no address: open its file for links");
      return;
    }
    const link = this.link();
    history.replaceState(null, "", link);
    navigator.clipboard?.writeText(link).then(
      () => this.say("link copied"),
      () => this.say("the link is in the address bar"),
    );
  }
}
