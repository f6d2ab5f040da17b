// The frame round all pages: title, ways to the pages, messages.
import { useEffect } from "preact/hooks";
import { get_access } from "./api/calls";
import { access } from "./api/client";
import { listen } from "./api/events";
import { LivePage } from "./live/live_page";
import { Login } from "./login";
import { ObjectPage } from "./objects/object_page";
import { ObjectsPage } from "./objects/objects_page";
import { ReferencePage } from "./reference/reference_page";
import { link_to, route, type Route } from "./router";
import { SettingsPage } from "./settings/settings_page";
import { TeachPage } from "./teach/teach_page";
import { TryPage } from "./try/try_page";
import { State, Waiting } from "./ui/state";
import { while_shown } from "./ui/while_shown";
import { Toasts, say_error } from "./ui/toast";
import "./app.css";

const kPages = { live: "Live", objects: "Objects", try: "Try", settings: "Settings" };

export function App() {
  const known = access.value;
  useEffect(() => {
    get_access().then((answer) => (access.value = answer), say_error);
  }, []);
  useEffect(() => (known?.authenticated ? while_shown(listen) : undefined), [known?.authenticated]);
  if (!known)
    return (
      <>
        <Waiting what="the studio" />
        <Toasts />
      </>
    );
  if (!known.authenticated) return <Login />;
  return (
    <>
      <a class="skip" href="#main" onClick={focus_main}>
        To the content
      </a>
      <header class="bar">
        <a class="brand" href={link_to("live")}>
          <img src="./icon.svg" alt="" width={28} height={28} />
          <span>posevote</span>
        </a>
        <nav class="tabs" aria-label="Pages">
          {Object.entries(kPages).map(([page, title]) => (
            <a key={page} href={link_to(page)} aria-current={route.value.page === page ? "page" : undefined}>
              {title}
            </a>
          ))}
        </nav>
        <a class="button primary" href={link_to("teach")} hidden={route.value.page === "teach"}>
          New object
        </a>
      </header>
      <main id="main" tabIndex={-1}>
        <Page {...route.value} />
      </main>
      <Toasts />
    </>
  );
}

function Page({ page, argument }: Route) {
  useEffect(() => {
    const titles: Record<string, string> = { ...kPages, teach: "New object", api: "HTTP interface" };
    document.title = `${titles[page] ?? "No such page"} – posevote studio`;
  }, [page]);
  switch (page) {
    case "live":
      return <LivePage />;
    case "teach":
      return <TeachPage key={argument} name={argument} />;
    case "objects":
      return argument ? <ObjectPage key={argument} name={argument} /> : <ObjectsPage />;
    case "try":
      return <TryPage />;
    case "api":
      return <ReferencePage wanted={argument} />;
    case "settings":
      return <SettingsPage wanted={argument} />;
    default:
      return (
        <State icon="?" title="There is no such page">
          <a class="button" href={link_to("live")}>
            To the live picture
          </a>
        </State>
      );
  }
}

function focus_main(event: Event): void {
  event.preventDefault();
  document.getElementById("main")!.focus();
}
