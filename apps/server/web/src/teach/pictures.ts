// Pictures that wait to be taught.
export interface Waiting {
  file: File;
  url: string; // of the file, in this browser
  width: number;
  height: number;
}

/// Says which file could not be read as a picture.
export async function read_pictures(files: File[]): Promise<Waiting[]> {
  return Promise.all(
    files.map(async (file) => {
      const picture = await createImageBitmap(file).catch(() => {
        throw new Error(`“${file.name}” is no picture that this browser can read.`);
      });
      const { width, height } = picture;
      picture.close();
      return { file, url: URL.createObjectURL(file), width, height };
    }),
  );
}

/// "y036.jpg", "mug_y270.png": the side that a file name tells; null: it does not.
export function yaw_of_name(name: string): number | null {
  const found = /(?:^|[^a-z])y(?:aw)?_?(\d{1,3})\.[a-z]+$/i.exec(name);
  return found ? Number(found[1]) % 360 : null;
}

export const is_background_name = (name: string): boolean => /background|empty/i.test(name);
