// A button for what cannot be undone: it asks first.
import { useState } from "preact/hooks";
import { Dialog } from "./dialog";

interface Props {
  label: string;
  title: string;  // the question
  text: string;   // what is lost
  keep: string;
  on_sure: () => void;
}

export function AskFirst({ label, title, text, keep, on_sure }: Props) {
  const [asking, set_asking] = useState(false);
  const close = (): void => set_asking(false);
  return (
    <>
      <button class="button plain" onClick={() => set_asking(true)}>
        {label}
      </button>
      {asking && (
        <Dialog title={title} on_close={close}>
          <p>{text}</p>
          <div class="row">
            <button class="button primary" onClick={close}>
              {keep}
            </button>
            <button
              class="button danger"
              onClick={() => {
                close();
                on_sure();
              }}
            >
              {label}
            </button>
          </div>
        </Dialog>
      )}
    </>
  );
}
