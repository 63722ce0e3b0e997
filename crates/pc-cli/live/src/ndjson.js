// Lines of JSON from a stream of bytes, each as soon as it is there.

export async function* lines(stream) {
  const reader = stream.getReader();
  const decoder = new TextDecoder();
  let rest = "";
  try {
    for (;;) {
      const { value, done } = await reader.read();
      rest += done ? decoder.decode() : decoder.decode(value, { stream: true });
      const whole = rest.split("\n");
      rest = done ? "" : whole.pop();
      for (const line of whole) {
        if (line.trim() !== "") {
          yield JSON.parse(line);
        }
      }
      if (done) {
        return;
      }
    }
  } finally {
    // Who stops reading wants nothing more.
    reader.cancel().catch(() => {});
  }
}
