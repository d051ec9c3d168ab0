// Links that contain the state of the page: deflated JSON in the fragment, which browsers do not send to servers.

const MARK = "#1.";
const MOST_CHARACTERS = 10_000_000;

/** Return the fragment for a JSON value. */
export async function packed(value) {
  const stream = new Blob([JSON.stringify(value)]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return MARK + btoa(text).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

/** Return the value in a fragment; null if there is none, or if it cannot be read. */
export async function unpacked(fragment) {
  if (!fragment.startsWith(MARK)) return null;
  try {
    const text = atob(fragment.slice(MARK.length).replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = Uint8Array.from(text, (character) => character.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    return JSON.parse(await read(stream.pipeThrough(new TextDecoderStream())));
  } catch {
    return null;
  }
}

async function read(stream) {
  let text = "";
  for (const reader = stream.getReader(); ; ) {
    const { done, value } = await reader.read();
    if (done) return text;
    text += value;
    // A short link can unpack to more than the memory holds.
    if (text.length > MOST_CHARACTERS) throw new Error("too long");
  }
}
