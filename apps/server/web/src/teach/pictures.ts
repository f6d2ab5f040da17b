// Pictures that wait to be taught.
export interface Waiting {
  file: File;
  url: string; // of the file, in this browser
  width: number;
  height: number;
}

/// One after the other, for decoded pictures are large. Says which file could not be read.
export async function read_pictures(files: File[]): Promise<Waiting[]> {
  const read: Waiting[] = [];
  for (const file of files) {
    const picture = await createImageBitmap(file).catch(() => {
      throw new Error(`“${file.name}” is no picture that this browser can read.`);
    });
    const { width, height } = picture;
    picture.close();
    read.push({ file, url: URL.createObjectURL(file), width, height });
  }
  return read;
}

/// "y036.jpg", "mug_y270.png": the side that a file name tells; null: it does not.
export function yaw_of_name(name: string): number | null {
  const found = /(?:^|[^a-z])y(?:aw)?_?(\d{1,3})\.[a-z]+$/i.exec(name);
  return found ? Number(found[1]) % 360 : null;
}

export const is_background_name = (name: string): boolean => /background|empty/i.test(name);
