// The dial of false alarms: a number over many decades as a slider and as a sentence.
import type { Setting } from "../api/types";

/// Slider positions are tenths of a decade between careful and eager, as far as the option allows.
const kCareful = 1e-4;
const kEager = 100;

export interface DialRange {
  min: number;
  max: number;
}

export function dial_range({ min = 0, max = Infinity, value }: Setting): DialRange {
  const now = Number(value);
  return {
    min: to_position(Math.max(min, Math.min(kCareful, now))),
    max: to_position(Math.min(max, Math.max(kEager, now))),
  };
}

export const to_position = (value: number): number => Math.round(10 * Math.log10(value));

/// Two digits are enough for a dial.
export const to_value = (position: number): number => Number((10 ** (position / 10)).toPrecision(2));

export function in_words(per_1000: number): string {
  const pictures = 1000 / per_1000;
  if (pictures < 1.5) return "About every picture may show something that is not there.";
  const rounded = Number(pictures.toPrecision(2)).toLocaleString("en");
  return `About one picture in ${rounded} may show something that is not there.`;
}

export const is_dial = ({ name }: Setting): boolean => name.endsWith("false_alarms_per_1000_images");
