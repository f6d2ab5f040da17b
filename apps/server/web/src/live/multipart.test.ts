import { expect, test } from "vitest";
import { MultipartParser } from "./multipart";

const bytes = (text: string) => new TextEncoder().encode(text);
const text_of = (body: Uint8Array) => new TextDecoder().decode(body);
const part = (frame: number, body: string) =>
  `--b\r\nContent-Type: image/jpeg\r\nContent-Length: ${body.length}\r\nX-Frame: ${frame}\r\n\r\n${body}\r\n`;

test("parts come out whole however the bytes are cut", () => {
  const stream = bytes(part(1, "first") + part(2, "a\r\n\r\nb--b\r\n") + part(3, ""));
  for (const size of [1, 2, 7, stream.length]) {
    const parser = new MultipartParser();
    const seen: string[] = [];
    for (let i = 0; i < stream.length; i += size)
      for (const found of parser.push(stream.subarray(i, i + size)))
        seen.push(`${found.headers.get("x-frame")}:${text_of(found.body)}`);
    expect(seen).toEqual(["1:first", "2:a\r\n\r\nb--b\r\n", "3:"]);
  }
});

test("an unfinished part waits", () => {
  const parser = new MultipartParser();
  expect(parser.push(bytes("--b\r\nContent-Length: 4\r\n\r\nab"))).toEqual([]);
  expect(text_of(parser.push(bytes("cd"))[0]!.body)).toBe("abcd");
});

test("a part without a length is refused", () => {
  expect(() => new MultipartParser().push(bytes("--b\r\nContent-Type: image/jpeg\r\n\r\nab"))).toThrow("length");
  expect(() => new MultipartParser().push(bytes("--b\r\nContent-Length: -1\r\n\r\n"))).toThrow("length");
});
