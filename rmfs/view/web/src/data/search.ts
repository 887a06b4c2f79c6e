/** Searching in ascending numbers. */

export interface Ascending {
  readonly [index: number]: number;
  readonly length: number;
}

/** Returns how many of the first `count` values are not greater than `limit`. */
export function countUpTo(values: Ascending, limit: number, count = values.length): number {
  return firstWhere(count, (place) => values[place] > limit);
}

/** Returns the first of `count` places where something holds, which from there on always does. */
export function firstWhere(count: number, holds: (place: number) => boolean): number {
  let low = 0;
  let high = count;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (holds(middle)) high = middle;
    else low = middle + 1;
  }
  return low;
}
