#!/usr/bin/python3
"""The node from outside: pictures in, named detections out; every service; bad pictures."""
import os
import sys
import unittest

import dynamic_reconfigure.client
import rospy
import rostest
import tf2_ros
from diagnostic_msgs.msg import DiagnosticArray
from posevote_msgs import srv
from posevote_msgs.msg import DatabaseInfo, DetectionArray, TeachGoal
from sensor_msgs.msg import CameraInfo, Image
from visualization_msgs.msg import MarkerArray

try:
    from vision_msgs.msg import Detection2DArray, Detection3DArray
except ImportError:  # then the node was built without them
    Detection2DArray = None

import demo

NODE = "/posevote/"
CAMERA = "/camera/image_raw"
SCENE = "test/reading.jpg"


def call(name, kind, **fields):
    rospy.wait_for_service(NODE + name, 30)
    return rospy.ServiceProxy(NODE + name, kind)(**fields)


def objects():
    return sorted(o.object for o in call("list_objects", srv.ListObjects).database.objects)


def teach(client, name, images, background=None, **fields):
    feedback = []
    goal = TeachGoal(object=name, images=images, **fields)
    if background:
        goal.background = background
    client.send_goal(goal, feedback_cb=feedback.append)
    result = client.wait_for_result()
    assert result, "no result"
    return result, feedback


class RecognitionTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.teaching = demo.TeachClient()

    def setUp(self):
        self.images = rospy.Publisher(CAMERA, Image, queue_size=1)
        self.infos = rospy.Publisher("/camera/camera_info", CameraInfo, queue_size=1, latch=True)
        for name in objects():
            self.assertTrue(call("remove_object", srv.RemoveObject, object=name).success)
        result, _ = teach(self.teaching, "poster", [demo.image("train/poster/cover.jpg")],
                          method="whole")
        self.assertTrue(result.success, result.message)
        self.collectors = []

    def tearDown(self):
        for collector in self.collectors:
            collector.close()
        self.assertTrue(call("set_active_objects", srv.SetActiveObjects).success)

    def collect(self, topic, kind):
        self.collectors.append(demo.Collector(topic, kind))
        return self.collectors[-1]

    def send(self, message):
        self.assertTrue(demo.wait_until(lambda: self.images.get_num_connections() > 0),
                        "the node does not subscribe")
        self.images.publish(message)

    def ask(self, detections, message):
        self.send(message)
        answer = detections.wait_for(lambda m: m.header.stamp == message.header.stamp)
        self.assertIsNotNone(answer, "no answer with the picture's stamp")
        return answer

    def test_detections_have_names_and_the_pictures_header(self):
        detections = self.collect(NODE + "detections", DetectionArray)
        answer = self.ask(detections, demo.image(SCENE, rospy.Time(1234, 567000000)))
        self.assertEqual(answer.header.frame_id, demo.FRAME)
        self.assertEqual((answer.image_width, answer.image_height), (1280, 960))
        self.assertEqual([d.object for d in answer.detections], ["poster"])
        found = answer.detections[0]
        self.assertGreater(found.probability, 0.9)
        self.assertGreater(found.inliers, 20)
        self.assertAlmostEqual(found.box.x, 270, delta=12)
        self.assertAlmostEqual(found.box.width, 285, delta=20)
        self.assertEqual(found.homography[8], 1)
        self.assertGreaterEqual(len(found.outline), 4)
        self.assertFalse(found.has_pose)
        again = self.ask(detections, demo.image(SCENE))
        self.assertTrue(again.detections[0].confirmed)
        self.assertEqual(again.detections[0].track, found.track)
        empty = self.ask(detections, demo.image("test/strangers.jpg"))
        self.assertEqual(empty.detections, [])

    def test_camera_is_left_alone_while_nobody_listens(self):
        self.assertTrue(demo.wait_until(lambda: self.images.get_num_connections() == 0))
        detections = self.collect(NODE + "detections", DetectionArray)
        self.assertTrue(demo.wait_until(lambda: self.images.get_num_connections() == 1))
        detections.close()
        self.assertTrue(demo.wait_until(lambda: self.images.get_num_connections() == 0))

    def test_annotated_picture_and_markers(self):
        annotated = self.collect(NODE + "annotated", Image)
        markers = self.collect(NODE + "markers", MarkerArray)
        self.infos.publish(demo.camera_info(1280, 960))
        info = self.collect("/camera/camera_info", CameraInfo)
        self.assertIsNotNone(info.wait_for(lambda m: True))
        for _ in range(3):  # the first may overtake the camera_info
            picture = demo.image(SCENE)
            self.send(picture)
            drawn = annotated.wait_for(lambda m: m.header.stamp == picture.header.stamp)
            self.assertIsNotNone(drawn)
            self.assertEqual((drawn.width, drawn.height, drawn.encoding), (1280, 960, "bgr8"))
        shown = markers.wait_for(lambda m: len(m.markers) == 3)
        self.assertIsNotNone(shown, "no outline and name")
        self.assertEqual(shown.markers[2].text, "poster")
        self.assertAlmostEqual(shown.markers[1].points[0].z, 1)

    def test_pose_and_tf_when_the_height_is_known(self):
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        client = dynamic_reconfigure.client.Client("/posevote", timeout=30)
        client.update_configuration({"object_heights": "poster=0.6", "publish_tf": True})
        try:
            detections = self.collect(NODE + "detections", DetectionArray)
            self.infos.publish(demo.camera_info(1280, 960))

            def posed():
                return [d for d in self.ask(detections, demo.image(SCENE)).detections
                        if d.has_pose and d.confirmed]
            self.assertTrue(demo.wait_until(posed))
            found = posed()[0]
            self.assertAlmostEqual(found.pose.position.z, 1.7, delta=0.15)
            self.assertEqual(found.frame, "posevote/poster_1")
            transform = buffer.lookup_transform(demo.FRAME, found.frame, rospy.Time(0),
                                                rospy.Duration(20))
            self.assertAlmostEqual(transform.transform.translation.z, found.pose.position.z,
                                   delta=0.01)
        finally:
            client.update_configuration({"object_heights": "", "publish_tf": False})
            listener.unregister()

    @unittest.skipUnless(Detection2DArray, "there is no vision_msgs")
    def test_vision_msgs_have_boxes_and_poses(self):
        client = dynamic_reconfigure.client.Client("/posevote", timeout=30)
        client.update_configuration({"object_heights": "poster=0.6"})
        try:
            flat = self.collect(NODE + "detections_2d", Detection2DArray)
            solid = self.collect(NODE + "detections_3d", Detection3DArray)
            self.infos.publish(demo.camera_info(1280, 960))

            def answer():  # the first pictures may overtake the camera_info
                picture = demo.image(SCENE)
                self.send(picture)
                return solid.wait_for(lambda m: m.header.stamp == picture.header.stamp)
            self.assertTrue(demo.wait_until(lambda: answer().detections))
            box = flat.messages[-1].detections[0].bbox
            self.assertAlmostEqual(box.center.x, 412, delta=12)
            self.assertAlmostEqual(box.size_x, 285, delta=20)
            found = solid.messages[-1].detections[0]
            self.assertEqual(found.results[0].id, 0)  # its place in the database
            self.assertGreater(found.results[0].score, 0.9)
            self.assertAlmostEqual(found.results[0].pose.pose.position.z, 1.7, delta=0.15)
            self.assertAlmostEqual(found.bbox.size.y, 0.6)
        finally:
            client.update_configuration({"object_heights": ""})

    def test_parameters_have_ranges_and_refuse_what_lies_outside(self):
        client = dynamic_reconfigure.client.Client("/posevote", timeout=30)
        descriptions = {d["name"]: d for d in client.get_parameter_descriptions()}
        octaves = descriptions["feature__surf__octaves"]
        self.assertEqual((octaves["min"], octaves["max"], octaves["default"]), (1, 8, 4))
        self.assertIn("Octaves", octaves["description"])
        self.assertIn("'value': 'paper'", descriptions["rule"]["edit_method"])
        self.assertNotIn("database", descriptions)
        before = client.get_configuration()["track__confirm_after"]
        self.assertEqual(client.update_configuration({"track__confirm_after": 3})
                         ["track__confirm_after"], 3)
        refused = client.update_configuration({"feature__kind": "sift"})
        self.assertEqual(refused["feature__kind"], "surf")
        client.update_configuration({"track__confirm_after": before})

    def test_detect_once_in_a_given_picture(self):
        picture = demo.image(SCENE, rospy.Time(77))
        answer = call("detect", srv.Detect, image=picture, camera_info=CameraInfo(), timeout_s=0,
                      annotate=True)
        self.assertTrue(answer.success, answer.message)
        self.assertEqual([d.object for d in answer.result.detections], ["poster"])
        self.assertEqual(answer.result.header, picture.header)
        self.assertEqual(answer.result.detections[0].track, 0)
        self.assertEqual(answer.annotated.width, 1280)

    def test_detect_once_in_the_cameras_next_picture(self):
        picture = demo.image(SCENE)
        timer = rospy.Timer(rospy.Duration(0.2), lambda _: self.images.publish(picture))
        answer = call("detect", srv.Detect, timeout_s=30)
        timer.shutdown()
        self.assertTrue(answer.success, answer.message)
        self.assertEqual([d.object for d in answer.result.detections], ["poster"])
        self.assertEqual(answer.annotated.width, 0)

    def test_detect_says_when_no_picture_comes(self):
        answer = call("detect", srv.Detect, timeout_s=0.2)
        self.assertFalse(answer.success)
        self.assertIn(CAMERA, answer.message)

    def test_rename_remove_and_list(self):
        self.assertTrue(call("rename_object", srv.RenameObject, object="poster",
                             new_name="print").success)
        self.assertEqual(objects(), ["print"])
        wrong = call("rename_object", srv.RenameObject, object="poster", new_name="x")
        self.assertFalse(wrong.success)
        self.assertIn("poster", wrong.message)
        self.assertFalse(call("remove_object", srv.RemoveObject, object="print",
                              view="none").success)
        self.assertTrue(call("remove_object", srv.RemoveObject, object="print").success)
        self.assertEqual(objects(), [])
        self.assertFalse(call("remove_object", srv.RemoveObject, object="print").success)

    def test_save_export_import(self):
        folder = rospy.get_param("/folder")
        file = os.path.join(folder, "exported.posevote")
        written = call("export_objects", srv.ExportObjects, path=file, objects=["poster"],
                       overwrite=True)
        self.assertTrue(written.success, written.message)
        self.assertEqual((written.objects_written, written.views_written), (1, 1))
        self.assertFalse(call("export_objects", srv.ExportObjects, path=file).success)
        self.assertFalse(call("import_objects", srv.ImportObjects, path=file).success)
        merged = call("import_objects", srv.ImportObjects, path=file, on_conflict="merge")
        self.assertEqual((merged.success, merged.views_known), (True, 1))
        self.assertTrue(call("remove_object", srv.RemoveObject, object="poster").success)
        self.assertTrue(call("import_objects", srv.ImportObjects, path=file).success)
        self.assertEqual(objects(), ["poster"])
        copy = os.path.join(folder, "saved.db")
        if os.path.exists(copy):
            os.remove(copy)
        saved = call("save_database", srv.SaveDatabase, path=copy)
        self.assertEqual((saved.success, saved.path), (True, copy))
        self.assertTrue(os.path.exists(copy))

    def test_active_objects(self):
        result, feedback = teach(self.teaching, "mug", [demo.image("train/mug/y%03d.jpg" % yaw)
                                         for yaw in (0, 30)],
                                 demo.image("train/mug/background.jpg"), turn_deg=30)
        self.assertTrue(result.success, result.message)
        self.assertEqual(result.views_added, 2)
        self.assertEqual(feedback[0].step, "object")  # the last may come after the result
        self.assertEqual(feedback[0].views_wanted, 2)
        self.assertTrue(call("set_active_objects", srv.SetActiveObjects, objects=["mug"]).success)
        answer = call("detect", srv.Detect, image=demo.image(SCENE))
        self.assertNotIn("poster", [d.object for d in answer.result.detections])
        wrong = call("set_active_objects", srv.SetActiveObjects, objects=["nothing"])
        self.assertFalse(wrong.success)
        listed = call("list_objects", srv.ListObjects).database
        self.assertEqual({o.object: o.active for o in listed.objects},
                         {"mug": True, "poster": False})

    def test_database_is_latched_and_follows(self):
        infos = self.collect(NODE + "database", DatabaseInfo)
        info = infos.wait_for(lambda m: [o.object for o in m.objects] == ["poster"])
        self.assertIsNotNone(info)
        self.assertTrue(info.location.endswith("recognition.db"))
        self.assertEqual(info.features, "surf")
        call("rename_object", srv.RenameObject, object="poster", new_name="print")
        renamed = infos.wait_for(lambda m: [o.object for o in m.objects] == ["print"])
        self.assertIsNotNone(renamed)
        self.assertGreater(renamed.version, info.version)

    def test_bad_pictures_are_refused_and_the_node_lives(self):
        detections = self.collect(NODE + "detections", DetectionArray)
        diagnostics = self.collect("/diagnostics", DiagnosticArray)
        good = demo.image(SCENE)
        bad = [Image(),
               Image(width=1280, height=960, step=3840, encoding="rgb8", data=b"short"),
               Image(width=4000000000, height=4000000000, step=1, encoding="mono8", data=b"x"),
               Image(width=2, height=2, step=2, encoding="no such", data=b"1234"),
               Image(width=1, height=1, step=1, encoding="mono8", data=b"1")]  # a picture, small
        for message in bad:
            self.send(message)
            rospy.sleep(0.2)  # else the newest only is looked at
        self.assertIsNotNone(diagnostics.wait_for(
            lambda m: any("cannot be used" in s.message or any(
                v.key == "refused" and int(v.value) > 0 for v in s.values) for s in m.status)))
        for message in bad[1:4]:
            answer = call("detect", srv.Detect, image=message)
            self.assertFalse(answer.success)
            self.assertIn("cannot be used", answer.message)
        self.assertEqual([d.object for d in self.ask(detections, good).detections], ["poster"])

    def test_goals_that_make_no_sense_are_aborted(self):
        picture = demo.image("train/poster/cover.jpg")
        for fields in ({"method": "magic"}, {"method": "box"}, {}):
            result, _ = teach(self.teaching, "x", [picture], **fields)
            self.assertFalse(result.success)
            self.assertNotEqual(result.message, "")
        self.assertEqual(objects(), ["poster"])


if __name__ == "__main__":
    rospy.init_node("recognition_test")
    rostest.rosrun("posevote_ros", "recognition", RecognitionTest, sys.argv)
