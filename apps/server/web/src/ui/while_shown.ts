// Work that only makes sense while somebody looks: browsers allow few connections to one server, and
// pages in the background would take them from the one in front.

/// Calls `begin` whenever the page is shown, and what it returned when it is hidden. Returns the end.
export function while_shown(begin: () => () => void): () => void {
  let end: (() => void) | null = null;
  const update = (): void => {
    if (document.hidden) {
      end?.();
      end = null;
    } else {
      end ??= begin();
    }
  };
  update();
  document.addEventListener("visibilitychange", update);
  return () => {
    document.removeEventListener("visibilitychange", update);
    end?.();
  };
}
