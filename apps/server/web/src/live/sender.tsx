// Sends this device's camera to the server, a frame when the one before it has arrived.
import { useEffect } from "preact/hooks";
import { post_frame } from "../api/calls";
import { use_device_camera } from "../ui/device_camera";
import { say_error } from "../ui/toast";
import "./sender.css";

export function Sender({ on_end }: { on_end: () => void }) {
  const camera = use_device_camera();
  useEffect(() => {
    if (!camera.ready) return;
    let going = true;
    const send = async (): Promise<void> => {
      while (going) await post_frame(await camera.grab());
    };
    send().catch((error) => {
      say_error(error);
      on_end();
    });
    return () => {
      going = false;
    };
  }, [camera.ready]);
  return (
    <div class="note sender small">
      <video ref={camera.video} muted playsInline width={96} height={72} />
      <span role="status">
        {camera.problem || (camera.ready ? "What this camera sees is sent to the server." : "Asking for the camera …")}
      </span>
    </div>
  );
}
