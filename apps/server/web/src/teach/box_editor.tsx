// A box drawn over a picture with the pointer, or typed in by keyboard. Pixels of the picture.
import { useRef, useState } from "preact/hooks";
import { Stage } from "../ui/stage";
import { box_between, type Box } from "./box";
import "./box_editor.css";

interface Props {
  picture: string;  // its address
  width: number;
  height: number;
  box: Box | null;
  on_change: (box: Box) => void;
}

const kSides = ["x", "y", "width", "height"] as const;

export function BoxEditor({ picture, width, height, box, on_change }: Props) {
  const area = useRef<HTMLDivElement>(null);
  const [start, set_start] = useState<[number, number] | null>(null);
  const place = (event: PointerEvent): [number, number] => {
    const bounds = area.current!.getBoundingClientRect();
    return [
      ((event.clientX - bounds.left) / bounds.width) * width,
      ((event.clientY - bounds.top) / bounds.height) * height,
    ];
  };
  const shown = box ?? { x: 0, y: 0, width, height };
  return (
    <div class="stack tight">
      <Stage width={width} height={height} label="Draw a box around the object">
        <img src={picture} alt="" draggable={false} />
        <div
          ref={area}
          class="box-area"
          onPointerDown={(event) => {
            area.current!.setPointerCapture(event.pointerId);
            set_start(place(event));
          }}
          onPointerMove={(event) => start && on_change(box_between(start, place(event), width, height))}
          onPointerUp={() => set_start(null)}
        >
          {box && (
            <svg viewBox={`0 0 ${width} ${height}`} preserveAspectRatio="none">
              <path
                class="box-dark"
                fill-rule="evenodd"
                d={`M0 0H${width}V${height}H0Z M${box.x} ${box.y}h${box.width}v${box.height}h${-box.width}Z`}
              />
              <rect class="box-edge" {...box} />
            </svg>
          )}
        </div>
      </Stage>
      <fieldset class="row">
        <legend class="small muted">Drag over the picture, or type the box in pixels</legend>
        {kSides.map((side) => (
          <label key={side} class="box-number small">
            {side}
            <input
              class="input"
              type="number"
              min={side === "x" || side === "y" ? 0 : 1}
              max={side === "x" || side === "width" ? width : height}
              value={Math.round(shown[side])}
              onChange={(event) => on_change({ ...shown, [side]: Number(event.currentTarget.value) })}
            />
          </label>
        ))}
      </fieldset>
    </div>
  );
}
