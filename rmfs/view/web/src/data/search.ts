/** Searching in ascending numbers. */

export interface Ascending {
  readonly [index: number]: number;
  readonly length: number;
}

/** Returns how many of the first `count` values are not greater than `limit`. */
export function countUpTo(values: Ascending, limit: number, count = values.length): number {
  let low = 0;
  let high = count;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] <= limit) low = middle + 1;
    else high = middle;
  }
  return low;
}
