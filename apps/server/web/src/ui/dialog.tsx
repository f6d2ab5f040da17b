// A modal question: the browser's own dialog, so focus, Escape and the screen reader are right.
import type { ComponentChildren } from "preact";
import { useEffect, useId, useRef } from "preact/hooks";
import "./dialog.css";

interface Props {
  title: string;
  on_close: () => void;
  wide?: boolean;
  children: ComponentChildren;
}

export function Dialog({ title, on_close, wide, children }: Props) {
  const dialog = useRef<HTMLDialogElement>(null);
  const heading = useId();
  useEffect(() => {
    const shown = dialog.current!;
    shown.showModal();
    return () => shown.close();
  }, []);
  return (
    <dialog
      ref={dialog}
      class={wide ? "dialog wide" : "dialog"}
      aria-labelledby={heading}
      onCancel={(event) => {
        event.preventDefault();
        on_close();
      }}
    >
      <header class="row spread">
        <h2 id={heading}>{title}</h2>
        <button class="button plain" aria-label="Close" onClick={on_close}>
          ✕
        </button>
      </header>
      {children}
    </dialog>
  );
}
