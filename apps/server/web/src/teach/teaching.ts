// A teach session as the page sees it: what is done, what comes next. No drawing here.
import { signal } from "@preact/signals";
import * as api from "../api/calls";
import type { Proposal, Saved, TeachSession } from "../api/types";
import { apart, wrap } from "./sides";

export const kTurnDeg = 30;

export class Teaching {
  readonly session = signal<TeachSession | null>(null);
  readonly proposal = signal<Proposal | null>(null);
  /// Side that the next view is of; null: not known, as for a cover.
  readonly yaw = signal<number | null>(0);
  readonly begun = signal(performance.now());
  readonly taking = signal(false);
  /// Why the last look gave nothing; empty when it did.
  readonly trouble = signal("");

  /// `of`: an object that gets further views; none: a new one.
  constructor(private readonly of?: string) {}

  /// Goes on with a session that is there already.
  adopt(session: TeachSession): void {
    this.session.value = session;
    this.begun.value = performance.now() - session.seconds * 1000;
    this.yaw.value = next_side(session);
  }

  async take_background(picture?: Blob): Promise<void> {
    this.session.value = await api.set_background(await this.id(), picture);
    this.proposal.value = null;
  }

  /// Looks for the object; keeps nothing. One look at a time: the server has one proposal in hand.
  look(way: api.Proposing): Promise<Proposal> {
    const looking = this.settled().then(async () => api.propose(await this.id(), way));
    this.looking = looking;
    return looking.then(
      (found) => {
        this.trouble.value = "";
        return (this.proposal.value = found);
      },
      (error: Error) => {
        this.trouble.value = error.message;
        throw error;
      },
    );
  }

  /// When the look under way, if any, has its answer.
  settled(): Promise<unknown> {
    return this.looking.catch(() => undefined);
  }

  /// Looks once more, at the picture of this moment, and keeps it. False when it is refused.
  async take(way: api.Proposing): Promise<boolean> {
    this.taking.value = true;
    try {
      const found = await this.look({ ...way, yaw: this.yaw.value ?? undefined });
      if (found.usable) await this.accept();
      return found.usable;
    } finally {
      this.taking.value = false;
    }
  }

  /// Keeps the proposal in hand.
  async accept(): Promise<void> {
    this.taking.value = true;
    try {
      const session = await api.accept_view(await this.id(), this.yaw.value ?? undefined);
      this.session.value = session;
      this.proposal.value = null;
      if (this.yaw.value != null) this.yaw.value = next_side(session);
    } finally {
      this.taking.value = false;
    }
  }

  async correct_mask(mask: Blob): Promise<void> {
    this.proposal.value = await api.replace_proposal_mask(await this.id(), mask);
  }

  async remove(view: string): Promise<void> {
    this.session.value = await api.remove_session_view(await this.id(), view);
  }

  async restore(view: string): Promise<void> {
    this.session.value = await api.restore_session_view(await this.id(), view);
  }

  async save(name: string, add_to_existing: boolean): Promise<Saved> {
    return api.save_session(await this.id(), name, add_to_existing);
  }

  /// The page goes: a session that has views can be gone on with later, an empty one would only take a place.
  leave(): void {
    if (this.session.value?.views.length === 0) void this.discard().catch(() => undefined);
  }

  /// Nothing is asked any more: a look that was about to begin would begin a session, too.
  close(): void {
    this.closed = true;
    this.leave();
  }

  async discard(): Promise<void> {
    const left = this.session.value;
    this.session.value = this.proposal.value = null;
    this.begun.value = performance.now();
    this.yaw.value = 0;
    if (left) await api.discard_session(left.session);
  }

  private closed = false;
  private looking: Promise<unknown> = Promise.resolve();
  private beginning: Promise<TeachSession> | null = null;

  private async id(): Promise<string> {
    if (this.closed) throw new Error("This page was left.");
    if (!this.session.value) {
      this.beginning ??= api.create_session(this.of).finally(() => (this.beginning = null));
      const session = await this.beginning;
      if (!this.session.value) {
        this.session.value = session;
        if (session.known_yaws.length > 0) this.yaw.value = next_side(session);
      }
    }
    return this.session.value!.session;
  }
}

/// Sides of which only views were taken that add little.
export function idle_sides(session: TeachSession): number[] {
  const useful = [...session.known_yaws, ...session.views.filter((view) => !view.adds_little).map(({ yaw }) => yaw)];
  return session.views.flatMap(({ yaw, adds_little }) =>
    yaw != null && adds_little && !useful.some((other) => other != null && apart(other, yaw) < kTurnDeg / 2) ? [yaw] : [],
  );
}

/// Sides that are known: of the views taken, after those that the object had before.
export const sides_of = ({ known_yaws, views }: TeachSession): number[] => [
  ...known_yaws,
  ...views.map(({ yaw }) => yaw).filter((yaw) => yaw != null),
];

/// Where to turn the object next: into the largest gap, else on from the last view.
export function next_side(session: TeachSession): number {
  const known = sides_of(session);
  if (known.length === 0) return 0;
  const next = session.next_yaw ?? known.at(-1)! + kTurnDeg;
  return wrap(Math.round(next / kTurnDeg) * kTurnDeg);
}
