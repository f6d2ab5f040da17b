"""The launch file's node from outside: pictures in, named detections out; every service; parameters;
bad pictures; the page beside it."""
import json
import os
import socket
import tempfile
import unittest
import urllib.request

import launch
import launch_testing.actions
import launch_testing.asserts
import pytest
from ament_index_python.packages import get_package_share_directory
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import TransformStamped
from launch.launch_description_sources import PythonLaunchDescriptionSource
from posevote_msgs import srv
from posevote_msgs.msg import DatabaseInfo, DetectionArray
from rcl_interfaces.srv import DescribeParameters, GetParameters
from sensor_msgs.msg import CameraInfo, Image
from tf2_msgs.msg import TFMessage
from vision_msgs.msg import Detection2DArray, Detection3DArray
from visualization_msgs.msg import MarkerArray

import demo

FOLDER = tempfile.mkdtemp()
DETECTIONS = demo.NODE + "/detections"
with socket.socket() as free:
    free.bind(("127.0.0.1", 0))
    LISTEN = "127.0.0.1:%d" % free.getsockname()[1]


@pytest.mark.launch_test
def generate_test_description():
    file = os.path.join(get_package_share_directory("posevote_ros"), "launch", "posevote.launch.py")
    arguments = {"image": demo.CAMERA, "database": os.path.join(FOLDER, "recognition.db"),
                 "tf": "true", "studio": "true", "listen": LISTEN}
    return launch.LaunchDescription([
        launch.actions.IncludeLaunchDescription(PythonLaunchDescriptionSource(file),
                                                launch_arguments=arguments.items()),
        launch_testing.actions.ReadyToTest()])


def http(path, **request):
    request = urllib.request.Request("http://" + LISTEN + path, **request)
    with urllib.request.urlopen(request, timeout=demo.TIMEOUT_S) as answer:
        return answer.read()


class RecognitionTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = demo.Robot()
        assert cls.robot.wait_until(lambda: cls.robot.state() == demo.ACTIVE), "it does not start"

    @classmethod
    def tearDownClass(cls):
        cls.robot.close()

    def setUp(self):
        self.robot.forget_objects()
        self.robot.teach_poster()
        self.collectors = []

    def tearDown(self):
        for collector in self.collectors:
            self.robot.forget(collector)
        self.assertTrue(self.call("set_active_objects", srv.SetActiveObjects).success)

    def call(self, name, kind, **fields):
        return self.robot.call(name, kind, **fields)

    def collect(self, topic, kind, qos=10):
        self.collectors.append(self.robot.collect(topic, kind, qos))
        return self.collectors[-1]

    def send_camera_info(self):
        """Its answer to a later picture knows the camera; it may be lost like a picture."""
        self.robot.publish(demo.camera_info(), "/camera/camera_info")

    def test_detections_have_names_and_the_pictures_header(self):
        detections = self.collect(DETECTIONS, DetectionArray)
        picture = demo.image(demo.SCENE)
        answer = self.robot.ask(detections, picture)
        self.assertEqual(answer.header, picture.header)
        self.assertEqual((answer.image_width, answer.image_height), (1280, 960))
        self.assertEqual([d.object for d in answer.detections], ["poster"])
        found = answer.detections[0]
        self.assertGreater(found.probability, 0.9)
        self.assertGreater(found.inliers, 20)
        self.assertAlmostEqual(found.box.x, 270, delta=12)
        self.assertAlmostEqual(found.box.width, 285, delta=20)
        self.assertEqual(found.homography[8], 1)
        self.assertGreaterEqual(len(found.outline), 4)
        again = self.robot.ask(detections, picture)
        self.assertTrue(again.detections[0].confirmed)
        self.assertEqual(again.detections[0].track, found.track)
        empty = self.robot.ask(detections, demo.image("test/strangers.jpg", "mono8"))
        self.assertEqual(len(empty.detections), 0)

    def test_annotated_picture_and_markers(self):
        annotated = self.collect(demo.NODE + "/annotated", Image)
        markers = self.collect(demo.NODE + "/markers", MarkerArray)
        picture = demo.image(demo.SCENE, "mono8")
        drawn = self.robot.ask(annotated, picture)
        self.assertEqual((drawn.width, drawn.height, drawn.encoding), (1280, 960, "bgr8"))
        self.assertEqual(drawn.header, picture.header)

        def shown():
            self.send_camera_info()
            self.robot.ask(annotated, picture)
            return [m for m in markers if len(m.markers) == 3]
        found = self.robot.wait_until(shown)[0].markers
        self.assertEqual(found[2].text, "poster")
        self.assertAlmostEqual(found[1].points[0].z, 1)

    def test_pose_tf_and_vision_msgs_when_the_height_is_known(self):
        self.assertEqual(self.robot.set_parameters(object_heights="poster=0.6"), [""])
        try:
            detections = self.collect(DETECTIONS, DetectionArray)
            flat = self.collect(demo.NODE + "/detections_2d", Detection2DArray)
            solid = self.collect(demo.NODE + "/detections_3d", Detection3DArray)
            frames = self.collect("/tf", TFMessage)
            picture = demo.image(demo.SCENE, "mono8")

            def posed():
                self.send_camera_info()
                return [d for d in self.robot.ask(detections, picture).detections
                        if d.has_pose and d.confirmed]
            found = self.robot.wait_until(posed)[0]
            self.assertAlmostEqual(found.pose.position.z, 1.7, delta=0.15)
            self.assertEqual(found.frame, "posevote/poster_1")

            def of_picture(messages):
                return [m for m in messages if m.header.stamp == picture.header.stamp]
            transform = self.robot.wait_until(
                lambda: of_picture([t for m in frames for t in m.transforms]))[0]
            self.assertIsInstance(transform, TransformStamped)
            self.assertEqual((transform.header.frame_id, transform.child_frame_id),
                             (demo.FRAME, found.frame))
            self.assertEqual(transform.transform.translation.z, found.pose.position.z)

            box = self.robot.wait_until(lambda: of_picture(flat))[0].detections[0]
            self.assertEqual(box.results[0].hypothesis.class_id, "poster")
            self.assertGreater(box.results[0].hypothesis.score, 0.9)
            self.assertEqual(box.id, str(found.track))
            self.assertAlmostEqual(box.bbox.center.position.x, 412, delta=12)
            self.assertAlmostEqual(box.bbox.size_x, 285, delta=20)
            body = self.robot.wait_until(lambda: of_picture(solid))[0].detections[0]
            self.assertEqual(body.results[0].hypothesis.class_id, "poster")
            self.assertEqual(body.results[0].pose.pose, found.pose)
            self.assertAlmostEqual(body.bbox.size.y, 0.6)
        finally:
            self.assertEqual(self.robot.set_parameters(object_heights=""), [""])

    def test_parameters_have_ranges_and_refuse_what_lies_outside(self):
        octaves, rule = self.call("describe_parameters", DescribeParameters,
                                  names=["feature.surf.octaves", "rule"]).descriptors
        self.assertEqual((octaves.integer_range[0].from_value, octaves.integer_range[0].to_value),
                         (1, 8))
        self.assertIn("Octaves", octaves.description)
        self.assertIn("paper", rule.additional_constraints)
        names = ["track.confirm_after", "publish_tf", "feature.kind"]

        def values():
            answer = self.call("get_parameters", GetParameters, names=names).values
            return answer[0].integer_value, answer[1].bool_value, answer[2].string_value
        before = values()
        self.assertEqual(before, (2, True, "surf"))  # of the file, an argument, the library
        self.assertEqual(self.robot.set_parameters(track__confirm_after=3), [""])
        self.assertEqual(values()[0], 3)
        for wrong in ({"feature__surf__octaves": 9}, {"feature__kind": "sift"}, {"rule": "none"},
                      {"object_heights": "poster"}, {"database": "other.db"},
                      {"track__confirm_after": "many"}):
            self.assertNotEqual(self.robot.set_parameters(**wrong), [""], wrong)
        self.assertEqual(self.robot.set_parameters(track__confirm_after=before[0]), [""])
        self.assertEqual(values(), before)

    def test_detect_once_in_a_given_picture(self):
        picture = demo.image(demo.SCENE)
        picture.header.stamp.sec = 77
        answer = self.call("detect", srv.Detect, image=picture, annotate=True)
        self.assertTrue(answer.success, answer.message)
        self.assertEqual([d.object for d in answer.result.detections], ["poster"])
        self.assertEqual(answer.result.header, picture.header)
        self.assertEqual(answer.result.detections[0].track, 0)
        self.assertEqual(answer.annotated.width, 1280)

    def test_detect_once_in_the_cameras_next_picture(self):
        picture = demo.image(demo.SCENE, "mono8")
        timer = self.robot.node.create_timer(
            0.5, lambda: self.robot.camera(Image).publish(picture))
        answer = self.call("detect", srv.Detect, timeout_s=30.0)
        self.robot.node.destroy_timer(timer)
        self.assertTrue(answer.success, answer.message)
        self.assertEqual([d.object for d in answer.result.detections], ["poster"])
        self.assertEqual(answer.annotated.width, 0)

    def test_detect_says_when_no_picture_comes(self):
        answer = self.call("detect", srv.Detect, timeout_s=0.2)
        self.assertFalse(answer.success)
        self.assertIn(demo.CAMERA, answer.message)

    def test_rename_remove_and_list(self):
        self.assertTrue(self.call("rename_object", srv.RenameObject, object="poster",
                                  new_name="print").success)
        self.assertEqual(self.robot.objects(), ["print"])
        wrong = self.call("rename_object", srv.RenameObject, object="poster", new_name="x")
        self.assertFalse(wrong.success)
        self.assertIn("poster", wrong.message)
        self.assertFalse(self.call("remove_object", srv.RemoveObject, object="print",
                                   view="none").success)
        self.assertTrue(self.call("remove_object", srv.RemoveObject, object="print").success)
        self.assertEqual(self.robot.objects(), [])
        self.assertFalse(self.call("remove_object", srv.RemoveObject, object="print").success)

    def test_save_export_import(self):
        file = os.path.join(FOLDER, "exported.posevote")
        written = self.call("export_objects", srv.ExportObjects, path=file, objects=["poster"])
        self.assertTrue(written.success, written.message)
        self.assertEqual((written.objects_written, written.views_written), (1, 1))
        self.assertFalse(self.call("export_objects", srv.ExportObjects, path=file).success)
        self.assertFalse(self.call("import_objects", srv.ImportObjects, path=file).success)
        merged = self.call("import_objects", srv.ImportObjects, path=file, on_conflict="merge")
        self.assertEqual((merged.success, merged.views_known), (True, 1))
        self.assertTrue(self.call("remove_object", srv.RemoveObject, object="poster").success)
        self.assertTrue(self.call("import_objects", srv.ImportObjects, path=file).success)
        self.assertEqual(self.robot.objects(), ["poster"])
        copy = os.path.join(FOLDER, "saved.db")
        saved = self.call("save_database", srv.SaveDatabase, path=copy)
        self.assertEqual((saved.success, saved.path), (True, copy))
        self.assertTrue(os.path.exists(copy))

    def test_active_objects(self):
        feedback = []
        result, _ = self.robot.teach(
            feedback.append, object="mug", turn_deg=30.0,
            images=[demo.image("train/mug/y%03d.jpg" % yaw) for yaw in (0, 30)],
            background=demo.image("train/mug/background.jpg"))
        self.assertTrue(result.success, result.message)
        self.assertEqual(result.views_added, 2)
        self.assertEqual((feedback[0].step, feedback[0].views_wanted), ("object", 2))
        self.assertTrue(self.call("set_active_objects", srv.SetActiveObjects,
                                  objects=["mug"]).success)
        answer = self.call("detect", srv.Detect, image=demo.image(demo.SCENE))
        self.assertNotIn("poster", [d.object for d in answer.result.detections])
        self.assertFalse(self.call("set_active_objects", srv.SetActiveObjects,
                                   objects=["nothing"]).success)
        listed = self.call("list_objects", srv.ListObjects).database
        self.assertEqual({o.object: o.active for o in listed.objects},
                         {"mug": True, "poster": False})

    def test_database_is_latched_and_follows_the_page(self):
        infos = self.collect(demo.NODE + "/database", DatabaseInfo, demo.LATCHED)

        def info_with(*names):
            found = self.robot.wait_until(
                lambda: [m for m in infos if [o.object for o in m.objects] == list(names)])
            self.assertTrue(found, names)
            return found[0]
        first = info_with("poster")
        self.assertTrue(first.location.endswith("recognition.db"))
        self.assertEqual(first.features, "surf")
        self.assertIn(b"<html", http("/").lower())
        listed = json.loads(http("/api/objects"))
        self.assertIn("poster", json.dumps(listed))
        http("/api/objects/poster", method="PATCH", data=b'{"object": "print"}',
             headers={"Content-Type": "application/json"})
        renamed = info_with("print")
        self.assertGreater(renamed.version, first.version)
        answer = self.call("detect", srv.Detect, image=demo.image(demo.SCENE))
        self.assertEqual([d.object for d in answer.result.detections], ["print"])

    def test_bad_pictures_are_refused_and_the_node_lives(self):
        detections = self.collect(DETECTIONS, DetectionArray)
        diagnostics = self.collect("/diagnostics", DiagnosticArray)
        good = demo.image(demo.SCENE, "mono8")
        self.robot.ask(detections, good)
        bad = [Image(),
               Image(width=1280, height=960, step=3840, encoding="rgb8", data=b"short"),
               Image(width=4000000000, height=4000000000, step=1, encoding="mono8", data=b"x"),
               Image(width=2, height=2, step=2, encoding="no such", data=b"1234"),
               Image(width=1, height=1, step=1, encoding="mono8", data=b"1")]  # a picture, small
        for message in bad:
            self.robot.publish(message)
            self.robot.wait_until(lambda: False, 0.2)  # else the newest only is looked at

        def refused():
            return [s for m in diagnostics for s in m.status for v in s.values
                    if v.key == "refused" and int(v.value) > 0]
        self.assertTrue(self.robot.wait_until(refused))
        for message in bad[1:4]:
            answer = self.call("detect", srv.Detect, image=message)
            self.assertFalse(answer.success)
            self.assertNotEqual(answer.message, "")
        answer = self.robot.ask(detections, good)
        self.assertEqual([d.object for d in answer.detections], ["poster"])
        names = {s.name for m in diagnostics for s in m.status}
        self.assertEqual(names, {"posevote: recognition", "posevote: database"})

    def test_goals_that_make_no_sense_are_aborted(self):
        for fields in ({"method": "magic"}, {"method": "box"}, {}):
            result, succeeded = self.robot.teach(object="x", images=[
                demo.image("train/poster/cover.jpg")], **fields)
            self.assertFalse(result.success or succeeded)
            self.assertNotEqual(result.message, "")
        self.assertEqual(self.robot.objects(), ["poster"])


@launch_testing.post_shutdown_test()
class AfterwardsTest(unittest.TestCase):
    def test_all_ended_well(self, proc_info):
        launch_testing.asserts.assertExitCodes(proc_info)
