// Light or dark: the system's choice, or this browser's.
export const kThemes = { system: "As the system", light: "Light", dark: "Dark" };
export type Theme = keyof typeof kThemes;

const kKey = "posevote-theme";

export function theme(): Theme {
  const kept = localStorage.getItem(kKey);
  return kept && kept in kThemes ? (kept as Theme) : "system";
}

export function use_theme(chosen: Theme): void {
  localStorage.setItem(kKey, chosen);
  if (chosen === "system") delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = chosen;
}
