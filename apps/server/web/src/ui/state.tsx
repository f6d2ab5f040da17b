// What is shown where there is nothing (yet) to show: waiting, empty, failed.
import type { ComponentChildren } from "preact";
import "./state.css";

interface Props {
  icon: string;
  title: string;
  children?: ComponentChildren;
  alert?: boolean;
}

export function State({ icon, title, children, alert }: Props) {
  return (
    <div class="state" role={alert ? "alert" : undefined}>
      <span class="state-icon" aria-hidden="true">
        {icon}
      </span>
      <h2>{title}</h2>
      {children}
    </div>
  );
}

export function Waiting({ what }: { what: string }) {
  return <p class="state muted">Loading {what} …</p>;
}

export function Failed({ what, error, on_retry }: { what: string; error: Error; on_retry: () => void }) {
  return (
    <State icon="⚠" title={`The ${what} could not be loaded`} alert>
      <p>{error.message}</p>
      <button class="button" onClick={on_retry}>
        Try again
      </button>
    </State>
  );
}
