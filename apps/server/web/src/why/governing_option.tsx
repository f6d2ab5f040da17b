// The option that decides at the step where it ended: its help, its value, the way to it.
import { get_settings } from "../api/calls";
import { link_to } from "../router";
import { title_of } from "../settings/setting_field";
import { use_loaded } from "../ui/loaded";

export function GoverningOption({ name, found }: { name: string; found: boolean }) {
  const { data } = use_loaded(get_settings, []);
  const setting = data?.settings.find((one) => one.name === name);
  if (!name) return null;
  return (
    <section class="why-option stack tight" aria-label="The option that decides here">
      <h3>{found ? "How careful it was" : "What decides here"}</h3>
      <p>
        <b>{title_of(name)}</b>
        {setting && (
          <>
            {" "}
            is <b>{String(setting.value)}</b> {setting.unit}
          </>
        )}
      </p>
      {setting && <p class="muted small">{setting.help}</p>}
      {setting?.fixed ? (
        <p class="muted small">It was decided when the first object was taught.</p>
      ) : (
        <a href={link_to("settings", name)}>To this option</a>
      )}
    </section>
  );
}
