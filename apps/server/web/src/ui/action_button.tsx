// A button that keeps the focus while it cannot be used: `disabled` would throw the keyboard out.
interface Props {
  can: boolean;
  on_click: () => void;
  children: string;
}

export function ActionButton({ can, on_click, children }: Props) {
  return (
    <button class="button primary" aria-disabled={!can} onClick={() => can && on_click()}>
      {children}
    </button>
  );
}
