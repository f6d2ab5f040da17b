import { expect, test } from "vitest";
import { is_background_name, yaw_of_name } from "./pictures";

test("a file name may tell the side", () => {
  expect(["y036.jpg", "mug_y270.png", "mug-yaw_30.jpeg", "y360.jpg"].map(yaw_of_name)).toEqual([36, 270, 30, 0]);
  expect(["cover.jpg", "IMG_2030.jpg", "toy36.jpg", "y1234.jpg", "y036"].map(yaw_of_name)).toEqual(
    Array(5).fill(null),
  );
});

test("a file name may tell that it is the empty table", () => {
  expect(["background.jpg", "Empty table.png", "mug.jpg"].map(is_background_name)).toEqual([true, true, false]);
});
