// multipart/x-mixed-replace, cut into its parts as the bytes come in.

export interface Part {
  headers: Map<string, string>;  // names in lower case
  body: Uint8Array<ArrayBuffer>;
}

const kMaxPart = 32 << 20;

/// Feeds on chunks of any size. Parts must carry Content-Length; a stream that breaks this or grows
/// without an end of the headers throws.
export class MultipartParser {
  private buffer = new Uint8Array(0);
  private part: { headers: Map<string, string>; length: number } | null = null;

  push(chunk: Uint8Array): Part[] {
    this.append(chunk);
    const parts: Part[] = [];
    for (;;) {
      this.part ??= this.read_headers();
      if (!this.part || this.buffer.length < this.part.length) return parts;
      parts.push({ headers: this.part.headers, body: this.buffer.slice(0, this.part.length) });
      this.buffer = this.buffer.subarray(this.part.length);
      this.part = null;
    }
  }

  private append(chunk: Uint8Array): void {
    const joined = new Uint8Array(this.buffer.length + chunk.length);
    joined.set(this.buffer);
    joined.set(chunk, this.buffer.length);
    this.buffer = joined;
    if (joined.length > kMaxPart) throw new Error("The stream's pictures are too large.");
  }

  private read_headers(): { headers: Map<string, string>; length: number } | null {
    const end = find_blank_line(this.buffer);
    if (end < 0) return null;
    const lines = new TextDecoder("latin1").decode(this.buffer.subarray(0, end)).split("\r\n");
    this.buffer = this.buffer.subarray(end + 4);
    const headers = new Map<string, string>();
    for (const line of lines) {
      const colon = line.indexOf(":");
      if (colon > 0) headers.set(line.slice(0, colon).trim().toLowerCase(), line.slice(colon + 1).trim());
    }
    const length = Number(headers.get("content-length"));
    if (!Number.isInteger(length) || length < 0) throw new Error("A picture of the stream has no length.");
    return { headers, length };
  }
}

function find_blank_line(bytes: Uint8Array): number {
  for (let i = 0; i + 3 < bytes.length; ++i)
    if (bytes[i] === 13 && bytes[i + 1] === 10 && bytes[i + 2] === 13 && bytes[i + 3] === 10) return i;
  return -1;
}
