// The operations of openapi.yaml that the page uses.
import { ask, ask_picture, path_of } from "./client";
import type * as t from "./types";

const kThumbnail = 320;

export const get_access = () => ask<t.Access>("GET", ["session"]);
export const login = (token: string) => ask("POST", ["login"], { json: { token } });
export const logout = () => ask("POST", ["logout"]);

export const get_source = (signal: AbortSignal) => ask<t.Source>("GET", ["source"], { signal });
export const set_source = (source: string) => ask<t.Source>("PUT", ["source"], { json: { source } });
export const post_frame = (body: Blob) => ask("POST", ["live", "frame"], { body });

export const recognize = (body: Blob) => ask<t.Recognition>("POST", ["recognize"], { body });

export const explain = (body: Blob, signal: AbortSignal) => ask<t.Explanations>("POST", ["explain"], { body, signal });
export const explain_drawn = (body: Blob, object: string, signal: AbortSignal) =>
  ask_picture("POST", ["explain"], { query: { object, format: "jpeg" }, body, signal });
/// A frame in full size: the newest, or that of a result.
export const get_frame = (frame?: number) => ask_picture("GET", ["frame.jpg"], { query: { frame } });

export const list_impostors = (signal: AbortSignal) =>
  ask<{ impostors: t.Impostor[] }>("GET", ["impostors"], { signal });
export const add_impostor = (found: t.Detection, of: { frame?: number; body?: Blob }) =>
  ask<t.Impostor>("POST", ["impostors"], { query: { frame: of.frame, box: found.box.join(",") }, body: of.body });
export const delete_impostor = (id: string) => ask("DELETE", ["impostors", id]);
export const impostor_picture = (id: string) => path_of(["impostors", id, "picture"], { width: kThumbnail });

export const list_objects = (signal: AbortSignal) =>
  ask<{ objects: t.ObjectSummary[] }>("GET", ["objects"], { signal });
export const get_object = (name: string, signal: AbortSignal) =>
  ask<t.TaughtObject>("GET", ["objects", name], { signal });
export const rename_object = (name: string, object: string) =>
  ask<t.TaughtObject>("PATCH", ["objects", name], { json: { object } });
export const merge_object = (name: string, into: string) =>
  ask<t.Undo>("POST", ["objects", name, "merge"], { json: { into } });
export const delete_object = (name: string) => ask<t.Undo>("DELETE", ["objects", name]);
export const delete_view = (name: string, view: string) => ask<t.Undo>("DELETE", ["objects", name, "views", view]);
export const list_deletions = (signal: AbortSignal) =>
  ask<{ deletions: t.Deletion[] }>("GET", ["undo"], { signal });
export const undo = (id: string) => ask<t.TaughtObject>("POST", ["undo", id]);
export const get_view = (name: string, view: string, signal: AbortSignal) =>
  ask<t.View>("GET", ["objects", name, "views", view], { signal });
export const view_quality = (name: string, view: string, signal: AbortSignal) =>
  ask<t.Quality>("GET", ["objects", name, "views", view, "quality"], { signal });
export const view_picture = (name: string, view: string, width?: number) =>
  path_of(["objects", name, "views", view, "picture"], { width });
export const view_thumbnail = (name: string, view: string) => view_picture(name, view, kThumbnail);
export const view_mask = (name: string, view: string) => path_of(["objects", name, "views", view, "mask"]);
export const replace_view_mask = (name: string, view: string, body: Blob) =>
  ask("PUT", ["objects", name, "views", view, "mask"], { body });

export const export_link = (object?: string) => path_of(["export"], { object });
export const import_objects = (body: Blob, existing: string) =>
  ask<t.Transfer>("POST", ["import"], { query: { existing }, body });

const kSessions = "teach-sessions";
export const list_sessions = (signal: AbortSignal) =>
  ask<{ sessions: t.TeachSession[] }>("GET", [kSessions], { signal });
/// `object`: it gets further views; none: a new one.
export const create_session = (object?: string) => ask<t.TeachSession>("POST", [kSessions], { query: { object } });
export const discard_session = (id: string) => ask("DELETE", [kSessions, id], { keepalive: true });
export const set_background = (id: string, body?: Blob) =>
  ask<t.TeachSession>("PUT", [kSessions, id, "background"], { body });

export interface Proposing {
  picture?: Blob; // none: the server's camera
  roi?: string;
  whole?: boolean;
  yaw?: number;
}

export const propose = (id: string, { picture, ...query }: Proposing) =>
  ask<t.Proposal>("POST", [kSessions, id, "proposal"], { query: { ...query }, body: picture });
export const proposal_picture = (id: string) => path_of([kSessions, id, "proposal", "picture"]);
export const proposal_mask = (id: string) => path_of([kSessions, id, "proposal", "mask"]);
export const replace_proposal_mask = (id: string, body: Blob) =>
  ask<t.Proposal>("PUT", [kSessions, id, "proposal", "mask"], { body });
export const accept_view = (id: string, yaw?: number) =>
  ask<t.TeachSession>("POST", [kSessions, id, "views"], { query: { yaw } });
export const remove_session_view = (id: string, view: string) =>
  ask<t.TeachSession>("DELETE", [kSessions, id, "views", view]);
export const restore_session_view = (id: string, view: string) =>
  ask<t.TeachSession>("POST", [kSessions, id, "views", view, "restore"]);
export const session_view_thumbnail = (id: string, view: string) =>
  path_of([kSessions, id, "views", view, "picture"], { width: kThumbnail });
export const save_session = (id: string, object: string, add_to_existing: boolean) =>
  ask<t.Saved>("POST", [kSessions, id, "save"], { json: { object, add_to_existing } });

export const get_settings = (signal: AbortSignal) => ask<{ settings: t.Setting[] }>("GET", ["settings"], { signal });
export const change_settings = (changed: Record<string, t.SettingValue | null>) =>
  ask<{ settings: t.Setting[] }>("PATCH", ["settings"], { json: changed });
