// The two cameras: the server's, and this device's own.
import { live } from "../api/events";
import { LivePicture } from "../live/live_picture";
import { use_device_camera } from "../ui/device_camera";
import { Stage } from "../ui/stage";
import { SilhouetteOverlay } from "./silhouette_overlay";
import { Turntable } from "./turntable";
import type { Teaching } from "./teaching";

export function CameraTeach({ teaching }: { teaching: Teaching }) {
  return (
    <div class="camera-teach">
      <LivePicture label="Live picture with what would be learned">
        <SilhouetteOverlay of={teaching.proposal.value} />
      </LivePicture>
      <Turntable teaching={teaching} ready={live.value?.state === "running"} />
    </div>
  );
}

export function DeviceTeach({ teaching }: { teaching: Teaching }) {
  const camera = use_device_camera();
  return (
    <div class="camera-teach">
      <Stage {...camera.size} label="This device's camera">
        <video ref={camera.video} muted playsInline />
        <SilhouetteOverlay of={teaching.proposal.value} />
        {!camera.ready && (
          <div class="stage-message" role="status">
            <h2>{camera.problem ? "No camera" : "Asking for the camera"}</h2>
            <p>{camera.problem || "Your browser asks whether this page may use it."}</p>
            {camera.problem && <p>Under “Pictures” a photo can be taken instead.</p>}
          </div>
        )}
      </Stage>
      <Turntable teaching={teaching} ready={camera.ready} grab={camera.grab} />
    </div>
  );
}
