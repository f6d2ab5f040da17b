// Places that somebody marked as wrong; each can be taken back.
import { delete_impostor, impostor_picture, list_impostors } from "../api/calls";
import { objects_version } from "../api/events";
import { use_loaded } from "../ui/loaded";
import { attempt } from "../ui/toast";

export function Impostors() {
  const { data, reload } = use_loaded(list_impostors, [objects_version.value]);
  return (
    <section class="card stack" aria-label="Marked as wrong">
      <h2>Marked as wrong</h2>
      {data?.impostors.length ? (
        <ul class="impostors">
          {data.impostors.map(({ impostor, source }) => (
            <li key={impostor}>
              <img src={impostor_picture(impostor)} alt={`Marked in ${source || "the live picture"}`} />
              <button class="button plain small" onClick={() => void attempt(() => delete_impostor(impostor)).then(reload)}>
                Forget it
              </button>
            </li>
          ))}
        </ul>
      ) : (
        <p class="muted">Nothing. A false detection can be marked in the live picture or under “Try”.</p>
      )}
    </section>
  );
}
