import { expect, test } from "vitest";
import { link_to, parse_route } from "./router";

test("an empty address is the live page", () => {
  for (const hash of ["", "#", "#/"]) expect(parse_route(hash)).toEqual({ page: "live", argument: "" });
});

test("any name survives the way through the address", () => {
  for (const name of ["mug", "red mug", "a/b", "50 %", "Tee für zwei", "#?&"])
    expect(parse_route(link_to("objects", name))).toEqual({ page: "objects", argument: name });
});

test("a stray percent sign is no error", () => {
  expect(parse_route("#/objects/50%")).toEqual({ page: "objects", argument: "50%" });
});
