// Files by dropping, choosing, pasting, or - on a phone - by taking a photograph.
import { useEffect, useRef, useState } from "preact/hooks";
import "./drop_zone.css";

interface Props {
  title: string;
  multiple?: boolean;
  on_files: (files: File[]) => void;
}

export function DropZone({ title, multiple, on_files }: Props) {
  const chooser = useRef<HTMLInputElement>(null);
  const photo = useRef<HTMLInputElement>(null);
  const [over, set_over] = useState(false);
  const give = (list: FileList | null | undefined): void => {
    const files = [...(list ?? [])].filter((file) => file.type.startsWith("image/"));
    if (files.length) on_files(multiple ? files : files.slice(0, 1));
  };
  useEffect(() => {
    const on_paste = (event: ClipboardEvent): void => give(event.clipboardData?.files);
    addEventListener("paste", on_paste);
    return () => removeEventListener("paste", on_paste);
  }, [on_files]);
  return (
    <div
      class={over ? "drop-zone over" : "drop-zone"}
      onDragOver={(event) => {
        event.preventDefault();
        set_over(true);
      }}
      onDragLeave={() => set_over(false)}
      onDrop={(event) => {
        event.preventDefault();
        set_over(false);
        give(event.dataTransfer?.files);
      }}
    >
      <p>{title}</p>
      <div class="row">
        <button class="button" onClick={() => chooser.current!.click()}>
          Choose {multiple ? "pictures" : "a picture"}
        </button>
        <button class="button" onClick={() => photo.current!.click()}>
          Take a photo
        </button>
      </div>
      {[
        { ref: chooser, capture: undefined },
        { ref: photo, capture: "environment" as const },
      ].map(({ ref, capture }, i) => (
        <input
          key={i}
          ref={ref}
          type="file"
          hidden
          accept="image/*"
          capture={capture}
          multiple={multiple && !capture}
          onChange={(event) => {
            give(event.currentTarget.files);
            event.currentTarget.value = "";
          }}
        />
      ))}
    </div>
  );
}
