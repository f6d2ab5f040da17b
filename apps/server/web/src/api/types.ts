// The schemas of openapi.yaml that the page reads, under the same names.
export type Point = [number, number];
export type Box = [number, number, number, number];

export interface Access {
  token_needed: boolean;
  authenticated: boolean;
  version: string;
}

export interface Source {
  source: string;
  choices: string[];
}

export interface Live {
  source: string;
  state: "waiting" | "running" | "lost";
  message: string;
  frame: number;
  width: number;
  height: number;
  source_fps: number;
  recognizing: boolean;
  recognized_fps: number;
  objects: number;
  version: number;
}

export interface Detection {
  object: string;
  view: string;
  confidence: number;  // Eq. 11: share of the features in its area that agree
  probability: number;  // 0: none is computed, as with the preset of the paper
  inliers: number;
  features_in_area: number;
  outline: Point[];
  box: Box;
  alternatives?: string[];
}

export interface UnknownRegion {
  box: Box;
  features: number;
}

export interface Recognition {
  frame?: number;
  age_ms?: number;
  width: number;
  height: number;
  time_ms: Record<"detect" | "match" | "vote" | "verify" | "total", number>;
  counts: Record<"features" | "matched" | "clustered" | "verified", number>;
  detections: Detection[];
  unknown?: UnknownRegion[];
}

export interface Explanation {
  object: string;
  found: boolean;
  stage: "found" | "features" | "similar" | "ratio" | "votes" | "pose" | "chance" | "object" | "place" | "competition";
  reason: string;
  option: string;
  scene_features: number;
  similar: number;
  matched: number;
  largest_bin: number;
  clusters: number;
  best?: Detection;
}

export interface Explanations {
  width: number;
  height: number;
  explanations: Explanation[];
}

export interface ObjectSummary {
  object: string;
  views: number;
  features: number;
  last_taught_at: string;
  cover?: string;
}

export interface ViewSummary {
  view: string;
  yaw: number | null;
  width: number;
  height: number;
  features: number;
  coverage: number;
  method: string;
  source: string;
  taught_at: string;
}

export interface TakenView extends ViewSummary {
  adds_little: boolean; // most of it is known from the views before it
}

export interface View extends ViewSummary {
  outline: Point[];
}

export interface TaughtObject {
  object: string;
  views: ViewSummary[];
  next_yaw: number | null;
}

export interface Quality {
  features: number;
  coverage: number;
  self_similarity: number | null;
  size_px: number;
  smallest_size_px: number | null;
  redundancy: number;
  next_yaw: number | null;
  advice: string[];
}

export interface Undo {
  undo: string;
  expires_s: number;
}

export interface Deletion extends Undo {
  age_s: number;
  object: string;
  view: string | null; // null: all of them
  into: string | null; // that it was merged into
}

export interface Impostor {
  impostor: string;
  features: number;
  source: string;
  taught_at: string;
}

export interface TeachSession {
  session: string;
  object: string | null; // that gets further views
  known_yaws: number[]; // of the views that it has already
  seconds: number;
  background: boolean;
  views: TakenView[];
  next_yaw: number | null;
  enough: boolean;
}

export interface Proposal {
  usable: boolean;
  width: number;
  height: number;
  features: number;
  outline: Point[];
  quality: Quality | null;
  adds_little?: boolean;
  advice: string[];
}

export interface Saved {
  object: string;
  views_added: number;
  views_known: number;
  seconds: number;
}

export interface Transfer {
  objects: number;
  views_added: number;
  views_known: number;
}

export type SettingValue = boolean | number | string;

export interface Setting {
  name: string;
  group: string;
  level: "basic" | "expert";
  type: "boolean" | "integer" | "number" | "text";
  value: SettingValue;
  default: SettingValue;
  min?: number;
  max?: number;
  choices?: string[];
  unit: string;
  help: string;
  fixed?: boolean;
}
