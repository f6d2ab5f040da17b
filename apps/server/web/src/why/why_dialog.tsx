// Where the evidence for an object ended: in words, in numbers, and as a picture.
import { useId, useState } from "preact/hooks";
import { explain, explain_drawn } from "../api/calls";
import type { Explanation, Explanations } from "../api/types";
import { Dialog } from "../ui/dialog";
import { use_loaded } from "../ui/loaded";
import { sentence } from "../ui/numbers";
import { Waiting } from "../ui/state";
import { Evidence } from "./evidence";
import { farthest_first, steps_of } from "./explained";
import { GoverningOption } from "./governing_option";
import "./why_dialog.css";

interface Props {
  picture: Blob;
  on_close: () => void;
}

export function WhyDialog({ picture, on_close }: Props) {
  const { data, error } = use_loaded((signal) => explain(picture, signal), []);
  return (
    <Dialog title="Why not?" wide on_close={on_close}>
      {error ? (
        <p class="note bad" role="alert">
          {error.message}
        </p>
      ) : !data ? (
        <Waiting what="what became of each object" />
      ) : data.explanations.length === 0 ? (
        <p class="note">Nothing was taught yet, so nothing can be found.</p>
      ) : (
        <Explained picture={picture} of={data} />
      )}
    </Dialog>
  );
}

function Explained({ picture, of }: { picture: Blob; of: Explanations }) {
  const id = useId();
  const all = farthest_first(of.explanations);
  const [object, set_object] = useState(all[0]!.object);
  const shown = all.find((one) => one.object === object)!;
  return (
    <>
      <div class="field">
        <label htmlFor={id}>Object</label>
        <select id={id} class="input" value={object} onChange={(event) => set_object(event.currentTarget.value)}>
          <Choices title="Not found" of={all.filter(({ found }) => !found)} />
          <Choices title="Found" of={all.filter(({ found }) => found)} />
        </select>
      </div>
      <p class={`note why-reason ${shown.found ? "good" : "warn"}`} role="status">
        <b>{shown.found ? "Found." : "Not found."}</b> {sentence(shown.reason)}
      </p>
      <Evidence
        key={object}
        load={(signal) => explain_drawn(picture, object, signal)}
        width={of.width}
        height={of.height}
        object={object}
      />
      <div class="why-numbers">
        <Steps of={shown} />
        <GoverningOption name={shown.option} found={shown.found} />
      </div>
    </>
  );
}

function Choices({ title, of }: { title: string; of: Explanation[] }) {
  if (of.length === 0) return null;
  return (
    <optgroup label={title}>
      {of.map(({ object }) => (
        <option key={object}>{object}</option>
      ))}
    </optgroup>
  );
}

function Steps({ of }: { of: Explanation }) {
  return (
    <table class="steps">
      <caption class="hidden-text">What was left after each step</caption>
      <tbody>
        {steps_of(of).map(({ name, left, ended }) => (
          <tr key={name} class={ended ? "why-end" : undefined}>
            <th scope="row">
              {name} {ended && <span class="tag warn">it ends here</span>}
            </th>
            <td class="number">{left}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
