// One view in full size with its quality card; its mask can be corrected.
import { useState } from "preact/hooks";
import { get_view, replace_view_mask, view_mask, view_picture, view_quality } from "../api/calls";
import type { ViewSummary } from "../api/types";
import { MaskEditor } from "../teach/mask_editor";
import { SilhouetteOverlay } from "../teach/silhouette_overlay";
import { Dialog } from "../ui/dialog";
import { use_loaded } from "../ui/loaded";
import { degrees } from "../ui/numbers";
import { Stage } from "../ui/stage";
import { QualityCard } from "./quality_card";
import "./view_dialog.css";

interface Props {
  object: string;
  view: ViewSummary;
  on_delete: () => void;
  on_close: () => void;
}

export function ViewDialog({ object, view, on_delete, on_close }: Props) {
  const { data, error } = use_loaded((signal) => view_quality(object, view.view, signal), []);
  const { data: taught } = use_loaded((signal) => get_view(object, view.view, signal), []);
  const [correcting, set_correcting] = useState(false);
  const picture = view_picture(object, view.view);
  const mask = view_mask(object, view.view);
  if (correcting)
    return (
      <MaskEditor
        picture={picture}
        mask={mask}
        width={view.width}
        height={view.height}
        on_save={(corrected) => replace_view_mask(object, view.view, corrected)}
        on_close={on_close}
      />
    );
  return (
    <Dialog title={`${object}, ${view.yaw == null ? `view ${view.view}` : degrees(view.yaw)}`} wide on_close={on_close}>
      <div class="view-dialog">
        <Stage width={view.width} height={view.height} label="The taught picture">
          <img src={picture} alt={`${object} as taught`} />
          <SilhouetteOverlay of={taught} />
        </Stage>
        <div class="stack">
          <QualityCard quality={data} problem={error?.message} />
          <p class="muted small">
            Found by {view.method}, from {view.source || "the camera"}, {new Date(view.taught_at).toLocaleString()}.
          </p>
          <div class="row">
            <button class="button" onClick={() => set_correcting(true)}>
              Correct the mask
            </button>
            <button class="button danger" onClick={on_delete}>
              Delete view
            </button>
          </div>
        </div>
      </div>
    </Dialog>
  );
}
