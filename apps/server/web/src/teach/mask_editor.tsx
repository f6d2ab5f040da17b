// Correcting a mask by brush: pointer, or arrow keys and Space on the picture.
import { useEffect, useRef, useState } from "preact/hooks";
import { ApiError, fetch_picture } from "../api/client";
import { Dialog } from "../ui/dialog";
import { use_problem } from "../ui/problem";
import { Stage } from "../ui/stage";
import { Painting } from "./painting";
import { use_brush } from "./use_brush";
import "./mask_editor.css";

interface Props {
  picture: string;
  mask: string;
  width: number;
  height: number;
  on_save: (mask: Blob) => Promise<void>;
  on_close: () => void;
}

export function MaskEditor({ picture, mask, width, height, on_save, on_close }: Props) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const [painting, set_painting] = useState<Painting | null>(null);
  const [add, set_add] = useState(false);
  const [size, set_size] = useState(Math.round(width / 16));
  const [can_go_back, set_can_go_back] = useState(false);
  const problem = use_problem();
  const brush = use_brush(painting, { width, height, size, add }, () => set_can_go_back(true));
  useEffect(() => {
    void problem.run(async () => {
      set_painting(new Painting(canvas.current!, { width, height }, await mask_or_nothing(mask)));
    });
  }, [mask]);
  return (
    <Dialog title="Correct the mask" wide on_close={on_close}>
      <p class="muted small">
        The dark part is not the object. Paint with the pointer; on the keyboard, focus the picture, move with the
        arrow keys and paint with Space.
      </p>
      <Stage width={width} height={height} label="Picture with mask">
        <img src={picture} alt="" />
        <canvas
          ref={canvas}
          class="mask-canvas"
          tabIndex={0}
          role="application"
          aria-label="Mask; arrow keys move the brush, Space paints"
          {...brush.handlers}
        />
        <span
          class="mask-brush"
          style={{
            left: `${(brush.at[0] / width) * 100}%`,
            top: `${(brush.at[1] / height) * 100}%`,
            width: `${(size / width) * 100}%`,
          }}
        />
      </Stage>
      <div class="mask-tools">
        <fieldset class="row" aria-label="Brush">
          <label class="choice">
            <input type="radio" name="brush" checked={add} onChange={() => set_add(true)} /> Add to the object
          </label>
          <label class="choice">
            <input type="radio" name="brush" checked={!add} onChange={() => set_add(false)} /> Take away
          </label>
        </fieldset>
        <label class="field">
          <span class="small">Size of the brush: {size} px</span>
          <input
            type="range"
            min={2}
            max={Math.round(width / 4)}
            value={size}
            onInput={(event) => set_size(Number(event.currentTarget.value))}
          />
        </label>
      </div>
      {problem.shown}
      <div class="row spread">
        <button
          class="button"
          disabled={!can_go_back}
          onClick={() => {
            painting!.step_back();
            set_can_go_back(painting!.can_go_back);
          }}
        >
          Undo stroke
        </button>
        <button
          class="button primary"
          disabled={!painting || !can_go_back || problem.busy}
          onClick={() =>
            void problem.run(async () => {
              await on_save(await painting!.to_png());
              on_close();
            })
          }
        >
          Use this mask
        </button>
      </div>
    </Dialog>
  );
}

/// Where no object was found there is no mask: painting begins with nothing.
async function mask_or_nothing(mask: string): Promise<ImageBitmap | null> {
  try {
    return await fetch_picture(mask);
  } catch (error) {
    if (error instanceof ApiError && error.status === 404) return null;
    throw error;
  }
}
