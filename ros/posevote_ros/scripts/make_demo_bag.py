#!/usr/bin/python3
"""Writes a bag of the demo's scenes, as a calibrated camera would send them.

usage: make_demo_bag.py DEMO_FOLDER BAG [--seconds 2] [--rate 10] [--raw]

Topics: /camera/image_raw/compressed (the JPEG files as they are; with --raw: /camera/image_raw,
which needs python3-pil), /camera/camera_info and /tf, in which camera_link looks along x, with z up.
Each scene is shown for some seconds.
"""
import argparse
import glob
import os
import sys

import genpy
import rosbag
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import CameraInfo, CompressedImage, Image
from tf2_msgs.msg import TFMessage

FRAME = "camera_optical"
WIDTH, HEIGHT = 1280, 960
FOCAL_PX = 1100.0  # of the camera that the scenes were rendered with, about


def camera_info():
    cx, cy = (WIDTH - 1) / 2, (HEIGHT - 1) / 2
    return CameraInfo(width=WIDTH, height=HEIGHT, distortion_model="plumb_bob", D=[0.0] * 5,
                      K=[FOCAL_PX, 0, cx, 0, FOCAL_PX, cy, 0, 0, 1],
                      R=[1, 0, 0, 0, 1, 0, 0, 0, 1],
                      P=[FOCAL_PX, 0, cx, 0, 0, FOCAL_PX, cy, 0, 0, 0, 1, 0])


def camera_transform(stamp):
    transform = TransformStamped(child_frame_id=FRAME)
    transform.header.frame_id = "camera_link"
    transform.header.stamp = stamp
    rotation = transform.transform.rotation
    rotation.x, rotation.y, rotation.z, rotation.w = -0.5, 0.5, -0.5, 0.5
    return TFMessage([transform])


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
    parser.add_argument("bag", help="the file to write")
    parser.add_argument("--seconds", type=float, default=2, help="that each scene is shown")
    parser.add_argument("--rate", type=float, default=10, help="pictures per second")
    parser.add_argument("--raw", action="store_true", help="pixels instead of JPEG")
    arguments = parser.parse_args()
    scenes = sorted(glob.glob(os.path.join(arguments.demo, "test", "*.jpg")))
    if not scenes:
        sys.exit("make_demo_bag: there are no scenes in '%s/test'" % arguments.demo)
    topic = "/camera/image_raw" + ("" if arguments.raw else "/compressed")
    stamp = genpy.Time(1)
    info = camera_info()
    with rosbag.Bag(arguments.bag, "w") as bag:
        for scene in scenes:
            picture = load(scene, arguments.raw)
            for _ in range(max(1, round(arguments.seconds * arguments.rate))):
                bag.write("/tf", camera_transform(stamp), stamp)
                for message, name in ((info, "/camera/camera_info"), (picture, topic)):
                    message.header.stamp = stamp
                    message.header.frame_id = FRAME
                    bag.write(name, message, stamp)
                stamp += genpy.Duration.from_sec(1 / arguments.rate)
    print("%s: %d scenes" % (arguments.bag, len(scenes)))


if __name__ == "__main__":
    main()
