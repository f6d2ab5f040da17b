// Numbers and sentences as people read them. null stands for what cannot be known.
export function percent(share: number | null | undefined): string {
  return share == null ? "–" : `${Math.round(share * 100)} %`;
}

export function count(value: number, one: string, many = one + "s"): string {
  return `${value.toLocaleString("en")} ${value === 1 ? one : many}`;
}

export function degrees(yaw: number | null | undefined): string {
  return yaw == null ? "–" : `${Math.round(yaw)}°`;
}

/// "0:07", "1:15"
export function clock(ms: number): string {
  const seconds = Math.max(0, Math.floor(ms / 1000));
  return `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;
}

/// "just now", "5 min ago"
export function ago(seconds: number): string {
  const minutes = Math.round(seconds / 60);
  return minutes === 0 ? "just now" : minutes < 60 ? `${minutes} min ago` : `${Math.round(minutes / 60)} h ago`;
}

export function milliseconds(ms: number): string {
  return ms < 10 ? `${ms.toFixed(1)} ms` : `${Math.round(ms)} ms`;
}

/// The library's messages begin small, for they follow "posevote: " in a terminal.
export function sentence(text: string): string {
  const trimmed = text.trim();
  return trimmed.charAt(0).toUpperCase() + trimmed.slice(1) + (/[.!?…]$/.test(trimmed) ? "" : ".");
}
