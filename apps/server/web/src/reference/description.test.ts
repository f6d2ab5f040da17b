import api from "virtual:openapi";
import { expect, test } from "vitest";
import { curl, operations_of, properties_of, schema_name, type_text, type Operation, type Schema } from "./description";

const all: Operation[] = api.tags.flatMap(({ name }) => operations_of(api, name));
const operation = (id: string): Operation => all.find((one) => one.id === id)!;

test("every operation of the description stands under one tag, with its references followed", () => {
  const described = Object.values(api.paths).flatMap((methods) => Object.values(methods).map((raw) => raw.operationId));
  expect(all.map(({ id }) => id).sort()).toEqual([...described].sort());
  for (const one of all) {
    expect(one.parameters.every(({ name, schema }) => name && schema), one.id).toBe(true);
    expect(one.responses.every(([status, { description }]) => /^(\d{3}|default)$/.test(status) && description), one.id).toBe(true);
  }
});

test("every schema that is named is there", () => {
  const named = [...JSON.stringify(api).matchAll(/#\/components\/schemas\/(\w+)/g)].map(([ref]) => schema_name(ref));
  expect(named.length).toBeGreaterThan(10);
  for (const name of named) expect(api.components.schemas).toHaveProperty(name);
});

const schema = (name: string): Schema => api.components.schemas[name]!;

test("types are said in words", () => {
  expect(type_text(schema("Recognition").properties!.detections!)).toEqual({ before: "list of ", ref: "Detection", after: "" });
  expect(type_text(schema("ViewSummary").properties!.yaw!)).toEqual({ before: "number, or null", after: "" });
  expect(type_text(schema("Proposal").properties!.quality!)).toEqual({ before: "", ref: "Quality", after: ", or null" });
  expect(type_text({})).toEqual({ before: "anything", after: "" });
});

test("what is made of parts has the properties of all of them", () => {
  const names = properties_of(api, schema("View")).map(({ name }) => name);
  expect(names).toEqual(expect.arrayContaining(["view", "yaw", "object", "outline"]));
});

test("a line for the terminal has method, token and body as needed", () => {
  const at = "http://robot:8080";
  expect(curl(operation("getLive"), at, false)).toBe("curl http://robot:8080/api/live");
  expect(curl(operation("recognize"), at, false)).toBe("curl --data-binary @picture.jpg http://robot:8080/api/recognize");
  expect(curl(operation("deleteObject"), at, true)).toBe(
    'curl -X DELETE -H "Authorization: Bearer $POSEVOTE_TOKEN" http://robot:8080/api/objects/OBJECT',
  );
  expect(curl(operation("login"), at, true)).toBe(`curl --json '{"token":"…"}' http://robot:8080/api/login`);
  expect(curl(operation("streamEvents"), at, false)).toContain("curl -N ");
});
