/** Values that change at certain times and stay as they are in between. */

import { countUpTo } from "./search";

export class Steps<Value> {
  readonly times: number[] = [];
  readonly values: Value[] = [];

  constructor(private readonly initial: Value) {}

  /** Adds a change; times must not decrease. */
  push(time_us: number, value: Value): void {
    this.times.push(time_us);
    this.values.push(value);
  }

  /** Returns the value at a time; a change counts from its very moment. */
  at(time_us: number): Value {
    const count = countUpTo(this.times, time_us);
    return count === 0 ? this.initial : this.values[count - 1];
  }

  get last(): Value {
    return this.values.length === 0 ? this.initial : this.values[this.values.length - 1];
  }

  /** Returns when the value at a time came to be; undefined if it is the initial one. */
  since(time_us: number): number | undefined {
    const count = countUpTo(this.times, time_us);
    return count === 0 ? undefined : this.times[count - 1];
  }
}

/** Makes a list whose entries come into being when they are first asked for. */
export function lazily<Entry>(make: (index: number) => Entry): (index: number) => Entry {
  const entries: Entry[] = [];
  return (index) => {
    entries[index] ??= make(index);
    return entries[index];
  };
}
