// The place of a picture: keeps its shape before the picture is there, so that nothing jumps.
import type { ComponentChildren } from "preact";
import "./stage.css";

interface Props {
  width: number;
  height: number;
  label: string;
  children: ComponentChildren;
}

export function Stage({ width, height, label, children }: Props) {
  return (
    <figure class="stage" aria-label={label} style={{ "--shape": String(width / height) }}>
      <div class="stage-picture">{children}</div>
    </figure>
  );
}
