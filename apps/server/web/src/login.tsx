// The door: the token that the server was started with.
import { useState } from "preact/hooks";
import { get_access, login } from "./api/calls";
import { access } from "./api/client";

export function Login() {
  const [token, set_token] = useState("");
  const [problem, set_problem] = useState("");
  async function enter(event: Event): Promise<void> {
    event.preventDefault();
    try {
      await login(token.trim());
      access.value = await get_access();
    } catch (error) {
      set_problem((error as Error).message);
    }
  }
  return (
    <main class="login">
      <form class="card stack" onSubmit={(event) => void enter(event)}>
        <h1>posevote studio</h1>
        <p class="muted">This server asks for its token: the first line of the file that “posevote serve” was started with.</p>
        <label class="field">
          <span class="label">Token</span>
          <input
            class="input"
            type="password"
            autocomplete="current-password"
            required
            autofocus
            value={token}
            aria-describedby="login-problem"
            onInput={(event) => set_token(event.currentTarget.value)}
          />
        </label>
        <p id="login-problem" class="note bad" role="alert" hidden={!problem}>
          {problem}
        </p>
        <button class="button primary">Enter</button>
      </form>
    </main>
  );
}
