// Pages by the address after '#': "#/objects/red%20mug" is page "objects" with argument "red mug".
import { signal } from "@preact/signals";

export interface Route {
  page: string;
  argument: string;
}

export function parse_route(hash: string): Route {
  const [page = "", ...rest] = hash.replace(/^#?\/?/, "").split("/");
  let argument = rest.join("/");
  try {
    argument = decodeURIComponent(argument);
  } catch {
    // A stray % typed by hand: taken as it stands.
  }
  return { page: page || "live", argument };
}

export function link_to(page: string, argument = ""): string {
  return `#/${page}${argument ? "/" + encodeURIComponent(argument) : ""}`;
}

export const route = signal<Route>(parse_route(globalThis.location?.hash ?? ""));

export function go_to(page: string, argument = ""): void {
  location.hash = link_to(page, argument);
}

export function follow_address(): void {
  addEventListener("hashchange", () => {
    route.value = parse_route(location.hash);
    scrollTo(0, 0);
  });
}
