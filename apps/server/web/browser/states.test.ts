import { cpSync, mkdtempSync, renameSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { expect, test } from "vitest";
import { demo, Studio } from "./studio";

const kToken = "a token of enough letters";

test("settings are changed, are in force, and go back to their defaults", async () => {
  const studio = await Studio.start();
  const page = await studio.open("#/settings");
  const dial = page.getByRole("slider");
  await dial.focus();
  await dial.press("ArrowLeft");
  await page.getByText("1 change not in force yet").waitFor();
  await studio.shoot(page, "settings");
  await page.getByRole("button", { name: "Apply" }).click();
  await page.getByText("The settings are in force").waitFor();
  const { settings } = await studio.ask<{ settings: { value: number }[] }>("GET", "settings");
  expect(settings[0]!.value).toBeCloseTo(3.2);
  await page.reload();
  await page.getByText("3.2 in 1000").waitFor();
  await studio.stop();
});

test("unknown parts are drawn when that is wanted, nothing when recognition is off", async () => {
  const studio = await Studio.start();
  await studio.teach("poster", ["cover"]);
  await studio.show("test/strangers.jpg");
  const page = await studio.open("#/live");
  await page.getByText("Nothing that was taught is in the picture").waitFor();
  expect(await page.locator(".found").count()).toBe(0);
  await studio.change({ "recognize.unknown": true });
  await page.locator(".found.unknown").first().waitFor();
  await page.getByText("Something unknown").first().hover();
  await page.locator(".found.unknown.chosen").waitFor();
  await studio.shoot(page, "unknown");
  await studio.change({ "live.recognize": false });
  await page.getByText("Recognition is switched off").waitFor();
  expect(await page.locator(".found").count()).toBe(0);
  await studio.stop();
});

test("without the token nobody enters; with it everybody", async () => {
  const folder = mkdtempSync(join(tmpdir(), "posevote-token-"));
  writeFileSync(join(folder, "token"), kToken);
  const studio = await Studio.start({ arguments: ["--camera", "client", "--token-file", join(folder, "token")] });
  const page = await studio.open("#/objects");
  await page.getByLabel("Token").fill("wrong");
  await page.getByRole("button", { name: "Enter" }).click();
  await page.getByRole("alert").filter({ hasText: /./ }).waitFor();
  await studio.shoot(page, "login");
  await page.getByLabel("Token").fill(kToken);
  await page.getByRole("button", { name: "Enter" }).click();
  await page.getByRole("heading", { name: "Objects" }).waitFor();
  await page.goto(`${studio.address}/#/settings`);
  await page.getByRole("button", { name: "Log out" }).click();
  await page.getByLabel("Token").waitFor();
  await studio.stop();
});

test("a folder of pictures is a camera, and its objects are found", async () => {
  const studio = await Studio.start({ arguments: ["--camera", join(demo, "test"), "--fps", "1"] });
  await studio.teach("mug", ["y000", "y030", "y330", "y300"]);
  const page = await studio.open("#/live");
  await page.locator(".detection", { hasText: "mug" }).waitFor();
  await page.getByLabel("Source of the picture").selectOption("client");
  await page.getByText("Waiting for the first picture").waitFor();
  await studio.stop();
});

test("a camera that is lost is said, with the reason, and comes back by itself", async () => {
  const camera = join(mkdtempSync(join(tmpdir(), "posevote-camera-")), "pictures");
  cpSync(join(demo, "test"), camera, { recursive: true });
  const studio = await Studio.start({ arguments: ["--camera", camera] });
  await studio.teach("poster", ["cover"]);
  const page = await studio.open("#/live");
  await expect.poll(() => page.locator(".stage-message").count()).toBe(0);
  renameSync(camera, `${camera}-away`);
  const message = page.locator(".stage-message", { hasText: "Camera lost" });
  await message.waitFor();
  expect(await message.textContent()).toContain("pictures");
  await page.getByText("There is no picture now").waitFor();
  await studio.shoot(page, "camera-lost");
  renameSync(`${camera}-away`, camera);
  await expect.poll(() => page.locator(".stage-message").count()).toBe(0);
  await studio.stop();
});

test("a server that went away is said, and the picture keeps its place", async () => {
  const studio = await Studio.start({ arguments: ["--camera", join(demo, "test")] });
  const page = await studio.open("#/live");
  await expect.poll(() => page.locator(".stage-message").count()).toBe(0);
  const before = await page.locator(".stage").boundingBox();
  studio.kill_server();
  await page.getByText("The server does not answer").waitFor();
  expect(await page.locator(".stage").boundingBox()).toEqual(before);
  await studio.shoot(page, "server-gone");
  await page.goto(`${studio.address}/#/objects/mug`).catch(() => undefined); // the page is still there
  await page.getByText("The object could not be loaded").waitFor();
  await studio.stop();
});

test("this device's camera teaches, and serves as the live source", async () => {
  const studio = await Studio.start({
    browser_flags: ["--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream"],
  });
  const page = await studio.open("#/teach");
  await page.getByText("This device", { exact: true }).click();
  await page.getByRole("button", { name: "The table is empty" }).click();
  await page.locator(".verdict.good, .verdict.warn, .verdict.bad").waitFor();
  await studio.shoot(page, "device");
  await page.goto(`${studio.address}/#/live`);
  await page.getByRole("button", { name: "Send this device's camera" }).click();
  await expect.poll(() => page.locator(".stage-message").count()).toBe(0);
  await studio.stop();
});

test("a browser that allows no camera is told what else there is", async () => {
  const studio = await Studio.start();
  const page = await studio.open("#/teach");
  await page.getByText("This device", { exact: true }).click();
  await page.getByRole("heading", { name: "No camera" }).waitFor();
  await studio.stop();
});
