// All options of the server, made from what it says of them; the dial of false alarms first.
import { useEffect, useState } from "preact/hooks";
import { change_settings, get_settings } from "../api/calls";
import type { Setting, SettingValue } from "../api/types";
import { link_to } from "../router";
import { use_loaded } from "../ui/loaded";
import { Failed, Waiting } from "../ui/state";
import { attempt, say } from "../ui/toast";
import { count } from "../ui/numbers";
import { Dial } from "./dial_field";
import { is_dial } from "./dial";
import { Impostors } from "./impostors";
import { SettingField } from "./setting_field";
import { ThisBrowser } from "./this_browser";
import "./settings_page.css";

const kGroups: Record<string, string> = { recognize: "Recognition", teach: "Teaching", live: "Camera and stream" };

/// `wanted`: the name of an option to go to.
export function SettingsPage({ wanted }: { wanted: string }) {
  const { data, error, reload } = use_loaded(get_settings, []);
  const [changed, set_changed] = useState<Record<string, SettingValue>>({});
  const [saving, set_saving] = useState(false);
  useEffect(() => show_option(wanted), [wanted, !data]);
  if (error && !data)
    return (
      <Failed what="settings" error={error} on_retry={reload} />
    );
  if (!data) return <Waiting what="settings" />;

  const dial = data.settings.find(is_dial);
  const others = data.settings.filter((setting) => setting !== dial);
  const value_of = (setting: Setting): SettingValue => changed[setting.name] ?? setting.value;
  const change = (setting: Setting, value: SettingValue): void => {
    const { [setting.name]: _, ...rest } = changed;
    set_changed(value === setting.value ? rest : { ...rest, [setting.name]: value });
  };
  const fields = (level: Setting["level"], group: string) =>
    others
      .filter((setting) => setting.level === level && setting.group === group)
      .map((setting) => (
        <SettingField
          key={setting.name}
          setting={setting}
          value={value_of(setting)}
          on_change={(value) => change(setting, value)}
        />
      ));
  async function save(): Promise<void> {
    set_saving(true);
    if (await attempt(() => change_settings(changed))) {
      say("The settings are in force.");
      set_changed({});
      reload();
    }
    set_saving(false);
  }
  const pending = Object.keys(changed).length;
  return (
    <div class="stack settings">
      <h1>Settings</h1>
      {dial && <Dial setting={dial} value={Number(value_of(dial))} on_change={(value) => change(dial, value)} />}
      {Object.entries(kGroups).map(([group, title]) => {
        const expert = fields("expert", group);
        const basic = fields("basic", group);
        if (basic.length + expert.length === 0) return null;
        return (
          <section key={group} class="card stack" aria-label={title}>
            <h2>{title}</h2>
            {basic}
            {expert.length > 0 && (
              <details>
                <summary>{count(expert.length, "more option")} for experts</summary>
                {expert}
              </details>
            )}
          </section>
        );
      })}
      <Impostors />
      <ThisBrowser />
      <section class="card stack tight" aria-label="For programs">
        <h2>For programs</h2>
        <p class="muted">All that this page does, programs can do, too.</p>
        <a href={link_to("api")}>The HTTP interface</a>
      </section>
      {pending > 0 && (
        <div class="settings-save">
          <span>{count(pending, "change")} not in force yet</span>
          <button class="button" disabled={saving} onClick={() => set_changed({})}>
            Forget
          </button>
          <button class="button primary" disabled={saving} onClick={() => void save()}>
            Apply
          </button>
        </div>
      )}
    </div>
  );
}

function show_option(name: string): void {
  const option = name && document.getElementById(name);
  if (!option) return;
  option.closest("details")?.setAttribute("open", "");
  option.scrollIntoView({ block: "center" });
  option.querySelector<HTMLElement>("input, select")?.focus({ preventScroll: true });
}
