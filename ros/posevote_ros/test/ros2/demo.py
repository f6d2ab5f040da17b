"""The demo's pictures as messages, and a node that calls and waits for answers."""
import os
import time

import rclpy
from action_msgs.msg import GoalStatus
from builtin_interfaces.msg import Time
from lifecycle_msgs.msg import State, Transition
from lifecycle_msgs.srv import ChangeState, GetState
from PIL import Image as Pillow
from posevote_msgs.action import Teach
from posevote_msgs.srv import ListObjects, RemoveObject
from rcl_interfaces.srv import SetParameters
from rclpy.action import ActionClient
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from sensor_msgs.msg import CameraInfo, CompressedImage, Image

FRAME = "camera_optical"
CAMERA = "/camera/image_raw"
NODE = "/posevote"
SCENE = "test/reading.jpg"
TIMEOUT_S = 60
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
ACTIVE, INACTIVE = State.PRIMARY_STATE_ACTIVE, State.PRIMARY_STATE_INACTIVE
UNCONFIGURED = State.PRIMARY_STATE_UNCONFIGURED
CONFIGURE, CLEANUP = Transition.TRANSITION_CONFIGURE, Transition.TRANSITION_CLEANUP
ACTIVATE, DEACTIVATE = Transition.TRANSITION_ACTIVATE, Transition.TRANSITION_DEACTIVATE


def path(name):
    return os.path.join(os.environ["POSEVOTE_DEMO"], name)


def image(name, encoding="rgb8"):
    """A raw picture of the demo set, rgb8 or mono8: of a smaller one less is lost on its way."""
    mode, channels = {"rgb8": ("RGB", 3), "mono8": ("L", 1)}[encoding]
    picture = Pillow.open(path(name)).convert(mode)
    message = Image(width=picture.width, height=picture.height, encoding=encoding,
                    step=channels * picture.width, data=picture.tobytes())
    message.header.frame_id = FRAME
    return message


def compressed(name):
    with open(path(name), "rb") as file:
        message = CompressedImage(format="jpeg", data=file.read())
    message.header.frame_id = FRAME
    return message


def camera_info(width=1280, height=960, focal_px=1100.0):
    cx, cy = (width - 1) / 2, (height - 1) / 2
    info = CameraInfo(width=width, height=height, distortion_model="plumb_bob", d=[0.0] * 5,
                      k=[focal_px, 0.0, cx, 0.0, focal_px, cy, 0.0, 0.0, 1.0],
                      p=[focal_px, 0.0, cx, 0.0, 0.0, focal_px, cy, 0.0, 0.0, 0.0, 1.0, 0.0])
    info.header.frame_id = FRAME
    return info


class Robot:
    """All that is around the node: its camera, and who asks it."""

    def __init__(self):
        rclpy.init()
        self.node = rclpy.create_node("robot")
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self.node)
        self._cameras = {}
        self._kept = {}
        self._stamp = 1000

    def close(self):
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.shutdown()

    def wait_until(self, condition, timeout_s=TIMEOUT_S):
        """The first true value of `condition()`, or its last."""
        end = time.monotonic() + timeout_s
        value = condition()
        while not value and time.monotonic() < end:
            self._executor.spin_once(timeout_sec=0.05)
            value = condition()
        return value

    def wait_for(self, future):
        assert self.wait_until(future.done), "no answer in time"
        return future.result()

    def call(self, name, kind, node=NODE, **fields):
        client = self.node.create_client(kind, node + "/" + name)
        try:
            assert client.wait_for_service(TIMEOUT_S), f"there is no service {name}"
            return self.wait_for(client.call_async(kind.Request(**fields)))
        finally:
            self.node.destroy_client(client)

    def collect(self, topic, kind, qos=10):
        """A list that grows with the topic's messages; the node knows that somebody listens."""
        messages = []
        self._kept[id(messages)] = self.node.create_subscription(kind, topic, messages.append, qos)
        assert self.wait_until(lambda: self.node.count_publishers(topic) > 0), f"no topic {topic}"
        return messages

    def forget(self, messages):
        self.node.destroy_subscription(self._kept.pop(id(messages)))

    # The camera.

    def camera(self, kind, topic=CAMERA):
        """The publisher of the camera's messages of this kind."""
        if topic not in self._cameras:
            self._cameras[topic] = self.node.create_publisher(kind, topic, qos_profile_sensor_data)
        return self._cameras[topic]

    def publish(self, message, topic=CAMERA):
        camera = self.camera(type(message), topic)
        assert self.wait_until(lambda: camera.get_subscription_count() > 0), "nobody subscribes"
        camera.publish(message)

    def ask(self, answers, message, topic=CAMERA):
        """The message among `answers` that has the stamp of the picture `message`."""
        self._stamp += 1
        message.header.stamp = Time(sec=self._stamp)
        end = time.monotonic() + TIMEOUT_S
        while time.monotonic() < end:  # the camera's quality of service allows that one is lost
            self.publish(message, topic)
            found = self.wait_until(
                lambda: [m for m in answers if m.header.stamp == message.header.stamp], 1)
            if found:
                return found[0]
        raise AssertionError("no answer with the picture's stamp")

    # The node.

    def state(self, node=NODE):
        return self.call("get_state", GetState, node).current_state.id

    def change_state(self, transition, node=NODE):
        return self.call("change_state", ChangeState, node,
                         transition=Transition(id=transition)).success

    def set_parameters(self, **values):
        """Why each was refused; "" for those that were set. `__` stands for a dot."""
        parameters = [Parameter(name.replace("__", "."), value=value).to_parameter_msg()
                      for name, value in values.items()]
        results = self.call("set_parameters", SetParameters, parameters=parameters).results
        return ["" if result.successful else result.reason or "refused" for result in results]

    def objects(self):
        return sorted(o.object for o in self.call("list_objects", ListObjects).database.objects)

    def forget_objects(self):
        for name in self.objects():
            assert self.call("remove_object", RemoveObject, object=name).success

    def start_teaching(self, feedback=None, **fields):
        """The goal's handle."""
        client = ActionClient(self.node, Teach, NODE + "/teach")
        self._kept[id(client)] = client
        assert client.wait_for_server(TIMEOUT_S), "there is no action teach"
        follow = (lambda message: feedback(message.feedback)) if feedback else None
        return self.wait_for(client.send_goal_async(Teach.Goal(**fields), follow))

    def teach(self, feedback=None, **fields):
        """The result of a goal that is taken, and whether it succeeded."""
        goal = self.start_teaching(feedback, **fields)
        assert goal.accepted
        answer = self.wait_for(goal.get_result_async())
        return answer.result, answer.status == GoalStatus.STATUS_SUCCEEDED

    def teach_poster(self):
        result, _ = self.teach(object="poster", method="whole",
                               images=[image("train/poster/cover.jpg")])
        assert result.success, result.message
