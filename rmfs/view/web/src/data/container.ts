/** Reads the container in which a scene comes: a JSON header and named arrays behind it. */

const MAGIC = "RMFSSCN1";
const FORMAT = "rmfs-scene/1";

const TYPES = { u1: Uint8Array, i4: Int32Array, f4: Float32Array, f8: Float64Array } as const;

export type Column = Uint8Array | Int32Array | Float32Array | Float64Array;

/** What is wrong with a container, in words for the user. */
export class ContainerError extends Error {}

export interface Container<Header> {
  header: Header;
  /** Returns an array by its name; it shares the memory of the container. */
  bytes(name: string): Uint8Array;
  integers(name: string): Int32Array;
  reals(name: string): Float64Array;
  singles(name: string): Float32Array;
}

interface Directory {
  format: string;
  size: number;
  arrays: Record<string, [keyof typeof TYPES, number, number]>;
}

/** Decodes a container; every defect ends in a `ContainerError`. */
export function decode<Header>(buffer: ArrayBuffer): Container<Header> {
  if (buffer.byteLength < 16 || text(buffer, 0, 8) !== MAGIC) {
    throw new ContainerError("this is not a scene of rmfs");
  }
  const length = Number(new DataView(buffer).getBigUint64(8, true));
  if (16 + length > buffer.byteLength) throw cutOff();
  const header = JSON.parse(text(buffer, 16, length)) as Directory;
  if (header.format !== FORMAT) {
    throw new ContainerError(`the scene has format ${header.format}, this page reads ${FORMAT}`);
  }
  if (buffer.byteLength < header.size) throw cutOff();

  const column = (name: string, type: keyof typeof TYPES): Column => {
    const entry = header.arrays[name];
    if (entry === undefined || entry[0] !== type) {
      throw new ContainerError(`the scene has no array ${name} of type ${type}`);
    }
    return new TYPES[type](buffer, entry[1], entry[2]);
  };
  return {
    header: header as unknown as Header,
    bytes: (name) => column(name, "u1") as Uint8Array,
    integers: (name) => column(name, "i4") as Int32Array,
    reals: (name) => column(name, "f8") as Float64Array,
    singles: (name) => column(name, "f4") as Float32Array,
  };
}

function text(buffer: ArrayBuffer, offset: number, length: number): string {
  return new TextDecoder().decode(new Uint8Array(buffer, offset, length));
}

function cutOff(): ContainerError {
  return new ContainerError("the scene is cut off: its end is missing");
}
