/** Parameters in words: their names without underscores, and their units. */

/** What the ends of names say: a unit, or a kind of number. The longest that fits counts. */
const UNITS: [ending: string, unit: string][] = [
  ["_m_s2", "m/s²"],
  ["_m_s", "m/s"],
  ["_rad_s", "rad/s"],
  ["_per_h", "per hour"],
  ["_kwh", "kWh"],
  ["_wh", "Wh"],
  ["_kg", "kg"],
  ["_kw", "kW"],
  ["_rad", "rad"],
  ["_share", "share, 0 to 1"],
  ["_km", "km"],
  ["_s", "s"],
  ["_m", "m"],
  ["_w", "W"],
  ["_j", "J"],
  ["_h", "h"],
];

/** Names that are not just words with underscores between them. */
const OWN: Readonly<Record<string, string>> = {
  skus: "SKUs",
  warmup_s: "warm-up",
  duration_s: "measured time",
};

/** Returns the words for a parameter, and its unit or nothing. */
export function inWords(name: string): { words: string; unit: string } {
  const [ending, unit] = UNITS.find(([end]) => name.endsWith(end)) ?? ["", ""];
  const own = OWN[name];
  if (own !== undefined) return { words: own, unit };
  const kept = ending === "_share" ? name : name.slice(0, name.length - ending.length);
  return { words: kept.replaceAll("_", " "), unit };
}

/** Returns a number of seconds as people say it; nothing where that would say no more. */
export function spoken(seconds: number): string {
  if (!(seconds >= 120)) return "";
  const [hours, minutes] = [Math.floor(seconds / 3600), (seconds % 3600) / 60];
  const rest = Number(minutes.toFixed(1));
  if (hours === 0) return `= ${rest} min`;
  return rest === 0 ? `= ${hours} h` : `= ${hours} h ${rest} min`;
}

/** Leaves a unit out of a description that begins or ends with it: it stands beside the number. */
export function withoutUnit(description: string, unit: string): string {
  const written = unit === "m/s²" ? "m/s2" : unit;
  if (written === "" || written.includes(" ") || description === written) {
    return description === written ? "" : description;
  }
  const kept = description.startsWith(`${written} `)
    ? description.slice(written.length + 1)
    : description;
  return kept.endsWith(`, ${written}`) ? kept.slice(0, -written.length - 2) : kept;
}
