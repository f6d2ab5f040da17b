// What concerns this browser alone: light or dark, and leaving.
import { useState } from "preact/hooks";
import { access } from "../api/client";
import { get_access, logout } from "../api/calls";
import { attempt } from "../ui/toast";
import { kThemes, theme, use_theme, type Theme } from "../ui/theme";

export function ThisBrowser() {
  const [chosen, set_chosen] = useState(theme());
  return (
    <section class="card stack" aria-label="This browser">
      <h2>This browser</h2>
      <fieldset class="row" aria-label="Colours">
        {Object.entries(kThemes).map(([value, label]) => (
          <label key={value} class="choice">
            <input
              type="radio"
              name="theme"
              checked={value === chosen}
              onChange={() => {
                use_theme(value as Theme);
                set_chosen(value as Theme);
              }}
            />
            {label}
          </label>
        ))}
      </fieldset>
      <div class="row spread">
        <span class="muted small">
          posevote {access.value?.version} ·{" "}
          <a href="/api/openapi.yaml" download>
            the API
          </a>
        </span>
        {access.value?.token_needed && (
          <button
            class="button"
            onClick={() =>
              void attempt(async () => {
                await logout();
                access.value = await get_access();
              })
            }
          >
            Log out
          </button>
        )}
      </div>
    </section>
  );
}
