"""The demo's pictures as messages, and waiting for answers."""
import os
import threading

import actionlib
import rospy
from PIL import Image as Pillow
from posevote_msgs.msg import TeachAction
from sensor_msgs.msg import CameraInfo, CompressedImage, Image

FRAME = "camera_optical"


def path(name):
    return os.path.join(rospy.get_param("/demo"), name)


def image(name, stamp=None):
    """A raw picture of the demo set, rgb8."""
    picture = Pillow.open(path(name)).convert("RGB")
    message = Image(width=picture.width, height=picture.height, encoding="rgb8",
                    step=3 * picture.width, data=picture.tobytes())
    message.header.frame_id = FRAME
    message.header.stamp = stamp or rospy.Time.now()
    return message


def compressed(name, stamp=None):
    message = CompressedImage(format="jpeg")
    with open(path(name), "rb") as file:
        message.data = file.read()
    message.header.frame_id = FRAME
    message.header.stamp = stamp or rospy.Time.now()
    return message


def camera_info(width, height, focal_px=1100.0):
    info = CameraInfo(width=width, height=height, distortion_model="plumb_bob", D=[0.0] * 5)
    info.K = [focal_px, 0, (width - 1) / 2, 0, focal_px, (height - 1) / 2, 0, 0, 1]
    info.P = [focal_px, 0, (width - 1) / 2, 0, 0, focal_px, (height - 1) / 2, 0, 0, 0, 1, 0]
    info.header.frame_id = FRAME
    return info


class Collector:
    """Keeps the messages of a topic."""

    def __init__(self, topic, kind):
        self._changed = threading.Condition()
        self.messages = []
        self._subscriber = rospy.Subscriber(topic, kind, self._add)

    def _add(self, message):
        with self._changed:
            self.messages.append(message)
            self._changed.notify_all()

    def wait_for(self, accept, timeout_s=60):
        """The first message that `accept` takes, or None."""
        with self._changed:
            found = []

            def look():
                found[:] = [m for m in self.messages if accept(m)]
                return found
            self._changed.wait_for(look, timeout_s)
            return found[0] if found else None

    def close(self):
        self._subscriber.unregister()


class TeachClient:
    """The action teach. Unlike actionlib's SimpleActionClient it misses nothing that the node
    answers before send_goal has returned, as a goal that makes no sense is."""

    def __init__(self):
        self._client = actionlib.ActionClient("/posevote/teach", TeachAction)
        assert self._client.wait_for_server(rospy.Duration(30))

    def send_goal(self, goal, feedback_cb=None):
        done = threading.Event()

        def change(handle):
            if handle.get_comm_state() == actionlib.CommState.DONE:
                done.set()
        self._done = done
        self._handle = self._client.send_goal(
            goal, change, lambda _, feedback: feedback_cb and feedback_cb(feedback))

    def cancel_goal(self):
        # Not by the goal's name: a client that has done so takes it for lost when the next status
        # was sent before the goal came.
        self._client.cancel_goals_at_and_before_time(rospy.Time.now())

    def wait_for_result(self, timeout_s=60):
        """The result, or None; then the goal's status can be asked for, too."""
        return self._handle.get_result() if self._done.wait(timeout_s) else None

    def get_status(self):
        return self._handle.get_goal_status()


def wait_until(condition, timeout_s=60):
    rate = rospy.Rate(20)
    end = rospy.Time.now() + rospy.Duration(timeout_s)
    while not condition() and rospy.Time.now() < end and not rospy.is_shutdown():
        rate.sleep()
    return condition()
