/** One run on its canvas: brings the drawn bodies to the state and time that are asked for. */

import type { Mesh } from "three";
import { newPose, type Pose } from "../data/motion";
import type { Run } from "../data/run";
import { Floor } from "../draw/floor";
import { HeatSquares, type Range } from "../draw/heat";
import { Paths } from "../draw/paths";
import { Placement } from "../draw/placement";
import { PodBodies } from "../draw/pods";
import { Rings } from "../draw/rings";
import { RobotBodies } from "../draw/robots";
import { Stage } from "../draw/stage";
import { h } from "./dom";
import { Hint, hintOf, hintOfWaypoint, waypointUnder } from "./hints";
import type { Chosen, Selection, Store, ViewState } from "./state";

/** Robots change colour seldom: it is looked up anew after so much wall time, or a jump. */
const REPAINT_MS = 200;
const HIT_M = 1.5;
/** A click that moved further was a drag of the camera. */
const DRAGGED_PX = 4;

type Place = { what: Exclude<Chosen, "order">; index: number };

export class Pane {
  readonly root: HTMLElement;
  readonly stage: Stage;
  readonly poses: Pose[];
  placement: Placement;
  /** What the heat map shows, if it does. */
  counts: Float64Array | undefined;
  private floor: Floor;
  private readonly robots: RobotBodies;
  private readonly pods: PodBodies;
  private readonly heat: HeatSquares;
  private readonly paths: Paths;
  private readonly rings = new Rings();
  private readonly title: HTMLElement;
  private pressed = [0, 0];
  private readonly hint: Hint;
  private painted_ms = Number.NEGATIVE_INFINITY;

  constructor(
    readonly run: Run,
    private readonly number: number,
    private readonly store: Store,
    caption: string,
    private readonly changed: () => void,
  ) {
    this.title = h("div", { className: "caption" }, caption);
    const canvas = h("canvas", { tabIndex: 0, ariaLabel: `warehouse of ${caption}` });
    this.root = h("div", { className: "pane" }, canvas, this.title);
    this.stage = new Stage(canvas, changed);
    this.hint = new Hint(canvas, (x, y) => this.told(x, y));
    this.root.append(this.hint.root);
    this.poses = Array.from({ length: run.motion.robots }, newPose);
    this.robots = new RobotBodies(run);
    this.pods = new PodBodies(run);
    this.heat = new HeatSquares(run);
    this.paths = new Paths(run, "#D55E00");
    const { mode, tier, theme } = store.state;
    this.placement = new Placement(run.layout, mode, tier);
    this.floor = new Floor(run.layout, theme);
    this.stage.scene.add(
      this.robots.group,
      this.pods.bodies.mesh,
      this.paths.lines,
      this.rings.group,
    );
    this.dress();
    this.arrange();
    store.listen((names) => this.react(names));
    canvas.addEventListener("pointerdown", ({ clientX, clientY }) => {
      this.pressed = [clientX, clientY];
    });
    canvas.addEventListener("click", (event) => this.click(event));
    new ResizeObserver(() => {
      this.stage.resize(this.root.clientWidth, this.root.clientHeight);
      changed();
    }).observe(this.root);
  }

  /** Says what the picture shows. */
  set caption(text: string) {
    this.title.textContent = text;
  }

  /** Draws the heat map of counts on a scale that runs side by side share. */
  showHeat(range: Range): void {
    const { heat, theme } = this.store.state;
    this.heat.squares.mesh.visible = heat !== "off";
    if (this.counts !== undefined) this.heat.draw(this.counts, range, this.placement, theme);
    this.stage.relay();
  }

  /** Draws how much more there is in run B than in run A, and nothing that moves. */
  showDifference(differences: Float64Array | undefined, most: number): void {
    const shown = differences !== undefined;
    this.robots.group.visible = this.pods.bodies.mesh.visible = this.paths.lines.visible = !shown;
    this.counts = differences ?? this.counts;
    if (differences === undefined) return;
    this.heat.squares.mesh.visible = true;
    this.heat.drawDifference(differences, most, this.placement, this.store.state.theme);
    this.stage.relay();
  }

  /** Looks colours up anew in the next frame. */
  repaint(): void {
    this.painted_ms = Number.NEGATIVE_INFINITY;
  }

  frame(now_ms: number): void {
    const { state } = this.store;
    const time_us = state.time_s * 1e6;
    const paint = now_ms - this.painted_ms > REPAINT_MS;
    this.poses.forEach((pose, robot) => {
      this.run.motion.pose(robot, time_us, pose);
    });
    this.robots.place(this.poses, this.placement);
    this.pods.place(time_us, this.poses, this.placement);
    const all = this.painted_ms === Number.NEGATIVE_INFINITY;
    this.pods.paint(time_us, state.pods, state.theme, all);
    if (paint) {
      this.poses.forEach((pose, robot) => {
        this.robots.paint(robot, pose, time_us, state.robots, state.theme);
      });
      this.painted_ms = now_ms;
    }
    this.drawPaths(state, time_us);
    this.floor.scaleLabels(this.stage.pixel_m);
    this.mark(state.selection, time_us);
    this.stage.render();
    this.hint.update(now_ms);
  }

  /** Says what is at a point of the page, the waypoint if nothing stands there. */
  private told(clientX: number, clientY: number): string {
    const { overlay, heat } = this.store.state;
    const hit = overlay && heat !== "off" ? null : this.pick(clientX, clientY);
    if (hit !== null) return hintOf(this, hit, this.store.state.time_s * 1e6);
    const ray = this.stage.ray(clientX, clientY).ray;
    const waypoint = waypointUnder(this.run.layout, this.placement, ray);
    return waypoint < 0 ? "" : hintOfWaypoint(this, waypoint, this.store.state);
  }

  private react(names: ReadonlySet<keyof ViewState>): void {
    if (names.has("theme")) this.dress();
    if (names.has("mode") || names.has("tier")) this.arrange();
    if (names.has("heat")) this.shapePods();
    if (names.has("zones")) {
      this.floor.showZones(this.store.state.zones);
      this.stage.relay();
    }
    if (["theme", "pods", "robots", "playing"].some((name) => names.has(name as keyof ViewState)))
      this.repaint();
    this.changed();
  }

  private dress(): void {
    const { theme, zones } = this.store.state;
    this.floor = new Floor(this.run.layout, theme);
    this.floor.arrange(this.placement);
    this.floor.showZones(zones);
    this.stage.lay(this.floor.group, this.heat.squares.mesh);
    this.stage.setTheme(theme);
  }

  private arrange(): void {
    const { mode, tier } = this.store.state;
    this.placement = new Placement(this.run.layout, mode, tier);
    this.floor.arrange(this.placement);
    this.stage.relay();
    this.shapePods();
    this.stage.overlook(this.placement);
  }

  private shapePods(): void {
    const { mode, heat } = this.store.state;
    this.pods.shape(mode, heat !== "off");
  }

  private drawPaths(state: ViewState, time_us: number): void {
    this.paths.clear();
    const { selection } = state;
    const chosen = this.isHere(selection) && selection?.what === "robot" ? selection.index : -1;
    this.poses.forEach((pose, robot) => {
      if (state.paths || robot === chosen) this.paths.add(robot, pose, time_us, this.placement);
    });
    this.paths.finish();
  }

  private mark(selection: Selection | null, time_us: number): void {
    const marked =
      selection !== null && this.isHere(selection) ? this.marked(selection, time_us) : [];
    const places = marked.map((one) => this.whereIs(one, time_us));
    this.rings.show(places, this.placement.mode === "2d" ? 1 : 0.05);
    const movable = selection?.what === "robot" || selection?.what === "pod";
    if (this.store.state.follow && movable && places.length > 0) {
      const [{ x, y, z }] = places;
      this.stage.follow(x, y, z);
    }
  }

  /** Returns what is to be marked: of an order its stations, and the pods and robots under way. */
  private marked(selection: Selection, time_us: number): Place[] {
    const { what, index } = selection;
    if (what !== "order") return [{ what, index }];
    const { orders } = this.run;
    if (!orders.exists(index, time_us)) return [];
    const stays = orders.course(index)?.stays ?? [];
    const here = stays.filter(({ from_us, to_us }) => from_us <= time_us && time_us < to_us);
    const brought = orders.lines(index, time_us).flatMap(({ bringing }) => bringing);
    return [
      ...here.map(({ station }) => ({ what: "station" as const, index: station })),
      ...brought.flatMap(({ pod, robot }) => [
        { what: "pod" as const, index: pod },
        { what: "robot" as const, index: robot },
      ]),
    ];
  }

  private isHere(selection: Selection | null): boolean {
    return selection?.run === this.number;
  }

  private whereIs(selection: Place, time_us: number) {
    const { layout, places } = this.run;
    if (selection.what === "robot") return this.placement.of(this.poses[selection.index]);
    let waypoint: number;
    if (selection.what === "pod") {
      const where = places.of[selection.index].at(time_us);
      if (where < 0) return this.placement.of(this.poses[-1 - where]);
      waypoint = where;
    } else waypoint = layout.header.stations[selection.index].waypoint;
    const tier = layout.tier[waypoint];
    return {
      x: layout.x[waypoint] + this.placement.x[tier],
      y: layout.y[waypoint],
      z: this.placement.z[tier],
      shown: this.placement.shown[tier],
    };
  }

  private click(event: MouseEvent): void {
    const [x, y] = this.pressed;
    if (Math.hypot(event.clientX - x, event.clientY - y) > DRAGGED_PX) return;
    const hit = this.pick(event.clientX, event.clientY);
    this.store.set({ selection: hit });
  }

  /** Returns what is at a point of the page: a robot before a station before a pod. */
  private pick(clientX: number, clientY: number): Selection | null {
    const caster = this.stage.ray(clientX, clientY);
    const hits: { what: Chosen; index: number; away: number; rank: number }[] = [];
    const bodies = [
      { what: "robot", drawn: this.robots.bodies },
      { what: "pod", drawn: this.pods.bodies },
    ] as const;
    for (const { what, drawn } of bodies) {
      const struck = drawn.struck(caster);
      if (struck !== undefined) hits.push({ what, ...struck, rank: what === "robot" ? 0 : 2 });
    }
    const [station] = caster.intersectObjects(this.floor.stations, false);
    if (station !== undefined) {
      const index = this.floor.stations.indexOf(station.object as Mesh);
      hits.push({ what: "station", index, away: station.distance, rank: 1 });
    }
    const nearest = Math.min(...hits.map(({ away }) => away));
    const near = hits.filter(({ away }) => away < nearest + HIT_M);
    near.sort((a, b) => a.rank - b.rank);
    return near.length === 0
      ? null
      : { run: this.number, what: near[0].what, index: near[0].index };
  }
}
