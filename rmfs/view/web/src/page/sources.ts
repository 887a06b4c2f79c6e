/** Where scenes come from: the server behind the page, or the page itself. */

export interface Session {
  runs: number;
  /** Whether the run goes on. */
  live: boolean;
  /** Whether runs can be started. */
  form: boolean;
}

/** Returns the scenes inside an exported page; none if it is served. */
export function embedded(): HTMLScriptElement[] {
  return [...document.querySelectorAll<HTMLScriptElement>("script[data-scene]")];
}

/** Unpacks a scene inside the page. */
export async function unpack(script: HTMLScriptElement): Promise<ArrayBuffer> {
  try {
    const text = atob(script.textContent ?? "");
    const bytes = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    return await new Response(stream).arrayBuffer();
  } catch {
    throw new Error("the scene in this file is cut off or damaged");
  }
}

/** Asks the server; a refusal becomes an error with its reason. */
export async function ask(path: string, body?: unknown): Promise<Response> {
  const request: RequestInit =
    body === undefined
      ? {}
      : {
          method: "POST",
          headers: { "Content-Type": "application/json" },
          body: JSON.stringify(body),
        };
  const answer = await fetch(path, request);
  if (answer.ok) return answer;
  const reason = (await answer.json().catch(() => ({}))) as { error?: string };
  throw new Error(reason.error ?? `the server answers ${answer.status}`);
}
