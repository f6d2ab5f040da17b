#!/usr/bin/python3
"""Writes a bag of the demo's scenes, as a calibrated camera would send them.

usage: make_demo_bag.py DEMO_FOLDER BAG [--seconds 2] [--rate 10] [--raw]

Topics: /camera/image_raw/compressed (the JPEG files as they are; with --raw: /camera/image_raw,
which needs python3-pil), /camera/camera_info and /tf, in which camera_link looks along x, with z up.
Each scene is shown for some seconds. The bag is of ROS 2 if ROS_VERSION is 2, else of ROS 1.
"""
import argparse
import glob
import os
import sys

from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import CameraInfo, CompressedImage, Image
from tf2_msgs.msg import TFMessage

FRAME = "camera_optical"
WIDTH, HEIGHT = 1280, 960
FOCAL_PX = 1100.0  # of the camera that the scenes were rendered with, about
SECOND = 1000000000


class Bag1:
    def __init__(self, path):
        import rosbag
        self._bag = rosbag.Bag(path, "w")

    def time(self, stamp_ns):
        import genpy
        return genpy.Time(stamp_ns // SECOND, stamp_ns % SECOND)

    def write(self, topic, message, stamp_ns):
        self._bag.write(topic, message, self.time(stamp_ns))

    def close(self):
        self._bag.close()


class Bag2:
    def __init__(self, path):
        import rosbag2_py
        self._rosbag = rosbag2_py
        self._bag = rosbag2_py.SequentialWriter()
        self._bag.open(rosbag2_py.StorageOptions(uri=path),
                       rosbag2_py.ConverterOptions("cdr", "cdr"))
        self._topics = set()

    def time(self, stamp_ns):
        from builtin_interfaces.msg import Time
        return Time(sec=stamp_ns // SECOND, nanosec=stamp_ns % SECOND)

    def write(self, topic, message, stamp_ns):
        from rclpy.serialization import serialize_message
        if topic not in self._topics:
            kind = type(message).__module__.split(".")[0] + "/msg/" + type(message).__name__
            self._bag.create_topic(self._rosbag.TopicMetadata(
                id=0, name=topic, type=kind, serialization_format="cdr"))
            self._topics.add(topic)
        self._bag.write(topic, serialize_message(message), stamp_ns)

    def close(self):
        del self._bag  # writes what is left


def camera_info():
    cx, cy = (WIDTH - 1) / 2, (HEIGHT - 1) / 2
    info = CameraInfo(width=WIDTH, height=HEIGHT, distortion_model="plumb_bob")
    matrices = {"d": [0.0] * 5,
                "k": [FOCAL_PX, 0.0, cx, 0.0, FOCAL_PX, cy, 0.0, 0.0, 1.0],
                "r": [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
                "p": [FOCAL_PX, 0.0, cx, 0.0, 0.0, FOCAL_PX, cy, 0.0, 0.0, 0.0, 1.0, 0.0]}
    for name, values in matrices.items():
        setattr(info, name if hasattr(info, name) else name.upper(), values)
    return info


def camera_transform(stamp):
    transform = TransformStamped(child_frame_id=FRAME)
    transform.header.frame_id = "camera_link"
    transform.header.stamp = stamp
    rotation = transform.transform.rotation
    rotation.x, rotation.y, rotation.z, rotation.w = -0.5, 0.5, -0.5, 0.5
    return TFMessage(transforms=[transform])


def load(path, raw):
    if raw:
        from PIL import Image as Pillow
        picture = Pillow.open(path).convert("RGB")
        return Image(width=picture.width, height=picture.height, encoding="rgb8",
                     step=3 * picture.width, data=picture.tobytes())
    with open(path, "rb") as file:
        return CompressedImage(format="jpeg", data=file.read())


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("demo", help="the folder data/demo of posevote")
    parser.add_argument("bag", help="the file to write; for ROS 2 a folder")
    parser.add_argument("--seconds", type=float, default=2, help="that each scene is shown")
    parser.add_argument("--rate", type=float, default=10, help="pictures per second")
    parser.add_argument("--raw", action="store_true", help="pixels instead of JPEG")
    arguments = parser.parse_args()
    scenes = sorted(glob.glob(os.path.join(arguments.demo, "test", "*.jpg")))
    if not scenes:
        sys.exit("make_demo_bag: there are no scenes in '%s/test'" % arguments.demo)
    topic = "/camera/image_raw" + ("" if arguments.raw else "/compressed")
    bag = (Bag2 if os.environ.get("ROS_VERSION") == "2" else Bag1)(arguments.bag)
    stamp_ns = SECOND
    info = camera_info()
    for scene in scenes:
        picture = load(scene, arguments.raw)
        for _ in range(max(1, round(arguments.seconds * arguments.rate))):
            stamp = bag.time(stamp_ns)
            bag.write("/tf", camera_transform(stamp), stamp_ns)
            for message, name in ((info, "/camera/camera_info"), (picture, topic)):
                message.header.stamp = stamp
                message.header.frame_id = FRAME
                bag.write(name, message, stamp_ns)
            stamp_ns += round(SECOND / arguments.rate)
    bag.close()
    print("%s: %d scenes" % (arguments.bag, len(scenes)))


if __name__ == "__main__":
    main()
